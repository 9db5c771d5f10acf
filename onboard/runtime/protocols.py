"""The Protocols of the runtime: what real and fake share."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import NamedTuple, Protocol

from onboard.wire.bus.topics import Delivery


class Clock(Protocol):
    """Two readings of time, both integer nanoseconds."""

    def wall_ns(self) -> int:
        """Wall instant, nanoseconds since the epoch: stamps data."""
        ...

    def monotonic_ns(self) -> int:
        """Local monotonic time: every timeout and age."""
        ...


Receiver = Callable[[bytes, Hashable], None]


class Link(Protocol):
    """Datagrams (or chunks of a byte stream) to and from one or several peers."""

    @property
    def name(self) -> str:
        """For people: the URL it was opened with."""
        ...

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """Send to `peer`; None: the one last heard or configured. Never raises: failures count."""
        ...

    def receive(self, receiver: Receiver) -> None:
        """Set the one callback (data, peer); called on the event loop."""
        ...

    def counters(self) -> dict[str, int]:
        """Sent, received, failed … by cause."""
        ...

    def close(self) -> None:
        """Release it; idempotent."""
        ...


class Sample(NamedTuple):
    """One message of the bus, as it arrived on the event loop."""

    key: str
    payload: bytes


class Subscription(Protocol):
    """Anything on the bus that can be undone."""

    def close(self) -> None:
        """Undo it; idempotent."""
        ...


class Bus(Protocol):
    """Publish, subscribe, request: over Zenoh, or in memory."""

    def publish(self, key: str, payload: bytes, delivery: Delivery) -> None:
        """Put a message. Never blocks, never raises: while there is no bus it is counted as dropped,
        but the last value of a CACHED or EVENT key is put again when the bus is back."""
        ...

    def subscribe(
        self, pattern: str, receiver: Callable[[Sample], None], *, every: bool = False
    ) -> Subscription:
        """Call `receiver` on the event loop for each message that matches (`*` one chunk, `**` any).

        Cached values that already exist are delivered first. A loop that is late gets the latest of each
        LATEST key; with `every` it gets all of them, for who records."""
        ...

    def wanted_in(self, wait: float) -> None:
        """What has come by `wait` [s] from now is wanted then, and not before: say so once a control step.

        Without this what comes is taken in time, too."""
        ...

    def serve(self, key: str, handler: Callable[[bytes], bytes]) -> Subscription:
        """Answer requests on `key`."""
        ...

    async def request(self, key: str, payload: bytes, timeout_s: float) -> list[bytes]:
        """All replies that came within `timeout_s` (as soon as the first where only one can come).

        A key with `*` for a chunk asks all who serve one that belongs to it."""
        ...

    def announce(self, key: str) -> Subscription:
        """Declare a liveliness token."""
        ...

    def presence(self, pattern: str, receiver: Callable[[str, bool], None]) -> Subscription:
        """Call `receiver(key, alive)` for tokens, those that already exist first."""
        ...

    def connected(self) -> bool:
        """Whether there is somebody to talk to, as far as the bus knows."""
        ...

    def counters(self) -> dict[str, int]:
        """Published, received, dropped … by cause."""
        ...

    async def close(self) -> None:
        """Release it; idempotent."""
        ...
