"""Periodic tasks: on a fixed grid of instants, reporting overruns, skipping what they missed."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Clock


class Pace:
    """How well a periodic task keeps its time."""

    def __init__(self, name: str, period_s: float) -> None:
        self.name = name
        self.period_ns = round(period_s * NS_PER_S)
        self.runs = 0
        self.overruns = 0  # runs that were not done when the next one was due
        self.skipped = 0  # instants passed over because of them
        self.worst_ns = 0  # longest time from the instant a run was due to its end

    def counters(self) -> dict[str, int]:
        """For a health report: overruns, skipped, worst [µs]."""
        return {
            f"{self.name}_overruns": self.overruns,
            f"{self.name}_skipped": self.skipped,
            f"{self.name}_worst_us": self.worst_ns // 1000,
        }

    def done(self, due_ns: int, now_ns: int) -> int:
        """Note that the run due at `due_ns` has ended now; gives the instant of the next one [ns]."""
        self.runs += 1
        took = now_ns - due_ns
        self.worst_ns = max(self.worst_ns, took)
        missed = max(0, took // self.period_ns)
        if missed:
            self.overruns += 1
            self.skipped += missed
        return due_ns + (missed + 1) * self.period_ns


async def periodic(
    pace: Pace, step: Callable[[], Awaitable[None] | None], clock: Clock, *, delay_s: float = 0.0
) -> None:
    """Call `step` every period of `pace`, for ever; the first time after `delay_s`.

    Instants lie on a grid, so a late run does not shift the next; a run that takes longer than the
    period makes it skip the instants it missed rather than run several at once. What `step` raises
    ends the task: its owner (a TaskGroup) decides.
    """
    due = clock.monotonic_ns() + round(delay_s * NS_PER_S)
    while True:
        await asyncio.sleep(max(0, due - clock.monotonic_ns()) / NS_PER_S)
        result = step()
        if result is not None:
            await result
        due = pace.done(due, clock.monotonic_ns())
