"""Instants on a fixed grid: what is done again and again, and how well its time is kept."""

from __future__ import annotations

from math import inf

EARLY_S = 1e-6  # a timer may fire this much before its deadline


class Grid:
    """A deadline that comes again every `period_s`; instants that were missed are passed over."""

    def __init__(self, period_s: float) -> None:
        self.at = inf  # the next instant [s, monotonic]; inf = not running
        self.overruns = 0  # runs that came so late that the next one was due
        self.skipped = 0  # instants passed over because of them
        self.worst_s = 0.0  # the latest that a run came
        self._period = period_s
        self._start = 0.0
        self._count = 0

    def start(self, now: float) -> None:
        """Due from now on [s]."""
        self._start, self._count = now, 0
        self.at = now

    def stop(self) -> None:
        """Due no more."""
        self.at = inf

    def due(self, now: float) -> bool:
        """Whether to run at `now` [s]; if so, the next instant is set."""
        if now < self.at - EARLY_S:
            return False
        late = max(0.0, now - self.at)
        self.worst_s = max(self.worst_s, late)
        missed = int(late / self._period)
        if missed:
            self.overruns += 1
            self.skipped += missed
        self._count += missed + 1
        self.at = self._start + self._count * self._period
        return True

    def counters(self, name: str) -> dict[str, int]:
        """For a health report."""
        return {
            f"{name}_overruns": self.overruns,
            f"{name}_skipped": self.skipped,
            f"{name}_worst_us": int(self.worst_s * 1e6),
        }
