"""A file that is complete after every write: its end is rewritten in place, so a kill leaves it whole.

An MCAP file ends in a footer and a magic number; without them most readers refuse it. Each write here
appends data and, in the same call, the end of an unindexed file; the next write overwrites that end. A
write that the disk refuses is undone to the last whole state, kept, and tried again. A thread may do it.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from struct import Struct, pack
from typing import Protocol

from mcap._chunk_builder import ChunkBuilder
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Channel, DataEnd, Footer, MessageIndex, Schema, Statistics
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

MAGIC: bytes = MCAP0_MAGIC
CHUNK, COUNTS = "_Writer__chunk_builder", "_Writer__statistics"  # the library's, of a chunk and of a file


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


Run = Callable[[Callable[[], None]], bool]  # has a job done, at once or by a thread; False: it will not be
SILENT = "the disk does not answer"
SILENT_CALLS = 4  # of `settle` while one piece is on its way


def at_once(job: Callable[[], None]) -> bool:
    """Do a job here and now."""
    job()
    return True


class _Attempt:
    """One piece on its way to the disk. The thread that does it sets `trouble` and, last, `done`."""

    def __init__(self, size: int) -> None:
        self.size = size  # [bytes] of the piece
        self.trouble = ""
        self.done = False
        self.looks = 0  # calls of `settle` that found it under way


class WholeFile:
    """The stream that an MCAP writer writes into: buffers, and has whole pieces put on the disk by `run`.

    `write`, `tell` and `flush` are the writer's; `settle` has the buffered bytes put on the disk. With a
    `run` that hands jobs to a thread nothing here waits for the disk.
    """

    def __init__(self, disk: Disk, run: Run = at_once) -> None:
        self._disk = disk
        self._run = run
        self._size = 0  # bytes on the disk, without the end
        self._waiting: list[bytes] = []
        self._attempt: _Attempt | None = None  # the first of what waits is on its way
        self.waiting_bytes = 0
        self.trouble = ""  # why the last attempt failed, "" = all is on the disk

    @property
    def size(self) -> int:
        """Bytes on the disk, without the file's end."""
        return self._size

    @property
    def busy(self) -> bool:
        """Whether a piece is on its way to the disk."""
        self._reap()
        return self._attempt is not None

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

    def settle(self, *, final: bool = False) -> None:
        """Have everything buffered put on the disk; with `final` the data brings the file's end itself.

        `trouble` says why where the disk refused or does not answer: the file is then as it was before, and
        the bytes wait for the next call.
        """
        self._reap()
        if self._attempt is not None:
            self._attempt.looks += 1
            if self._attempt.looks >= SILENT_CALLS:
                self.trouble = SILENT
            return
        if not self._waiting:
            return
        data = b"".join(self._waiting)
        self._waiting = [data]
        attempt = self._attempt = _Attempt(len(data))
        if not self._run(partial(self._put, attempt, data, self._size, final)):
            attempt.trouble, attempt.done = SILENT, True
        self._reap()

    def close(self) -> None:
        """Release the file, once what is on its way is there."""
        self._run(self._close)

    def _reap(self) -> None:
        """Take in how an attempt went."""
        attempt = self._attempt
        if attempt is None or not attempt.done:
            return
        self._attempt = None
        self.trouble = attempt.trouble
        if not attempt.trouble:
            self._size += attempt.size
            self.waiting_bytes -= attempt.size
            del self._waiting[0]

    # ------------------------------------------------------------------ at the disk

    def _put(self, attempt: _Attempt, data: bytes, size: int, final: bool) -> None:
        try:
            self._all(data if final else data + END, size)
            if final:
                self._disk.truncate(size + len(data))
        except OSError as error:
            attempt.trouble = (error.strerror or str(error)).lower() or "the disk refused"
            self._restore(size)
        finally:
            attempt.done = True

    def _close(self) -> None:
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

    def _restore(self, size: int) -> None:
        """Back to the last whole state: its blocks exist already, so this needs no space."""
        with suppress(OSError):
            if size:
                self._all(END, size)
                self._disk.truncate(size + len(END))
            else:
                self._disk.truncate(0)


_MESSAGE = Struct("<BQHIQQ")  # opcode, length, channel, sequence, log time, publish time
_HEAD = _MESSAGE.size - 9  # [bytes] of a message before its payload
_INDEX = Struct("<BQHI")  # opcode, length, channel, size of the pairs
_OPCODE = int(Opcode.MESSAGE)


class _Index(MessageIndex):
    """Where a chunk's messages of one channel lie, written at once; `records` holds the pairs end to end."""

    def write(self, stream: RecordBuilder) -> None:
        places: list[int] = self.records  # type: ignore[assignment]
        size = 8 * len(places)
        head = _INDEX.pack(Opcode.MESSAGE_INDEX, _INDEX.size - 9 + size, self.channel_id, size)
        stream.write(head + pack(f"<{len(places)}Q", *places))


class _Chunk(ChunkBuilder):
    """A chunk in progress to which a message is added in one write: the library's own way takes nine.

    What the library counts of each message is counted when the chunk is complete.
    """

    def __init__(self, counts: Statistics) -> None:
        super().__init__()
        self._counts = counts
        self._places: dict[int, list[int]] = {}  # by channel: stamp and place of each message, in turn
        self._pieces: list[bytes] = []  # of messages, not in the library's buffer yet
        self.size = 0  # [bytes] of the records so far

    @property
    def count(self) -> int:
        return self.size

    def put(self, channel: int, stamp_ns: int, payload: bytes, sequence: int) -> None:
        """Add a message."""
        if not self.num_messages or stamp_ns < self.message_start_time:
            self.message_start_time = stamp_ns
        if stamp_ns > self.message_end_time:
            self.message_end_time = stamp_ns
        places: list[int] | None = self._places.get(channel)
        if places is None:
            places = self._places[channel] = []
            self.message_indices[channel] = _Index(channel_id=channel, records=places)  # type: ignore[arg-type]
        places += (stamp_ns, self.size)
        self.num_messages += 1
        size = _HEAD + len(payload)
        self.size += 9 + size
        self._pieces.append(_MESSAGE.pack(_OPCODE, size, channel, sequence, stamp_ns, stamp_ns))
        self._pieces.append(payload)

    def add_channel(self, channel: Channel) -> None:
        self._join()
        super().add_channel(channel)
        self.size = self.record_writer.count

    def add_schema(self, schema: Schema) -> None:
        self._join()
        super().add_schema(schema)
        self.size = self.record_writer.count

    def end(self) -> bytes:
        self._join()
        self.size = 0
        return bytes(super().end())  # type: ignore[no-untyped-call]

    def _join(self) -> None:
        """Put what was collected in the library's buffer."""
        self.record_writer.write(b"".join(self._pieces))
        self._pieces.clear()

    def reset(self) -> None:
        """Count the complete chunk, and begin another."""
        counts = self._counts
        if self.num_messages:
            first = counts.message_count == 0
            begun = self.message_start_time
            counts.message_start_time = begun if first else min(counts.message_start_time, begun)
            counts.message_end_time = max(counts.message_end_time, self.message_end_time)
            counts.message_count += self.num_messages
            for channel, index in self.message_indices.items():
                counts.channel_message_counts[channel] += len(index.records) // 2
        self._places.clear()
        self._pieces.clear()
        self.size = 0
        super().reset()  # type: ignore[no-untyped-call]


class McapWriter:
    """The mcap library's writer on a `WholeFile`, typed."""

    def __init__(self, file: WholeFile, library: str, chunk_bytes: int) -> None:
        self._writer = Writer(file, chunk_size=chunk_bytes, compression=CompressionType.ZSTD)  # type: ignore[arg-type]
        assert hasattr(self._writer, CHUNK), "the mcap library has changed: see _Chunk"
        self._chunk, self._chunk_bytes = _Chunk(getattr(self._writer, COUNTS)), chunk_bytes
        setattr(self._writer, CHUNK, self._chunk)
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
        self._chunk.put(channel, stamp_ns, payload, sequence)
        if self._chunk.size > self._chunk_bytes:
            self.flush()

    def flush(self) -> None:
        """End the chunk in progress."""
        self._writer.flush()  # type: ignore[no-untyped-call]

    def finish(self) -> None:
        """Write the index and the file's end."""
        self._writer.finish()  # type: ignore[no-untyped-call]
