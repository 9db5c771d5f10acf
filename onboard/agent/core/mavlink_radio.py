"""The own MAVLink links: frames in from one or two of them, messages out by the one that works.

One framing state per peer; the autopilot's peer is the first its component was heard from (`one_sender`),
so that another sender on the same port cannot draw the answers to itself, be it a second autopilot.
With two links to one autopilot each frame counts once, and the second takes over when the first falls silent;
setpoints go out on the one that counts, everything else on both.
"""

from __future__ import annotations

from collections import Counter, OrderedDict
from collections.abc import Sequence
from typing import NamedTuple

from onboard.agent.core.events import ANY_PEER, Instant, Keep, LinkFacts, Outbox, Send
from onboard.autopilot.link_redundancy import Redundant
from onboard.autopilot.one_sender import OneSender
from onboard.autopilot.one_sender import Sender as Sent
from onboard.core.math.constants import NEVER
from onboard.core.math.each import new
from onboard.wire.bus.messages import LinkLock
from onboard.wire.mavlink.commands import Outgoing, SetpointMessage
from onboard.wire.mavlink.frames import SIGNATURES, Framer, Packet, Sender, marked_signed
from onboard.wire.mavlink.ids import AUTOPILOT, COMPANION
from onboard.wire.mavlink.signing import Signing

PEERS_MAX = 16  # framing states of one link
REFUSED_S = 2.0  # frames with bad signatures, and for so long no good one of the autopilot's


class _Line:
    """One link: the framing states of its peers, and which of them is the autopilot."""

    def __init__(self, facts: LinkFacts) -> None:
        self.facts = facts
        self.framers: OrderedDict[int, Framer] = OrderedDict()
        self.sender = OneSender()

    @property
    def peer(self) -> int | None:
        """The autopilot's."""
        return self.sender.peer


class Received(NamedTuple):
    """What a datagram brought."""

    packets: tuple[Packet, ...]  # good frames of anybody's, each once
    took_over: bool  # the other link is used for sending from now on
    second: bool = False  # another autopilot speaks under the same system id


class Radio:
    """Sends as component 191 of the vehicle's own system; hears whoever is on the links."""

    def __init__(
        self,
        links: Sequence[LinkFacts],
        system: int,
        out: Outbox,
        *,
        signing: Signing | None = None,
        link_id: int = 0,
        mute: bool = False,
    ) -> None:
        self.causes: Counter[str] = Counter()  # frames that did not count or were not sent, by cause
        self.mute = mute
        self.signed = signing is not None
        self.received = 0  # datagrams
        self._system = system
        self._out = out
        self._signing = signing
        self._sender = Sender(system, COMPANION, signing=signing, link_id=link_id)
        self._lines = [_Line(link) for link in links]
        self._redundant = Redundant(len(links))
        self.due: list[Outgoing] = []  # to be sent with the next `flush`
        self._good_at = NEVER  # when the vehicle's own autopilot was last heard [s]
        self._refused = 0  # frames whose signatures were not good
        self._refused_at = NEVER

    @property
    def active(self) -> str:
        """The name of the link that is used for sending."""
        return self._lines[self._redundant.active].facts.name

    @property
    def lock(self) -> LinkLock:
        """What keeps strangers off the links."""
        if self._signing is None:
            return LinkLock.OPEN
        if self._refused_at != NEVER and self._refused_at - self._good_at > REFUSED_S:
            return LinkLock.REFUSED
        return LinkLock.SILENT if self._good_at == NEVER else LinkLock.SIGNED

    def take(self, index: int, peer: int, data: bytes, now: Instant) -> Received:
        """Take what arrived on link `index` from `peer`."""
        self.received += 1
        line = self._lines[index]
        framer = line.framers.get(peer) or self._new_framer(line, peer)
        packets: list[Packet] = []
        took_over = second = False
        for packet in framer.feed(data, now.wall_ns):
            if packet.system == self._system and packet.component == AUTOPILOT:
                if self._signing is None and marked_signed(packet.raw):
                    self.causes["signed_without_key"] += 1
                sender = line.sender.judge(now.s, peer, packet)
                if sender in (Sent.OTHER, Sent.SECOND):
                    second = second or sender is Sent.SECOND
                    self.causes[f"{sender.value}_autopilot"] += 1
                    continue
                if len(self._lines) > 1:
                    heard = self._redundant.take(now.s, index, packet)
                    took_over = took_over or heard.took_over
                    if not heard.use:
                        self.causes["twin"] += 1
                        continue
            self._out.put(Keep(now.wall_ns, packet.raw))
            packets.append(packet)
            if packet.component == AUTOPILOT and packet.system == self._system:
                self._good_at = now.s
        if self._signing is not None:
            self._count_refused(now.s)
        return new(Received, (tuple(packets), took_over, second))

    def _count_refused(self, now: float) -> None:
        refused = sum(self.causes[cause] for cause in SIGNATURES)
        if refused > self._refused:
            self._refused, self._refused_at = refused, now

    def send(self, message: Outgoing) -> None:
        """Send to the autopilot, with the next `flush`."""
        self.due.append(message)

    def flush(self, now: Instant) -> None:
        """Put what is to be sent in the outbox.

        Nothing leaves while mute, or while it is not known who of several peers the autopilot is.
        """
        if not self.due:
            return
        due, self.due = self.due, []
        for message in due:
            if self.mute:
                self.causes["muted"] += 1
                continue
            frame = self._sender.pack(message, now.wall_ns)
            indices = range(len(self._lines))
            if len(indices) > 1 and isinstance(message, SetpointMessage):
                indices = range(self._redundant.active, self._redundant.active + 1)
            for index in indices:
                line = self._lines[index]
                peer = line.peer
                if peer is None and len(line.framers) > 1:
                    self.causes["no_peer"] += 1
                else:
                    self._out.put(Send(index, ANY_PEER if peer is None else peer, frame))
            self._out.put(Keep(now.wall_ns, frame))

    def _new_framer(self, line: _Line, peer: int) -> Framer:
        if len(line.framers) >= PEERS_MAX:
            old = next((p for p in line.framers if p != line.peer), None)
            if old is not None:
                line.framers.pop(old).end()
            self.causes["peers_forgotten"] += 1
        framer = Framer(signing=self._signing, causes=self.causes)
        line.framers[peer] = framer
        return framer
