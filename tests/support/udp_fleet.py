"""Simulated vehicles on real UDP and in real time, on the test's own loop: for independent clients."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager

from onboard.core.math.vectors import Vec
from onboard.game.scenario import WINGED, Flight, Kind, Scenario, VehicleSpec
from onboard.runtime.clock import RealClock
from onboard.runtime.links import open_udp
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.motion import Motion
from sim_bridge.world.radio import Radio
from sim_bridge.world.world import World

HOST = "127.0.0.1"
TICK_S = 0.01
READY_S = 2.0  # of a start from the ground, in place of the usual 12 s


class Fleet:
    """The vehicles of one world, and where each listens."""

    def __init__(self, world: World, radios: dict[int, Radio]) -> None:
        self._world = world
        self._radios = radios

    def autopilot(self, id: int) -> Autopilot:
        return self._world.vehicles[id].autopilot

    def motion(self, id: int) -> Motion:
        return self._world.motions[id]

    def position(self, id: int) -> Vec:
        return self.motion(id).position

    def address(self, id: int) -> tuple[str, int]:
        """Where its autopilot's socket is."""
        return self._radios[id].address


def free_port() -> int:
    """A UDP port that was free just now."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind((HOST, 0))
        return int(probe.getsockname()[1])


def scenario(kind: Kind, count: int, *, ground: bool) -> Scenario:
    """`count` vehicles of one kind, 100 m apart; planes at 22 m/s, multicopters at 5 m/s."""
    height = 0.0 if ground else 60.0
    plane = kind in WINGED
    specs = [
        VehicleSpec(
            position=(0.0, 100.0 * i, height),
            speed=22.0 if plane else 5.0,
            speed_max=30.0 if plane else 8.0,
            speed_min=12.0 if plane else 0.0,
            turn_rate_deg=40.0,
            pitch_min_deg=-20.0 if plane else -90.0,
            pitch_max_deg=25.0 if plane else 90.0,
            heading_deg=0.0,
        )
        for i in range(count)
    ]
    return Scenario(
        name="clients",
        evader=specs[0],
        pursuers=tuple(specs[1:]),
        flight=Flight(autopilot=kind, ground_start=ground),
    )


@asynccontextmanager
async def fleet(kind: Kind, ports: Sequence[Sequence[int]], *, ground: bool = False) -> AsyncIterator[Fleet]:
    """Vehicles 1, 2, …, of which each sends to its own list of ports on this machine."""
    what = scenario(kind, len(ports), ground=ground)
    radios = {
        id: Radio(await open_udp(HOST, 0), [(HOST, port) for port in to])
        for id, to in zip(what.ids, ports, strict=True)
    }
    world = World(what, RealClock(), {id: [radio] for id, radio in radios.items()})
    for vehicle in world.vehicles.values():
        autopilot = vehicle.autopilot
        autopilot.setup = autopilot.setup._replace(
            options=autopilot.setup.options._replace(ready_s=READY_S, healthy_share=1.0)
        )

    async def run() -> None:
        while True:
            world.step()
            await asyncio.sleep(TICK_S)

    task = asyncio.create_task(run())
    try:
        yield Fleet(world, radios)
        assert not task.done()  # the world ran to the end
    finally:
        task.cancel()
        await asyncio.wait([task])
        for radio in radios.values():
            radio.close()
