"""Alerts: raised, acknowledged, cleared, never flapping; each says what to do. Pure, time passed in.

A rule (`gcs.picture.alert_rules`) names what is wrong at one instant. Two things keep an alert from flapping:
a rule is told which alerts are in force and then uses its wider threshold, and an alert clears only
after its cause has been away for `CLEAR_NS`. An alert that comes again is raised anew, unacknowledged.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from typing import NamedTuple

import msgspec

from gcs.picture.values import Alert
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Severity

CLEAR_NS = 1_500_000_000  # a cause must be away for this long
KEPT = 200  # cleared alerts
RANK = {Severity.ERROR: 0, Severity.WARNING: 1, Severity.INFO: 2}


class Finding(NamedTuple):
    """What a rule found wrong at one instant."""

    kind: str
    id: int  # vehicle, 0 = none
    severity: Severity
    text: str
    advice: str
    hold_s: float = 0.0  # must last this long before it is raised
    detail: str = ""  # tells several alerts of one kind and vehicle apart

    @property
    def name(self) -> str:
        """Unique name of the alert."""
        parts = [self.kind, *([str(self.id)] if self.id else []), *([self.detail] if self.detail else [])]
        return ":".join(parts)


class _Live:
    __slots__ = ("alert", "seen_ns")

    def __init__(self, alert: Alert, now_ns: int) -> None:
        self.alert = alert
        self.seen_ns = now_ns


class Alerts:
    """The board of alerts."""

    def __init__(self) -> None:
        self._live: dict[str, _Live] = {}
        self._pending: dict[str, int] = {}  # found since
        self._past: deque[Alert] = deque(maxlen=KEPT)

    def judge(self, find: Callable[[Callable[[str], bool]], Iterable[Finding]], now_ns: int) -> list[Alert]:
        """Let `find(in_force)` name what is wrong now; the alerts that this raised or cleared."""
        changed = []
        found: dict[str, Finding] = {}
        for finding in find(self.in_force):
            found.setdefault(finding.name, finding)
        for name, finding in found.items():
            live = self._live.get(name)
            if live is not None:
                live.seen_ns = now_ns
                live.alert = _updated(live.alert, finding)
                continue
            since = self._pending.setdefault(name, now_ns)
            if now_ns - since < finding.hold_s * NS_PER_S:
                continue
            alert = Alert(
                name=name,
                kind=finding.kind,
                id=finding.id,
                severity=finding.severity,
                text=finding.text,
                advice=finding.advice,
                raised_ns=now_ns,
            )
            self._live[name] = _Live(alert, now_ns)
            changed.append(alert)
        self._pending = {
            name: at for name, at in self._pending.items() if name in found and name not in self._live
        }
        for name in [n for n, live in self._live.items() if now_ns - live.seen_ns >= CLEAR_NS]:
            cleared = msgspec.structs.replace(self._live.pop(name).alert, cleared_ns=now_ns)
            self._past.append(cleared)
            changed.append(cleared)
        return changed

    def in_force(self, name: str) -> bool:
        """Whether an alert of this name is raised."""
        return name in self._live

    def acknowledge(self, name: str) -> None:
        """Mark as seen; "" means all. Unknown names are ignored: an alert may clear while one types."""
        for key, live in self._live.items():
            if name in ("", key):
                live.alert = msgspec.structs.replace(live.alert, acknowledged=True)

    def board(self) -> tuple[Alert, ...]:
        """In force: unacknowledged first, worst first, then oldest."""
        alerts = [live.alert for live in self._live.values()]
        return tuple(sorted(alerts, key=lambda a: (a.acknowledged, RANK[a.severity], a.raised_ns, a.name)))

    def past(self) -> tuple[Alert, ...]:
        """Cleared, newest last."""
        return tuple(self._past)


def _updated(alert: Alert, finding: Finding) -> Alert:
    """The text follows the facts; a worse severity asks for attention again."""
    if (alert.text, alert.severity) == (finding.text, finding.severity):
        return alert
    worse = RANK[finding.severity] < RANK[alert.severity]
    return msgspec.structs.replace(
        alert,
        severity=finding.severity,
        text=finding.text,
        advice=finding.advice,
        acknowledged=alert.acknowledged and not worse,
    )
