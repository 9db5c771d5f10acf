"""The adapter's way to its child process, by events and effects."""

from __future__ import annotations

from onboard.agent.core.events import ChildEnd, ChildLine, ChildStart, Outbox
from onboard.autopilot.base import Note

LINES_MAX = 256  # kept of what the child has said


class ChildCourier:
    """See `autopilot.mavsdk.Courier`. The shell starts, feeds and ends the process."""

    def __init__(self, out: Outbox) -> None:
        self._out = out
        self._lines: list[bytes] = []
        self._alive = False

    def launch(self, *arguments: str) -> ChildCourier:
        """Start the child."""
        self._out.put(ChildStart(arguments))
        self._lines.clear()
        self._alive = True
        return self

    def send(self, line: bytes) -> bool:
        """Pass a line on; False where there is no child."""
        if self._alive:
            self._out.put(ChildLine(line))
        return self._alive

    def said(self) -> list[Note]:
        """What the child has said since: lines `severity kind text`."""
        lines, self._lines = self._lines, []
        parts = (line.decode("utf-8", errors="replace").split(" ", 2) for line in lines)
        return [Note(*part) for part in parts if len(part) == 3]

    def alive(self) -> bool:
        """Whether there is a child."""
        return self._alive

    def close(self) -> None:
        """End the child."""
        if self._alive:
            self._alive = False
            self._out.put(ChildEnd())

    def heard(self, line: bytes) -> None:
        """The child wrote a line."""
        if len(self._lines) < LINES_MAX:
            self._lines.append(line)

    def exited(self) -> None:
        """The child has ended."""
        self._alive = False
