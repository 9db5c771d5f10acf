"""The offset between the autopilot's clock and ours, by TIMESYNC (https://mavlink.io/en/services/timesync.html).

We ask with our time; the autopilot answers with its own beside it. The offset is that of the middle of the
round trip, and the answer with the shortest round trip of a window is the one to trust: queues only add.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

from onboard.wire.mavlink.values import Timesync

WINDOW = 16  # answers from which the best is taken
PENDING = 8  # questions kept: an answer to an older one, or to somebody else's, does not count
JUMP = 3  # answers in a row that contradict the window: a clock was set, or the autopilot started again


class Offset(NamedTuple):
    """What is known of the autopilot's clock."""

    known: bool
    offset_ns: int  # autopilot − ours
    round_trip_ns: int  # of the answer trusted
    uncertainty_ns: int  # half of it: the offset is not further off, for constant clocks


class TimesyncEstimator:
    """The offset of one autopilot's clock. All instants are of the local monotonic clock [ns]."""

    def __init__(self) -> None:
        self._asked: deque[int] = deque(maxlen=PENDING)
        self._answers: deque[tuple[int, int]] = deque(maxlen=WINDOW)  # (round trip, offset)
        self._against: list[tuple[int, int]] = []

    def ask(self, now_ns: int) -> Timesync:
        """Return a question to send now; about one a second is enough."""
        self._asked.append(now_ns)
        return Timesync(0, now_ns)

    def take(self, now_ns: int, value: Timesync) -> Timesync | None:
        """Take a TIMESYNC in; return the answer to send where it was the autopilot's own question."""
        if value.answered_ns == 0:
            return Timesync(now_ns, value.asked_ns)
        if value.asked_ns not in self._asked:
            return None
        self._asked.remove(value.asked_ns)
        trip = now_ns - value.asked_ns
        if trip < 0:
            return None
        answer = (trip, value.answered_ns - (value.asked_ns + trip // 2))
        best = self.offset()
        if best.known and abs(answer[1] - best.offset_ns) > trip // 2 + best.uncertainty_ns + 1_000_000:
            self._against.append(answer)
            if len(self._against) < JUMP:
                return None
            self._answers.clear()
            self._answers.extend(self._against)
            self._against = []
            return None
        self._against = []
        self._answers.append(answer)
        return None

    def offset(self) -> Offset:
        """Return the estimate from the answers so far."""
        if not self._answers:
            return Offset(False, 0, 0, 0)
        trip, offset = min(self._answers)
        return Offset(True, offset, trip, trip // 2)
