"""A lean process writes and reads what any other does, byte for byte, and keeps less in memory."""

from __future__ import annotations

import json
import os
import subprocess
import sys

from tests.support.paths import ROOT
from tests.support.real_time import patience

# Every message that an agent writes, and every one of the dialect, known or not, as a frame to read.
WALK = """
import sys, json, resource
lean = sys.argv[1] == "lean"
if lean:
    from onboard.agent.lean import lean as leave_out
    leave_out()
from hashlib import sha256
import onboard.agent.program
from onboard.core.math.vectors import Vec
from onboard.wire.mavlink import commands as c
from onboard.wire.mavlink.dialect import checksum, dialect, layout_of
from onboard.wire.mavlink.encoding import _STREAMED, _WRITERS, written
from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.values import AdsbVehicle, Timesync

to = c.Target(7, 1)
said = [
    c.OwnHeartbeat(), c.AdsbHeartbeat(), c.CommandLong(to, 400, (1.0, 2.0)), c.RollTarget(to, 3.0, 0.2),
    c.CommandInt(to, 192, 0, (1.0,), 5, 6, 7.0), c.ParamRead(to, "SYSID_THISMAV"), Timesync(11, 12),
    c.SetupSigning(to, bytes(range(32)), 99), c.VelocityTarget(to, 1.0, Vec(1.0, 2.0, 3.0), 0.5),
    c.PlaceTarget(to, 1.0, 50.1, 30.2, 99.0),
    AdsbVehicle(5, 'UAV5', 50.1, 30.2, 99.0, True, Vec(1.0, 2.0, 3.0), 1.0, True, True),
]
assert {type(one) for one in said} == set(_WRITERS) | set(_STREAMED), "a message is missing here"
digest = sha256()
for one in said:
    layout, payload = written(one)
    digest.update(layout.name.encode() + payload)
read = []
for number in sorted(dialect.mavlink_map):
    layout = layout_of(number)
    payload = bytes((number + 7 * k) % 120 + 1 for k in range(layout.size))
    head = bytes((len(payload), 0, 0, 0, 1, 1)) + number.to_bytes(3, "little")
    crc = checksum(head + payload + layout.crc_extra)
    packets = Framer().feed(b"\\xfd" + head + payload + crc.to_bytes(2, "little"))
    assert len(packets) == (number != 256), number  # a SETUP_SIGNING is for autopilots alone
    read.append(any(packet.value is not None for packet in packets))
    digest.update(repr(packets).encode())
print(json.dumps({
    "digest": digest.hexdigest(), "read": sum(read), "kinds": len(read), "ssl": "ssl" in sys.modules,
    "openssl": "_hashlib" in sys.modules, "resident": int(open("/proc/self/statm").read().split()[1]),
}))
"""


def walked(kind: str) -> dict[str, object]:
    """What a process of this kind says."""
    told = subprocess.run(
        [sys.executable, "-c", WALK, kind], check=True, timeout=patience(60.0), cwd=ROOT,
        stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    found: dict[str, object] = json.loads(told.stdout)
    return found


def test_a_lean_process_reads_and_writes_the_same_bytes() -> None:
    lean, whole = walked("lean"), walked("whole")
    assert lean["digest"] == whole["digest"]
    assert lean["kinds"] == whole["kinds"] == 301
    assert isinstance(lean["read"], int)
    assert lean["read"] > 20
    assert (lean["ssl"], lean["openssl"]) == (False, False)
    assert isinstance(lean["resident"], int)
    assert isinstance(whole["resident"], int)
    assert lean["resident"] < 0.95 * whole["resident"]  # 50 and 59 MB


SERVED = """
from onboard.agent.lean import lean
lean()
import hashlib, hmac, ssl
print(ssl.create_default_context().verify_mode.name, hashlib.sha256(b"x").hexdigest()[:8],
      hmac.new(b"k", b"x", "sha256").hexdigest()[:8])
"""


def test_who_needs_openssl_later_has_it() -> None:
    """A bus with keys that does not open is asked by a handshake why: see `onboard.runtime.bus_security`."""
    told = subprocess.run(
        [sys.executable, "-c", SERVED], check=True, timeout=patience(60.0), cwd=ROOT, text=True,
        stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(ROOT)},
    ).stdout  # fmt: skip
    assert told.split() == ["CERT_REQUIRED", "2d711642", "c38edc88"]
