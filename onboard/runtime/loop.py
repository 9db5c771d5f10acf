"""An asyncio loop in virtual time: when nothing is ready, its clock jumps to the next timer.

Integer nanoseconds, so that 20 Hz for an hour ends on the nanosecond. No threads, no executor and
no sockets: whatever could make two runs differ raises. Timers of one deadline run in the order in
which they were set. `asyncio.sleep`, `asyncio.timeout` and `TaskGroup` obey it as they are.
"""

from __future__ import annotations

import asyncio
import threading
from asyncio.events import Handle, TimerHandle
from collections.abc import Callable, Coroutine
from contextvars import Context, copy_context
from heapq import heapify, heappop, heappush
from typing import Any, NoReturn, TypeVar

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.clock import VirtualClock

T = TypeVar("T")

EPOCH_NS = 1_767_225_600 * NS_PER_S  # 2026-01-01T00:00:00Z, where virtual time starts unless told otherwise
_PURGE_ABOVE = 256  # cancelled timers kept in the heap before it is swept


class VirtualTimeError(RuntimeError):
    """Something that virtual time cannot have: a thread, a socket, or a wait that nothing can end."""


class _Soon(Handle):
    """A callback for the next round: asyncio's handle, made in fewer steps."""

    __slots__ = ()

    def __init__(
        self,
        callback: Callable[..., object],
        args: tuple[Any, ...],
        loop: asyncio.AbstractEventLoop,
        context: Context | None,
    ) -> None:
        self._context = copy_context() if context is None else context
        self._loop = loop
        self._callback = callback
        self._args = args
        self._cancelled = False
        self._repr = None
        self._source_traceback = None


class _Timed(TimerHandle):
    """A callback for an instant, likewise."""

    __slots__ = ()

    def __init__(
        self,
        when: float,
        callback: Callable[..., object],
        args: tuple[Any, ...],
        loop: asyncio.AbstractEventLoop,
        context: Context | None,
    ) -> None:
        self._context = copy_context() if context is None else context
        self._loop = loop
        self._callback = callback
        self._args = args
        self._cancelled = False
        self._repr = None
        self._source_traceback = None
        self._when = when
        self._scheduled = True


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
        self._heap: list[tuple[int, int, TimerHandle]] = []  # deadline [ns], order of setting, handle
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
        handle = _Soon(callback, args, self, context)
        self._ready.append(handle)
        return handle

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
        handle = _Timed(when_ns / NS_PER_S, callback, args, self, context)
        self._order += 1
        heappush(self._heap, (when_ns, self._order, handle))
        return handle

    def _timer_handle_cancelled(self, handle: TimerHandle) -> None:
        if not handle._scheduled:  # type: ignore[attr-defined]
            return
        self._cancelled += 1
        if self._cancelled > _PURGE_ABOVE and 2 * self._cancelled > len(self._heap):
            self._heap = [entry for entry in self._heap if not entry[2]._cancelled and entry[2] is not handle]
            heapify(self._heap)
            handle._scheduled = False  # type: ignore[attr-defined]
            self._cancelled = 0

    def _run_once(self) -> None:
        """One round: jump if nothing is ready, then run what is."""
        heap, ready, clock = self._heap, self._ready, self.clock
        while heap and heap[0][2]._cancelled:
            heappop(heap)
            self._cancelled -= 1
        if not ready and not self._stopping:
            if not heap:
                raise VirtualTimeError(self._deadlock())
            if heap[0][0] > clock.monotonic_ns():
                clock.advance_to(heap[0][0])
        now = clock.monotonic_ns()
        while heap and heap[0][0] <= now:
            handle = heappop(heap)[2]
            handle._scheduled = False  # type: ignore[attr-defined]
            if handle._cancelled:
                self._cancelled -= 1
            else:
                ready.append(handle)
        for _ in range(len(ready)):  # what these set for "soon" is for the next round
            handle = ready.popleft()
            if handle._cancelled:
                continue
            try:  # `handle._run()`, without its frame
                handle._context.run(handle._callback, *handle._args)
            except (SystemExit, KeyboardInterrupt):
                raise
            except BaseException as error:
                context = {"message": f"Exception in callback {handle!r}", "exception": error}
                self.call_exception_handler(context | {"handle": handle})

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


def run_virtual(main: Coroutine[Any, Any, T], epoch_ns: int = EPOCH_NS) -> T:
    """Run `main` to its end in virtual time that starts at the wall instant `epoch_ns`; give its result.

    Tasks left over are cancelled, as `asyncio.run` does. Raises VirtualTimeError on a deadlock.
    Inside, `virtual_clock()` is the clock.
    """
    with asyncio.Runner(loop_factory=lambda: VirtualLoop(VirtualClock(epoch_ns))) as runner:
        return runner.run(main)


def virtual_clock() -> VirtualClock:
    """The clock of the running virtual loop. Raises VirtualTimeError on any other loop."""
    loop = asyncio.get_running_loop()
    if not isinstance(loop, VirtualLoop):
        raise VirtualTimeError("the running loop is not in virtual time")
    return loop.clock
