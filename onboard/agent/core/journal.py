"""The agent's events for people: numbered, published, and one line each in the log."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import NamedTuple

from onboard.agent.core.events import Instant, Note, Outbox, Publish
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import DecisionLevel, DecisionModule, Event, Severity
from onboard.wire.bus.topics import EVENTS

BURST = 20  # events of one kind within `WINDOW_S` before the rest are only counted
WINDOW_S = 10.0


class Entry(NamedTuple):
    """Something that happened, before it is stamped."""

    severity: Severity
    kind: str  # machine-readable
    text: str
    level: str  # of the decision that it is about, '' = none
    module: str  # likewise


class Journal:
    """Collects what happened during a call of the machine; says it when what is urgent is done."""

    def __init__(self, id: int, game: str, nonce: int) -> None:
        self._id = id
        self._key = EVENTS.key(game, id)
        self._nonce = nonce
        self._number = 0
        self._recent: dict[str, list[float]] = {}
        self.noted: list[Entry] = []  # not stamped yet
        self.stamped: list[Event] = []  # to be said
        self.suppressed = 0  # events of floods that were only counted
        self.kinds: dict[str, int] = {}  # how often each kind was said

    def info(self, kind: str, text: str, level: str = "", module: str = "") -> None:
        """Note something that a person may want to know."""
        self.noted.append(Entry(Severity.INFO, kind, text, level, module))

    def warning(self, kind: str, text: str, level: str = "", module: str = "") -> None:
        """Note something that a person should look at."""
        self.noted.append(Entry(Severity.WARNING, kind, text, level, module))

    def error(self, kind: str, text: str, level: str = "", module: str = "") -> None:
        """Note something that a person must act on."""
        self.noted.append(Entry(Severity.ERROR, kind, text, level, module))

    def say(self, severity: Severity, kind: str, text: str, level: str = "", module: str = "") -> None:
        """Note something of the given severity."""
        self.noted.append(Entry(severity, kind, text, level, module))

    def stamp(self, now: Instant) -> None:
        """Number and stamp what was noted since the last call; a flood of one kind is cut and counted."""
        if not self.noted:
            return
        for entry in self.noted:
            recent = [at for at in self._recent.get(entry.kind, ()) if now.s - at < WINDOW_S]
            if len(recent) >= BURST:
                self._recent[entry.kind] = recent
                self.suppressed += 1
                continue
            self._recent[entry.kind] = [*recent, now.s]
            self.kinds[entry.kind] = self.kinds.get(entry.kind, 0) + 1
            self._number += 1
            event = Event(
                id=self._id, number=self._number, stamp_ns=now.wall_ns, severity=entry.severity,
                kind=entry.kind, text=entry.text,
                level=DecisionLevel(entry.level), module=DecisionModule(entry.module), nonce=self._nonce,
            )  # fmt: skip
            self.stamped.append(event)
        self.noted.clear()

    def tell(self, out: Outbox) -> None:
        """Publish and log what was stamped."""
        for event in self.stamped:
            out.put(Publish(self._key, EVENTS.encode(event), EVENTS.delivery))
            when = datetime.fromtimestamp(event.stamp_ns / NS_PER_S, UTC).strftime("%H:%M:%S.%f")[:-3]
            line = f"{when} {event.severity.value:7} vehicle {self._id} {event.kind}: {event.text}"
            out.put(Note(event.severity, line))
        self.stamped.clear()
