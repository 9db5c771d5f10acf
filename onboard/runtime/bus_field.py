"""The bus of a field with keys: Zenoh over TLS, and beside it authenticated datagrams for state and orders.

Under real loss TCP keeps a message back until every earlier one has come, for seconds. So states and orders
also travel as datagrams, orders again every 0.1 s until their reply has come. Setup, events and everything
declared stay on TLS. A session over which the listener does not answer for 1.5 s is opened again.
"""

from __future__ import annotations

import asyncio
import secrets
from collections import Counter
from collections.abc import Callable
from typing import Any

from onboard.config.strict import ConfigError
from onboard.runtime.datagram_path import BEAT_S, DatagramPath, Hooks
from onboard.runtime.links import open_udp
from onboard.runtime.membership import Membership
from onboard.runtime.patterns import matches
from onboard.runtime.protocols import Sample, Subscription
from onboard.runtime.rate_limit import BusLimit
from onboard.runtime.udp_link import UdpLink
from onboard.runtime.zenoh_config import Candidate
from onboard.runtime.zenoh_session import ZenohBus
from onboard.wire.bus.topics import Delivery, echo_key

REPEAT_S = 0.1  # between two datagrams that ask the same
FRESH_S = 0.5  # a key heard by datagram so lately is not heard from the session, which may be behind
ECHO_S = 0.5  # between two questions whether the session works
ECHO_AGE_S = 1.5  # without an answer for so long the session is opened again
ECHO_AGE_MAX_S = 12.0  # doubled each time, up to this: on a bad network opening takes a while, too
HEARD_MAX = 1024  # keys whose last datagram is remembered


class _Both:
    """Two subscriptions that end together."""

    def __init__(self, inner: Subscription, undo: Callable[[], None]) -> None:
        self._inner = inner
        self._undo: Callable[[], None] | None = undo

    def close(self) -> None:
        """Undo both; idempotent."""
        undo, self._undo = self._undo, None
        if undo is not None:
            undo()
            self._inner.close()


class FieldBus(ZenohBus):
    """A `ZenohBus` with datagrams beside it. Made by `open_zenoh` where there are keys."""

    def __init__(
        self,
        sessions: list[Candidate],
        endpoint: str,
        why_not: Callable[[], str],
        member: Membership,
        listen: bool,
    ) -> None:
        super().__init__(sessions, endpoint, why_not)
        self.member = member
        self._echo_key = echo_key(member.field)
        self._hub = member.listens and listen
        hooks = Hooks(self._send, self._deliver, self._answer, self._take_reply)
        address = None if member.listens else (member.host, member.port)
        self._path = DatagramPath(member, _draw, self._loop.time, hooks, address)
        self._unanswered = False  # the listener let the last session in and gave no echo
        self._datagram_limit = BusLimit()
        self._link: UdpLink | None = None
        self._hearers: list[tuple[str, Callable[[Sample], None]]] = []
        self._serving: dict[str, Callable[[bytes], bytes]] = {}
        self._asking: dict[int, tuple[str, asyncio.Future[bytes]]] = {}
        self._heard_at: dict[str, float] = {}
        self._tasks: list[asyncio.Task[None]] = []
        if self._hub:
            self._echoing = super().serve(self._echo_key, lambda question: question)

    def status(self) -> str:
        """As of the session; and where the listener lets it in but answers nothing."""
        trouble = self.trouble()
        return super().status() + (f"; {trouble}" if trouble else "")

    def trouble(self) -> str:
        """That the listener lets the session in and answers nothing: its roster does not have this member."""
        name = self.member.certificate
        return f"the listener answers nothing: is {name} in its roster?" if self._unanswered else ""

    async def open_datagrams(self) -> None:
        """Open the socket and begin to beat. A port that is taken leaves the bus without datagrams."""
        member = self.member
        if member.listens and not self._hub:
            return  # another program of the listener's computer has them
        try:
            host = "::" if ":" in member.host else "0.0.0.0"
            self._link = await open_udp(host, member.port if self._hub else 0, "datagrams")
        except ConfigError:
            self._inbox.counts["datagrams_no_socket"] += 1
            return
        self._link.receive(lambda data, peer: self._path.take(data, peer))
        self._tasks.append(asyncio.create_task(self._beat(), name="datagrams"))
        if not self._hub:
            self._tasks.append(asyncio.create_task(self._watch_session(), name="session"))

    def counters(self) -> dict[str, int]:
        """Those of the session, and those of the datagrams."""
        limited = Counter(self._datagram_limit.counters())
        limited.update(super().counters())
        return dict(limited) | self._path.counters()

    def publish(self, key: str, payload: bytes, delivery: Delivery) -> None:
        """Put a message on the session, and by datagram where it is of a topic that travels so."""
        if delivery is Delivery.LATEST and not self._stop.is_set():
            self._path.put(key, payload)  # only keys of the membership leave
        super().publish(key, payload, delivery)

    def subscribe(
        self, pattern: str, receiver: Callable[[Sample], None], *, every: bool = False
    ) -> Subscription:
        """Call `receiver` on the loop for what matches, whichever way it came."""

        def from_session(sample: Sample) -> None:
            if self._loop.time() - self._heard_at.get(sample.key, -FRESH_S) < FRESH_S:
                self._inbox.counts["came_by_datagram"] += 1
            else:
                receiver(sample)

        entry = (pattern, receiver)
        self._hearers.append(entry)
        inner = super().subscribe(pattern, from_session, every=every)
        return _Both(inner, lambda: self._hearers.remove(entry))

    def serve(self, key: str, handler: Callable[[bytes], bytes]) -> Subscription:
        """Answer requests on `key`, whichever way they come."""
        self._serving[key] = handler
        inner = super().serve(key, handler)
        return _Both(inner, lambda: self._serving.pop(key, None) and None)

    async def request(self, key: str, payload: bytes, timeout_s: float) -> list[bytes]:
        """The replies that came first: over the session, or by datagrams that are repeated meanwhile.

        A pattern asks every key of the membership that belongs to it: keys are granted one by one.
        """
        if "*" in key:
            keys = sorted({k for peer in self.member.peers for k in peer.reads if matches(key, k)})
            found = await asyncio.gather(*(self.request(one, payload, timeout_s) for one in keys))
            return [reply for replies in found for reply in replies]
        number = self._path.next_request()
        if not self._path.ask(number, key, payload):
            return await self._over_session(key, payload, timeout_s)
        future: asyncio.Future[bytes] = self._loop.create_future()
        self._asking[number] = (key, future)
        session = asyncio.ensure_future(self._over_session(key, payload, timeout_s))
        ends = self._loop.time() + timeout_s
        try:
            while (left := ends - self._loop.time()) > 0.0 and not future.done():
                waits: set[asyncio.Future[Any]] = {future} if session.done() else {future, session}
                await asyncio.wait(waits, timeout=min(REPEAT_S, left), return_when=asyncio.FIRST_COMPLETED)
                if session.done() and (replies := session.result()):
                    return replies
                if not future.done():
                    self._path.ask(number, key, payload)
            return [future.result()] if future.done() else []
        finally:
            session.cancel()
            self._asking.pop(number, None)

    async def close(self) -> None:
        """Close session and socket."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        if self._link is not None:
            self._link.close()
        await super().close()

    async def _over_session(self, key: str, payload: bytes, timeout_s: float) -> list[bytes]:
        return await super().request(key, payload, timeout_s)

    def _send(self, data: bytes, address: object) -> None:
        if self._link is not None:
            self._link.send(data, address)

    def _deliver(self, sample: Sample) -> None:
        if not self._datagram_limit.admits(sample.key, len(sample.payload), self._loop.time()):
            return
        if len(self._heard_at) >= HEARD_MAX:
            self._heard_at.clear()
        self._heard_at[sample.key] = self._loop.time()
        for pattern, receiver in tuple(self._hearers):
            if matches(pattern, sample.key):
                receiver(sample)

    def _answer(self, key: str, question: bytes) -> bytes | None:
        handler = self._serving.get(key)
        if handler is None or not self._datagram_limit.admits(key, len(question), self._loop.time()):
            return None
        return handler(question)

    def _take_reply(self, number: int, key: str, reply: bytes) -> None:
        asked = self._asking.get(number)
        if asked is not None and asked[0] == key and not asked[1].done():
            asked[1].set_result(reply)

    async def _beat(self) -> None:
        while True:
            self._path.beat()
            await asyncio.sleep(BEAT_S)

    async def _watch_session(self) -> None:
        """Ask the listener for an echo over the session; open another session where none comes."""
        patience = ECHO_AGE_S
        answered_at = self._loop.time()
        while True:
            await asyncio.sleep(ECHO_S)
            now = self._loop.time()
            if self._session is None:
                answered_at = now
            elif await self._over_session(self._echo_key, b"", ECHO_S):
                answered_at, patience, self._unanswered = self._loop.time(), ECHO_AGE_S, False
            elif self._loop.time() - answered_at > patience:
                patience = min(2.0 * patience, ECHO_AGE_MAX_S)
                self._unanswered = True
                self.reopen()


def _draw() -> int:
    return secrets.randbits(63) + 1
