"""The agent's events: numbered, published, and one line each in the log."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Clock
from onboard.wire.bus.messages import DecisionLevel, DecisionModule, Event, Severity
from onboard.wire.bus.topics import EVENTS, Delivery

BURST = 20  # events of one kind within `WINDOW_S` before the rest are only counted
WINDOW_S = 10.0


class Journal:
    """Says what happened, once, to everybody."""

    def __init__(
        self,
        id: int,
        game: str,
        nonce: int,
        clock: Clock,
        publish: Callable[[str, bytes, Delivery], None],
        log: Callable[[str], None],
    ) -> None:
        self._id = id
        self._key = EVENTS.key(game, id)
        self._nonce = nonce
        self._clock = clock
        self._publish = publish
        self._log = log
        self._number = 0
        self._recent: dict[str, list[int]] = {}
        self.suppressed = 0
        self.kinds: dict[str, int] = {}  # how often each kind was said

    def info(self, kind: str, text: str, level: str = "", module: str = "") -> None:
        """Something a person may want to know."""
        self.say(Severity.INFO, kind, text, level, module)

    def warning(self, kind: str, text: str, level: str = "", module: str = "") -> None:
        """Something a person should look at."""
        self.say(Severity.WARNING, kind, text, level, module)

    def error(self, kind: str, text: str, level: str = "", module: str = "") -> None:
        """Something a person must act on."""
        self.say(Severity.ERROR, kind, text, level, module)

    def say(self, severity: Severity, kind: str, text: str, level: str = "", module: str = "") -> None:
        """Publish and log one event; a flood of one kind is cut and counted."""
        now = self._clock.monotonic_ns()
        recent = [at for at in self._recent.get(kind, ()) if now - at < WINDOW_S * NS_PER_S]
        if len(recent) >= BURST:
            self._recent[kind] = recent
            self.suppressed += 1
            return
        self._recent[kind] = [*recent, now]
        self.kinds[kind] = self.kinds.get(kind, 0) + 1
        self._number += 1
        stamp = self._clock.wall_ns()
        event = Event(
            id=self._id, number=self._number, stamp_ns=stamp, severity=severity, kind=kind, text=text,
            level=DecisionLevel(level), module=DecisionModule(module), nonce=self._nonce,
        )  # fmt: skip
        self._publish(self._key, EVENTS.encode(event), EVENTS.delivery)
        when = datetime.fromtimestamp(stamp / NS_PER_S, UTC).strftime("%H:%M:%S.%f")[:-3]
        self._log(f"{when} {severity.value:7} vehicle {self._id} {kind}: {text}")
