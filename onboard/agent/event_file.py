"""A flight in a file: an agent's configuration, and every event with its effects.

The file is a sequence of records, each MessagePack behind its length (four bytes, little-endian). It is
bounded: where it would grow longer it ends with the record `Full`. `gcs replay --decide` feeds it to the same
machine again. What a strategy was shown and what goes to the telemetry log are not recorded: the machine
makes both again of the same events.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from io import FileIO
from pathlib import Path
from struct import Struct
from typing import NamedTuple, Protocol

import msgspec

from onboard.agent.config import AgentConfig
from onboard.agent.core.events import (
    Announce,
    AnyEffect,
    AnyEvent,
    Beat,
    ChildEnd,
    ChildLine,
    ChildStart,
    Count,
    Effect,
    End,
    Instant,
    Keep,
    Load,
    Note,
    Publish,
    Reply,
    Send,
    Serve,
    Subscribe,
    Think,
    Unsubscribe,
)
from onboard.agent.core.machine import Facts
from onboard.config.strict import ConfigError
from onboard.config.undecodable import UNDECODABLE
from onboard.pilot.setup import Side
from onboard.runtime.file_writer import FileWriter

SCHEMA = 1
SUFFIX = ".events"
CHUNK = 64 * 1024  # bytes collected before they are handed to the disk
FLUSH_S = 1.0  # and for how long at most
TOGETHER = 64  # records that are encoded in one go
_LENGTH = Struct("<I")
RECORD_MAX = 16 * 1024 * 1024


class Asked(Effect, frozen=True, tag=2):
    """A `Think` as it is recorded: without what the strategy was shown."""

    number: int
    side: Side
    strategy: str


AnyRecorded = (
    Send | Asked | Load | Count | Publish | Reply | Subscribe | Unsubscribe | Serve | Announce | ChildStart
    | ChildLine | ChildEnd | Beat | Note | End
)  # fmt: skip


class Record(msgspec.Struct, frozen=True, array_like=True):
    """Base of all records."""


class Head(Record, frozen=True, tag=1):
    """The first record: what the machine was made of."""

    schema: int
    config: AgentConfig
    facts: Facts


class Happened(Record, frozen=True, tag=2):
    """One event, and what the machine wanted done."""

    now: Instant
    event: AnyEvent
    effects: tuple[AnyRecorded, ...]


class Full(Record, frozen=True, tag=3):
    """The file has reached its bound: the flight went on unrecorded."""

    limit: int  # [bytes]


class Lost(Record, frozen=True, tag=4):
    """The disk was too slow: records are missing here, and what follows cannot be fed again exactly."""

    chunks: int


def recorded(effects: Sequence[AnyEffect]) -> tuple[AnyRecorded, ...]:
    """The effects as they are recorded."""
    kept: list[AnyRecorded] = []  # in a loop: most events have one effect, or none
    for effect in effects:
        kind = type(effect)
        if kind is Think:
            kept.append(Asked(effect.number, effect.side, effect.strategy))  # type: ignore[union-attr]
        elif kind is not Keep:
            kept.append(effect)  # type: ignore[arg-type]
    return tuple(kept)


# ---------------------------------------------------------------------- writing


class Sink(Protocol):
    """Where chunks of the file go."""

    def put(self, chunk: bytes) -> bool:
        """Take a chunk without waiting; False where it cannot be taken."""
        ...

    def close(self) -> None:
        """Write what is left and close."""
        ...


def unused(path: Path) -> Path:
    """The path, or with a number where it exists: an agent that starts again spoils no record."""
    number, free = 2, path
    while free.exists():
        free = path.with_name(f"{path.stem}.{number}{path.suffix}")
        number += 1
    return free


def _opened(path: Path) -> FileIO:
    try:
        return path.open("wb", buffering=0)
    except OSError as error:
        raise ConfigError(f"events: {path}: {(error.strerror or str(error)).lower()}") from None


class FileSink:
    """Writes at once: for virtual time, where nothing may depend on a thread. Raises ConfigError."""

    def __init__(self, path: Path) -> None:
        self._file = _opened(path)

    def put(self, chunk: bytes) -> bool:
        """Write a chunk; False where the disk is full."""
        try:
            self._file.write(chunk)
        except OSError:
            return False
        return True

    def close(self) -> None:
        """Close the file."""
        with contextlib.suppress(OSError):
            self._file.close()


class WriterSink:
    """Writes by a `FileWriter`'s thread: a slow disk never holds a flight up. Raises ConfigError."""

    def __init__(self, path: Path, writer: FileWriter) -> None:
        self._file = writer.open(path, sink=_opened(path))

    def put(self, chunk: bytes) -> bool:
        """Queue a chunk; False where the disk is too slow."""
        return self._file.write(chunk)

    def close(self) -> None:
        """Close the file once what is queued is written; whoever closes the writer waits for that."""
        self._file.close()


class EventFile:
    """Records one agent's flight, up to `limit` bytes."""

    def __init__(self, sink: Sink, limit: int) -> None:
        self.lost = 0  # chunks that the disk did not take
        self.full = False
        self._sink = sink
        self._limit = limit
        self._size = 0
        self._records: list[Record] = []  # not encoded yet
        self._pieces: list[bytes] = []  # of encoded ones, not handed to the disk yet
        self._waiting = 0  # bytes of them
        self._flushed = 0.0
        self._encoder = msgspec.msgpack.Encoder()
        self._missing = 0  # chunks lost since the last one that was taken

    def begin(self, config: AgentConfig, facts: Facts) -> None:
        """Write the head."""
        self._records.append(Head(SCHEMA, config, facts))

    def add(self, now: Instant, event: AnyEvent, effects: Sequence[AnyEffect]) -> None:
        """Record an event and its effects."""
        if self.full:
            return
        records = self._records
        records.append(Happened(now, event, recorded(effects) if effects else ()))
        if len(records) < TOGETHER and now.s - self._flushed < FLUSH_S:
            return
        self._encode()
        if self.full or self._waiting >= CHUNK or now.s - self._flushed >= FLUSH_S:
            self._flushed = now.s
            self._flush()

    def close(self) -> None:
        """Write what is left and close."""
        self._encode()
        self._flush()
        self._sink.close()

    def counters(self) -> dict[str, int]:
        """For a health report."""
        return {"events_unrecorded": self.lost, "events_file_full": int(self.full)}

    def _encode(self) -> None:
        """Encode what happened since the last time; beyond the limit nothing but that it is reached."""
        encode, pieces = self._encoder.encode, self._pieces
        records, self._records = self._records, []
        for record in records:
            data = encode(record)
            size = _LENGTH.size + len(data)
            if self._size + size > self._limit:
                self.full = True
                data = encode(Full(self._limit))
                size = _LENGTH.size + len(data)
            self._size += size
            self._waiting += size
            pieces.append(_LENGTH.pack(size - _LENGTH.size))
            pieces.append(data)
            if self.full:
                break

    def _flush(self) -> None:
        if not self._pieces:
            return
        chunk = b"".join(self._pieces)
        self._pieces.clear()
        self._waiting = 0
        if self._missing:
            mark = self._encoder.encode(Lost(self._missing))
            chunk = _LENGTH.pack(len(mark)) + mark + chunk
        if self._sink.put(chunk):
            self._missing = 0
        else:
            self._missing += 1
            self.lost += 1


# ---------------------------------------------------------------------- reading


class Story(NamedTuple):
    """A recorded flight."""

    head: Head
    records: Iterator[tuple[float, Happened | Full | Lost]]  # in order, each with the share of the file read


def read(path: Path) -> Story:
    """Read a file. Raises ConfigError where it is none, damaged, or of another version."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    pieces = _pieces(data)
    first = next(pieces, b"")
    try:
        _tag, schema = msgspec.msgpack.decode(first, type=tuple[int, int, msgspec.Raw, msgspec.Raw])[:2]
    except UNDECODABLE:
        raise ConfigError(f"{path}: found no recorded flight, expected what an agent wrote") from None
    if schema != SCHEMA:
        raise ConfigError(f"{path}: found version {schema}, expected {SCHEMA}: recorded by another release")
    try:
        head = msgspec.msgpack.decode(first, type=Head)
    except UNDECODABLE as error:
        raise ConfigError(f"{path}: the configuration does not fit this release: {error}") from None
    return Story(head, _records(path, pieces, len(data)))


def _pieces(data: bytes) -> Iterator[bytes]:
    """The records' bytes; a torn end is left out."""
    at = 0
    while at + 4 <= len(data):
        size = int.from_bytes(data[at : at + 4], "little")
        if size > RECORD_MAX or at + 4 + size > len(data):
            return
        yield data[at + 4 : at + 4 + size]
        at += 4 + size


def _records(
    path: Path, pieces: Iterator[bytes], size: int
) -> Iterator[tuple[float, Happened | Full | Lost]]:
    decoder = msgspec.msgpack.Decoder(Happened | Full | Lost)
    done = 0
    for number, piece in enumerate(pieces, 2):
        done += len(piece) + 4
        try:
            yield done / size, decoder.decode(piece)
        except UNDECODABLE as error:
            raise ConfigError(f"{path}: record {number} is damaged: {error}") from None
