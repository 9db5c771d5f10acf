"""What all links share: a name, counters, one receiver and the peer last heard."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable

from onboard.runtime.protocols import Receiver


class Receiving:
    """The receiving half of a link."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._counts: Counter[str] = Counter()
        self._receiver: Receiver | None = None
        self._last: Hashable | None = None
        self._closed = False

    @property
    def name(self) -> str:
        """For people: the URL."""
        return self._name

    def receive(self, receiver: Receiver) -> None:
        """Set the one callback (data, peer)."""
        self._receiver = receiver

    def counters(self) -> dict[str, int]:
        """sent, received, and what was lost by cause."""
        return dict(self._counts)

    def _arrived(self, data: bytes, peer: Hashable) -> None:
        if self._closed:
            return
        self._counts["received"] += 1
        self._last = peer
        if self._receiver is None:
            self._counts["unheard"] += 1
        else:
            self._receiver(data, peer)
