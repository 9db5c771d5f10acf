"""A flood on the bus is shown to the operator while it lasts, and named by its kind."""

from __future__ import annotations

import asyncio

from gcs.station import Station, StationSetup
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.loop import VirtualLoop, run_virtual


def test_a_flood_is_an_alert_until_it_ends() -> None:
    async def story() -> None:
        loop = asyncio.get_running_loop()
        assert isinstance(loop, VirtualLoop)
        bus = MemoryBroker().connect()
        counts = {"limited_vehicles_events": 0}
        bus.counters = lambda: counts  # type: ignore[method-assign]
        station = Station(bus, loop.clock, StationSetup("range"))
        task = asyncio.create_task(station.run())
        await asyncio.sleep(1.0)
        assert not station.picture().alerts
        for _ in range(20):
            counts["limited_vehicles_events"] += 50_000
            await asyncio.sleep(0.1)
        (alert,) = station.picture().alerts
        assert alert.kind == "flood"
        assert "vehicles_events" in alert.text
        await asyncio.sleep(10.0)
        assert not station.picture().alerts
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)

    run_virtual(story())
