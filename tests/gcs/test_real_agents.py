"""Real agents on a real bus: killed, stopped, started again."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

import onboard
from gcs.picture.values import Presence
from gcs.station import Station, StationSetup
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.clock import RealClock
from tests.support.bus_stages import free_port
from tests.support.real_time import until

ROOT = Path(onboard.__file__).parents[1]
STARTED_S = 20.0

pytestmark = pytest.mark.real


async def agent(i: int, endpoint: str) -> asyncio.subprocess.Process:
    """An agent of its own; it has no autopilot, and says so twice a second."""
    return await asyncio.create_subprocess_exec(
        sys.executable, "-m", "onboard.cli", "--id", str(i), "--link", "udpin://127.0.0.1:0",
        "--bus", endpoint, "--game", "field", stderr=asyncio.subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip


@asynccontextmanager
async def field(*ids: int):
    """Agents, and a station that listens."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    bus = await open_zenoh(endpoint, listen=True)
    station = Station(bus, RealClock(), StationSetup("field"))
    watching = asyncio.create_task(station.run())
    processes = {i: await agent(i, endpoint) for i in ids}
    try:  # a liveliness token alone shows an agent, but does not tell one process from the next
        await until(lambda: present(station) == introduced(station) == [*ids], STARTED_S)
        yield station, processes, endpoint
    finally:
        for process in processes.values():
            if process.returncode is None:
                process.kill()
            await process.wait()
        watching.cancel()
        await asyncio.gather(watching, return_exceptions=True)
        await bus.close()


def present(station: Station) -> list[int]:
    """Who is there."""
    return [v.id for v in station.picture().vehicles if v.presence is Presence.PRESENT]


def introduced(station: Station) -> list[int]:
    """Whose health has come: it names the process that speaks."""
    return [v.id for v in station.picture().vehicles if v.health is not None]


def alerts(station: Station) -> set[str]:
    """What is wrong."""
    return {alert.name for alert in station.picture().alerts}


def said(station: Station) -> set[tuple[str, int]]:
    """Kinds of the log's lines, and of whom."""
    return {(line.kind, line.id) for line in station.picture().log}


async def test_killed_stopped_and_back_again():
    async with field(2, 3, 4) as (station, processes, endpoint):
        processes[2].kill()
        processes[3].send_signal(signal.SIGSTOP)
        await until(lambda: {"lost:2", "lost:3"} <= alerts(station))
        await until(lambda: present(station) == [4] and "lost:4" not in alerts(station))
        processes[3].send_signal(signal.SIGCONT)
        await until(lambda: 3 in present(station))
        await processes[2].wait()
        processes[2] = await agent(2, endpoint)
        await until(lambda: present(station) == [2, 3, 4], STARTED_S)
        await until(lambda: not {"lost:2", "lost:3"} & alerts(station))
        await until(lambda: ("restarted", 2) in said(station))


async def test_two_agents_of_one_id_are_found_out():
    async with field(2) as (station, processes, endpoint):
        processes[102] = await agent(2, endpoint)
        await until(lambda: "double_id:2" in alerts(station), STARTED_S)
