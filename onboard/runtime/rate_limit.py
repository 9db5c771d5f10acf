"""Bounds on how much of one kind one sender may bring: token buckets. What is over them is counted by kind.

Time is an argument. A bucket is small, and their number is bounded: who is heard beyond it shares one.
"""

from __future__ import annotations

from collections import Counter, OrderedDict
from collections.abc import Hashable
from typing import Any, NamedTuple

from onboard.wire.bus.topics import ID, PLACES_KEPT, TOPICS, Delivery, Topic

BUCKETS_MAX = 1024  # of a link
PAYLOAD_MAX = 65_536  # [bytes] of a message on the bus: none of the table comes near it
LATER_S = 0.05  # of a key whose latest value counts, the newest is heard at this pace though over its bound


class Rate(NamedTuple):
    """A bound: so many a second on the long run, and so many at once."""

    per_s: float
    burst: float


LATEST_FACTOR = 5.0  # a topic's nominal rate times this, for late packets that come together
KEPT = Rate(100.0, 512.0)  # events and cached values; all that a publisher keeps comes at once
ASKED = Rate(100.0, 100.0)  # orders to one vehicle
FOREIGN = Rate(100.0, 100.0)  # keys that the table does not have, all together
FROM_AUTOPILOT = Rate(200.0, 200.0)  # datagrams of a link that begin with one kind of message read here, each
BESIDE = Rate(500.0, 250.0)  # STATUSTEXT, and kinds that nobody reads, all together
FROM_OTHERS = Rate(500.0, 250.0)  # datagrams of a link, from all others together


class Bucket:
    """What is left of a bound."""

    __slots__ = ("at", "left")

    def __init__(self, burst: float, now: float) -> None:
        self.left = burst
        self.at = now

    def admits(self, rate: Rate, now: float) -> bool:
        """Whether one more at `now` [s; steady] is within the bound."""
        per_s, burst = rate
        left = self.left + (now - self.at) * per_s
        if left > burst:
            left = burst
        self.at = now
        if left < 1.0:
            self.left = left
            return False
        self.left = left - 1.0
        return True


class RateLimit:
    """One bucket for each sender and kind, `most` of them."""

    def __init__(self, most: int = BUCKETS_MAX) -> None:
        self.limited: Counter[str] = Counter()  # by kind
        self._most = most
        self._buckets: OrderedDict[Hashable, Bucket] = OrderedDict()

    def admits(self, sender: Hashable, kind: str, rate: Rate, now: float) -> bool:
        """Whether one more of a kind from a sender at `now` [s; steady] is within its bound."""
        bucket = self._buckets.get((sender, kind))
        if bucket is None:
            bucket = self.bucket(sender, kind, rate, now)
        if bucket.admits(rate, now):
            return True
        self.limited[kind] += 1
        return False

    def bucket(self, sender: Hashable, kind: str, rate: Rate, now: float) -> Bucket:
        """The bucket of a kind from a sender, full where it is new."""
        key = (sender, kind)
        if key not in self._buckets and len(self._buckets) >= self._most:
            key = ("", "")  # the rest share one
        return self._buckets.setdefault(key, Bucket(rate.burst, now))


class BusLimit:
    """The bounds of the bus: for each key, which names the sender and the kind."""

    def __init__(self) -> None:
        self._limit = RateLimit(PLACES_KEPT)  # room for every key of the largest game
        self._known: dict[str, tuple[str, Rate, Bucket]] = {}  # by key

    def admits(self, key: str, size: int, now: float) -> bool:
        """Whether a message of `size` bytes on a key is within its bound."""
        if size > PAYLOAD_MAX:
            self._limit.limited["payload"] += 1
            return False
        known = self._known.get(key)
        kind, rate, bucket = self._bound(key, now) if known is None else known
        if bucket.admits(rate, now):
            return True
        self._limit.limited[kind] += 1
        return False

    def _bound(self, key: str, now: float) -> tuple[str, Rate, Bucket]:
        """The kind under which a key's messages are counted, their bound, and what is left of it."""
        place = TOPICS.find(key)
        if place is None:
            return "foreign", FOREIGN, self._limit.bucket("", "foreign", FOREIGN, now)
        kind, rate = _bound_of(place.topic)
        found = kind, rate, self._limit.bucket(key, kind, rate, now)
        if len(self._known) < PLACES_KEPT:  # keys come from the network
            self._known[key] = found
        return found

    def counters(self) -> dict[str, int]:
        """How many were over their bound, by kind: `limited_KIND`."""
        return {f"limited_{kind}": number for kind, number in self._limit.limited.items()}


def _bound_of(topic: Topic[Any]) -> tuple[str, Rate]:
    """The kind under which a topic's messages are counted, and their bound."""
    kind = topic.suffix.replace(f"/{ID}", "").replace("/", "_")
    return kind, rate_of(topic.delivery, topic.rate_hz)


def rate_of(delivery: Delivery, nominal_hz: float) -> Rate:
    """The bound of a topic's key."""
    if delivery is Delivery.LATEST:
        rate = max(nominal_hz, 2.0) * LATEST_FACTOR
        return Rate(rate, rate)
    return ASKED if delivery is Delivery.REQUEST else KEPT
