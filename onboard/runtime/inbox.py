"""What foreign threads leave for the event loop."""

from __future__ import annotations

import asyncio
import threading
from collections import Counter, deque
from collections.abc import Callable

TOGETHER_S = 0.005  # messages of a stream wait so long at most for those that follow
STREAM_S = 2.0 * TOGETHER_S  # what comes closer to the last is a stream
LATER_S = 0.05  # what comes faster than it may is drained at this pace
QUEUE_MAX = 8192  # calls that wait for the event loop before the oldest is dropped


class Inbox:
    """Calls from any thread to the loop: bounded, and where a slot is given the latest wins.

    To wake a loop that sleeps costs more than most messages. A call that comes after a silence, and each one
    that is `soon`, wakes it at once; in a stream the loop looks by itself every `TOGETHER_S` seconds, until
    there is nothing more, and takes all that has come meanwhile. Whatever it is woken for, it takes all.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.counts: Counter[str] = Counter()
        self.wakes = 0  # how often a thread woke the loop
        self._loop = loop
        self._lock = threading.Lock()
        self._latest: dict[tuple[int, str], Callable[[], None]] = {}
        self._queue: deque[Callable[[], None]] = deque()
        self._woken = False  # the loop is on its way
        self._looking = False  # it will look by itself within `TOGETHER_S`
        self._deferred = False  # within `LATER_S`
        self._taken = float("-inf")  # when it took something last [s; the loop's time]

    @property
    def looking(self) -> bool:
        """Whether the loop looks by itself: a stream is under way, or has just ended."""
        return self._looking

    def latest(self, slot: tuple[int, str], call: Callable[[], None]) -> None:
        """Any thread: leave a call, in place of an older one of the same slot."""
        with self._lock:
            if slot in self._latest:
                self.counts["overwritten"] += 1
            self._latest[slot] = call
            wake = not (self._woken or self._looking)
            self._woken = self._woken or wake
        if wake:
            self._wake(self._drain)

    def latest_later(self, slot: tuple[int, str], call: Callable[[], None]) -> None:
        """Any thread: as `latest`, but the loop takes it within `LATER_S`, with whatever else has come."""
        with self._lock:
            if slot in self._latest:
                self.counts["overwritten"] += 1
            self._latest[slot] = call
            defer = not (self._woken or self._looking or self._deferred)
            self._deferred = self._deferred or defer
        if defer:
            self._wake(self._defer)

    def queue(self, call: Callable[[], None], *, soon: bool = True) -> None:
        """Any thread: leave a call behind all others; `soon`: the loop takes it at once, stream or not."""
        with self._lock:
            if len(self._queue) >= QUEUE_MAX:
                self._queue.popleft()
                self.counts["overflow"] += 1
            self._queue.append(call)
            wake = not (self._woken or (self._looking and not soon))
            self._woken = self._woken or wake
        if wake:
            self._wake(self._drain)

    def _wake(self, then: Callable[[], object]) -> None:
        try:
            self._loop.call_soon_threadsafe(then)
            self.wakes += 1
        except RuntimeError:  # the loop is closed: nobody is left to hear
            self.counts["late"] += 1

    def _defer(self) -> None:
        self._loop.call_later(LATER_S, self._drain)

    def _look(self) -> None:
        self._looking = False
        if self._queue or self._latest:
            self._drain()

    def _drain(self) -> None:
        now = self._loop.time()
        with self._lock:
            self._deferred = False
            calls = (*self._queue, *self._latest.values())
            self._queue.clear()
            self._latest.clear()
            self._woken = False
            look = not self._looking and now - self._taken < STREAM_S
            self._looking = self._looking or look
        self._taken = now
        if look:
            self._loop.call_later(TOGETHER_S, self._look)
        for call in calls:
            try:
                call()
            except Exception as error:
                self._loop.call_exception_handler({"message": "a receiver failed", "exception": error})
