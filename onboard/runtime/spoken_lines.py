"""Lines to standard output or standard error, written by a thread: who reads there slowly holds nobody up."""

from __future__ import annotations

import os
from pathlib import Path

from onboard.config.printable import printable
from onboard.runtime.file_writer import FileWriter, Sink

LINES_BYTES = 256 << 10  # lines that wait for their reader
OUTPUT, ERROR = 1, 2


class StandardStream:
    """Standard output (1) or standard error (2) as a sink; never closed: others write there, too."""

    def __init__(self, number: int) -> None:
        self._number = number

    def write(self, data: bytes, /) -> int:
        """Write from the front of `data`."""
        return os.write(self._number, data)

    def close(self) -> None:
        """Leave it open."""


class SpokenLines:
    """Lines that are made printable here and then wait, at most `LINES_BYTES` of them, for their reader."""

    def __init__(
        self, number: int = OUTPUT, *, writer: FileWriter | None = None, sink: Sink | None = None
    ) -> None:
        self._writer = writer or FileWriter(queue_bytes=LINES_BYTES)
        self._file = self._writer.open(Path(f"stream {number}"), sink=sink or StandardStream(number))

    @property
    def lost(self) -> int:
        """Lines that found no room, or no reader."""
        return self._file.lost

    def say(self, line: str) -> None:
        """Say a line. Raises OSError once none can be written: BrokenPipeError where the reader has left."""
        if self._file.fault:
            raise OSError(self._file.fault_number, self._file.fault)
        self._file.write(printable(line).encode("utf-8", errors="backslashreplace") + b"\n")

    def close(self, seconds: float = 0.5) -> bool:
        """Say what waits, at most for `seconds`; False where the reader did not take it."""
        return self._writer.close(seconds)
