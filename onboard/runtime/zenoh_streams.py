"""What subscriptions over Zenoh bring: it waits in a channel of Zenoh's until the event loop takes it.

No thread of Zenoh's enters Python for a message, and none wakes the loop for one: on a small computer either
costs more than most messages. The loop looks every `LOOK_S`, or once when it has said that it will want what
has come, and takes all of it. The master's beat alone wakes it: how long that waited would count as an offset
of the clocks.
"""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import zenoh
from zenoh import handlers

from onboard.runtime.protocols import Sample
from onboard.runtime.rate_limit import LATER_S, PAYLOAD_MAX, BusLimit
from onboard.wire.bus.topics import MASTER, TOPICS, Delivery

LOOK_S = 0.03  # a message waits so long at most for a loop that is not late …
PUT_OFF_S = 0.05  # … and at most so much longer for one that has said when it wants what has come
# Messages that wait in a channel; beyond them the oldest are lost, and that is counted. In time a stream
# fills each of these places with 250 bytes, waiting or not.
EVERY_MAX = 8192  # where each message counts: a station hears a thousand vehicles
MANY_MAX = 1024  # of many keys, or kept for who comes late
ONE_MAX = 128  # of one key whose latest value counts


class Stream:
    """One subscription: its channel, where the session has one, and who hears.

    `every`: of LATEST keys each message counts; `kept`: others are among what it hears."""

    def __init__(
        self, receiver: Callable[[Sample], None], pattern: str, *, every: bool = False, kept: bool = False
    ) -> None:
        self.receiver = receiver
        self.every = every
        self.size = EVERY_MAX if every else MANY_MAX if kept or "*" in pattern else ONE_MAX  # of its channel
        self.take: Callable[[], Any] | None = None  # the channel's next message, or None
        place = TOPICS.find(pattern)
        self.prompt = place is not None and place.topic is MASTER  # it wakes the loop
        self.told, self.heard_at = False, float("-inf")  # that it is to be heard, and when it last was [s]
        self.over: dict[str, Sample] = {}  # over their bounds, the newest of each key
        self.over_at = float("-inf")  # when such were heard last [s]


class Streams:
    """All subscriptions of a bus; made on its loop, with the bus's counts and its bounds for each key."""

    def __init__(self, loop: asyncio.AbstractEventLoop, counts: Counter[str], limit: BusLimit) -> None:
        self.looks = 0  # how often the loop looked
        self._loop = loop
        self._counts = counts
        self._limit = limit
        self._open: list[Stream] = []
        self._timer: asyncio.TimerHandle | None = None
        self._asked = -1  # how often it had looked when it last said when it wants to

    def channel(self, stream: Stream) -> tuple[Any, Callable[[], Any] | None]:
        """Where Zenoh puts what comes, and how it is taken from there; None: as from any channel."""
        if not stream.prompt:
            return handlers.RingChannel(stream.size), None
        waiting: deque[Any] = deque(maxlen=stream.size)

        def arrived(sample: Any) -> None:  # on a thread of Zenoh's
            waiting.append(sample)
            if not stream.told:
                stream.told = True
                with suppress(RuntimeError):  # the loop is closed: nobody is left to hear
                    self._loop.call_soon_threadsafe(self._prompted, stream)

        return handlers.Callback(arrived, indirect=False), lambda: waiting.popleft() if waiting else None

    def _prompted(self, stream: Stream) -> None:
        """Hear one that woke the loop, in a flood no more often than others."""
        wait = stream.heard_at + LOOK_S - self._loop.time()
        if wait > 0.0:
            self._loop.call_later(wait, self._prompted, stream)
            return
        stream.told, stream.heard_at = False, self._loop.time()
        self._hear(stream)

    def attach(self, stream: Stream, take: Callable[[], Any]) -> None:
        """A session has declared it: from now on the loop looks into its channel."""
        stream.take = take
        if stream not in self._open:
            self._open.append(stream)
        if self._timer is None:
            self._timer = self._loop.call_later(LOOK_S, self._look)

    def detach(self, stream: Stream) -> None:
        """Nobody hears it any more, or its session is gone; idempotent."""
        stream.take = None
        if stream in self._open:
            self._open.remove(stream)
        if not self._open and self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def look_in(self, wait: float) -> None:
        """Look in `wait` [s], and not before; where it has not looked since it was last asked to, at once."""
        if self._timer is not None:
            late, self._asked = self._asked == self.looks, self.looks
            self._timer.cancel()
            self._timer = self._loop.call_later(0.0 if late else min(wait, PUT_OFF_S), self._look)

    def _look(self) -> None:
        self._timer = self._loop.call_later(LOOK_S, self._look)
        self.looks += 1
        for stream in tuple(self._open):
            self._hear(stream)

    def _hear(self, stream: Stream) -> None:
        for sample in self._heard(stream):
            if stream.take is None:
                break
            self._counts["received"] += 1
            try:
                stream.receiver(sample)
            except Exception as error:
                said = {"message": "a receiver failed", "exception": error}
                self._loop.call_exception_handler(said)

    def _heard(self, stream: Stream) -> Iterator[Sample]:
        """What has come and is within its bounds; of a LATEST key the newest, unless every one is wanted."""
        now, admits, find = self._loop.time(), self._limit.admits, TOPICS.find
        queue, newest = list[Sample](), dict[str, Sample]()
        for sample in self._taken(stream):
            key, payload = str(sample.key_expr), sample.payload
            size = len(payload)
            admitted = admits(key, size, now)
            place = find(key)
            latest = place is not None and place.topic.delivery is Delivery.LATEST
            if not admitted and (not latest or size > PAYLOAD_MAX):
                continue
            heard = Sample(key, payload.to_bytes())
            if admitted and (stream.every or not latest):
                queue.append(heard)
                continue
            self._counts["overwritten"] += (key in newest) + (stream.over.pop(key, None) is not None)
            (newest if admitted else stream.over)[key] = heard
            if not admitted:
                newest.pop(key, None)
        if stream.over and now - stream.over_at >= LATER_S:
            newest |= stream.over
            stream.over_at = now
            stream.over.clear()
        yield from queue
        yield from newest.values()

    def _taken(self, stream: Stream) -> Iterator[Any]:
        put = zenoh.SampleKind.PUT
        for _ in range(stream.size):
            sample = stream.take() if stream.take is not None else None
            if sample is None:
                return
            if sample.kind == put:
                yield sample
        self._counts["overflow"] += 1  # it was full: how many went before is not known
