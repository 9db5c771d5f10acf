"""How long the control step takes, and how long a setpoint comes after the position that caused it."""

from __future__ import annotations

from collections import deque

from onboard.core.math.constants import NS_PER_S

KEPT = 4000  # last measurements


class Timing:
    """Durations in nanoseconds; percentiles over the last measurements."""

    def __init__(self, period_s: float) -> None:
        self.overruns = 0  # control steps longer than their period
        self._period_ns = round(period_s * NS_PER_S)
        self.latencies: deque[int] = deque(maxlen=KEPT)  # position datagram → setpoint
        self.timer_steps = 0  # control steps that no position caused
        self.steps = 0
        self.worst_ns = 0

    def latency(self, ns: int) -> None:
        """One position's."""
        self.latencies.append(ns)

    def step(self, ns: int) -> None:
        """One control step's duration."""
        self.steps += 1
        self.overruns += ns > self._period_ns
        self.worst_ns = max(self.worst_ns, ns)

    def percentile_us(self, share: float) -> int:
        """Of the latencies [µs]; 0 where there are none."""
        if not self.latencies:
            return 0
        ordered = sorted(self.latencies)
        return ordered[min(len(ordered) - 1, int(share * len(ordered)))] // 1000

    def counters(self) -> dict[str, int]:
        """For a health report."""
        return {
            "control_steps": self.steps,
            "control_steps_by_timer": self.timer_steps,
            "control_overruns": self.overruns,
            "step_worst_us": self.worst_ns // 1000,
        }
