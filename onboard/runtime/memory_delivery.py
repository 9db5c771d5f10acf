"""Delivery of messages to one connection of the bus in memory: through an impairment, and in bounds."""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from collections.abc import Callable

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.impairment import Channel
from onboard.wire.bus.topics import Delivery

CALLS_MAX = 4096  # messages under way to one connection before LATEST messages to it are dropped
RESEND_S = 0.2  # what an impaired connection loses of reliable messages comes this much later

Arrived = Callable[[bytes], None]


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

    def bring(self, delivery: Delivery, payload: bytes, arrived: Arrived) -> None:
        """Call `arrived` with what comes of a payload, in a later round of the loop."""
        loop = asyncio.get_running_loop()
        latest = delivery is Delivery.LATEST
        if latest and self._under_way >= CALLS_MAX:
            self._counts["overflow"] += 1
        elif self._channel is None:
            self._under_way += 1
            loop.call_soon(self._land, payload, arrived)
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
        self._under_way -= 1
        arrived(payload)
