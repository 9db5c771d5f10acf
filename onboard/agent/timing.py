"""How long a setpoint comes after the position that caused it."""

from __future__ import annotations

from collections import deque

from onboard.core.math.constants import NS_PER_S

KEPT = 4000  # last measurements


class Timing:
    """Durations from a position's datagram to the setpoint [ns]; percentiles over the last measurements."""

    def __init__(self, period_s: float) -> None:
        self.overruns = 0  # that were longer than a control period
        self.worst_ns = 0
        self.latencies: deque[int] = deque(maxlen=KEPT)
        self._period_ns = round(period_s * NS_PER_S)

    def answered(self, ns: int) -> None:
        """A control step that a position caused is complete after `ns`."""
        self.latencies.append(ns)
        self.overruns += ns > self._period_ns
        self.worst_ns = max(self.worst_ns, ns)

    def percentile_us(self, share: float) -> int:
        """Percentile of the latencies [µs]; 0 where there are none."""
        if not self.latencies:
            return 0
        ordered = sorted(self.latencies)
        return ordered[min(len(ordered) - 1, int(share * len(ordered)))] // 1000

    def counters(self) -> dict[str, int]:
        """For a health report."""
        return {"control_overruns": self.overruns, "step_worst_us": self.worst_ns // 1000}
