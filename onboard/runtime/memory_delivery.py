"""What is delivered on the bus in memory, and to whom; to one connection, impaired and in bounds."""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from collections.abc import Callable
from typing import NamedTuple

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.impairment import Channel
from onboard.runtime.protocols import Sample
from onboard.wire.bus.topics import Delivery

EVENTS_KEPT = 256  # events a publisher keeps of each key
CALLS_MAX = 4096  # messages under way to one connection before LATEST messages to it are dropped
RESEND_S = 0.2  # what an impaired connection loses of reliable messages comes this much later

Arrived = Callable[[bytes], None]


class Kept:
    """What a publisher keeps of one key: (number, payload), the oldest first."""

    def __init__(self, delivery: Delivery) -> None:
        self.number = 0
        self.entries: deque[tuple[int, bytes]] = deque(
            maxlen=EVENTS_KEPT if delivery is Delivery.EVENT else 1
        )


class Listener:
    """One subscription of one connection; numbers tell what it has had already."""

    def __init__(self, pattern: str, receiver: Callable[[Sample], None]) -> None:
        self.pattern = pattern
        self.receiver = receiver
        self.had: dict[tuple[int, str], int] = {}  # (publisher, key) → number last delivered
        self.open = True


class Watcher:
    """One presence subscription: what it believes, so that it is told changes only."""

    def __init__(self, pattern: str, receiver: Callable[[str, bool], None]) -> None:
        self.pattern = pattern
        self.receiver = receiver
        self.alive: set[str] = set()
        self.open = True


class Parcel(NamedTuple):
    """One message on its way."""

    sample: Sample
    delivery: Delivery
    source: tuple[int, str]  # (publisher, key)
    number: int  # of the kept message; 0: it is not kept


class MemoryDelivery:
    """Hands payloads over in a later round of the loop; `channel` (None: none) impairs them.

    LATEST payloads may be lost, doubled or overtaken. All others arrive in order: what the channel loses of
    them is sent again, as TCP does it. Counts `overflow` in `counts`.
    """

    def __init__(self, channel: Channel | None, counts: Counter[str]) -> None:
        self._channel = channel
        self._counts = counts
        self._under_way = 0
        self._reliable: deque[tuple[bytes, Arrived]] = deque(maxlen=CALLS_MAX)
        self._reliable_ns = 0  # arrival of the last reliable payload: the next comes no sooner
        self._pumping = False

    def clear(self) -> None:
        """Forget the reliable payloads that were not sent yet: the connection is lost."""
        self._reliable.clear()

    def begin(self, delivery: Delivery) -> bool:
        """Take one more payload under way, without an impairment; False for one too many. `end` ends it."""
        if delivery is Delivery.LATEST and self._under_way >= CALLS_MAX:
            self._counts["overflow"] += 1
            return False
        self._under_way += 1
        return True

    def end(self) -> None:
        """A payload that began has arrived."""
        self._under_way -= 1

    def bring(self, delivery: Delivery, payload: bytes, arrived: Arrived) -> None:
        """Call `arrived` with what comes of a payload, in a later round of the loop."""
        loop = asyncio.get_running_loop()
        latest = delivery is Delivery.LATEST
        if self._channel is None:
            if self.begin(delivery):
                loop.call_soon(self._land, payload, arrived)
        elif latest and self._under_way >= CALLS_MAX:
            self._counts["overflow"] += 1
        elif latest:
            now_ns = round(loop.time() * NS_PER_S)
            for arrival_ns, shape in self._channel.fate(payload, now_ns):
                self._under_way += 1
                loop.call_later((arrival_ns - now_ns) / NS_PER_S, self._land, shape, arrived)
        else:
            if len(self._reliable) == self._reliable.maxlen:
                self._counts["overflow"] += 1
            self._reliable.append((payload, arrived))
            if not self._pumping:
                self._pump(self._channel)

    def _pump(self, channel: Channel) -> None:
        """Pass on the reliable payloads in order; what the channel loses is sent again later."""
        loop = asyncio.get_running_loop()
        now_ns = round(loop.time() * NS_PER_S)
        self._pumping = False
        while self._reliable:
            payload, arrived = self._reliable[0]
            fate = channel.fate(b"", now_ns)
            if not fate:
                self._pumping = True
                loop.call_later(RESEND_S, self._pump, channel)
                return
            self._reliable.popleft()
            self._reliable_ns = max(self._reliable_ns, fate[0][0])
            self._under_way += 1
            loop.call_later((self._reliable_ns - now_ns) / NS_PER_S, self._land, payload, arrived)

    def _land(self, payload: bytes, arrived: Arrived) -> None:
        self.end()
        arrived(payload)
