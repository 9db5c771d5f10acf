"""A file that is complete after every write: its end is rewritten in place, so a kill leaves it whole.

An MCAP file ends in a footer and a magic number; without them most readers refuse it. Each write here
appends data and, in the same call, the end of an unindexed file; the next write overwrites that end. A
write that the disk refuses is undone to the last whole state, kept, and tried again.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from mcap.data_stream import RecordBuilder
from mcap.records import DataEnd, Footer
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

MAGIC: bytes = MCAP0_MAGIC


def _end() -> bytes:
    builder = RecordBuilder()
    DataEnd(data_section_crc=0).write(builder)
    Footer(summary_start=0, summary_offset_start=0, summary_crc=0).write(builder)
    return bytes(builder.end()) + MAGIC  # type: ignore[no-untyped-call]


END = _end()


class Disk(Protocol):
    """Writing at a place of a file; each raises OSError."""

    def write_at(self, data: memoryview, offset: int) -> int:
        """Write what fits; how many bytes did."""
        ...

    def truncate(self, size: int) -> None:
        """Cut the file to `size` bytes."""
        ...

    def close(self) -> None:
        """Release it."""
        ...


class OsFile:
    """A new file of the operating system. Raises FileExistsError rather than overwrite a recording."""

    def __init__(self, path: Path) -> None:
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644)

    def write_at(self, data: memoryview, offset: int) -> int:
        """Write what fits; how many bytes did."""
        return os.pwrite(self._descriptor, data, offset)

    def truncate(self, size: int) -> None:
        """Cut the file to `size` bytes."""
        os.ftruncate(self._descriptor, size)

    def close(self) -> None:
        """Release it."""
        os.close(self._descriptor)


OpenDisk = Callable[[Path], Disk]


class WholeFile:
    """The stream that an MCAP writer writes into: buffers, and puts whole pieces on the disk.

    `write`, `tell` and `flush` are the writer's; `settle` puts the buffered bytes on the disk.
    """

    def __init__(self, disk: Disk) -> None:
        self._disk = disk
        self._size = 0  # bytes on the disk, without the end
        self._waiting: list[bytes] = []
        self.waiting_bytes = 0
        self.trouble = ""  # why the last attempt failed, "" = all is on the disk

    @property
    def size(self) -> int:
        """Bytes on the disk, without the file's end."""
        return self._size

    def write(self, data: bytes) -> int:
        """Buffer."""
        self._waiting.append(data)
        self.waiting_bytes += len(data)
        return len(data)

    def tell(self) -> int:
        """Where the next byte will lie."""
        return self._size + self.waiting_bytes

    def flush(self) -> None:
        """Nothing: `settle` says when."""

    def settle(self, *, final: bool = False) -> bool:
        """Put everything buffered on the disk; with `final` the data brings the file's end itself.

        False (and `trouble` says why) where the disk refused: the file is then as it was before,
        and the bytes wait for the next call.
        """
        if not self._waiting:
            return True
        data = b"".join(self._waiting)
        try:
            self._all(data if final else data + END, self._size)
            if final:
                self._disk.truncate(self._size + len(data))
        except OSError as error:
            self.trouble = (error.strerror or str(error)).lower()
            self._waiting = [data]
            self._restore()
            return False
        self._size += len(data)
        self._waiting, self.waiting_bytes, self.trouble = [], 0, ""
        return True

    def close(self) -> None:
        """Release the file."""
        with suppress(OSError):
            self._disk.close()

    def _all(self, data: bytes, offset: int) -> None:
        view = memoryview(data)
        while view:
            written = self._disk.write_at(view, offset)
            if written <= 0:
                raise OSError("nothing was written")
            offset += written
            view = view[written:]

    def _restore(self) -> None:
        """Back to the last whole state: its blocks exist already, so this needs no space."""
        with suppress(OSError):
            if self._size:
                self._all(END, self._size)
                self._disk.truncate(self._size + len(END))
            else:
                self._disk.truncate(0)


class McapWriter:
    """The mcap library's writer on a `WholeFile`, typed."""

    def __init__(self, file: WholeFile, library: str, chunk_bytes: int) -> None:
        self._writer = Writer(file, chunk_size=chunk_bytes, compression=CompressionType.ZSTD)  # type: ignore[arg-type]
        self._writer.start(profile="", library=library)

    def metadata(self, name: str, values: dict[str, str]) -> None:
        """Write a metadata record."""
        self._writer.add_metadata(name, values)

    def schema(self, name: str, text: bytes) -> int:
        """Register a JSON schema; its number."""
        return int(self._writer.register_schema(name, "jsonschema", text))

    def channel(self, topic: str, encoding: str, schema: int) -> int:
        """Register a channel; its number. `schema` 0 = none."""
        return self._writer.register_channel(topic, encoding, schema)

    def message(self, channel: int, stamp_ns: int, payload: bytes, sequence: int = 0) -> None:
        """Add a message to the chunk in progress."""
        self._writer.add_message(channel, stamp_ns, payload, stamp_ns, sequence)

    def flush(self) -> None:
        """End the chunk in progress."""
        self._writer.flush()  # type: ignore[no-untyped-call]

    def finish(self) -> None:
        """Write the index and the file's end."""
        self._writer.finish()  # type: ignore[no-untyped-call]
