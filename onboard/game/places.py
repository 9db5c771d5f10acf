"""Whether t₀ is to be put off, so that everybody is at its place by then: the master's patience for it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from onboard.core.math.constants import NS_PER_S

MOST_NS = 180 * NS_PER_S  # for which t₀ is put off at most, from when it was said first
TOLD_NS = NS_PER_S  # after a t₀ is said, until reports reckon with it
LATE_S = 0.2  # nobody waits for who is late by less


class PlaceReport(NamedTuple):
    """What an agent says of its way to its place."""

    id: int
    heard_ns: int  # [monotonic]
    late_s: float  # at t₀ [s]


class PutOff(NamedTuple):
    """By how much, and what to tell; by nothing, and something to tell, where there is no patience left."""

    more_ns: int = 0
    text: str = ""


class PlaceWatch:
    """Puts t₀ off while somebody would be late, within bounds. Instants are monotonic [ns]."""

    def __init__(self) -> None:
        self._first_ns = self._said_ns = 0  # when t₀ was said first, and last

    def begin(self, now_ns: int) -> None:
        """A t₀ is said."""
        self._first_ns = self._said_ns = now_ns

    def look(self, now_ns: int, left_ns: int, reports: Iterable[PlaceReport]) -> PutOff:
        """What the reports demand, `left_ns` before t₀."""
        if now_ns - self._said_ns <= TOLD_NS:
            return PutOff()
        fresh = [report for report in reports if report.heard_ns > self._said_ns + TOLD_NS]
        last = max(fresh, key=lambda report: report.late_s, default=None)
        if last is None or last.late_s < LATE_S:
            return PutOff()
        more_ns = round(last.late_s * NS_PER_S)
        if now_ns - self._first_ns + left_ns + more_ns > MOST_NS:
            return PutOff(0, f"vehicle {last.id} will not be at its place by t₀: begun without")
        self._said_ns = now_ns
        return PutOff(more_ns, f"vehicle {last.id} needs {last.late_s:.0f} s more to its place")
