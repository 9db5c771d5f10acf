"""What nobody reads is switched off where a link is narrow: an autopilot's default streams can fill it.

PX4 sends 22 kB/s to a companion by default; at 57600 baud (5.8 kB/s) its position then comes at 1.5 to 2.5
Hz, and at 16 Hz once the rest is off (flown on PX4 1.16 in simulation). What is unread is known by what
arrives, whatever the version.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.commands import CommandLong, Target, set_message_interval
from onboard.wire.mavlink.ids import frame_size, message_number
from onboard.wire.mavlink.telemetry import READ

CROWDED = 0.5  # share of the link's capacity that is in use, above which it counts as narrow
SEEN = 3  # times a message must have come to be a stream
TRIES, EVERY_S = 5, 3.0  # for one message, and [s] between two
KEPT_HZ = 1.0  # of what is read, but not needed at its default rate
NO_STREAMS = frozenset(
    (
        "HEARTBEAT", "STATUSTEXT", "COMMAND_ACK", "PARAM_VALUE", "TIMESYNC", "AUTOPILOT_VERSION",
        "RADIO_STATUS", "RADIO", "MESSAGE_INTERVAL", "PING", "FILE_TRANSFER_PROTOCOL", "MISSION_ACK",
        "MISSION_COUNT", "MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ITEM_REACHED",
        "LOG_DATA", "LOG_ENTRY",
    )
)  # fmt: skip
"""Answers and news, which no interval stops."""


class UnreadStreams:
    """The streams of one autopilot beside those that the agent asks for."""

    def __init__(
        self, to: Target, needed: Iterable[str], capacity: float | None, signed: bool = False
    ) -> None:
        """`capacity` [bytes/s] of the link; None: not known, as of UDP, which may lead through a radio."""
        self._to = to
        self._needed = frozenset(needed)
        self._capacity = capacity
        self._signed = signed
        self._seen: Counter[str] = Counter()
        self._tries: Counter[str] = Counter()
        self._asked_at: dict[str, float] = {}

    @property
    def asked(self) -> tuple[str, ...]:
        """The messages that were asked off, or slower."""
        return tuple(sorted(self._asked_at))

    def forget(self) -> None:
        """Begin anew: the autopilot has started again, or another link is used."""
        self._seen.clear()
        self._tries.clear()

    def step(
        self, now: float, counts: Mapping[str, int], span: float, starving: bool = False
    ) -> list[CommandLong]:
        """Return the requests due at `now` [s, monotonic]; `counts` of what came in the last `span` [s].

        `starving`: what is needed stays out because the link carries too little, whatever its capacity."""
        if span <= 0.0:
            return []
        self._seen.update(counts)
        load = sum(count * frame_size(name, self._signed) for name, count in counts.items()) / span
        crowded = self._capacity is not None and load >= CROWDED * self._capacity
        if not crowded and not starving:
            return []
        requests = []
        for name, count in counts.items():
            rate = self._rate(name, count / span)
            due = now - self._asked_at.get(name, NEVER) >= EVERY_S and self._tries[name] < TRIES
            if rate is not None and due:
                self._asked_at[name] = now
                self._tries[name] += 1
                requests.append(set_message_interval(self._to, message_number(name), rate))
        return requests

    def _rate(self, name: str, comes: float) -> float | None:
        """The rate [Hz] that is enough of a stream that comes at `comes` [Hz]; None: as it is."""
        if name in self._needed or name in NO_STREAMS or self._seen[name] < SEEN:
            return None
        if message_number(name) in READ:
            return KEPT_HZ if comes > 1.5 * KEPT_HZ else None
        return 0.0
