"""Floods against an agent in flight, on the bus and on its MAVLink link, from outside the rules and inside.

The agent is a process on a core of its own; on the other core are its autopilot, the listener of a field with
keys (or an open bus), and the flood: 50,000 messages a second, payloads of 50 MB, 20,000 datagrams a second.
Promise: setpoints at 19 Hz at least, no gap above 0.2 s, the autopilot's heartbeat never older than 1.5 s,
and memory that stays. Setpoints are stamped by the kernel.
`nice -n -20 python -m tests.benchmarks.bench_floods [KIND ...]`, or with pytest.
"""

from __future__ import annotations

import asyncio
import os
import socket
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import psutil  # type: ignore[import-untyped]
import pytest

from onboard.config.strict import parse
from onboard.game.field_roster import FieldRoster
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.wire.bus import topics
from tests.benchmarks.bench_agent import EVADER, GAME, PURSUER, Stage, agent, running, scenario, udp_port
from tests.support import benchmark_record
from tests.support.bus_stages import free_port
from tests.support.field_keys import Field
from tests.support.real_time import until
from tests.support.setpoint_stopwatch import Stopwatch

LOOK_S = 6.0
MESSAGES_HZ, DATAGRAMS_HZ, HUGE = 50_000, 20_000, 50_000_000
RATE_HZ, GAP_S, HEARTBEAT_S, GROWTH_MB = 19.0, 0.2, 1.5, 40.0  # promised
SHARE = 0.97  # of the positions, where a busy machine sends fewer than 20 a second
MATE = PURSUER + 1
KINDS = {
    "none": "no flood",
    "mate": "a team mate's state and events, 50,000/s",
    "mate-huge": "a team mate's state, payloads of 50 MB",
    "forbidden": "phases, setups and orders by the evader, who may not, 50,000/s",
    "bus-datagrams": "datagrams of a stranger on the port of the bus, 20,000/s",
    "open": "an open bus: phases, tracks, mates by anybody, 50,000/s",
    "open-huge": "an open bus: payloads of 50 MB by anybody",
    "link-foreign": "another system's frames on the link, 20,000/s",
    "link-garbage": "bytes that are no frames on the link, 20,000/s",
    "link-statustext": "STATUSTEXT with the vehicle's own id from another port, 20,000/s",
    "link-own-port": "STATUSTEXT with the vehicle's own id from the autopilot's own port, 20,000/s",
}  # fmt: skip


class Found(NamedTuple):
    """What became of an agent under a flood."""

    kind: str
    sent_hz: float  # of the flood, as far as this machine made it
    positions_hz: float  # of the autopilot, as far as this machine sent them
    rate_hz: float  # setpoints
    gap_s: float  # the longest between two setpoints
    heartbeat_s: float  # the greatest age that the agent reported of its autopilot's heartbeat
    before_mb: float
    after_mb: float
    counted: dict[str, int]  # drops by cause

    def kept(self) -> bool:
        """Whether all promises were."""
        return (
            self.rate_hz >= min(RATE_HZ, SHARE * self.positions_hz) and self.gap_s <= GAP_S
            and self.heartbeat_s <= HEARTBEAT_S and self.after_mb - self.before_mb <= GROWTH_MB
        )  # fmt: skip


# ---------------------------------------------------------------------- the flood, a process of its own


def flood(kind: str, where: str, descriptor: int) -> None:
    """Flood until killed; the number sent so far goes to standard output, a line each half second."""
    if kind == "none":
        time.sleep(3600.0)
    os.nice(8)  # the autopilot on the same core keeps its time
    send, pace = _sender(kind, where, descriptor)
    sent, begun, told = 0, time.monotonic(), 0.0
    while True:
        past = time.monotonic() - begun
        behind = min(int(past * pace) - sent, 2000 if pace > 100 else 1)
        for n in range(behind):
            send(sent + n)
        sent += max(behind, 0)
        if past - told > 0.5:
            told = past
            print(sent, past, flush=True)
        if behind < 20:
            time.sleep(0.0005)


def _sender(kind, where, descriptor):  # type: ignore[no-untyped-def]
    if kind.startswith(("link", "bus-")):
        sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM, fileno=descriptor or None)
        frames, address = _frames(kind), ("127.0.0.1", int(where))

        def to_socket(n: int) -> None:
            try:
                sock.sendto(frames[n % len(frames)], address)
            except OSError:  # its buffer is full
                time.sleep(0.0001)

        return to_socket, DATAGRAMS_HZ
    import zenoh

    config = zenoh.Config.from_file(where) if where.endswith("json5") else zenoh.Config()
    if not where.endswith("json5"):
        config.insert_json5("mode", '"client"')
        config.insert_json5("connect/endpoints", f'["{where}"]')
        config.insert_json5("scouting/multicast/enabled", "false")
    session = zenoh.open(config)
    huge = kind.endswith("huge")
    payload = bytes(HUGE) if huge else topics.STATE.encode(_state())
    mine = [topics.STATE.key(GAME, MATE), topics.EVENTS.key(GAME, MATE)]
    keys = {
        "mate": mine, "mate-huge": mine[:1],
        "forbidden": [topics.PHASE.key(GAME), topics.SETUP.key(GAME), topics.COMMAND.key(GAME, PURSUER)],
        "open": [topics.PHASE.key(GAME), topics.TRACK.key(GAME, EVADER), *mine], "open-huge": mine[:1],
    }[kind]  # fmt: skip

    def to_bus(n: int) -> None:
        session.put(keys[n % len(keys)], payload, congestion_control=zenoh.CongestionControl.DROP)

    return to_bus, 20 if huge else MESSAGES_HZ


def _state():  # type: ignore[no-untyped-def]
    from tests.support.sample_messages import state

    return state(MATE, nonce=MATE)


def _frames(kind: str) -> list[bytes]:
    from onboard.wire.mavlink.dialect import dialect

    if kind == "bus-datagrams":
        return [b"APD1" + bytes(200)]
    if kind == "link-garbage":
        return [b"\xfd" * 300, os.urandom(60)]
    system = 77 if kind == "link-foreign" else PURSUER
    mav = dialect.MAVLink(None, srcSystem=system, srcComponent=1)
    if kind == "link-foreign":
        place = dialect.MAVLink_global_position_int_message(1, 473977420, 85455940, 538000, 50000, 0, 0, 0, 0)
        return [bytes(place.pack(mav))]
    return [bytes(dialect.MAVLink_statustext_message(3, b"boom %d" % n).pack(mav)) for n in range(50)]


# ---------------------------------------------------------------------- the agent under it


def field(place: Path) -> Field:
    """A field with keys, in which everybody of the scenario has a certificate."""
    made = Field(place)
    roles = {id: "evader" if id == EVADER else "pursuer" for id in scenario().ids}
    made.text = (
        f'game = "{GAME}"\nhost = "127.0.0.1"\nport = {made.port}\n'
        '[[stations]]\nname = "bench"\nparts = ["master", "sensor"]\n'
        + "".join(f'[[vehicles]]\nid = {id}\nrole = "{role}"\n' for id, role in roles.items())
    )
    made.roster = parse(made.text, FieldRoster, "roster")
    return made.make()


@contextmanager
def flooding(kind: str, where: str, descriptor: int) -> Iterator[subprocess.Popen[str]]:
    """The flood's process."""
    words = [sys.executable, "-m", "tests.benchmarks.bench_floods", "--flood", kind, where, str(descriptor)]
    keep = (descriptor,) if descriptor else ()
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, pass_fds=keep)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


async def measure(kind: str, folder: Path, core: str) -> Found:
    """One agent in flight on a core of its own, under one flood."""
    port = udp_port()
    locked = not kind.startswith("open")
    if locked:
        keys = field(folder / f"keys-{kind}")
        bus = await open_zenoh(listen=True, config_file=keys.config("bench"))
        command = agent(PURSUER, port, "", "--zenoh", str(keys.config(f"vehicle-{PURSUER}")))
        command[command.index("--bus") : command.index("--bus") + 2] = []
        flooder = keys.config(f"vehicle-{EVADER if kind == 'forbidden' else MATE}")
        where = str(keys.port) if kind == "bus-datagrams" else str(flooder)
    else:
        where = f"tcp/127.0.0.1:{free_port()}"
        bus = await open_zenoh(where, listen=True)
        command = agent(PURSUER, port, where)
    watch = Stopwatch(port, fresh=False)
    world = asyncio.create_task(Stage(watch, bus, None).run())  # cancelled below
    ages: list[float] = []
    counters: dict[str, int] = {}

    def hear(sample: object) -> None:
        report = topics.HEALTH.decode(sample.payload, drops)  # type: ignore[attr-defined]
        if report is not None:
            ages.append(report.heartbeat_age_s)
            counters.update(report.counters)

    drops: Counter[str] = Counter()
    bus.subscribe(topics.HEALTH.key(GAME, PURSUER), hear)
    own = watch.lend() if kind == "link-own-port" else 0
    where = str(port) if kind.startswith("link") else where
    try:
        with running(["taskset", "-c", core, *command], folder / f"{kind}.log") as process:
            await until(lambda: len(watch.arrivals_ns) >= 60 or world.done(), 60.0)
            seen = psutil.Process(process.pid)
            before_mb, peak = seen.memory_info().rss / 1e6, 0.0
            base = dict(counters)
            with flooding(kind, where, own) as storm:
                await asyncio.sleep(2.0)
                ages.clear()
                watch.restart()
                ends = time.monotonic() + LOOK_S
                while time.monotonic() < ends:
                    await asyncio.sleep(0.25)
                    peak = max(peak, seen.memory_info().rss / 1e6)
                positions = watch.positions / LOOK_S
                arrivals, heard = list(watch.arrivals_ns), list(ages)
            told = storm.stdout.read().split() if storm.stdout is not None else []
            sent_hz = float(told[-2]) / float(told[-1]) if len(told) >= 2 else 0.0
            await asyncio.sleep(0.6)
    finally:
        world.cancel()
        await asyncio.gather(world, return_exceptions=True)
        watch.close()
        counted = {k: n for k, n in bus.counters().items() if "limited" in k or "foreign" in k}
        await bus.close()
    gaps = [(b - a) / 1e9 for a, b in pairwise(arrivals)]
    grown = {k: n - base.get(k, 0) for k, n in counters.items() if n > base.get(k, 0) and _is_drop(k)}
    return Found(
        kind, sent_hz, positions, len(gaps) / sum(gaps) if gaps else 0.0, max(gaps, default=99.0),
        max(heard, default=99.0), before_mb, peak,
        grown | {f"listener {k}": n for k, n in counted.items() if n},
    )  # fmt: skip


def _is_drop(name: str) -> bool:
    return "limited" in name or "overrun" in name or name in ("garbage_bytes", "other_autopilot")


def report(kinds: list[str]) -> list[Found]:
    """Measure, print and write down."""
    cores = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, cores[:1])
    found = []
    lines = [
        "An agent in flight on a core of its own; autopilot, listener and flood share the other. Promised:",
        f"setpoints at {RATE_HZ:g} Hz, gaps of {GAP_S:g} s, heartbeat at most {HEARTBEAT_S:g} s old.", "",
        "| flood | sent [1/s] | positions [Hz] | setpoints [Hz] | longest gap [s] | heartbeat [s] "
        "| memory [MB] | counted |",
        "|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    with TemporaryDirectory() as name:
        for kind in kinds:
            one = asyncio.run(measure(kind, Path(name), str(cores[-1])))
            found.append(one)
            counted = ", ".join(f"{k.replace('_', ' ')} {n}" for k, n in sorted(one.counted.items()))
            row = (
                f"| {KINDS[kind]} | {one.sent_hz:,.0f} | {one.positions_hz:.1f} | {one.rate_hz:.1f} "
                f"| {one.gap_s:.3f} | {one.heartbeat_s:.2f} "
                f"| {one.before_mb:.0f} → {one.after_mb:.0f} | {counted} |"
            )
            print(row, "" if one.kept() else "MISSED", flush=True)
            lines.append(row)
    if kinds == list(KINDS):
        command = "nice -n -20 python -m tests.benchmarks.bench_floods"
        benchmark_record.write("floods.md", "An agent under floods", command, lines)
    return found


@pytest.mark.real
def test_an_agent_flies_on_through_every_flood() -> None:
    assert [one for one in report(list(KINDS)) if not one.kept()] == []


def main() -> None:
    """The command line: kinds of floods, all unless told."""
    if sys.argv[1:2] == ["--flood"]:
        flood(sys.argv[2], sys.argv[3], int(sys.argv[4]))
    else:
        report(sys.argv[1:] or list(KINDS))


if __name__ == "__main__":
    main()
