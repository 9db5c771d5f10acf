"""An overloaded computer is told apart from a bad radio: by the station's own lateness."""

from __future__ import annotations

import asyncio

from gcs.station import LATE_S, Station, StationSetup
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.wire.bus import topics
from tests.support.sample_messages import GAME, health, state


class Stalling:
    """The virtual clock of a computer that can stand still for a while without its programs noticing."""

    def __init__(self) -> None:
        self._clock = virtual_clock()
        self.stalled_ns = 0

    def monotonic_ns(self) -> int:
        return self._clock.monotonic_ns() + self.stalled_ns

    def wall_ns(self) -> int:
        return self._clock.wall_ns() + self.stalled_ns


async def _watch(stalls: bool) -> tuple[set[str], set[str], set[str]]:
    """Alerts before, just after, and long after three seconds in which nothing of vehicle 2 was heard."""
    broker, clock = MemoryBroker(), Stalling()
    station = Station(broker.connect("gcs"), clock, StationSetup(GAME))
    agent = broker.connect("agent-2")
    task = asyncio.create_task(station.run())

    async def fly(seconds: float) -> set[str]:
        for _ in range(round(seconds * 20)):
            for topic, message in ((topics.STATE, state(2)), (topics.HEALTH, health(2))):
                agent.publish(topic.key(GAME, 2), topic.encode(message), topic.delivery)
            await asyncio.sleep(0.05)
        return {alert.kind for alert in station.picture().alerts}

    before = await fly(3.0)
    if stalls:
        clock.stalled_ns += 3 * NS_PER_S
        await asyncio.sleep(0.35)
    else:
        await asyncio.sleep(3.0)
    during = {alert.kind for alert in station.picture().alerts}
    after = await fly(10.0)
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
    return before, during, after


def test_a_computer_that_was_late_says_so_beside_what_it_takes_for_lost() -> None:
    before, during, after = run_virtual(_watch(stalls=True))
    assert LATE_S < 3.0
    assert "overloaded" not in before
    assert {"overloaded", "lost"} <= during
    assert not {"overloaded", "lost"} & after


def test_a_radio_that_was_silent_is_no_overloaded_computer() -> None:
    _, during, after = run_virtual(_watch(stalls=False))
    assert "lost" in during
    assert "overloaded" not in during | after
