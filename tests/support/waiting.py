"""Waiting for what real sockets and processes do in their own time."""

from __future__ import annotations

import asyncio
from collections.abc import Callable


async def until(condition: Callable[[], object], timeout_s: float = 20.0) -> None:
    """Return as soon as `condition()` holds. Raises TimeoutError; in virtual time it costs nothing."""
    async with asyncio.timeout(timeout_s):
        while not condition():  # noqa: ASYNC110 - the condition is anybody's, it sets no event
            await asyncio.sleep(0.005)
