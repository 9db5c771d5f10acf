"""Clocks: the real one, and one that stands still until the virtual loop moves it."""

from __future__ import annotations

import time

from onboard.runtime.protocols import Clock


class RealClock:
    """The machine's clocks: the only place that reads them."""

    def wall_ns(self) -> int:
        """Wall instant [ns since the epoch]."""
        return time.time_ns()

    def monotonic_ns(self) -> int:
        """Monotonic time [ns]; its zero means nothing."""
        return time.monotonic_ns()


class SteadyClock:
    """Wall time as it was at first, carried on by monotonic time: setting the clock does not move it."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._base_ns = clock.wall_ns() - clock.monotonic_ns()

    def wall_ns(self) -> int:
        """Wall instant [ns since the epoch], without any jump since this was made."""
        return self._base_ns + self._clock.monotonic_ns()

    def monotonic_ns(self) -> int:
        """Monotonic time [ns]; its zero means nothing."""
        return self._clock.monotonic_ns()


class VirtualClock:
    """Integer nanoseconds from an epoch; moves only when told to."""

    __slots__ = ("_elapsed_ns", "epoch_ns")

    def __init__(self, epoch_ns: int) -> None:
        self.epoch_ns = epoch_ns  # wall instant at which monotonic time is 0
        self._elapsed_ns = 0

    def wall_ns(self) -> int:
        """Wall instant: the epoch and what has elapsed [ns since 1970]."""
        return self.epoch_ns + self._elapsed_ns

    def monotonic_ns(self) -> int:
        """Elapsed since the clock was made [ns]."""
        return self._elapsed_ns

    def advance_to(self, elapsed_ns: int) -> None:
        """Jump to `elapsed_ns`. Raises ValueError for a jump back."""
        if elapsed_ns < self._elapsed_ns:
            raise ValueError(f"time does not run back: {elapsed_ns} ns after {self._elapsed_ns} ns")
        self._elapsed_ns = elapsed_ns


class SkewedClock:
    """Another clock with its wall time off by a constant, as on a machine whose time is not synchronised."""

    def __init__(self, clock: RealClock | VirtualClock, offset_ns: int) -> None:
        self._clock = clock
        self.offset_ns = offset_ns

    def wall_ns(self) -> int:
        """The other clock's wall instant plus the offset [ns since 1970]."""
        return self._clock.wall_ns() + self.offset_ns

    def monotonic_ns(self) -> int:
        """The other clock's monotonic time [ns]."""
        return self._clock.monotonic_ns()
