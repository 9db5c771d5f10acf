"""Links as they are met: bridges that cut frames, TCP alone, serial ports into the ground's tools."""

from __future__ import annotations

import asyncio
import os
import pty
import socket
import tty
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from gcs.recording.tlog import TlogRecorder
from onboard.agent.config import AgentConfig
from onboard.agent.preflight import Ears
from onboard.agent.preflight_rows import Mark, Sight, judge
from onboard.game.scenario import Kind
from onboard.runtime.clock import RealClock
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Link
from onboard.runtime.tcp_link import TcpServerLink
from onboard.runtime.udp_link import UdpLink
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.flown_autopilot import FlownAutopilot
from tests.support.real_time import patience

SYSTEM = 2
LISTEN_S = 1.5
PIECE = 128  # bytes that a bridge sends at once


def stream(count: int = 300) -> list[bytes]:
    """What an autopilot sends: whole frames."""
    sender = DialectSender(SYSTEM, 1)
    tilts = [dialect.MAVLink_attitude_message(50 * k, 0.1, 0.2, 0.3, 0, 0, 0) for k in range(count)]
    return [sender.pack(tilt) for tilt in tilts]


def recorded(folder: Path) -> list[bytes]:
    """The frames of the vehicle's log."""
    return [entry.packet.raw for entry in read_tlog((folder / f"vehicle-{SYSTEM}.tlog").read_bytes())]


@contextmanager
def serial_port() -> Iterator[tuple[int, str]]:
    """The other end of a serial port, and its device."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    os.set_blocking(master, False)
    yield master, os.ttyname(slave)
    os.close(master)
    os.close(slave)


async def written(master: int, data: bytes) -> None:
    """Write what a device says, as fast as it is taken."""
    async with asyncio.timeout(patience(5.0)):
        while data:
            with suppress(BlockingIOError):
                data = data[os.write(master, data[:PIECE]) :]
            await asyncio.sleep(0.0)


async def heard(recorder: TlogRecorder, folder: Path, count: int) -> list[bytes]:
    """The recorded frames, once they are there."""
    path = folder / f"vehicle-{SYSTEM}.tlog"
    async with asyncio.timeout(patience(5.0)):
        while True:
            recorder.flush()
            if path.exists() and len(recorded(folder)) >= count:
                return recorded(folder)
            await asyncio.sleep(0.01)


@pytest.mark.real
async def test_the_ground_recorder_hears_a_serial_port(tmp_path: Path) -> None:
    frames, recorder = stream(), TlogRecorder(tmp_path)
    with serial_port() as (master, device):
        link = await open_link(f"{device},57600")
        recorder.hear(link, RealClock().wall_ns)
        await written(master, b"".join(frames))
        assert await heard(recorder, tmp_path, len(frames)) == frames
        link.close()
    recorder.close()


@pytest.mark.real
async def test_the_ground_recorder_puts_a_bridges_pieces_together_beside_a_peer_that_sends_whole_ones(
    tmp_path: Path,
) -> None:
    frames, recorder = stream(), TlogRecorder(tmp_path)
    link = await open_link("udpin:127.0.0.1:0")
    assert isinstance(link, UdpLink)
    recorder.hear(link, RealClock().wall_ns)
    data = b"".join(frames)
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bridge,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other,
    ):
        for at in range(0, len(data), PIECE):
            bridge.sendto(data[at : at + PIECE], link.address)
            other.sendto(frames[0], link.address)
            await asyncio.sleep(0.0)
        pieces = -(-len(data) // PIECE)
        got = await heard(recorder, tmp_path, len(frames) + pieces)
    assert sorted(got) == sorted([*frames, *[frames[0]] * pieces])
    link.close()
    recorder.close()


def row_of(link: Link, seen: Sight, name: str) -> tuple[Mark, str]:
    """A row of the check's table."""
    found = next(row for row in judge(AgentConfig(id=SYSTEM), seen) if row.name == name)
    return found.mark, found.found


@pytest.mark.real
@pytest.mark.parametrize("way", ["tcp", "serial", "bridge", "called"])
async def test_the_check_finds_an_autopilot_over(way: str) -> None:
    """A real link each, with a simulated autopilot at its other end."""
    flown = FlownAutopilot(Kind.ARDUCOPTER, system=SYSTEM, tick_s=0.05)
    with serial_port() as (master, device):
        if way == "serial":
            mine = await open_link(f"serial:{device}")
        elif way == "tcp":
            far = await open_link("tcpin:127.0.0.1:0")
            assert isinstance(far, TcpServerLink)
            mine = await open_link(f"tcp:127.0.0.1:{far.address[1]}")
        elif way == "called":  # a port that answers only whom it has heard
            far = await open_link("udpin:127.0.0.1:0")
            assert isinstance(far, UdpLink)
            mine = await open_link(f"udpout:127.0.0.1:{far.address[1]}")
        else:
            mine = await open_link("udpin:127.0.0.1:0")
            assert isinstance(mine, UdpLink)
            far = await open_link(f"udpout:127.0.0.1:{mine.address[1]}")

        def arrived(data: bytes, peer: object) -> None:
            flown.autopilot.receive(flown.now_ns, data, "agent")

        def say(data: bytes) -> None:
            if way == "serial":
                os.write(master, data)
                return
            size = PIECE if way == "bridge" else 4096
            for at in range(0, len(data), size):
                far.send(data[at : at + size])

        async def fly() -> None:
            while True:
                flown.forward(0.05)
                say(b"".join(flown.frames))
                flown.frames.clear()
                if way == "serial":
                    with suppress(BlockingIOError):
                        arrived(os.read(master, 65536), None)
                await asyncio.sleep(0.02)

        if way != "serial":
            far.receive(arrived)
        task = asyncio.create_task(fly())
        ears = Ears(AgentConfig(id=SYSTEM), [mine], None, None, RealClock())
        seen = await ears.listen(Sight(), LISTEN_S)
        task.cancel()
        mine.close()
        if way != "serial":
            far.close()
    assert row_of(mine, seen, "autopilot")[0] is Mark.PASS
    assert row_of(mine, seen, "link")[0] is Mark.PASS
    assert seen.telemetry.position_at > seen.now - LISTEN_S  # it flies on to the end
    assert len(seen.parameters or {}) > 5  # it hears us, too


@pytest.mark.real
async def test_the_check_names_two_autopilots_that_send_from_two_ports() -> None:
    mine = await open_link("udpin:127.0.0.1:0")
    assert isinstance(mine, UdpLink)
    far = [await open_link(f"udpout:127.0.0.1:{mine.address[1]}") for _ in range(2)]
    flown = [FlownAutopilot(Kind.ARDUCOPTER, system=SYSTEM, tick_s=0.05) for _ in range(2)]
    flown[1].forward(30.0)  # switched on earlier

    async def fly() -> None:
        while True:
            for one, link in zip(flown, far, strict=True):
                one.forward(0.05)
                for frame in one.frames:
                    link.send(frame)
                one.frames.clear()
                await asyncio.sleep(0.02)

    flown[1].frames.clear()
    task = asyncio.create_task(fly())
    seen = await Ears(AgentConfig(id=SYSTEM), [mine], None, None, RealClock()).listen(Sight(), LISTEN_S)
    task.cancel()
    for link in (mine, *far):
        link.close()
    assert row_of(mine, seen, "system id") == (Mark.FAIL, "two autopilots have system id 2")
