"""An asyncio loop in virtual time: when nothing is ready, its clock jumps to the next timer.

Integer nanoseconds, so that 20 Hz for an hour ends on the nanosecond. No threads, no executor and
no sockets: whatever could make two runs differ raises. Timers of one deadline run in the order in
which they were set. `asyncio.sleep`, `asyncio.timeout` and `TaskGroup` obey it as they are.
"""

from __future__ import annotations

import asyncio
import gc
import threading
from asyncio.events import Handle, TimerHandle
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from contextvars import Context
from heapq import heapify, heappop, heappush
from typing import Any, NoReturn, TypeVar

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.clock import VirtualClock

T = TypeVar("T")

EPOCH_NS = 1_767_225_600 * NS_PER_S  # 2026-01-01T00:00:00Z, where virtual time starts unless told otherwise
COLLECT_AFTER = 20_000  # objects made since the last search for garbage in cycles: a game makes hardly any
_PURGE_ABOVE = 256  # cancelled timers kept in the heap before it is swept


class VirtualTimeError(RuntimeError):
    """Something that virtual time cannot have: a thread, a socket, or a wait that nothing can end."""


class _Call(list[Any]):
    """A callback for the next round: [callback, arguments, context], the callback None once cancelled.

    A list is made in a quarter of the time that asyncio's handle takes. Without a context of its own
    (None) a callback runs in the loop's: nothing in virtual time has context variables.
    """

    __slots__ = ()
    __hash__ = object.__hash__  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        return self is other

    def __repr__(self) -> str:
        return f"<call of {self[0]!r}>"

    def cancel(self) -> None:
        """Do not call."""
        self[0] = None

    def cancelled(self) -> bool:
        """Whether it will not be called."""
        return self[0] is None


class _Timer(_Call):
    """A callback for an instant: likewise, then the instant [ns] and the loop whose heap it lies in."""

    __slots__ = ()

    def cancel(self) -> None:
        """Do not call."""
        if self[0] is not None:
            self[0] = None
            self[1] = ()
            if self[4] is not None:
                self[4].forgotten(self)

    def when(self) -> float:
        """The loop's time at which it is due [s]."""
        due: int = self[3]
        return due / NS_PER_S


class VirtualLoop(asyncio.BaseEventLoop):
    """An event loop on a `VirtualClock`. An exception in a callback ends the run: nothing fails unseen."""

    def __init__(self, clock: VirtualClock) -> None:
        super().__init__()
        self.clock = clock
        self._ready: Any  # the base class's deque of handles
        self._stopping: bool
        self._closed: bool
        self._check_closed: Callable[[], None]
        self._thread_id: int | None
        self._owner = threading.get_ident()
        self._heap: list[tuple[int, int, _Timer]] = []  # deadline [ns], order of setting, timer
        self._order = 0
        self._cancelled = 0

    @property
    def timers(self) -> int:
        """Timers kept: those that are due later, and cancelled ones that are not swept yet."""
        return len(self._heap)

    def time(self) -> float:
        """Elapsed virtual time [s]."""
        return self.clock.monotonic_ns() / NS_PER_S

    def call_soon(  # type: ignore[override]
        self, callback: Callable[..., object], *args: Any, context: Context | None = None
    ) -> Handle:
        """Call in the next round."""
        if self._closed:
            self._check_closed()
        call = _Call((callback, args, context))
        self._ready.append(call)
        return call  # type: ignore[return-value]

    def call_later(  # type: ignore[override]
        self, delay: float, callback: Callable[..., object], *args: Any, context: Context | None = None
    ) -> TimerHandle:
        """Call `delay` seconds from now, exact to the nanosecond."""
        return self._set(self.clock.monotonic_ns() + round(delay * NS_PER_S), callback, args, context)

    def call_at(  # type: ignore[override]
        self, when: float, callback: Callable[..., object], *args: Any, context: Context | None = None
    ) -> TimerHandle:
        """Call at the loop time `when` [s]."""
        return self._set(round(when * NS_PER_S), callback, args, context)

    def _set(
        self, when_ns: int, callback: Callable[..., object], args: tuple[Any, ...], context: Context | None
    ) -> TimerHandle:
        if self._closed:
            self._check_closed()
        timer = _Timer((callback, args, context, when_ns, self))
        self._order += 1
        heappush(self._heap, (when_ns, self._order, timer))
        return timer  # type: ignore[return-value]

    def forgotten(self, timer: _Timer) -> None:
        """A timer of the heap was cancelled; where most of them are, they are swept."""
        self._cancelled += 1
        if self._cancelled > _PURGE_ABOVE and 2 * self._cancelled > len(self._heap):
            self._heap = [entry for entry in self._heap if entry[2][0] is not None]
            heapify(self._heap)
            self._cancelled = 0

    def _run_once(self) -> None:
        """Rounds until the loop is stopped: jump if nothing is ready, then run what is."""
        ready, clock = self._ready, self.clock
        while not self._stopping or ready:
            if self._heap:
                self._ripen(self._heap, clock)
            elif not ready:
                raise VirtualTimeError(self._deadlock())
            for _ in range(len(ready)):  # what these set for "soon" is for the next round
                call = ready.popleft()
                callback, args, context = call[0], call[1], call[2]
                if callback is None:
                    continue
                try:
                    if context is None:
                        callback(*args)
                    else:
                        context.run(callback, *args)
                except (SystemExit, KeyboardInterrupt):
                    raise
                except BaseException as error:
                    told = {"message": f"Exception in callback {call!r}", "exception": error}
                    self.call_exception_handler(told | {"handle": call})
            if self._stopping:
                break

    def _ripen(self, heap: list[tuple[int, int, _Timer]], clock: VirtualClock) -> None:
        """Make ready what is due; where nothing is ready, time jumps to the next timer first."""
        ready = self._ready
        while heap and heap[0][2][0] is None:
            heappop(heap)
            self._cancelled -= 1
        now = clock.monotonic_ns()
        if not ready and not self._stopping:
            if not heap:
                raise VirtualTimeError(self._deadlock())
            if heap[0][0] > now:
                now = heap[0][0]
                clock.advance_to(now)
        while heap and heap[0][0] <= now:
            timer = heappop(heap)[2]
            timer[4] = None
            if timer[0] is None:
                self._cancelled -= 1
            else:
                ready.append(timer)

    def _deadlock(self) -> str:
        waiting = sorted(f"{task.get_name()} ({task.get_coro()!r})" for task in asyncio.all_tasks(self))
        return (
            f"deadlock at {self.time():.9f} s of virtual time: nothing is ready and no timer is set; "
            f"waiting: {'; '.join(waiting) or 'nobody'}"
        )

    def call_exception_handler(self, context: dict[str, Any]) -> None:
        """Raise what a callback raised; leave the rest (a task never awaited) to the base class."""
        error = context.get("exception")
        if isinstance(error, BaseException) and "handle" in context:
            raise error
        super().call_exception_handler(context)

    def call_soon_threadsafe(  # type: ignore[override]
        self, callback: Callable[..., object], *args: Any, context: Context | None = None
    ) -> Handle:
        """As `call_soon`. Raises VirtualTimeError on any thread but the loop's own."""
        if threading.get_ident() != (self._thread_id or self._owner):
            raise VirtualTimeError("a thread called into virtual time: nothing there may depend on threads")
        return self.call_soon(callback, *args, context=context)

    def run_in_executor(self, executor: Any, func: Any, *args: Any) -> Any:  # type: ignore[override]
        """Raise VirtualTimeError: a thread's time is not virtual."""
        raise VirtualTimeError(f"no executor in virtual time: {func!r} would run on a thread")

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        raise VirtualTimeError("no sockets, pipes or signals in virtual time: use memory links")


for _name in (
    *("create_datagram_endpoint", "create_connection", "create_server", "sock_recv", "sock_sendall"),
    *("sock_connect", "getaddrinfo", "getnameinfo", "connect_read_pipe", "connect_write_pipe"),
    *("subprocess_exec", "subprocess_shell", "add_reader", "add_writer", "add_signal_handler"),
):
    setattr(VirtualLoop, _name, VirtualLoop._refuse)


_FROZEN = gc.get_freeze_count()  # by Python 3.12 itself, which begins with some


@contextmanager
def seldom_collected() -> Iterator[None]:
    """Search seldom for garbage in cycles, and not at all among what was there before; then as it was."""
    before = gc.get_threshold()
    nested = gc.get_freeze_count() > _FROZEN  # what somebody else froze stays frozen
    if not nested:
        gc.freeze()
    gc.set_threshold(COLLECT_AFTER, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)
        if not nested:
            gc.unfreeze()


def run_virtual(main: Coroutine[Any, Any, T], epoch_ns: int = EPOCH_NS) -> T:
    """Run `main` to its end in virtual time that starts at the wall instant `epoch_ns`; give its result.

    Tasks left over are cancelled, as `asyncio.run` does. Raises VirtualTimeError on a deadlock.
    Inside, `virtual_clock()` is the clock.
    """
    runners = asyncio.Runner(loop_factory=lambda: VirtualLoop(VirtualClock(epoch_ns)))
    with seldom_collected(), runners as runner:
        return runner.run(main)


def virtual_clock() -> VirtualClock:
    """The clock of the running virtual loop. Raises VirtualTimeError on any other loop."""
    loop = asyncio.get_running_loop()
    if not isinstance(loop, VirtualLoop):
        raise VirtualTimeError("the running loop is not in virtual time")
    return loop.clock
