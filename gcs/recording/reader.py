"""Reads recordings back: whole ones, and ones that were cut at any byte.

Nothing that is whole is given up: a cut file gives every chunk before the cut, a damaged chunk costs
itself alone, and `Recording.remarks` says in one line each what was found.
"""

from __future__ import annotations

import mmap
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from struct import Struct, error
from typing import NamedTuple

import msgspec
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Header, Metadata
from mcap.stream_reader import get_chunk_data_stream

from gcs.recording.file import MAGIC
from gcs.recording.recorder import CHANNELS, FORMAT, METADATA, OTHER
from onboard.config.strict import ConfigError
from onboard.wire.bus.messages import SCHEMA

RECORD = Struct("<BQ")  # opcode, length
MESSAGE = Struct("<HIQQ")  # channel, sequence, log time, publish time
MARK = b"\x04\x00\x00\x00zstd"  # inside each chunk's header: its compression
MARK_AT = RECORD.size + 28  # after start and end time, size and checksum
DATA_END_LENGTH = 4
IN_DATA = {
    Opcode.HEADER, Opcode.METADATA, Opcode.CHUNK, Opcode.MESSAGE_INDEX,
    Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE, Opcode.ATTACHMENT,
}  # fmt: skip
CHUNK_FIXED = 40  # bytes of a chunk's record beside the name of its compression and its data
UNPACKED_MAX = 1 << 30  # [bytes] of a chunk; what says more is damaged
BROKEN = (McapError, ValueError, error, zstandard.ZstdError, MemoryError)


class Entry(NamedTuple):
    """One recorded message."""

    key: str  # of the bus or the journal; of viewers' channels: their topic
    payload: bytes
    stamp_ns: int  # arrival, station time


class Span(NamedTuple):
    """One chunk of the file."""

    offset: int  # of its content
    length: int
    start_ns: int
    end_ns: int
    messages: int


class Recording:
    """An open recording. `entries` reads it; the file stays on the disk until then.

    Raises ConfigError with one line for a file that is missing, empty, foreign, of another format or
    schema, or without a single message.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.remarks: list[str] = []  # what a person should know, one line each
        self.spans: list[Span] = []
        self.game = ""
        self._channels: dict[int, str] = {}
        self._data = _open(path)
        self._scan()
        if not self.spans:
            raise ConfigError(f"{path}: a recording without a message")

    @property
    def start_ns(self) -> int:
        """Arrival of the first message."""
        return self.spans[0].start_ns

    @property
    def end_ns(self) -> int:
        """Arrival of the last message."""
        return max(span.end_ns for span in self.spans)

    @property
    def messages(self) -> int:
        """How many messages can be read, viewers' included."""
        return sum(span.messages for span in self.spans)

    def entries(self, start_ns: int = 0) -> Iterator[Entry]:
        """The messages of bus and journal that arrived at or after `start_ns`, in order of arrival."""
        for span in self.spans:
            if span.end_ns >= start_ns:
                for entry in self.of(span):
                    if entry.stamp_ns >= start_ns:
                        yield entry

    def of(self, span: Span) -> list[Entry]:
        """The messages of bus and journal in one chunk."""
        return [entry for entry in self._messages(span) if not entry.key.startswith("/")]

    def views(self, topic: str) -> Iterator[Entry]:
        """The messages of one of the viewers' channels, e.g. `/scene`."""
        for span in self.spans:
            yield from (entry for entry in self._messages(span) if entry.key == topic)

    def close(self) -> None:
        """Release the file."""
        self._data.close()

    def _messages(self, span: Span) -> Iterator[Entry]:
        data = _unpacked(self._data[span.offset : span.offset + span.length])
        for opcode, start, length in _records(data):
            if opcode == Opcode.MESSAGE:
                channel, _, stamp_ns, _ = MESSAGE.unpack_from(data, start)
                key = self._channels.get(channel)
                payload = data[start + MESSAGE.size : start + length]
                if key == OTHER:
                    key, payload = msgspec.msgpack.decode(payload, type=tuple[str, bytes])
                if key is not None:
                    yield Entry(key, payload, stamp_ns)

    def _scan(self) -> None:
        """Follow the records; where one makes no sense, look for the next chunk by its mark."""
        data, at, size = self._data, len(MAGIC), len(self._data)
        floor = at  # where to look from: the end of the last chunk whose checksum held
        while True:
            start = at + RECORD.size
            opcode, length = RECORD.unpack_from(data, at) if start <= size else (0, 0)
            if opcode == Opcode.DATA_END and length == DATA_END_LENGTH:
                return
            sound = opcode in IN_DATA and start + length <= size
            if sound and opcode == Opcode.CHUNK:
                sound = self._take(start, length)
                floor = start + length if sound else floor
            elif sound and opcode in (Opcode.HEADER, Opcode.METADATA):
                sound = self._check(opcode, data[start : start + length])
            if sound:
                at = start + length
                continue
            found = self._next_chunk(floor)
            if found < 0:
                whole = "read up to there" if self.spans else "nothing whole before that"
                self.remarks.append(f"{self.path}: cut in the record at byte {at}: {whole}")
                return
            if found > at:
                self.remarks.append(f"{self.path}: damaged at byte {at}: {found - at} bytes left out")
            at, floor = found, found + 1

    def _next_chunk(self, start: int) -> int:
        """Where the first sound chunk at or after `start` begins, -1 = nowhere."""
        mark = self._data.find(MARK, start + MARK_AT)
        while mark >= 0:
            at = mark - MARK_AT
            opcode, length = RECORD.unpack_from(self._data, at)
            end = at + RECORD.size + length
            if opcode == Opcode.CHUNK and end <= len(self._data):
                try:
                    _unpacked(self._data[at + RECORD.size : end])
                    return at
                except BROKEN:
                    pass
            mark = self._data.find(MARK, mark + 1)
        return -1

    def _check(self, opcode: int, content: bytes) -> bool:
        try:
            if opcode == Opcode.HEADER:
                self._check_header(content)
            else:
                self._check_metadata(content)
        except BROKEN:
            return False
        return True

    def _check_header(self, content: bytes) -> None:
        library = Header.read(ReadDataStream(BytesIO(content))).library
        if not library.startswith(METADATA):
            raise ConfigError(f"{self.path}: found MCAP written by {library!r}, expected a recording of gcs")

    def _check_metadata(self, content: bytes) -> None:
        record = Metadata.read(ReadDataStream(BytesIO(content)))
        if record.name == CHANNELS:
            self._channels.update((int(number), key) for number, key in record.metadata.items())
        if record.name != METADATA:
            return
        self.game = record.metadata.get("game", "")
        for key, known in (("format", FORMAT), ("schema", SCHEMA)):
            found = int(record.metadata.get(key, "0"))
            if found != known:
                which = "a newer gcs" if found > known else "the gcs that recorded it"
                raise ConfigError(
                    f"{self.path}: {key}: found version {found}, expected {known}: read it with {which}"
                )

    def _take(self, start: int, length: int) -> bool:
        """Learn what a chunk holds; False where its checksum says that it is damaged."""
        stamps: list[int] = []
        try:
            data = _unpacked(self._data[start : start + length])
            for opcode, at, size in _records(data):
                if opcode == Opcode.MESSAGE:
                    stamps.append(MESSAGE.unpack_from(data, at)[2])
                elif opcode == Opcode.CHANNEL:
                    channel = Channel.read(ReadDataStream(BytesIO(data[at : at + size])))
                    self._channels[channel.id] = channel.topic
        except BROKEN:
            return False
        if stamps:
            self.spans.append(Span(start, length, min(stamps), max(stamps), len(stamps)))
        return True


def _open(path: Path) -> mmap.mmap:
    try:
        with path.open("rb") as file:
            if path.stat().st_size == 0:
                raise ConfigError(f"{path}: empty, expected a recording (MCAP)")
            data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    if data[: len(MAGIC)] != MAGIC[: len(data)]:
        data.close()
        raise ConfigError(f"{path}: not a recording: found no MCAP file")
    return data


def _unpacked(content: bytes) -> bytes:
    """A chunk's records. Raises on damage, which the checksum shows."""
    chunk = Chunk.read(ReadDataStream(BytesIO(content)))
    if CHUNK_FIXED + len(chunk.compression.encode()) + len(chunk.data) != len(content):
        raise ValueError("the chunk's length is not that of its contents")
    if chunk.uncompressed_size > UNPACKED_MAX:
        raise ValueError("the chunk says it unpacks to more than any chunk")
    stream, length = get_chunk_data_stream(chunk, validate_crc=True)
    return stream.read(length)


def _records(data: bytes) -> Iterator[tuple[int, int, int]]:
    """(opcode, start of the content, its length) of each record in a chunk."""
    at, size = 0, len(data)
    while at < size:
        opcode, length = RECORD.unpack_from(data, at)
        yield opcode, at + RECORD.size, length
        at += RECORD.size + length
