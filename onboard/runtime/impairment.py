"""What radio does to datagrams: loss, delay, jitter, duplication, reordering, bursts, bit errors.

`Channel` decides, from a seeded generator and the time, what becomes of each datagram of one
direction; `Impaired` puts two of them around a link. Every datagram takes the same count of random
numbers whatever the impairment is, so that changing one share leaves the other fates as they were. A channel
that does nothing but delay draws them once it does more.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable, Hashable
from math import log1p
from typing import TYPE_CHECKING

import msgspec

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Link, Receiver

if TYPE_CHECKING:
    from numpy.random import Generator

IN_FLIGHT_MAX = 20_000  # delayed datagrams of one direction before the next are dropped
HELD_BACK_S = (0.02, 0.06)  # how much later a reordered datagram comes: later ones overtake it
_DRAWS = 8  # random numbers a datagram takes
_AT_ONCE = 8192  # datagrams whose numbers are made up for in one call
_STRETCH_S = (1e-3, 1e6)  # shortest and longest stretch of a burst or of good time


class Impairment(msgspec.Struct, frozen=True, kw_only=True):
    """What happens to the datagrams of one direction. Shares in 0…1, times in seconds.

    A scenario has the same keys, but for `cut`.
    """

    loss: float = 0.0  # share lost, each on its own
    delay_s: float = 0.0
    jitter_s: float = 0.0  # added to the delay, uniform in 0…jitter; keeps the order
    duplication: float = 0.0  # share that arrives twice
    reordering: float = 0.0  # share held back so that later ones overtake it
    burst_rate: float = 0.0  # bursts per second of good time
    burst_s: float = 0.0  # mean length of a burst, in which all is lost
    bit_error: float = 0.0  # share with one bit flipped
    cut: bool = False  # nothing passes at all


CLEAR = Impairment()
CUT = Impairment(cut=True)


def steady(impairment: Impairment) -> bool:
    """Whether nothing is left to chance: every datagram arrives, as it is, in order and `delay_s` late."""
    return msgspec.structs.replace(impairment, delay_s=0.0) == CLEAR


class Channel:
    """The fate of datagrams in one direction; deterministic for a seed and the instants of sending."""

    def __init__(self, impairment: Impairment, rng: Generator) -> None:
        self.counts: Counter[str] = Counter()
        self._rng = rng
        self._burst_rng = rng.spawn(1)[0]
        self._latest_ns = 0  # arrival of the last datagram that kept the order
        self._turn_ns = 0  # when the present stretch, good or burst, ends
        self._in_burst = False
        self._impairment = impairment
        self._steady = steady(impairment)
        self.clear = impairment == CLEAR  # and always was: whatever is sent arrives at once
        self._owed = 0  # datagrams whose random numbers are not drawn yet
        self._started = False

    @property
    def impairment(self) -> Impairment:
        """What is in force; may be changed at any time, for datagrams sent from then on."""
        return self._impairment

    @impairment.setter
    def impairment(self, impairment: Impairment) -> None:
        old, self._impairment = self._impairment, impairment
        self._steady = steady(impairment)
        self.clear = self.clear and impairment == CLEAR
        if (old.burst_rate, old.burst_s) != (impairment.burst_rate, impairment.burst_s):
            self._started = False

    def passed(self) -> None:
        """A datagram was sent while `clear`: its random numbers are drawn once there is any chance."""
        self._owed += 1

    def fate(self, data: bytes, now_ns: int) -> list[tuple[int, bytes]]:
        """When (the instant, ns) and in what shape the copies of a datagram sent at `now_ns` arrive."""
        impairment = self._impairment
        if self._steady:
            self._owed += 1
            self._latest_ns = max(self._latest_ns, now_ns + round(impairment.delay_s * NS_PER_S))
            return [(self._latest_ns, data)]
        while self._owed:
            late = min(self._owed, _AT_ONCE)
            self._rng.random(late * _DRAWS)
            self._owed -= late
        u = self._rng.random(_DRAWS).tolist()
        burst = self._burst(now_ns)
        if impairment.cut:
            self.counts["cut"] += 1
            return []
        if burst:
            self.counts["burst"] += 1
            return []
        if u[0] < impairment.loss:
            self.counts["lost"] += 1
            return []
        if u[1] < impairment.bit_error and data:
            self.counts["bit_error"] += 1
            data = _flip(data, int(u[2] * 8 * len(data)))
        arrival = now_ns + round((impairment.delay_s + u[3] * impairment.jitter_s) * NS_PER_S)
        if u[4] < impairment.reordering:
            self.counts["reordered"] += 1
            low, high = HELD_BACK_S
            arrival = max(arrival, self._latest_ns) + round((low + u[5] * (high - low)) * NS_PER_S)
        else:
            arrival = self._latest_ns = max(arrival, self._latest_ns)
        if u[6] < impairment.duplication:
            self.counts["duplicated"] += 1
            return [(arrival, data), (arrival + round(u[7] * impairment.jitter_s * NS_PER_S), data)]
        return [(arrival, data)]

    def _burst(self, now_ns: int) -> bool:
        """Whether a burst is on: good and bad stretches of exponential lengths take turns."""
        impairment = self._impairment
        if impairment.burst_rate <= 0.0 or impairment.burst_s <= 0.0:
            return False
        if not self._started:
            self._started, self._in_burst = True, False
            self._turn_ns = now_ns + self._exponential_ns(1.0 / impairment.burst_rate)
        while self._turn_ns <= now_ns:
            self._in_burst = not self._in_burst
            mean = impairment.burst_s if self._in_burst else 1.0 / impairment.burst_rate
            self._turn_ns += self._exponential_ns(mean)
        return self._in_burst

    def _exponential_ns(self, mean_s: float) -> int:
        length = -log1p(-float(self._burst_rng.random())) * mean_s
        return round(min(max(length, _STRETCH_S[0]), _STRETCH_S[1]) * NS_PER_S)


def _flip(data: bytes, bit: int) -> bytes:
    changed = bytearray(data)
    changed[bit >> 3] ^= 1 << (bit & 7)
    return bytes(changed)


class Impaired:
    """A link with impaired channels, one for each direction: `outgoing` and `incoming`."""

    def __init__(self, link: Link, impairment: Impairment, rng: Generator) -> None:
        ways = rng.spawn(2)
        self.link = link
        self.outgoing = Channel(impairment, ways[0])
        self.incoming = Channel(impairment, ways[1])
        self._flights = {id(self.outgoing): 0, id(self.incoming): 0}
        self._receiver: Receiver | None = None
        self._closed = False

    @property
    def name(self) -> str:
        """The link's."""
        return self.link.name

    def change(self, impairment: Impairment) -> None:
        """Put another impairment in force in both directions; what is under way still arrives."""
        self.outgoing.impairment = impairment
        self.incoming.impairment = impairment

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """Send through the outgoing channel."""
        self._through(self.outgoing, data, peer, self.link.send)

    def receive(self, receiver: Receiver) -> None:
        """Set the one callback; it hears what the incoming channel lets pass."""
        self._receiver = receiver
        self.link.receive(self._arrived)

    def counters(self) -> dict[str, int]:
        """The link's, and what was done to datagrams: `out_lost`, `in_burst` …"""
        counts = dict(self.link.counters())
        for prefix, channel in (("out", self.outgoing), ("in", self.incoming)):
            counts.update({f"{prefix}_{cause}": count for cause, count in channel.counts.items()})
        return counts

    def close(self) -> None:
        """Close the link; what is under way is lost."""
        self._closed = True
        self.link.close()

    def _arrived(self, data: bytes, peer: Hashable) -> None:
        if self._receiver is not None:
            self._through(self.incoming, data, peer, self._receiver)

    def _through(
        self, channel: Channel, data: bytes, peer: Hashable | None, to: Callable[[bytes, Hashable], None]
    ) -> None:
        if channel.clear:
            channel.passed()
            to(data, peer)
            return
        loop = asyncio.get_running_loop()
        now_ns = round(loop.time() * NS_PER_S)
        for arrival_ns, shape in channel.fate(data, now_ns):
            if arrival_ns <= now_ns:
                to(shape, peer)
            elif self._flights[id(channel)] >= IN_FLIGHT_MAX:
                channel.counts["overflow"] += 1
            else:
                self._flights[id(channel)] += 1
                loop.call_later((arrival_ns - now_ns) / NS_PER_S, self._land, channel, shape, peer, to)

    def _land(
        self, channel: Channel, data: bytes, peer: Hashable | None, to: Callable[[bytes, Hashable], None]
    ) -> None:
        self._flights[id(channel)] -= 1
        if not self._closed:
            to(data, peer)
