"""A lean process writes and reads what any other does, byte for byte, and keeps less in memory."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

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


@pytest.mark.real
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_an_agent_as_it_is_started_has_no_openssl_in_its_memory() -> None:
    """Whatever options are typed: what reads them imports half of the agent."""
    command = [sys.executable, "-m", "onboard.cli", "--id", "7", "--role", "pursuer", "--game", "lean",
               "--link", "udpin://127.0.0.1:0", "--bus", "tcp/127.0.0.1:1"]  # fmt: skip
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=ROOT) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if "started: pursuer 7" in line:
                break
        maps = Path(f"/proc/{process.pid}/maps").read_text("utf-8")
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=patience(5.0))
    files = {Path(line.split()[-1]).name for line in maps.splitlines() if "/" in line}
    assert any(name.startswith("zenoh") for name in files)
    assert [name for name in files if name.startswith(("libcrypto", "libssl", "_ssl", "_hashlib"))] == []


LOOP = """
from onboard.agent.lean import lean
lean()
import asyncio, sys
from onboard.runtime.fast_loop import loop_factory, loop_name

class Echo(asyncio.DatagramProtocol):
    def connection_made(self, transport): self.transport = transport
    def datagram_received(self, data, address): self.transport.sendto(data.upper(), address)

class Ask(asyncio.DatagramProtocol):
    def __init__(self): self.heard = asyncio.get_running_loop().create_future()
    def datagram_received(self, data, address): self.heard.set_result(data)

async def main():
    loop = asyncio.get_running_loop()
    there, _ = await loop.create_datagram_endpoint(Echo, local_addr=("127.0.0.1", 0))
    here, ask = await loop.create_datagram_endpoint(Ask, remote_addr=there.get_extra_info("sockname")[:2])
    here.sendto(b"heard")
    print(loop_name(loop), (await asyncio.wait_for(ask.heard, 10)).decode(), "ssl" in sys.modules)
    import ssl
    async with asyncio.timeout(10):
        server = await asyncio.start_server(lambda r, w: None, "127.0.0.1", 0)
        port = server.sockets[0].getsockname()[1]
        try:
            context = ssl.create_default_context()
            await loop.create_connection(asyncio.Protocol, "127.0.0.1", port, ssl=context)
        except (RuntimeError, TypeError, ValueError) as error:
            print(type(error).__name__)

with asyncio.Runner(loop_factory=loop_factory()) as runner:
    runner.run(main())
"""


def test_the_loop_of_a_lean_process_moves_datagrams_and_refuses_tls() -> None:
    pytest.importorskip("uvloop")
    told = subprocess.run(
        [sys.executable, "-c", LOOP], check=True, timeout=patience(40.0), cwd=ROOT, text=True,
        stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(ROOT)},
    ).stdout.split()  # fmt: skip
    assert told[:3] == ["uvloop", "HEARD", "False"]
    assert told[3] in {"RuntimeError", "TypeError", "ValueError"}


HINTS = """
import sys
import onboard.agent.program
from typing import ForwardRef, get_type_hints
from onboard.agent.lean import settle

kinds = [kind for kind in tuple.__subclasses__() if kind.__module__.startswith("onboard.")]

def hints(kind):
    try:
        return get_type_hints(kind)
    except NameError as error:  # a type that is imported for checking alone
        return str(error)

Theirs = type("Theirs", (), {"__doc__": "Mine.", "__module__": "theirs"})
before = {kind: hints(kind) for kind in kinds}
count = sum(isinstance(one, ForwardRef) for kind in kinds for one in kind.__annotations__.values())
settle()
left = sum(isinstance(one, ForwardRef) for kind in kinds for one in kind.__annotations__.values())
print(len(kinds), count, left, before == {kind: hints(kind) for kind in kinds})
from onboard.wire.bus.messages import Role, State
from onboard.agent import program
print(program.__doc__, Role.__doc__, State.__doc__, kinds[0].__doc__, Role("pursuer").name)
print(str.__doc__ is None, Theirs.__doc__)
"""


def test_named_tuples_tell_the_same_types_afterwards() -> None:
    told = subprocess.run(
        [sys.executable, "-c", HINTS], check=True, timeout=patience(40.0), cwd=ROOT, text=True,
        stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(ROOT)},
    ).stdout.split()  # fmt: skip
    assert int(told[0]) > 100
    assert told[2:4] == ["0", "True"]
    assert told[4:] == ["None", "None", "None", "None", "PURSUER", "False", "Mine."]
    if sys.version_info < (3, 14):
        assert int(told[1]) > 300  # words of types that typing had compiled


def test_a_loop_that_cannot_be_imported_is_done_without(tmp_path: Path) -> None:
    (tmp_path / "uvloop.py").write_text("raise ImportError('for another interpreter')", encoding="utf-8")
    code = """
from onboard.agent.lean import lean
lean()
import sys
from onboard.runtime.fast_loop import loop_factory
print(loop_factory(), "ssl" in sys.modules)
"""
    told = subprocess.run(
        [sys.executable, "-c", code], check=True, timeout=patience(40.0), cwd=ROOT, text=True,
        stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": os.pathsep.join((str(tmp_path), str(ROOT)))},
    ).stdout  # fmt: skip
    assert told.split() == ["None", "False"]


def test_who_calls_the_command_line_keeps_its_own_process_whole() -> None:
    """Afterwards pymavlink still has all its messages, and modules their words."""
    code = (
        "import sys; from onboard.cli import parser, run\n"
        "parser().parse_args(['--id', '3', '--role', 'pursuer'])\n"
        "try: run(['--id', '0'])\n"
        "except Exception as error: print(error)\n"
        "from pymavlink.dialects.v20 import ardupilotmega as dialect\n"
        "import onboard.agent.config as config\n"
        "assert dialect.MAVLink(None, 1, 1).heartbeat_encode.__doc__ and config.load.__doc__\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "id" in done.stdout
