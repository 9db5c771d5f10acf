"""Files written by one background thread behind a bounded queue: who writes a record never waits for a disk.

A disk that stalls fills the queue; then records are lost, counted, and what was taken stays in order.
"""

from __future__ import annotations

import contextlib
import threading
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

QUEUE_BYTES = 8 << 20  # records that wait, of all files together
BATCH_BYTES = 64 << 10  # about what one write takes to the disk


class Sink(Protocol):
    """A file opened for writing, without a buffer of its own."""

    def write(self, data: bytes, /) -> int | None:
        """Write from the front of `data`; gives how many bytes it took. Raises OSError."""
        ...

    def close(self) -> None:
        """Release it. Raises OSError."""
        ...


class _Item(NamedTuple):
    file: WrittenFile | None  # None: a job
    data: bytes
    last: bool  # the file is closed after it
    job: Callable[[], None] | None = None


class WrittenFile:
    """One file of a `FileWriter`. For the thread that owns it; only the writer's thread touches the disk."""

    def __init__(self, writer: FileWriter, path: Path, size_max: int | None, full_mark: bytes) -> None:
        self.path = path
        self.written = 0  # records on the disk, the mark included
        self.beyond = 0  # records left out because the file had reached `size_max`
        self.fault = ""  # why the disk refused, in words; "" = it did not
        self.fault_number = 0  # the same as an `errno`
        self._writer = writer
        self._room = None if size_max is None else size_max - len(full_mark)
        self._full_mark = full_mark
        self._closed = False
        self._refused = 0  # records that were not taken; counted by the caller's thread
        self._failed = 0  # records that the disk refused; counted by the writer's thread

    def refused_by(self, error: OSError) -> None:
        """Keep why nothing more is written. For the writer's thread."""
        self.fault_number = error.errno or 0  # before the words: they are what others look at
        self.fault = (error.strerror or str(error)).lower()

    @property
    def lost(self) -> int:
        """Records that the queue had no room for, or that the disk refused."""
        return self._refused + self._failed

    @property
    def full(self) -> bool:
        """Whether the file has reached its greatest size: its mark is the last thing in it."""
        return self.beyond > 0

    def write(self, record: bytes) -> bool:
        """Append a record: returns at once, and False where the record is left out and counted."""
        if self._closed or self.fault:
            self._refused += 1
            return False
        if self.full or (self._room is not None and len(record) > self._room):
            if not self.full:
                self._writer._put(_Item(self, self._full_mark, False), must=True)
            self.beyond += 1
            return False
        if not self._writer._put(_Item(self, record, False), must=False):
            self._refused += 1
            return False
        if self._room is not None:
            self._room -= len(record)
        return True

    def close(self) -> None:
        """Close the file once everything taken is written: returns at once; idempotent."""
        if not self._closed:
            self._closed = True
            self._writer._put(_Item(self, b"", True), must=True)

    def counters(self) -> dict[str, int]:
        """For a report: written, lost, beyond (the greatest size)."""
        return {"written": self.written, "lost": self.lost, "beyond": self.beyond}


class FileWriter:
    """The one background thread of a process that writes files."""

    def __init__(
        self, *, queue_bytes: int = QUEUE_BYTES, opener: Callable[[Path], Sink] | None = None
    ) -> None:
        self._queue_bytes = queue_bytes
        self._opener = opener or _open_new
        self._changed = threading.Condition()
        self._queue: deque[_Item] = deque()
        self._waiting = 0  # bytes in the queue and on the way to the disk
        self._busy = False  # the thread is at the disk
        self._stopped = False
        self._sinks: dict[WrittenFile, Sink] = {}  # of the writer's thread
        self._thread = threading.Thread(target=self._run, name="file-writer", daemon=True)
        self._thread.start()

    def open(
        self, path: Path, *, size_max: int | None = None, full_mark: bytes = b"", sink: Sink | None = None
    ) -> WrittenFile:
        """A new file at `path`, whose first record makes it; an older file there is replaced.

        With `sink` the caller has opened it already, and gives it away; `path` is then only its name.
        With `size_max` [bytes] it grows no larger: the first record that does not fit becomes `full_mark`,
        which those who read the file know, and all later ones are left out and counted.
        """
        file = WrittenFile(self, path, size_max, full_mark)
        if sink is not None:
            with self._changed:
                self._sinks[file] = sink
        return file

    def submit(self, job: Callable[[], None]) -> bool:
        """Have the thread do something else with a disk, in its turn; False where the writer is closed.

        The caller bounds how many of its jobs wait. What a job raises is its own to tell: it is dropped here.
        """
        return self._put(_Item(None, b"", False, job), must=True)

    def flush(self, deadline_s: float) -> bool:
        """Wait until everything taken is on its way to the disk, at most `deadline_s`; False: it is not.

        The one call beside `close` that waits: for the end of a program, never on an event loop.
        """
        with self._changed:
            return self._changed.wait_for(lambda: not self._queue and not self._busy, deadline_s)

    def close(self, deadline_s: float) -> bool:
        """Write what was taken, close the files and end the thread; False where that took too long.

        The records that then still wait are counted as lost.
        """
        with self._changed:
            self._stopped = True
            self._changed.notify_all()
        self._thread.join(deadline_s)
        if not self._thread.is_alive():
            return True
        with self._changed:
            for item in self._queue:
                if item.file is not None:
                    item.file._refused += bool(item.data)
            self._queue.clear()
        return False

    def _put(self, item: _Item, *, must: bool) -> bool:
        """Queue an item; `must`: a mark or a close, of which a file has one, goes in beyond the bound."""
        with self._changed:
            full = self._waiting + len(item.data) > self._queue_bytes
            if self._stopped or (full and not must):
                return False
            self._queue.append(item)
            self._waiting += len(item.data)
            self._changed.notify_all()
            return True

    def _run(self) -> None:
        while True:
            with self._changed:
                self._busy = False
                self._changed.notify_all()
                self._changed.wait_for(lambda: self._queue or self._stopped)
                if not self._queue:
                    break
                batch = self._next_batch()
                self._busy = True
            data = b"".join(item.data for item in batch)
            file, job = batch[0].file, batch[0].job
            if file is not None:
                self._append(file, data, sum(1 for item in batch if item.data))
                if batch[-1].last:
                    self._close(file)
            elif job is not None:
                with contextlib.suppress(Exception):
                    job()
            with self._changed:
                self._waiting -= len(data)
        for file in list(self._sinks):
            self._close(file)

    def _next_batch(self) -> list[_Item]:
        """What stands first in the queue, and what follows it for the same file."""
        batch = [self._queue.popleft()]
        size = len(batch[0].data)
        if batch[0].file is None:
            return batch
        while self._queue and self._queue[0].file is batch[0].file and size < BATCH_BYTES:
            batch.append(self._queue.popleft())
            size += len(batch[-1].data)
        return batch

    def _append(self, file: WrittenFile, data: bytes, records: int) -> None:
        if data and not file.fault:
            try:
                sink = self._sinks.get(file)
                if sink is None:
                    sink = self._sinks[file] = self._opener(file.path)
                _write_all(sink, data)
            except OSError as error:
                file.refused_by(error)
            else:
                file.written += records
                return
        file._failed += records

    def _close(self, file: WrittenFile) -> None:
        sink = self._sinks.pop(file, None)
        if sink is not None:
            try:
                sink.close()
            except OSError as error:
                file.refused_by(error)


def _open_new(path: Path) -> Sink:
    return path.open("wb", buffering=0)


def _write_all(sink: Sink, data: bytes) -> None:
    while data:
        taken = sink.write(data)
        data = b"" if taken is None else data[taken:]
