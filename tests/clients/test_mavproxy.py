"""MAVProxy, a ground station nobody here wrote: parameters, modes, arming; its log is read back whole.

It lives in an environment of its own (`make mavproxy`), for it is heavy.
"""

from __future__ import annotations

import asyncio
import os
from collections import Counter
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path

import pytest

from gcs.neighbours.teller import teller
from gcs.picture.values import Picture
from gcs.settings import NeighbourSettings
from onboard.game.scenario import Kind
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.flown_autopilot import FLOWN
from tests.support.paths import ROOT
from tests.support.real_time import patience, until
from tests.support.sample_messages import Tower, setup, track
from tests.support.udp_fleet import HOST, fleet, free_port

PROGRAM = ROOT / ".venv-mavproxy" / "bin" / "mavproxy.py"
KINDS = pytest.mark.parametrize("kind", FLOWN, ids=lambda kind: kind.value)
PLAYED_S = 30.0  # the longest of these stories on a quiet machine
pytestmark = [
    pytest.mark.real,
    pytest.mark.timeout(60),
    pytest.mark.skipif(
        not PROGRAM.exists() and not os.environ.get("CI"),
        reason="MAVProxy is not installed: run `make mavproxy`",
    ),
]
MODES = {  # what is typed → the mode it leads to; `mode OFFBOARD` is broken in MAVProxy for PX4
    Kind.PX4: ("long DO_SET_MODE 129 4 5", "RTL"),
    Kind.ARDUCOPTER: ("mode GUIDED", "GUIDED"),
    Kind.ARDUPLANE: ("mode FBWA", "FBWA"),
}
PARAMETER = {Kind.PX4: "NAV_DLL_ACT", Kind.ARDUCOPTER: "FS_GCS_ENABLE", Kind.ARDUPLANE: "FS_GCS_ENABL"}


class Console:
    """MAVProxy's terminal: what it says, and typing into it."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process
        self.said = ""

    async def listen(self) -> None:
        assert self._process.stdout is not None
        while data := await self._process.stdout.read(4096):
            self.said += data.decode(errors="replace")

    def type(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(line.encode() + b"\n")

    def leave(self) -> None:
        """The end of what is typed ends it."""
        assert self._process.stdin is not None
        self._process.stdin.close()


@asynccontextmanager
async def mavproxy(port: int, folder: Path, more: str = "") -> AsyncIterator[Console]:
    """MAVProxy listening on a port, with its state and its log in a folder."""
    process = await asyncio.create_subprocess_exec(
        str(PROGRAM.with_name("python")),
        "-u",
        str(PROGRAM),
        f"--master=udpin:{HOST}:{port}",
        f"--state-basedir={folder}",
        "--logfile=flight.tlog",
        "--cmd=set flushlogs 1",
        f"--default-modules=log,param,arm,mode,cmdlong,misc{more}",
        cwd=folder,
        env={**os.environ, "HOME": str(folder), "TERM": "dumb"},
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.STDOUT,
    )
    console = Console(process)
    listening = asyncio.create_task(console.listen())
    try:
        yield console
        console.leave()
        await asyncio.wait_for(process.wait(), patience(5.0))
    except TimeoutError:
        pytest.fail(f"MAVProxy said:\n{console.said}")
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
        listening.cancel()
        await asyncio.wait([listening])


@KINDS
async def test_it_fetches_parameters_changes_the_mode_and_arms(kind: Kind, tmp_path: Path) -> None:
    port = free_port()
    async with fleet(kind, [[port], []], ground=True) as vehicles:
        autopilot = vehicles.autopilot(1)
        try:
            async with asyncio.timeout(patience(PLAYED_S)), mavproxy(port, tmp_path) as console:
                received = f"Received {len(autopilot.parameters)} parameters"
                await until(lambda: received in console.said)
                console.type(f"param set {PARAMETER[kind]} 1")
                await until(lambda: autopilot.parameters[PARAMETER[kind]] == 1.0)
                console.type("arm throttle")
                await until(lambda: autopilot.armed)
                typed, mode = MODES[kind]
                console.type(typed)
                await until(lambda: autopilot.mode_name == mode)
                console.type("disarm")
                await until(lambda: not autopilot.armed)
                await until(lambda: console.said.count("COMPONENT_ARM_DISARM: ACCEPTED") == 2)
        except TimeoutError:
            pytest.fail(f"MAVProxy said:\n{console.said}")
        assert not vehicles.autopilot(2).armed
        assert vehicles.autopilot(2).mode == vehicles.autopilot(2).first_mode
        parameters = len(autopilot.parameters)
    await asyncio.to_thread(check_log, tmp_path, parameters)


async def test_it_draws_the_evader_that_the_station_knows_by_tracks(tmp_path: Path) -> None:
    """Two senders share its port, as on 14550: the autopilot, and the station's reports of traffic."""
    port, tower = free_port(), Tower()
    tower.hear(setup(2))
    where = track(7, position=(300.0, -400.0, -60.0))
    async with fleet(Kind.ARDUCOPTER, [[port], []], ground=True), AsyncExitStack() as stack:
        settings = NeighbourSettings(adsb=(f"udpout://{HOST}:{port}",))

        def picture() -> Picture:  # vehicle 1 of the fleet flies beside it; the opponent is known as 7
            tower.fly(0.1, 1)
            tower.hear(where)
            return tower.picture

        told = await teller(picture, settings, stack)
        assert told is not None
        telling = asyncio.create_task(told.run())
        async with asyncio.timeout(patience(PLAYED_S)), mavproxy(port, tmp_path, ",adsb") as console:
            for wanted in (1, 0):  # it knows the evader; and once nobody tells of it, no more
                said = f"total threat count: {wanted} "
                for _ in range(120):
                    begun = len(console.said)
                    console.type("adsb status")
                    await asyncio.sleep(0.5)
                    if said in console.said[begun:]:
                        break
                else:
                    pytest.fail(f"MAVProxy said:\n{console.said}")
                telling.cancel()
        await asyncio.wait([telling])


def check_log(folder: Path, parameters: int) -> None:
    """Both readers, pymavlink's own and ours, find the same messages in its log, none bad."""
    from pymavlink import mavutil

    [path] = folder.rglob("flight.tlog")
    theirs: Counter[str] = Counter()
    log = mavutil.mavlink_connection(str(path), dialect="ardupilotmega")
    while (message := log.recv_msg()) is not None:
        theirs[message.get_type()] += 1
    causes: Counter[str] = Counter()
    ours = Counter(entry.packet.name for entry in read_tlog(path.read_bytes(), causes))
    assert theirs["BAD_DATA"] == 0
    assert not causes
    assert ours == theirs
    assert theirs["HEARTBEAT"] >= 3
    assert theirs["PARAM_VALUE"] >= parameters
    assert theirs["COMMAND_ACK"] >= 3
