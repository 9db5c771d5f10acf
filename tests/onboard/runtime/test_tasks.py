"""Periodic tasks keep to their grid, skip what they missed, and say so."""

from __future__ import annotations

import asyncio

import pytest

from onboard.runtime.loop import virtual_clock
from onboard.runtime.tasks import Pace, periodic
from tests.support.virtual_time import virtual

MS = 1_000_000


@virtual
async def test_twenty_hertz_for_a_minute_is_twelve_hundred_runs_on_the_grid() -> None:
    clock, ran = virtual_clock(), list[int]()
    pace = Pace("control", 0.05)
    with pytest.raises(TimeoutError):
        async with asyncio.timeout(60):
            await periodic(pace, lambda: ran.append(clock.monotonic_ns()), clock)
    assert ran == [50 * MS * tick for tick in range(1200)]
    assert pace.counters() == {"control_overruns": 0, "control_skipped": 0, "control_worst_us": 0}


@virtual
async def test_a_run_that_takes_too_long_is_reported_and_its_instants_are_skipped() -> None:
    clock, ran = virtual_clock(), list[int]()
    pace = Pace("control", 0.05)

    async def step() -> None:
        ran.append(clock.monotonic_ns() // MS)
        await asyncio.sleep(0.17 if len(ran) == 3 else 0.01)

    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0.44):
            await periodic(pace, step, clock)
    assert ran == [0, 50, 100, 300, 350, 400]  # due at 150, 200 and 250 while the third still ran
    assert pace.overruns == 1
    assert pace.skipped == 3
    assert pace.worst_ns == 170 * MS


@virtual
async def test_the_first_run_waits_for_its_delay() -> None:
    clock, ran = virtual_clock(), list[int]()
    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0.3):
            await periodic(Pace("late", 0.1), lambda: ran.append(clock.monotonic_ns()), clock, delay_s=0.12)
    assert ran == [120 * MS, 220 * MS]


@virtual
async def test_a_failing_step_ends_the_group_that_owns_it() -> None:
    clock = virtual_clock()
    others: list[int] = []

    def fail() -> None:
        if clock.monotonic_ns() >= 200 * MS:
            raise ValueError("broken")

    async def fly() -> None:
        async with asyncio.TaskGroup() as group:
            group.create_task(periodic(Pace("broken", 0.1), fail, clock))
            group.create_task(periodic(Pace("other", 0.05), lambda: others.append(1), clock))

    with pytest.raises(ExceptionGroup) as caught:
        await fly()
    assert caught.group_contains(ValueError, match="broken")
    assert len(others) == 5  # 0 to 200 ms
