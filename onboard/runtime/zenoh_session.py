"""A session of Zenoh that may come later, go and return: with `zenoh_config` what imports Zenoh.

What subscriptions bring waits for the loop in channels of Zenoh's (`zenoh_streams`). For requests and
presence Zenoh calls back on threads of its own, which touch one locked, bounded `Inbox` and wake the
event loop at once; all else happens on the loop. Cached values and events go through Zenoh's advanced
publisher, which keeps them, and its advanced subscriber, which asks for what it missed: a late joiner,
or after the router was away.
"""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

import zenoh
from zenoh import ext, handlers

from onboard.runtime.inbox import Inbox
from onboard.runtime.off_loop import off_loop
from onboard.runtime.patterns import intersects
from onboard.runtime.protocols import Sample, Subscription
from onboard.runtime.rate_limit import BusLimit
from onboard.runtime.zenoh_config import Candidate, first_sentence, of_zenoh
from onboard.runtime.zenoh_streams import Stream, Streams
from onboard.wire.bus.topics import TOPICS, Delivery

EVENTS_KEPT = 256  # events a publisher keeps of each key
RETRY_S = 0.5  # between attempts to connect
CLOSE_S = 2.0
ASKED_S = 0.2  # so long a session's answer holds whether somebody is there; it counts messages, no more
_HEARTBEAT_S = 0.5  # of advanced publishers: how soon a lost last event is noticed
_KEPT = (Delivery.CACHED, Delivery.EVENT)
_KEPT_PATTERNS = tuple(topic.key("*") for topic in TOPICS if topic.delivery in _KEPT)


class _Declared:
    """Something declared on the session, now or once there is one; closing undeclares it."""

    def __init__(
        self, bus: ZenohBus, declare: Callable[[Any], Any], ended: Callable[[], None] | None = None
    ) -> None:
        self.active = True
        self._bus = bus
        self._declare = declare
        self._ended = ended
        self._entity: Any = None

    def open(self, session: Any) -> None:
        """Declare it now; where that fails, again later."""
        if not self.active or session is not self._bus._session:
            return
        try:
            self._entity = self._declare(session)
        except BaseException as error:
            if not of_zenoh(error):
                raise
            self._bus._inbox.counts["declare_failed"] += 1
            self._bus._loop.call_later(RETRY_S, self.open, session)

    def forget(self) -> None:
        """Its session is gone, or going."""
        if self._ended is not None:
            self._ended()
        self._entity = None

    def close(self) -> None:
        """Undeclare it; idempotent."""
        if not self.active:
            return
        self.active = False
        self._bus._declared.remove(self)
        entity = self._entity
        self.forget()
        if entity is not None:
            try:
                entity.undeclare()
            except BaseException as error:
                if not of_zenoh(error):
                    raise
                self._bus._inbox.counts["error"] += 1


class ZenohBus:
    """A Zenoh session that may come later, go and return. Made by `open_zenoh`, on an event loop."""

    def __init__(
        self, sessions: list[Candidate], endpoint: str, why_not: Callable[[], str] = lambda: ""
    ) -> None:
        self._sessions = sessions  # what to try, in order, each time
        self._endpoint = endpoint
        self._why_not = why_not  # asked, on a thread, for words when no session opens
        self._loop = asyncio.get_running_loop()
        self._inbox = Inbox(self._loop)
        self._limit = BusLimit()
        self._met, self._asked_at = False, float("-inf")
        self._streams = Streams(self._loop, self._inbox.counts, self._limit)
        self._declared: list[_Declared] = []
        self._publishers: dict[str, Any] = {}
        self._kept: dict[str, tuple[Delivery, deque[bytes]]] = {}  # for a session that is yet to come
        self._session: Any = None
        self._how = ""
        self._trouble = ""
        self._stop = threading.Event()
        self._gone = False  # closed: a session that opens after all is nobody's
        self._closing: deque[threading.Thread] = deque(maxlen=4)  # that close what was given up
        self._attempted = asyncio.Event()
        self._thread = threading.Thread(target=self._open_in_thread, name="zenoh-open", daemon=True)
        self._thread.start()

    def status(self) -> str:
        """For people: listening, joined or connected, or what is waited for."""
        if self._session is None:
            return f"waiting for a bus at {self._endpoint} ({self._trouble or 'opening'})"
        if self._how == "joined":
            how = f"joined {self._endpoint} as a client: its port was taken"
        else:
            how = f"{'listening' if self._how == 'listening' else 'connected'} at {self._endpoint}"
        return how if self.connected() else f"{how}; nobody there"

    @property
    def how(self) -> str:
        """`listening`, `client`, `joined` (asked to listen, found the port taken), or empty while waiting."""
        return self._how

    def connected(self) -> bool:
        """Whether at least one other session is connected to this one."""
        self._asked_at = self._loop.time()
        self._met = self._session is not None and bool(self._session.info.transports())
        return self._met

    def _somebody(self) -> bool:
        """`connected` as it was when last asked, within `ASKED_S`: Zenoh answers it on another thread."""
        return self._met if self._loop.time() - self._asked_at < ASKED_S else self.connected()

    def trouble(self) -> str:
        """Why a session that is open does not serve; "" where it does, as far as is known."""
        return ""

    def counters(self) -> dict[str, int]:
        """published, received, how often the loop was woken, and what was dropped by cause."""
        woken = self._inbox.wakes + self._streams.looks
        return {**self._inbox.counts, "woken": woken, **self._limit.counters()}

    def publish(self, key: str, payload: bytes, delivery: Delivery) -> None:
        """Put a message; never blocks. Counts `no_bus` where nobody is connected."""
        counts, session = self._inbox.counts, self._session
        if self._stop.is_set():
            counts["closed"] += 1
            return
        if delivery in _KEPT:
            length = EVENTS_KEPT if delivery is Delivery.EVENT else 1
            self._kept.setdefault(key, (delivery, deque(maxlen=length)))[1].append(payload)
        if session is None:
            counts["no_bus"] += 1
            return
        counts["published" if self._somebody() else "no_bus"] += 1
        self._put(session, key, payload, delivery)

    def _put(self, session: Any, key: str, payload: bytes, delivery: Delivery) -> None:
        try:
            publisher = self._publishers.get(key)
            if publisher is None:
                publisher = self._publishers[key] = _publisher(session, key, delivery)
            publisher.put(payload)
        except BaseException as error:
            if not of_zenoh(error):
                raise
            self._inbox.counts["error"] += 1

    def subscribe(
        self, pattern: str, receiver: Callable[[Sample], None], *, every: bool = False
    ) -> Subscription:
        """Call `receiver` on the loop for what matches; kept values come first.

        With `every` a loop that is late gets all messages, up to `QUEUE_MAX`, not the latest of each key.
        """
        kept = any(intersects(pattern, other) for other in _KEPT_PATTERNS)
        stream = Stream(receiver, pattern, every=every, kept=kept)

        def declare(session: Any) -> Any:
            channel, take = self._streams.channel(stream)
            if not kept:
                entity = session.declare_subscriber(pattern, channel)
            else:
                entity = ext.declare_advanced_subscriber(
                    session,
                    pattern,
                    channel,
                    history=ext.HistoryConfig(detect_late_publishers=True),
                    recovery=ext.RecoveryConfig(heartbeat=True, periodic_queries=None),
                )
            self._streams.attach(stream, take or entity.handler.try_recv)
            return entity

        return self._declare(declare, partial(self._streams.detach, stream))

    def wanted_in(self, wait: float) -> None:
        """What has come by `wait` [s] from now is wanted then, and not before."""
        self._streams.look_in(wait)

    def serve(self, key: str, handler: Callable[[bytes], bytes]) -> Subscription:
        """Answer requests on `key`; the handler runs on the loop."""

        def answer(query: Any) -> None:
            with query:
                if not declared.active:
                    return
                question = b"" if query.payload is None else query.payload.to_bytes()
                self._inbox.counts["answered"] += 1
                query.reply(key, handler(question))

        def asked(query: Any) -> None:  # on a thread of Zenoh's
            size = 0 if query.payload is None else len(query.payload)
            if not self._limit.admits(key, size, self._loop.time()):
                query.drop()
                return
            self._inbox.queue(partial(answer, query))

        declared = self._declare(
            lambda session: session.declare_queryable(key, handlers.Callback(asked, indirect=False))
        )
        return declared

    async def request(self, key: str, payload: bytes, timeout_s: float) -> list[bytes]:
        """The replies of all who serve `key`: once all are there, or what came within `timeout_s`."""
        counts = self._inbox.counts
        if self._session is None:
            counts["no_bus"] += 1
            return []
        replies: list[bytes] = []
        complete = asyncio.Event()

        def arrived(reply: Any) -> None:  # on a thread of Zenoh's
            sample = reply.ok
            if sample is None:
                self._inbox.queue(partial(counts.update, ("reply_error",)))
            else:
                self._inbox.queue(partial(replies.append, sample.payload.to_bytes()))

        counts["requests"] += 1
        try:
            self._session.get(
                key,
                handlers.Callback(arrived, lambda: self._inbox.queue(complete.set), indirect=False),
                payload=payload,
                timeout=timeout_s,
                target=zenoh.QueryTarget.ALL,
                consolidation=zenoh.ConsolidationMode.NONE,
                congestion_control=zenoh.CongestionControl.DROP,  # BLOCK stops the loop; who asks asks again
            )
            async with asyncio.timeout(timeout_s):
                await complete.wait()
        except TimeoutError:
            counts["request_timeout"] += 1
        except zenoh.ZError:
            counts["error"] += 1
        if not replies:
            counts["request_unserved"] += 1
        return list(replies)

    def announce(self, key: str) -> Subscription:
        """Declare a liveliness token."""
        return self._declare(lambda session: session.liveliness().declare_token(key))

    def presence(self, pattern: str, receiver: Callable[[str, bool], None]) -> Subscription:
        """Call `receiver(key, alive)` on the loop, for tokens that already exist first."""

        def deliver(key: str, alive: bool) -> None:
            if declared.active:
                receiver(key, alive)

        def changed(sample: Any) -> None:  # on a thread of Zenoh's
            alive = sample.kind == zenoh.SampleKind.PUT
            self._inbox.queue(partial(deliver, str(sample.key_expr), alive))

        declared = self._declare(
            lambda session: session.liveliness().declare_subscriber(
                pattern, handlers.Callback(changed, indirect=False), history=True
            )
        )
        return declared

    def reopen(self) -> None:
        """Give up the session, which no longer works, and open another: all that was declared comes back.

        Values and events that were kept are put again; who has had them knows them by their numbers.
        """
        session, self._session = self._session, None
        if session is None or self._stop.is_set():
            return
        self._inbox.counts["reopened"] += 1
        self._how, self._trouble = "", "opening again"
        self._publishers.clear()
        for declared in self._declared:
            declared.forget()
        self._give_up(session)
        self._thread = threading.Thread(target=self._open_in_thread, name="zenoh-open", daemon=True)
        self._thread.start()

    async def close(self) -> None:
        """Close the session, within `CLOSE_S`; what was declared ends with it."""
        if self._stop.is_set():
            return
        self._stop.set()
        for declared in self._declared:
            declared.active = False
            declared.forget()
        self._declared.clear()
        for thread in (self._thread, *self._closing):  # whoever ends inside Zenoh's code dies by SIGABRT
            if thread.is_alive():
                await off_loop(partial(thread.join, CLOSE_S))
        session, self._session = self._session, None  # one that opened meanwhile is here, too
        self._gone = True
        if session is not None:
            self._give_up(session, closed := asyncio.Event())
            try:
                async with asyncio.timeout(CLOSE_S):
                    await closed.wait()
            except TimeoutError:
                self._inbox.counts["close_timeout"] += 1

    async def first_attempt(self, timeout_s: float) -> None:
        """Wait until the first attempt to connect has succeeded or failed."""
        try:
            async with asyncio.timeout(timeout_s):
                await self._attempted.wait()
        except TimeoutError:
            self._trouble = self._trouble or "no answer yet"

    def _declare(self, declare: Callable[[Any], Any], ended: Callable[[], None] | None = None) -> _Declared:
        declared = _Declared(self, declare, ended)
        self._declared.append(declared)
        if self._session is not None:
            declared.open(self._session)
        return declared

    def _open_in_thread(self) -> None:
        while not self._stop.is_set():
            for how, config in self._sessions:
                try:
                    session = zenoh.open(config)
                except BaseException as error:  # nothing else is there to open it
                    if not of_zenoh(error):
                        raise
                    trouble = self._why_not() or first_sentence(error)
                    self._inbox.queue(partial(self._failed, trouble))
                else:
                    self._inbox.queue(partial(self._opened, session, how))
                    return
            self._stop.wait(RETRY_S)

    def _close_in_thread(self, session: Any, closed: asyncio.Event | None = None) -> None:
        try:
            session.close()
        except BaseException as error:  # over a bad network it may give up
            if not of_zenoh(error):
                raise
            self._inbox.counts["close_timeout"] += 1
        if closed is not None:
            self._inbox.queue(closed.set)

    def _give_up(self, session: Any, closed: asyncio.Event | None = None) -> None:
        thread = threading.Thread(target=self._close_in_thread, args=(session, closed), daemon=True)
        self._closing.append(thread)
        thread.start()

    def _failed(self, trouble: str) -> None:
        self._trouble = trouble
        self._inbox.counts["open_failed"] += 1
        if len(self._sessions) == 1 or self._inbox.counts["open_failed"] >= len(self._sessions):
            self._attempted.set()

    def _opened(self, session: Any, how: str) -> None:
        if self._stop.is_set():  # `close` is under way and closes this, too; or it is over
            self._session = None if self._gone else session
            return self._give_up(session) if self._gone else None
        self._session, self._how = session, how
        for declared in self._declared:
            declared.open(session)
        for key, (delivery, payloads) in self._kept.items():
            for payload in payloads:
                self._put(session, key, payload, delivery)
        self._attempted.set()


def _publisher(session: Any, key: str, delivery: Delivery) -> Any:
    if delivery not in _KEPT:
        return session.declare_publisher(key, congestion_control=zenoh.CongestionControl.DROP)
    return ext.declare_advanced_publisher(
        session,
        key,
        congestion_control=zenoh.CongestionControl.DROP,  # what is dropped is recovered from the cache
        cache=ext.CacheConfig(EVENTS_KEPT if delivery is Delivery.EVENT else 1),
        publisher_detection=True,
        sample_miss_detection=ext.MissDetectionConfig(heartbeat=_HEARTBEAT_S, sporadic_heartbeat=None),
    )
