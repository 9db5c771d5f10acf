"""The own MAVLink links: frames in from one or two of them, messages out by the one that works.

One framing state per peer; the autopilot's peer is the one its component was last heard from, so
that another sender on the same port cannot draw the answers to itself. With two links to one
autopilot each frame counts once, and the second takes over when the first falls silent; setpoints
go out on the one that counts, everything else on both.
"""

from __future__ import annotations

from collections import Counter, OrderedDict
from collections.abc import Callable, Hashable, Sequence
from functools import partial

from onboard.autopilot.link_redundancy import Redundant
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Clock, Link
from onboard.wire.mavlink.commands import Outgoing, SetpointMessage
from onboard.wire.mavlink.frames import Framer, Packet, Sender
from onboard.wire.mavlink.ids import AUTOPILOT, COMPANION
from onboard.wire.mavlink.signing import Signing

PEERS_MAX = 16  # framing states of one link

Record = Callable[[int, bytes], None]  # (wall [ns], frame)


class _Line:
    """One link: its peers, and when the autopilot was last heard on it."""

    def __init__(self, link: Link) -> None:
        self.link = link
        self.stream = link.name.startswith("serial:")
        self.framers: OrderedDict[Hashable, Framer] = OrderedDict()
        self.peer: Hashable | None = None


class Radio:
    """Sends as component 191 of the vehicle's own system; hears whoever is on the links."""

    def __init__(
        self,
        links: Sequence[Link],
        system: int,
        clock: Clock,
        *,
        component: int = COMPANION,
        signing: Signing | None = None,
        link_id: int = 0,
        record: Record | None = None,
        mute: bool = False,
    ) -> None:
        self.causes: Counter[str] = Counter()
        self.mute = mute
        self.sent = 0
        self.signed = signing is not None
        self.took_over = False  # the other link is used since somebody last looked
        self._system = system
        self._clock = clock
        self._signing = signing
        self._sender = Sender(system, component, signing=signing, link_id=link_id)
        self._record = record
        self._lines = [_Line(link) for link in links]
        self._redundant = Redundant(len(links))
        self._hear: Callable[[Packet, float], None] | None = None

    def open(self, hear: Callable[[Packet, float], None]) -> None:
        """Call `hear(packet, now [s, monotonic])` for each good packet of anybody's."""
        self._hear = hear
        for index, line in enumerate(self._lines):
            line.link.receive(partial(self._arrived, index))

    @property
    def active(self) -> str:
        """The link that is used for sending."""
        return self._lines[self._redundant.active].link.name

    def send(self, message: Outgoing) -> None:
        """Send to the autopilot. Nothing leaves while mute, or while it is not known who of several it is."""
        if self.mute:
            self.causes["muted"] += 1
            return
        wall = self._clock.wall_ns()
        frame = self._sender.pack(message, wall)
        lines = self._lines
        if len(lines) > 1 and isinstance(message, SetpointMessage):
            lines = [lines[self._redundant.active]]
        for line in lines:
            if line.peer is None and len(line.framers) > 1:
                self.causes["no_peer"] += 1
            else:
                line.link.send(frame, line.peer)
        self.sent += 1
        if self._record is not None:
            self._record(wall, frame)

    def counters(self) -> dict[str, int]:
        """Bad frames by cause, and what the links count."""
        counts = Counter(self.causes)
        for line in self._lines:
            for cause, number in line.link.counters().items():
                if cause not in ("sent", "received"):
                    counts[f"link_{cause}"] += number
        return dict(counts)

    def close(self) -> None:
        """Close the links."""
        for line in self._lines:
            line.link.close()

    def _arrived(self, index: int, data: bytes, peer: Hashable) -> None:
        line = self._lines[index]
        framer = line.framers.get(peer)
        if framer is None:
            if len(line.framers) >= PEERS_MAX:
                old = next((p for p in line.framers if p != line.peer), None)
                if old is not None:
                    del line.framers[old]
                self.causes["peers_forgotten"] += 1
            framer = Framer(stream=line.stream, signing=self._signing, causes=self.causes)
            line.framers[peer] = framer
        wall = self._clock.wall_ns()
        now = self._clock.monotonic_ns() / NS_PER_S
        for packet in framer.feed(data, wall):
            if packet.system == self._system and packet.component == AUTOPILOT:
                line.peer = peer
                if len(self._lines) > 1:
                    heard = self._redundant.take(now, index, packet)
                    self.took_over = self.took_over or heard.took_over
                    if not heard.use:
                        self.causes["twin"] += 1
                        continue
            if self._record is not None:
                self._record(wall, packet.raw)
            if self._hear is not None:
                self._hear(packet, now)
