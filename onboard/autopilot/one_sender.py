"""Which of several senders on one link is the autopilot: the first, until it is silent.

Two autopilots left at one system id must not draw setpoints from each other. One autopilot may change its
port, at every datagram even: then its frames' numbers go on, and the old port falls silent.
"""

from __future__ import annotations

from collections import OrderedDict
from enum import Enum

from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.frames import Packet
from onboard.wire.mavlink.values import Attitude, GlobalPosition

MOVED_S = 0.3  # [s] of silence after which another port may be the same autopilot's: under `telemetry_age`
GONE_S = 3.0  # [s] of silence after which even another autopilot counts
NEXT = 8  # frames that may be lost before the next number
CLOCK = 1.0  # [s] by which the clocks of one autopilot's frames agree
MOST = 16  # senders remembered


class Sender(Enum):
    """Whose a frame is."""

    FIRST = "first"  # the autopilot's: it counts, and answers go there
    SAME = "same"  # the autopilot's over another port: it counts
    OTHER = "other"  # not to be told yet: it does not count
    SECOND = "second"  # another autopilot's: it does not count


class OneSender:
    """The autopilot among the peers of one link. Instants are local monotonic seconds."""

    def __init__(self) -> None:
        self.peer: int | None = None
        self._at = NEVER  # when the autopilot was last heard
        self._number = 0  # of its last frame
        self._clock: float | None = None  # its clock less ours [s]
        self._others: OrderedDict[int, float] = OrderedDict()  # other peers → when they were first heard
        self._second: OrderedDict[int, None] = OrderedDict()  # other autopilots

    def judge(self, now: float, peer: int, packet: Packet) -> Sender:
        """Judge a frame of the autopilot's own component that came from `peer`."""
        value = packet.value
        clock = value.time_boot_s - now if isinstance(value, (GlobalPosition, Attitude)) else None
        silence = now - self._at
        if peer == self.peer or self.peer is None or silence > GONE_S:
            return self._first(now, peer, packet, clock)
        if peer in self._second:
            return Sender.SECOND
        agrees = clock is None or self._clock is None or abs(clock - self._clock) <= CLOCK
        if not agrees and silence <= MOVED_S:
            return self._other_autopilot(peer)
        if agrees and silence > MOVED_S:
            return self._first(now, peer, packet, clock)
        if agrees and 1 <= (packet.sequence - self._number) % 256 <= NEXT:
            self._number = packet.sequence
            return Sender.SAME
        heard = self._others.setdefault(peer, now)
        while len(self._others) > MOST:
            self._others.popitem(last=False)
        if self._at > heard and (clock is None or silence <= MOVED_S):
            return self._other_autopilot(peer)  # both speak in turn
        return Sender.OTHER

    def _first(self, now: float, peer: int, packet: Packet, clock: float | None) -> Sender:
        if peer != self.peer:
            self._others.clear()
            self._second.clear()
        self.peer, self._at, self._number = peer, now, packet.sequence
        self._clock = clock if clock is not None else self._clock
        return Sender.FIRST

    def _other_autopilot(self, peer: int) -> Sender:
        self._second[peer] = None
        while len(self._second) > MOST:
            self._second.popitem(last=False)
        return Sender.SECOND
