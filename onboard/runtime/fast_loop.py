"""The event loop of a program in real time: uvloop's where it is installed, asyncio's own elsewhere.

uvloop comes with the extra `fast`: wheels for x86-64 and aarch64. A datagram then costs about half as much.
Its timers count whole milliseconds and may fire up to one and a half early: `grain_s`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from importlib import import_module
from typing import Any

UVLOOP = "uvloop"
_GRAIN_S = 1.5e-3  # of libuv's timers: its clock counts whole milliseconds, and the wait is rounded to one


def loop_factory() -> Callable[[], asyncio.AbstractEventLoop] | None:
    """For `asyncio.Runner`; None: asyncio's own loop."""
    try:
        uvloop: Any = import_module(UVLOOP)
    except ImportError:
        return None
    made: Callable[[], asyncio.AbstractEventLoop] = uvloop.new_event_loop
    return made


def loop_name(loop: asyncio.AbstractEventLoop) -> str:
    """The distribution that a loop comes from: `uvloop` or `asyncio`."""
    return UVLOOP if type(loop).__module__.partition(".")[0] == UVLOOP else "asyncio"


def grain_s(loop: asyncio.AbstractEventLoop) -> float:
    """By how much a loop's timers may fire before their time [s]."""
    return _GRAIN_S if loop_name(loop) == UVLOOP else 0.0
