"""`gcs tracks` as a process: what a sensor sends arrives on the bus of a game."""

from __future__ import annotations

import asyncio
import json
import os
import pty
import socket
import sys
import tty
from contextlib import asynccontextmanager, suppress
from pathlib import Path

import pytest

from onboard.runtime.bus_zenoh import open_zenoh
from onboard.wire.bus import topics
from onboard.wire.bus.messages import Track
from onboard.wire.bus.topics import TRACK, Dispatcher
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.bus_stages import free_port
from tests.support.paths import ROOT
from tests.support.real_time import until
from tests.support.sample_messages import GAME, on_bus, setup


@asynccontextmanager
async def feeding(*arguments: str, origin: bool = True):
    """The program beside a bus: (tracks heard, the bus, the process)."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    bus = await open_zenoh(endpoint, listen=True)
    heard: list[Track] = []
    bus.subscribe(TRACK.key(GAME), Dispatcher({}).on(TRACK, heard.append))
    where = ("--origin", "47.4,8.5,400") if origin else ()
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "gcs.cli", "tracks", *arguments, *where, "--bus", endpoint, "--game", GAME,
        stderr=asyncio.subprocess.PIPE, cwd=ROOT,
    )  # fmt: skip
    try:
        yield heard, bus, process
    finally:
        if process.returncode is None:
            process.kill()
        await process.wait()
        await bus.close()


@pytest.mark.real
async def test_a_file_is_played_to_its_end_at_its_own_speed(tmp_path: Path) -> None:
    file = tmp_path / "radar.csv"
    file.write_text(
        "t,track,lat,lon,alt\n" + "".join(f"{0.1 * k},r17,{47.4 + 1e-5 * k},8.5,500\n" for k in range(8))
    )
    async with feeding(str(file), "--map", "R17=3") as (heard, _, process):
        _, err = await process.communicate()
        assert process.returncode == 0
        assert "gcs: fed 8" in err.decode()
    assert [track.id for track in heard][-1] == 3
    assert heard[-1].stamp_ns - heard[0].stamp_ns <= 700_000_000
    assert heard[-1].position[2] == pytest.approx(-100.0, abs=0.1)


@pytest.mark.real
async def test_an_autopilot_on_a_link_is_fed_into_the_game_whose_origin_is_heard() -> None:
    port = free_port()
    async with feeding(f"udpin://127.0.0.1:{port}", "--map", "7=1", origin=False) as (heard, bus, _):
        game = setup(2)
        bus.publish(*on_bus(game), topics.SETUP.delivery)
        sender = DialectSender(7, 1)
        origin = game.origin
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as autopilot:

            def speaks() -> bool:
                place = dialect.MAVLink_global_position_int_message(
                    0, round(origin.latitude_deg * 1e7), round(origin.longitude_deg * 1e7),
                    round((origin.altitude_m + 50.0) * 1e3), 0, 100, 0, 0, 0,
                )  # fmt: skip
                autopilot.sendto(sender.pack(place), ("127.0.0.1", port))
                return bool(heard)

            await until(speaks)
    assert heard[0].id == 1
    assert heard[0].position == pytest.approx((0.0, 0.0, -50.0), abs=0.05)
    assert heard[0].velocity == (1.0, 0.0, 0.0)


@pytest.mark.real
async def test_a_receiver_is_read_over_http_and_over_its_lines() -> None:
    document = json.dumps({"now": 1.0, "aircraft": [
        {"hex": "4ca7b3", "lat": 47.4, "lon": 8.5, "alt_geom": 2000, "seen_pos": 0.0}]}).encode()  # fmt: skip
    line = b"MSG,3,1,1,4CA7B3,1,,,,,,2000,,,47.4,8.5,,,,,,0\r\n"

    async def http(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await reader.readuntil(b"\r\n\r\n")
        writer.write(b"HTTP/1.0 200 OK\r\nContent-Length: %d\r\n\r\n" % len(document) + document)
        writer.close()

    async def lines(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(line)
        writer.close()  # it goes away: the program comes again

    for scheme, serve, path in (("http", http, "/data/aircraft.json"), ("sbs", lines, "")):
        server = await asyncio.start_server(serve, "127.0.0.1", 0)
        port = server.sockets[0].getsockname()[1]
        async with feeding(f"{scheme}://127.0.0.1:{port}{path}", "--map", "4ca7b3=1") as (heard, _, process):
            await until(lambda heard=heard: bool(heard))
            assert process.returncode is None
        assert -heard[0].position[2] == pytest.approx(209.6, abs=0.1)
        server.close()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("x.csv", "--map", "a=1"), "x.csv: no such file"),
        (
            ("radar", "--map", "a=1"),
            "or sbs://HOST:PORT, http://…/aircraft.json, a file ending in .csv, .json or .sbs",
        ),
        (("x.csv",), "--map: found none, expected NUMBER=ID"),
        (("x.csv", "--map", "a=1", "--qnh", "29.92"), "--qnh: found 29.92, expected 870 to 1085"),
        (("x.csv", "--map", "a=1", "--origin", "here"), "--origin: found 'here', expected LAT,LON,ALT"),
        (("sbs://host", "--map", "a=1", "--origin", "47,8,0"), "expected sbs://HOST:PORT"),
    ],
)
async def test_a_mistake_is_one_line(arguments: tuple[str, ...], says: str) -> None:
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "gcs.cli", "tracks", *arguments, "--bus", "tcp/127.0.0.1:1",
        stderr=asyncio.subprocess.PIPE, cwd=ROOT,
    )  # fmt: skip
    _, err = await process.communicate()
    assert process.returncode == 2
    assert says in err.decode()
    assert err.count(b"\n") == 1


@pytest.mark.real
async def test_a_receiver_on_a_serial_port_brings_its_frames_in_pieces_of_any_size() -> None:
    master, slave = pty.openpty()
    tty.setraw(slave)
    sender = DialectSender(7, 1)
    frames = b"".join(
        sender.pack(
            dialect.MAVLink_global_position_int_message(k, 474_000_000 + k, 85_000_000, 500_000, *[0] * 5)
        )
        for k in range(20)
    )
    async with feeding(f"serial://{os.ttyname(slave)}:57600", "--map", "7=1") as (heard, _, process):
        await until(lambda: any(Path(f"/proc/{process.pid}/fd").glob("*")) and _opened(process.pid, slave))

        async def sending() -> None:
            """As a receiver does, again and again: what comes while a port is being set up is thrown away."""
            while True:
                for at in range(0, len(frames), 31):
                    os.write(master, frames[at : at + 31])
                    await asyncio.sleep(0.002)
                await asyncio.sleep(0.5)

        receiver = asyncio.create_task(sending())
        await until(lambda: bool(heard) and heard[-1].position[0] > 0.2)
        receiver.cancel()
    os.close(master)
    os.close(slave)


def _opened(pid: int, terminal: int) -> bool:
    """Whether a process has a terminal open."""
    name = os.ttyname(terminal)
    for fd in Path(f"/proc/{pid}/fd").iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            if os.readlink(fd) == name:
                return True
    return False
