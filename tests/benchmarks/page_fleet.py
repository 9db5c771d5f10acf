"""A fleet on a real bus: `python -m tests.benchmarks.page_fleet ENDPOINT VEHICLES HZ`, for `make bench-page`.

Every vehicle flies a circle; vehicle 1's north is the instant of its message, in milliseconds of the present
minute, so that who sees it can tell how old it is.
"""

from __future__ import annotations

import asyncio
import sys
from math import cos, sin

from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.clock import RealClock
from onboard.wire.bus.topics import DEFAULT_GAME
from tests.support.sample_messages import TOPIC, decision, health, on_bus, setup, state

MINUTE_MS = 60_000
GAME_MOST = 250  # vehicles that a scenario can have; those beyond are other networks' on the same bus


async def fly(endpoint: str, vehicles: int, hz: float) -> None:
    """Publish until killed."""
    bus, clock = await open_zenoh(endpoint), RealClock()
    key, payload = on_bus(setup(min(vehicles, GAME_MOST)), DEFAULT_GAME)
    bus.publish(key, payload, TOPIC[type(setup(1))].delivery)
    loop = asyncio.get_running_loop()
    due, tick = loop.time(), 0
    while True:
        due = max(due + 1.0 / hz, loop.time() - 1.0 / hz)
        for i in range(1, vehicles + 1):
            now_ns = clock.wall_ns()
            angle, radius = 0.05 * tick + i, 50.0 + 5.0 * i
            north = radius * cos(angle) if i > 1 else float(now_ns // 1_000_000 % MINUTE_MS)
            place = (north, radius * sin(angle), -50.0)
            told = [state(i, now_ns, position=place, yaw=angle), decision(i, now_ns, aim=place)]
            if tick % round(max(1.0, hz / 2.0)) == 0:
                told.append(health(i, now_ns))
            for message in told:
                key, payload = on_bus(message, DEFAULT_GAME)
                bus.publish(key, payload, TOPIC[type(message)].delivery)
            if i % 20 == 0:
                await asyncio.sleep(0)
        tick += 1
        await asyncio.sleep(max(0.0, due - loop.time()))


if __name__ == "__main__":
    asyncio.run(fly(sys.argv[1], int(sys.argv[2]), float(sys.argv[3])))
