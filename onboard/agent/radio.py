"""The own MAVLink links: frames in from one or two of them, messages out by the one that works.

One framing state per peer; the autopilot's peer is the one its component was last heard from, so
that another sender on the same port cannot draw the answers to itself. With two links to one
autopilot each frame counts once, and the second takes over when the first has been silent.
"""

from __future__ import annotations

from collections import Counter, OrderedDict
from collections.abc import Callable, Hashable, Sequence
from functools import partial

from onboard.runtime.protocols import Clock, Link
from onboard.wire.mavlink import Framer, MavMessage, Packet, Sender
from onboard.wire.signing import Signing

PEERS_MAX = 16  # framing states of one link
TAKE_OVER_S = 0.5  # a link silent for longer gives way to one that is not
TWIN_S = 1.0  # within which the same frame from the other link is a twin
TWINS_MAX = 2048
NEVER = -1e9
_NS = 1_000_000_000

Record = Callable[[int, bytes], None]  # (wall [ns], frame)


class _Line:
    """One link: its peers, and when the autopilot was last heard on it."""

    def __init__(self, link: Link) -> None:
        self.link = link
        self.stream = link.name.startswith("serial:")
        self.framers: OrderedDict[Hashable, Framer] = OrderedDict()
        self.peer: Hashable | None = None
        self.heard = NEVER


class Radio:
    """Sends as component 191 of the vehicle's own system; hears whoever is on the links."""

    def __init__(
        self,
        links: Sequence[Link],
        system: int,
        clock: Clock,
        *,
        component: int = 191,
        signing: Signing | None = None,
        link_id: int = 0,
        record: Record | None = None,
        mute: bool = False,
    ) -> None:
        self.causes: Counter[str] = Counter()
        self.mute = mute
        self.sent = 0
        self._system = system
        self._clock = clock
        self._signing = signing
        self._sender = Sender(system, component, signing=signing, link_id=link_id)
        self._record = record
        self._lines = [_Line(link) for link in links]
        self._active = 0
        self._twins: OrderedDict[bytes, float] = OrderedDict()
        self._hear: Callable[[Packet, float], None] | None = None
        self.take_overs = 0

    def open(self, hear: Callable[[Packet, float], None]) -> None:
        """Call `hear(packet, now [s, monotonic])` for each good packet of anybody's."""
        self._hear = hear
        for index, line in enumerate(self._lines):
            line.link.receive(partial(self._arrived, index))

    @property
    def active(self) -> str:
        """The link that is used for sending."""
        return self._lines[self._active].link.name

    def send(self, message: MavMessage) -> None:
        """Send to the autopilot. Nothing leaves while mute, or before the autopilot was heard."""
        if self.mute:
            self.causes["muted"] += 1
            return
        line = self._lines[self._active]
        if line.peer is None and len(line.framers) > 1:
            self.causes["no_peer"] += 1
            return
        wall = self._clock.wall_ns()
        frame = self._sender.pack(message, wall)
        line.link.send(frame, line.peer)
        self.sent += 1
        if self._record is not None:
            self._record(wall, frame)

    def choose(self, now: float) -> str:
        """Change to the other link where the active one is silent; its name if that happened, else ''."""
        if len(self._lines) < 2 or now - self._lines[self._active].heard <= TAKE_OVER_S:
            return ""
        best = max(range(len(self._lines)), key=lambda index: self._lines[index].heard)
        if best == self._active or now - self._lines[best].heard > TAKE_OVER_S:
            return ""
        self._active = best
        self.take_overs += 1
        return self._lines[best].link.name

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
        now = self._clock.monotonic_ns() / _NS
        for packet in framer.feed(data, wall):
            if packet.system == self._system and packet.component == 1:
                line.peer = peer
                line.heard = now
            if len(self._lines) > 1 and self._is_twin(packet.raw, now):
                self.causes["twin"] += 1
                continue
            if self._record is not None:
                self._record(wall, packet.raw)
            if self._hear is not None:
                self._hear(packet, now)

    def _is_twin(self, raw: bytes, now: float) -> bool:
        last = self._twins.get(raw)
        self._twins[raw] = now
        self._twins.move_to_end(raw)
        if len(self._twins) > TWINS_MAX:
            self._twins.popitem(last=False)
        return last is not None and now - last < TWIN_S
