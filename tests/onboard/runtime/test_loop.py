"""Virtual time: exact, ordered, and loud about whatever it cannot have."""

from __future__ import annotations

import asyncio
import gc
import threading
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.clock import VirtualClock
from onboard.runtime.loop import (
    COLLECT_AFTER,
    EPOCH_NS,
    VirtualLoop,
    VirtualTimeError,
    run_virtual,
    virtual_clock,
)
from tests.support.virtual_time import virtual


@virtual
async def test_an_hour_at_20_hz_ends_on_the_nanosecond() -> None:
    clock = virtual_clock()
    for _ in range(20 * 3600):
        await asyncio.sleep(0.05)
    assert clock.monotonic_ns() == 3600 * NS_PER_S
    assert clock.wall_ns() == EPOCH_NS + 3600 * NS_PER_S


def test_wall_time_starts_at_the_epoch_asked_for() -> None:
    async def main() -> int:
        await asyncio.sleep(1.5)
        return virtual_clock().wall_ns()

    assert run_virtual(main(), epoch_ns=42) == 42 + 1_500_000_000


def test_a_clock_refuses_to_run_back() -> None:
    clock = VirtualClock(0)
    clock.advance_to(5)
    with pytest.raises(ValueError, match="does not run back"):
        clock.advance_to(4)


@given(st.lists(st.integers(0, 2_000_000_000), min_size=1, max_size=60))
@settings(max_examples=60, deadline=None)
def test_timers_run_by_deadline_and_then_in_the_order_they_were_set(delays_ns: list[int]) -> None:
    async def main() -> list[tuple[int, int]]:
        loop, clock = asyncio.get_running_loop(), virtual_clock()
        ran: list[tuple[int, int]] = []

        def note(index: int) -> None:
            ran.append((clock.monotonic_ns(), index))

        for index, delay_ns in enumerate(delays_ns):
            loop.call_later(delay_ns / NS_PER_S, note, index)
        await asyncio.sleep(3.0)
        return ran

    expected = sorted((delay_ns, index) for index, delay_ns in enumerate(delays_ns))
    assert run_virtual(main()) == expected


@given(st.lists(st.tuples(st.integers(0, 100), st.booleans()), min_size=1, max_size=80))
@settings(max_examples=60, deadline=None)
def test_cancelled_timers_never_run_and_the_others_all_do(plan: list[tuple[int, bool]]) -> None:
    async def main() -> list[int]:
        loop = asyncio.get_running_loop()
        ran: list[int] = []
        handles = [loop.call_later(ms / 1000, ran.append, index) for index, (ms, _) in enumerate(plan)]
        for handle, (_, cancel) in zip(handles, plan, strict=True):
            if cancel:
                handle.cancel()
        await asyncio.sleep(1.0)
        return ran

    kept = [index for index, (_, cancel) in enumerate(plan) if not cancel]
    assert run_virtual(main()) == sorted(kept, key=lambda index: (plan[index][0], index))


@virtual
async def test_ten_thousand_cancelled_timeouts_leave_nothing_behind() -> None:
    loop = asyncio.get_running_loop()
    assert isinstance(loop, VirtualLoop)
    kept: list[float] = []
    loop.call_later(5.0, lambda: kept.append(loop.time()))
    for _ in range(10_000):
        async with asyncio.timeout(1000):
            await asyncio.sleep(0)
    assert loop.timers < 1000
    await asyncio.sleep(5.0)
    assert kept == [5.0], "what was not cancelled is still there"


@virtual
async def test_a_timeout_strikes_at_its_deadline() -> None:
    clock = virtual_clock()
    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0.25):
            await asyncio.Event().wait()
    assert clock.monotonic_ns() == 250_000_000


@virtual
async def test_a_task_group_shares_one_time() -> None:
    log: list[tuple[str, int]] = []
    clock = virtual_clock()

    async def tick(name: str, period: float, times: int) -> None:
        for _ in range(times):
            await asyncio.sleep(period)
            log.append((name, clock.monotonic_ns()))

    async with asyncio.TaskGroup() as group:
        group.create_task(tick("slow", 0.1, 2))
        group.create_task(tick("fast", 0.05, 4))
    assert log == [
        ("fast", 50_000_000),
        ("slow", 100_000_000),  # set at 0 s, before the second wait of `fast` was
        ("fast", 100_000_000),
        ("fast", 150_000_000),
        ("slow", 200_000_000),
        ("fast", 200_000_000),
    ]
    assert all(a[1] <= b[1] for a, b in pairwise(log))


def test_waiting_for_nothing_is_a_deadlock_that_names_who_waits() -> None:
    async def main() -> None:
        async def stuck() -> None:
            await asyncio.Event().wait()

        async with asyncio.TaskGroup() as group:
            group.create_task(stuck(), name="the one that waits")

    with pytest.raises(VirtualTimeError, match=r"deadlock at 0\.000000000 s.*the one that waits"):
        run_virtual(main())


@virtual
async def test_threads_and_executors_are_refused() -> None:
    loop = asyncio.get_running_loop()
    with pytest.raises(VirtualTimeError, match="no executor"):
        await asyncio.to_thread(print)
    errors: list[Exception] = []

    def intrude() -> None:
        try:
            loop.call_soon_threadsafe(print)
        except VirtualTimeError as error:
            errors.append(error)

    thread = threading.Thread(target=intrude)
    thread.start()
    thread.join()
    assert len(errors) == 1
    assert "thread called into virtual time" in str(errors[0])


@virtual
async def test_sockets_are_refused() -> None:
    loop = asyncio.get_running_loop()
    with pytest.raises(VirtualTimeError, match="use memory links"):
        await loop.create_datagram_endpoint(asyncio.DatagramProtocol, local_addr=("127.0.0.1", 0))
    with pytest.raises(VirtualTimeError, match="use memory links"):
        await asyncio.open_connection("127.0.0.1", 1)


def test_an_exception_in_a_callback_ends_the_run() -> None:
    async def main() -> None:
        asyncio.get_running_loop().call_later(0.1, lambda: 1 / 0)
        await asyncio.sleep(1.0)

    with pytest.raises(ZeroDivisionError):
        run_virtual(main())


async def test_the_virtual_clock_is_not_to_be_had_on_a_real_loop() -> None:
    with pytest.raises(VirtualTimeError, match="not in virtual time"):
        virtual_clock()


def test_the_search_for_garbage_is_as_it_was_after_a_run_and_after_one_that_failed() -> None:
    before, frozen = (gc.get_threshold(), gc.isenabled()), gc.get_freeze_count()
    inside: list[tuple[int, bool]] = []

    async def game(fails: bool) -> None:
        inside.append((gc.get_threshold()[0], gc.get_freeze_count() > frozen))
        if fails:
            raise RuntimeError("over")

    run_virtual(game(False))
    assert inside == [(COLLECT_AFTER, True)]
    with pytest.raises(RuntimeError, match="over"):
        run_virtual(game(True))
    assert (gc.get_threshold(), gc.isenabled()) == before
    assert gc.get_freeze_count() <= frozen
