"""The bus in memory: one `MemoryBroker` in a process, a `MemoryBus` for each who would have a session.

It behaves as the Zenoh bus does, so that programs cannot tell: a publisher keeps its cached values
and events and hands them to late joiners and to a broker that comes back; messages of one publisher
arrive in order; LATEST messages, requests and replies may be lost on an impaired connection (who asks
asks again, sooner than TCP would), all others come late instead, as over TCP.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from onboard.core.math.each import new
from onboard.runtime.impairment import Channel, Impairment
from onboard.runtime.memory_delivery import Kept, Listener, MemoryDelivery, Parcel, Watcher
from onboard.runtime.patterns import matches
from onboard.runtime.protocols import Sample
from onboard.runtime.rate_limit import LATER_S, PAYLOAD_MAX, BusLimit
from onboard.wire.bus.topics import Delivery

if TYPE_CHECKING:
    from numpy.random import Generator

LATEST = Delivery.LATEST
ROUTES_MAX = 10_000  # keys whose hearers are remembered
RECONNECT_S = 0.5  # a connection is back at most this long after the broker


class _Undo:
    """A subscription: closing runs `undo`, once."""

    def __init__(self, undo: Callable[[], None]) -> None:
        self._undo: Callable[[], None] | None = undo

    def close(self) -> None:
        """Undo it; idempotent."""
        undo, self._undo = self._undo, None
        if undo is not None:
            undo()


class MemoryBroker:
    """Joins the connections of one process; can be killed and brought back."""

    def __init__(self, impairment: Impairment | None = None, rng: Generator | None = None) -> None:
        if impairment is not None and rng is None:
            raise ValueError("an impaired broker needs a generator")
        self._impairment = impairment
        self._rng = rng
        self.up = True
        self.buses: list[MemoryBus] = []
        self._routes: dict[str, list[tuple[MemoryBus, tuple[Listener, ...]]]] = {}
        self._made = 0

    def connect(self, name: str = "") -> MemoryBus:
        """A new connection, with an impaired channel of its own where the broker is impaired."""
        channel = None
        if self._impairment is not None and self._rng is not None:
            channel = Channel(self._impairment, self._rng.spawn(1)[0])
        self._made += 1
        bus = MemoryBus(self, self._made, name or f"bus {self._made}", channel)
        self.buses.append(bus)
        bus._online = self.up
        return bus

    def kill(self) -> None:
        """The broker dies: everybody loses everybody, at once."""
        self.up = False
        for bus in self.buses:
            bus._online = False
        for bus in self.buses:
            bus._lost()

    def restore(self) -> None:
        """The broker is back: the connections return within `RECONNECT_S`, in the order they were made."""
        self.up = True
        for bus in self.buses:
            asyncio.get_running_loop().call_later(RECONNECT_S, bus._returned)

    def route(self, key: str) -> list[tuple[MemoryBus, tuple[Listener, ...]]]:
        """Who hears a key: connections, and their subscriptions to it."""
        found = self._routes.get(key)
        if found is None:
            if len(self._routes) >= ROUTES_MAX:
                self._routes.clear()
            heard = (
                (bus, tuple(listener for listener in bus.listeners if matches(listener.pattern, key)))
                for bus in self.buses
            )
            found = self._routes[key] = [(bus, listeners) for bus, listeners in heard if listeners]
        return found

    def changed(self) -> None:
        """Forget the routes: somebody subscribed or left."""
        self._routes.clear()

    def tokens_changed(self) -> None:
        """Tell all watchers what came and went."""
        for bus in self.buses:
            bus._look()

    def tokens(self) -> list[str]:
        """The keys that are alive, each once."""
        return list(dict.fromkeys(key for bus in self.buses if bus._online for key in bus.tokens))


class MemoryBus:
    """One connection to a `MemoryBroker`. `channel` is its impairment, of what comes in."""

    def __init__(self, broker: MemoryBroker, number: int, name: str, channel: Channel | None) -> None:
        self.number = number  # of the connection, for as long as the broker exists
        self.name = name
        self.channel = channel
        self.listeners: list[Listener] = []
        self.tokens: list[str] = []
        self._broker = broker
        self._watchers: list[Watcher] = []
        self._servers: list[tuple[str, Callable[[bytes], bytes]]] = []
        self._kept: dict[str, Kept] = {}
        self._counts: Counter[str] = Counter()
        self._delivery = MemoryDelivery(channel, self._counts)
        self._limit = BusLimit()
        self._later: dict[tuple[str, int], Callable[[], None]] = {}  # the newest of a flood, by key
        self.tap: Callable[[Sample], None] | None = None  # is told of everything delivered to this connection
        self.stopped = False  # its process is stopped (SIGSTOP): publishes nothing, and its tokens stay
        self._online = False
        self._closed = False

    def publish(self, key: str, payload: bytes, delivery: Delivery) -> None:
        """Put a message; counts `no_bus` while there is no broker."""
        if self._closed or self.stopped:
            self._counts["closed" if self._closed else "stopped"] += 1
            return
        number = 0
        if delivery is not LATEST and delivery in (Delivery.CACHED, Delivery.EVENT):
            kept = self._kept.get(key)
            if kept is None:
                kept = self._kept[key] = Kept(delivery)
            kept.number += 1
            number = kept.number
            kept.entries.append((number, payload))
        if not self._online:
            self._counts["no_bus"] += 1
            return
        self._counts["published"] += 1
        sample = new(Sample, (key, payload))
        parcel = new(Parcel, (sample, delivery, (self.number, key), number))
        at_once: list[tuple[MemoryBus, tuple[Listener, ...]]] = []
        for bus, listeners in self._broker.route(key):
            if not bus._online:
                continue
            if bus.channel is not None:
                bus._hand(listeners, parcel)
            elif bus._delivery.begin(delivery):
                at_once.append((bus, listeners))
        if at_once:
            asyncio.get_running_loop().call_soon(_arrive, at_once, parcel)

    def subscribe(self, pattern: str, receiver: Callable[[Sample], None], *, every: bool = False) -> _Undo:
        """Call `receiver` for what matches (here it is every message); what publishers keep comes first."""
        listener = Listener(pattern, receiver)
        self.listeners.append(listener)
        self._broker.changed()
        if self._online:
            self._catch_up(listener)

        def undo() -> None:
            listener.open = False
            self.listeners.remove(listener)
            self._broker.changed()

        return _Undo(undo)

    def wanted_in(self, wait: float) -> None:
        """Nothing waits here: what is published is on its way."""

    def serve(self, key: str, handler: Callable[[bytes], bytes]) -> _Undo:
        """Answer requests on `key`."""
        entry = (key, handler)
        self._servers.append(entry)
        return _Undo(lambda: self._servers.remove(entry) if entry in self._servers else None)

    async def request(self, key: str, payload: bytes, timeout_s: float) -> list[bytes]:
        """The replies of all who serve `key`: once all are there, or what came within `timeout_s`."""
        asked = [
            (bus, served, handler)
            for bus in (self._broker.buses if self._online else ())
            for served, handler in (bus._servers if bus._online else ())
            if matches(key, served)
        ]
        replies: dict[int, bytes] = {}
        answered: set[int] = set()
        complete = asyncio.Event()

        def answer(number: int, question: bytes) -> None:
            bus, served, handler = asked[number]
            now = asyncio.get_running_loop().time()
            if number not in answered and bus._online and bus._limit.admits(served, len(question), now):
                answered.add(number)
                bus._counts["answered"] += 1
                self._delivery.bring(Delivery.LATEST, handler(question), partial(arrived, number))

        def arrived(number: int, reply: bytes) -> None:
            replies.setdefault(number, reply)
            if len(replies) == len(asked):
                complete.set()

        self._counts["requests" if self._online else "no_bus"] += 1
        for number, (bus, _, _) in enumerate(asked):
            bus._delivery.bring(Delivery.LATEST, payload, partial(answer, number))
        if asked:
            try:
                async with asyncio.timeout(timeout_s):
                    await complete.wait()
            except TimeoutError:
                self._counts["request_timeout"] += 1
        else:
            self._counts["request_unserved"] += 1
        return list(replies.values())

    def announce(self, key: str) -> _Undo:
        """Declare a liveliness token."""
        self.tokens.append(key)
        self._broker.tokens_changed()

        def undo() -> None:
            self.tokens.remove(key)
            self._broker.tokens_changed()

        return _Undo(undo)

    def presence(self, pattern: str, receiver: Callable[[str, bool], None]) -> _Undo:
        """Call `receiver(key, alive)`, for tokens that already exist first."""
        watcher = Watcher(pattern, receiver)
        self._watchers.append(watcher)
        self._look()

        def undo() -> None:
            watcher.open = False
            self._watchers.remove(watcher)

        return _Undo(undo)

    def connected(self) -> bool:
        """Whether the broker is there."""
        return self._online

    def counters(self) -> dict[str, int]:
        """published, received, dropped by cause, and what the impairment did."""
        counts = dict(self._counts) | self._limit.counters()
        if self.channel is not None:
            counts.update({f"in_{cause}": count for cause, count in self.channel.counts.items()})
        return counts

    def cut(self) -> None:
        """From now on nothing goes out or comes in, and nobody is told: as with a radio out of reach."""
        self._online = False

    def mend(self) -> None:
        """End a `cut`: what publishers keep is caught up with, as after a broker's return."""
        self._returned()

    async def close(self) -> None:
        """Leave the broker; tokens and kept values go with it."""
        if self._closed:
            return
        self._closed = True
        self._online = False
        for listener in self.listeners:
            listener.open = False
        for watcher in self._watchers:
            watcher.open = False
        self.tokens.clear()
        self._broker.buses.remove(self)
        self._broker.changed()
        self._broker.tokens_changed()

    def _lost(self) -> None:
        self._delivery.clear()
        self._look()

    def _returned(self) -> None:
        if self._closed or self._online or not self._broker.up:
            return
        self._online = True
        for listener in self.listeners:
            self._catch_up(listener)
        for bus in self._broker.buses:
            if bus is not self and bus._online:
                for listener in bus.listeners:
                    bus._take_kept(self, listener)
        self._broker.tokens_changed()

    def _catch_up(self, listener: Listener) -> None:
        """Hand a listener what all publishers keep and it has not had."""
        for publisher in self._broker.buses:
            if publisher._online:
                self._take_kept(publisher, listener)

    def _take_kept(self, publisher: MemoryBus, listener: Listener) -> None:
        for key, kept in publisher._kept.items():
            if matches(listener.pattern, key):
                source = (publisher.number, key)
                for number, payload in kept.entries:
                    self._hand((listener,), Parcel(Sample(key, payload), Delivery.CACHED, source, number))

    def _hand(self, listeners: tuple[Listener, ...], parcel: Parcel) -> None:
        """Bring a parcel to own listeners, through the impairment: all of them hear it, or none."""
        self._delivery.bring(parcel.delivery, parcel.sample.payload, partial(self._came, listeners, parcel))

    def _came(self, listeners: tuple[Listener, ...], parcel: Parcel, payload: bytes) -> None:
        """Let own listeners hear what came of a parcel through the impairment."""
        sample = Sample(parcel.sample.key, payload)
        self._admit(listeners, parcel, sample, asyncio.get_running_loop().time())

    def _admit(self, listeners: tuple[Listener, ...], parcel: Parcel, sample: Sample, now: float) -> None:
        """Let own listeners hear a sample, within the bounds; `now` [s] is the loop's time."""
        key, payload = sample
        if self._limit.admits(key, len(payload), now):
            if self._later:
                self._later.pop((key, parcel.source[0]), None)
            self._arrived(listeners, parcel, sample)
        elif parcel.delivery is Delivery.LATEST and len(payload) <= PAYLOAD_MAX:
            if not self._later:  # the newest of a flood counts, but not every one of them
                asyncio.get_running_loop().call_later(LATER_S, self._take_later)
            self._later[key, parcel.source[0]] = partial(self._arrived, listeners, parcel, sample)

    def _arrived(self, listeners: tuple[Listener, ...], parcel: Parcel, sample: Sample) -> None:
        _, _, source, number = parcel
        for listener in listeners:
            if not self._online or not listener.open:
                continue
            if number:
                if listener.had.get(source, 0) >= number:
                    continue
                listener.had[source] = number
            self._counts["received"] += 1
            if self.tap is not None:
                self.tap(sample)
            listener.receiver(sample)

    def _take_later(self) -> None:
        later, self._later = self._later, {}
        for call in later.values():
            call()

    def _look(self) -> None:
        """Tell the own watchers which tokens came and went."""
        tokens = self._broker.tokens() if self._online else []
        for watcher in self._watchers:
            seen = {key for key in tokens if matches(watcher.pattern, key)}
            for key in sorted(watcher.alive ^ seen):
                self._delivery.bring(Delivery.REQUEST, b"", partial(self._tell, watcher, key, key in seen))
            watcher.alive = seen

    @staticmethod
    def _tell(watcher: Watcher, key: str, alive: bool, _: bytes) -> None:
        if watcher.open:
            watcher.receiver(key, alive)


def _arrive(hearers: list[tuple[MemoryBus, tuple[Listener, ...]]], parcel: Parcel) -> None:
    """A parcel arrives at connections without an impairment, one after the other."""
    sample, now = parcel.sample, asyncio.get_running_loop().time()
    for number, (bus, listeners) in enumerate(hearers, 1):
        bus._delivery.end()
        try:
            bus._admit(listeners, parcel, sample, now)
        except BaseException:  # one hearer's fault is not the others'
            if hearers[number:]:
                asyncio.get_running_loop().call_soon(_arrive, hearers[number:], parcel)
            raise
