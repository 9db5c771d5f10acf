"""The adapter's child process (MAVSDK's): started off the loop, written to and read without waiting."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Callable
from functools import partial

from onboard.agent.core.events import ChildExited, ChildSaid
from onboard.autopilot.mavsdk import Child
from onboard.runtime.off_loop import off_loop


class AdapterChild:
    """At most one child at a time; what it writes, and its end, go to `feed`. For the loop's thread alone."""

    def __init__(self, feed: Callable[[ChildSaid | ChildExited], None]) -> None:
        self._feed = feed
        self._child: Child | None = None
        self._rest = b""
        self._starting: asyncio.Task[None] | None = None

    def start(self, *arguments: str) -> None:
        """Start a child, in place of one that there is: a disk that hangs may hold up its start."""
        self.close()
        self._starting = asyncio.create_task(self._start(arguments), name="adapter's child")

    def write(self, data: bytes) -> None:
        """Write to the child, if it is there: orders and setpoints are repeated."""
        if self._child is not None:
            self._child.send(data)

    def close(self) -> None:
        """Close the child's input: it then ends by itself. Idempotent."""
        if self._starting is not None:
            self._starting.cancel()
            self._starting = None
        child, self._child = self._child, None
        if child is not None:
            with contextlib.suppress(ValueError, OSError):
                asyncio.get_running_loop().remove_reader(child.output)
            child.close()

    async def _start(self, arguments: tuple[str, ...]) -> None:
        try:
            child = await off_loop(partial(Child, *arguments), abandoned=Child.close)
        except OSError:
            self._starting = None
            self._feed(ChildExited())
            return
        self._starting, self._child, self._rest = None, child, b""
        asyncio.get_running_loop().add_reader(child.output, self._speaks)

    def _speaks(self) -> None:
        child = self._child
        if child is None:
            return
        try:
            data = os.read(child.output, 65536)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            self._feed(ChildSaid(line))
        if not data and self._child is child:
            self.close()
            self._feed(ChildExited())
