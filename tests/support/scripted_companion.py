"""A companion computer of few words: hears one autopilot over a link and sends it what the test says."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable

from onboard.runtime.protocols import Link
from onboard.wire.mavlink.commands import Outgoing, Target
from onboard.wire.mavlink.dialect import MavMessage, dialect_packet
from onboard.wire.mavlink.frames import Framer, Packet, Sender

COMPONENT = 191


class Companion:
    """Beside autopilot `system` on `link`."""

    def __init__(self, link: Link, system: int) -> None:
        self.target = Target(system)
        self.packets: list[Packet] = []
        self.bad: Counter[str] = Counter()
        self._link = link
        self._framer = Framer(causes=self.bad)
        self._sender = Sender(system, COMPONENT)
        link.receive(self._arrived)

    def send(self, message: Outgoing) -> None:
        self._link.send(self._sender.pack(message))

    def heard(self, name: str) -> list[MavMessage]:
        """All messages of a name, the oldest first."""
        return [dialect_packet(p.raw).message for p in self.packets if p.name == name]

    def _arrived(self, data: bytes, peer: Hashable) -> None:
        self.packets += self._framer.feed(data)
