"""Waiting for what real sockets and processes do in their own time, on a machine that may be busy."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable
from functools import cache

PROBE_ADDITIONS = 2_500_000  # about `PROBE_S` of work on a machine that has nothing else to do
PROBE_S = 0.15
SPARE = 5.0  # deadlines on a quiet machine, as a multiple of what is promised
SLOWNESS_MAX = 40.0


def slowness() -> float:
    """How much longer this machine takes for a fixed piece of work than a quiet one, 1 to `SLOWNESS_MAX`.

    The greater of what the work took at the start of the session of tests, and of the processes that wait for
    each core now: others may have come since.
    """
    waiting = os.getloadavg()[0] / (os.cpu_count() or 1)
    return min(max(1.0, waiting, _of_this_machine()), SLOWNESS_MAX)


@cache
def _of_this_machine() -> float:
    begun = time.perf_counter()
    total = 0
    for number in range(PROBE_ADDITIONS):
        total += number
    assert total == PROBE_ADDITIONS * (PROBE_ADDITIONS - 1) // 2
    return (time.perf_counter() - begun) / PROBE_S


def patience(promised_s: float) -> float:
    """Seconds to wait for something that is promised within `promised_s` [s].

    A deadline of a test bounds a wait that has failed; it measures nothing. What is promised is measured by
    the benchmarks.
    """
    return SPARE * slowness() * promised_s


async def until(condition: Callable[[], object], promised_s: float = 20.0) -> None:
    """Return as soon as `condition()` holds. Raises TimeoutError when patience is at its end.

    In virtual time it costs nothing.
    """
    async with asyncio.timeout(patience(promised_s)):
        while not condition():  # noqa: ASYNC110 - the condition is anybody's, it sets no event
            await asyncio.sleep(0.005)
