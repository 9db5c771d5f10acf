"""What foreign threads leave for the event loop."""

from __future__ import annotations

import asyncio
import threading
from collections import Counter, deque
from collections.abc import Callable

LATER_S = 0.05  # what comes faster than it may is drained at this pace
QUEUE_MAX = 8192  # calls that wait for the event loop before the oldest is dropped


class Inbox:
    """Calls from any thread to the loop: bounded, and where a slot is given the latest wins."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.counts: Counter[str] = Counter()
        self._loop = loop
        self._lock = threading.Lock()
        self._latest: dict[tuple[int, str], Callable[[], None]] = {}
        self._queue: deque[Callable[[], None]] = deque()
        self._woken = False
        self._deferred = False

    def latest(self, slot: tuple[int, str], call: Callable[[], None]) -> None:
        """Any thread: leave a call, in place of an older one of the same slot."""
        with self._lock:
            if slot in self._latest:
                self.counts["overwritten"] += 1
            self._latest[slot] = call
            wake, self._woken = not self._woken, True
        if wake:
            self._wake()

    def latest_later(self, slot: tuple[int, str], call: Callable[[], None]) -> None:
        """Any thread: as `latest`, but the loop takes it within `LATER_S`, with whatever else has come."""
        with self._lock:
            if slot in self._latest:
                self.counts["overwritten"] += 1
            self._latest[slot] = call
            defer = not self._woken and not self._deferred
            self._deferred = self._deferred or defer
        if defer:
            self._wake(self._defer)

    def queue(self, call: Callable[[], None]) -> None:
        """Any thread: leave a call behind all others."""
        with self._lock:
            if len(self._queue) >= QUEUE_MAX:
                self._queue.popleft()
                self.counts["overflow"] += 1
            self._queue.append(call)
            wake, self._woken = not self._woken, True
        if wake:
            self._wake()

    def _wake(self, then: Callable[[], object] | None = None) -> None:
        try:
            self._loop.call_soon_threadsafe(then or self._drain)
        except RuntimeError:  # the loop is closed: nobody is left to hear
            self.counts["late"] += 1

    def _defer(self) -> None:
        self._loop.call_later(LATER_S, self._drain)

    def _drain(self) -> None:
        with self._lock:
            self._deferred = False
            calls = (*self._queue, *self._latest.values())
            self._queue.clear()
            self._latest.clear()
            self._woken = False
        for call in calls:
            try:
                call()
            except Exception as error:
                self._loop.call_exception_handler({"message": "a receiver failed", "exception": error})
