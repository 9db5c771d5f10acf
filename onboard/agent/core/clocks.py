"""The agent's wall clock against the master's, and its jumps."""

from __future__ import annotations

from collections import deque

from onboard.agent.core.events import Instant
from onboard.core.math.constants import NEVER, NS_PER_S

WINDOW = 20  # of the master's stamps (2 Hz: ten seconds)
ALERT_S = 0.05  # offset that is an alert; it clears at four fifths
REFUSE_S = 0.2  # offset at which the agent is not ready


class MasterClock:
    """Own wall time less the master's, by the least of the last stamps: delay only ever adds to it."""

    def __init__(self) -> None:
        self._samples: deque[int] = deque(maxlen=WINDOW)
        self.alert = False

    @property
    def known(self) -> bool:
        """Whether the master's clock was ever heard."""
        return bool(self._samples)

    @property
    def offset_s(self) -> float:
        """Own − master [s]; 0 where it is not known. Up to the bus's least delay too large."""
        return min(self._samples) / NS_PER_S if self._samples else 0.0

    @property
    def ready(self) -> bool:
        """Whether the offset lets the agent take part."""
        return abs(self.offset_s) <= REFUSE_S

    def restart(self) -> None:
        """Forget: another master, or the clock jumped."""
        self._samples.clear()

    def hear(self, wall_ns: int, stamp_ns: int) -> bool:
        """One stamp of the master at own wall time; True where the alert begins or ends."""
        self._samples.append(wall_ns - stamp_ns)
        offset = abs(self.offset_s)
        alert = offset > ALERT_S * (0.8 if self.alert else 1.0)
        changed = alert != self.alert
        self.alert = alert
        return changed


class JumpWatch:
    """Wall time against monotonic time: a step of one against the other is a jump."""

    def __init__(self, threshold_s: float) -> None:
        self._threshold_ns = round(threshold_s * NS_PER_S)
        self._difference: int | None = None
        self.jumped_at = NEVER  # monotonic [s]

    def look(self, now: Instant) -> float:
        """Compare the clocks; the size of a jump since the last look [s], 0 where there was none."""
        difference = now.wall_ns - round(now.s * NS_PER_S)
        last, self._difference = self._difference, difference
        if last is None or abs(difference - last) <= self._threshold_ns:
            return 0.0
        self.jumped_at = now.s
        return (difference - last) / NS_PER_S
