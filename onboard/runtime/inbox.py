"""What foreign threads leave for the event loop."""

from __future__ import annotations

import asyncio
import threading
from collections import Counter, deque
from collections.abc import Callable

QUEUE_MAX = 8192  # calls that wait for the event loop before the oldest is dropped


class Inbox:
    """Calls from any thread to the loop, in their order: bounded, and it is woken at once."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.counts: Counter[str] = Counter()
        self.wakes = 0  # how often a thread woke the loop
        self._loop = loop
        self._lock = threading.Lock()
        self._queue: deque[Callable[[], None]] = deque()
        self._woken = False  # the loop is on its way

    def queue(self, call: Callable[[], None]) -> None:
        """Any thread: leave a call behind all others."""
        with self._lock:
            if len(self._queue) >= QUEUE_MAX:
                self._queue.popleft()
                self.counts["overflow"] += 1
            self._queue.append(call)
            wake, self._woken = not self._woken, True
        if not wake:
            return
        try:
            self._loop.call_soon_threadsafe(self._drain)
            self.wakes += 1
        except RuntimeError:  # the loop is closed: nobody is left to hear
            self.counts["late"] += 1

    def _drain(self) -> None:
        with self._lock:
            calls = tuple(self._queue)
            self._queue.clear()
            self._woken = False
        for call in calls:
            try:
                call()
            except Exception as error:
                self._loop.call_exception_handler({"message": "a receiver failed", "exception": error})
