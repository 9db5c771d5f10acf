"""The datagrams of one member of a field: who is told what, who is asked, what is passed on. Without I/O.

The listener is the hub: every other member exchanges datagrams with it alone, and it passes on what the
roster lets the one write and the other read.
"""

from __future__ import annotations

from collections import Counter, OrderedDict
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from onboard.runtime.membership import Membership, Peer
from onboard.runtime.protocols import Sample
from onboard.wire.bus.datagram import PROCESSES_MAX, Challenge, Content, Kind, Pair, key_id

BEAT_S = 0.1  # between beats to everybody: thirty in `SILENT_S`, so that loss alone never looks like silence
REMEMBERED = 256  # requests passed on lately
CHALLENGE_S = 0.02  # at most one challenge to a peer in this time

K = TypeVar("K")
V = TypeVar("V")


class Hooks(NamedTuple):
    """What the path calls."""

    send: Callable[[bytes, object], None]  # (datagram, address)
    deliver: Callable[[Sample], None]  # a message for the own subscribers
    answer: Callable[[str, bytes], bytes | None]  # (key, question): None where nobody here serves the key
    replied: Callable[[int, str, bytes], None]  # (own request, its key, reply)


class _Line:
    """A peer, the exchange with it, and where it was heard last."""

    def __init__(self, peer: Peer, listens: bool, draw: Callable[[], int], address: object) -> None:
        self.name = peer.name
        self.writes = frozenset(peer.writes)
        self.reads = frozenset(peer.reads)
        self.pair = Pair(bytes.fromhex(peer.key), listens=listens, draw=draw)
        self.address = address  # where to say hello; None: it comes to us
        self.addresses: OrderedDict[int, object] = OrderedDict()  # of its processes
        self.asked: OrderedDict[tuple[int, int], int] = OrderedDict()  # (process, request) → own number
        self.challenged_at = -1e9


class DatagramPath:
    """Give it datagrams and messages; it calls the hooks.

    `draw` gives random numbers of 64 bits, never 0; `clock` steady time [s]; `address` is where to say hello.
    """

    def __init__(
        self,
        member: Membership,
        draw: Callable[[], int],
        clock: Callable[[], float],
        hooks: Hooks,
        address: object = None,
    ) -> None:
        self._lines = [_Line(peer, member.listens, draw, address) for peer in member.peers]
        self._by_id = {line.pair.id: line for line in self._lines}
        self._hub = member.listens
        self._clock = clock
        self._hooks = hooks
        self._next = draw() & 0xFFFF_FFFF
        self._passed: OrderedDict[int, _Question] = OrderedDict()  # own number → whose request
        self.counts: Counter[str] = Counter()

    def counters(self) -> dict[str, int]:
        """What was sent, received and dropped, by cause."""
        found = Counter(self.counts)
        for line in self._lines:
            found.update({f"datagrams_{cause}": n for cause, n in line.pair.causes.items()})
        return dict(found)

    def proved(self) -> set[str]:
        """The names of the peers that have lately shown that they hear us."""
        now = self._clock()
        return {line.name for line in self._lines if line.pair.hearing(now)}

    def next_request(self) -> int:
        """A number for a new request."""
        self._next = (self._next + 1) & 0xFFFF_FFFF
        return self._next

    def put(self, key: str, payload: bytes) -> None:
        """Tell everybody who may read a key."""
        self._pass_on(Content(Kind.PUT, 0, key, payload), None)

    def ask(self, request: int, key: str, payload: bytes) -> bool:
        """Ask who serves a key; again with the same number until the reply comes. False: nobody to ask."""
        content = Content(Kind.ASK, request, key, payload)
        asked = [self._send(line, content) for line in self._lines if key in line.reads]
        return any(asked)

    def beat(self) -> None:
        """Let every peer know that it is heard, and say hello to who is not; due every `BEAT_S`."""
        for line in self._lines:
            if not self._send(line, Content(Kind.BEAT)) and line.address is not None:
                self._hooks.send(line.pair.hello(), line.address)

    def take(self, data: bytes, address: object) -> None:
        """Take a datagram that came from `address`. Never raises for what it holds."""
        line = self._by_id.get(key_id(data))
        if line is None:
            self.counts["datagrams_foreign"] += 1
            return
        now = self._clock()
        found = line.pair.open(data, now)
        if isinstance(found, Challenge):
            if now - line.challenged_at >= CHALLENGE_S:
                line.challenged_at = now
                self._hooks.send(found.data, address)
        elif found is not None:
            line.addresses[found.process] = address
            if len(line.addresses) > PROCESSES_MAX:
                line.addresses.popitem(last=False)
            self.counts["datagrams_received"] += 1
            if found.first:
                self._send(line, Content(Kind.BEAT))  # it learns at once that it is heard
            self._received(line, found.process, found.content)

    def _received(self, line: _Line, process: int, content: Content) -> None:
        if content.kind is Kind.PUT and content.key in line.writes:
            self._hooks.deliver(Sample(content.key, content.payload))
            if self._hub:
                self._pass_on(content, line)
        elif content.kind is Kind.ASK and content.key in line.writes:
            self._asked(line, process, content)
        elif content.kind is Kind.REPLY and content.key in line.reads:
            self._replied(content)
        elif content.kind is not Kind.BEAT:
            self.counts["datagrams_not_allowed"] += 1

    def _asked(self, line: _Line, process: int, content: Content) -> None:
        reply = self._hooks.answer(content.key, content.payload)  # orders are idempotent
        if reply is not None:
            self._send(line, Content(Kind.REPLY, content.request, content.key, reply), process)
        elif self._hub:
            number = line.asked.get((process, content.request))
            if number is None:
                number = self.next_request()
                _remember(line.asked, (process, content.request), number)
                _remember(self._passed, number, _Question(line, process, content.request, content.key))
            self.ask(number, content.key, content.payload)

    def _replied(self, content: Content) -> None:
        whose = self._passed.get(content.request)
        if whose is None:
            self._hooks.replied(content.request, content.key, content.payload)
        elif whose.key == content.key:
            reply = Content(Kind.REPLY, whose.request, content.key, content.payload)
            self._send(whose.line, reply, whose.process)

    def _pass_on(self, content: Content, source: _Line | None) -> None:
        for line in self._lines:
            if line is not source and content.key in line.reads:
                self._send(line, content)

    def _send(self, line: _Line, content: Content, process: int | None = None) -> bool:
        """Send to one process of a peer, or to all that hear us; whether there was one."""
        sent = False
        for one in line.pair.hearing(self._clock()):
            data = line.pair.seal(content, one) if process in (None, one) else None
            if data is not None and one in line.addresses:
                self.counts["datagrams_sent"] += 1
                self._hooks.send(data, line.addresses[one])
                sent = True
        return sent


class _Question(NamedTuple):
    """Whose request was passed on."""

    line: _Line
    process: int
    request: int
    key: str


def _remember(kept: OrderedDict[K, V], number: K, what: V) -> None:
    kept[number] = what
    if len(kept) > REMEMBERED:
        kept.popitem(last=False)
