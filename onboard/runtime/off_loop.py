"""A call that may block, on a thread that nobody waits for: neither the loop nor the end of the process."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


async def off_loop(
    call: Callable[[], T],
    abandoned: Callable[[T], None] | None = None,
    then: Callable[[T], object] | None = None,
) -> T:
    """The call's result, or what it raises. Who is cancelled leaves the call behind.

    `abandoned` takes a result that comes after that, to release it. `then` is what the thread does with a
    result once it is passed on.
    """
    loop = asyncio.get_running_loop()
    future: asyncio.Future[T] = loop.create_future()

    def settle(result: T | None, error: BaseException | None) -> None:
        if not future.done():
            if error is not None:
                future.set_exception(error)
            else:
                future.set_result(result)  # type: ignore[arg-type]
        elif error is None and abandoned is not None:
            abandoned(result)  # type: ignore[arg-type]

    def run() -> None:
        result: T | None = None
        error: BaseException | None = None
        try:
            result = call()
        except BaseException as trouble:
            error = trouble
        with contextlib.suppress(RuntimeError):  # the loop has ended: nobody asks any more
            loop.call_soon_threadsafe(settle, result, error)
        if error is None and then is not None:
            then(result)  # type: ignore[arg-type]

    threading.Thread(target=run, name="off-loop", daemon=True).start()
    return await future
