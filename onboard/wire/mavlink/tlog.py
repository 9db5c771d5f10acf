"""Telemetry logs (`.tlog`): before each MAVLink frame a big-endian 64-bit stamp, µs since the epoch.

The format of MAVProxy, Mission Planner and QGroundControl; pymavlink reads what this writes.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from struct import Struct
from typing import BinaryIO, NamedTuple

from onboard.wire.mavlink.frames import Framer, Packet

STAMP = Struct(">Q")


class TlogWriter:
    """Appends frames to an open binary file; the caller owns (buffers, flushes, closes) the file."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def write(self, wall_ns: int, frame: bytes) -> None:
        """Log one whole frame as it went over the link at `wall_ns` [ns since the epoch]."""
        self._file.write(STAMP.pack(wall_ns // 1000) + frame)


class Entry(NamedTuple):
    """One frame of a log."""

    stamp_ns: int  # wall instant, to the µs
    packet: Packet


def read_tlog(data: bytes, causes: Counter[str] | None = None) -> Iterator[Entry]:
    """Yield all frames of a log's bytes, in order. A cut or damaged stretch is skipped and counted in
    `causes` (the causes of `Framer`), never an error; a log cut anywhere gives all that is whole."""
    counts: Counter[str] = Counter() if causes is None else causes
    framer = Framer(causes=counts)
    at, damage = 0, 0
    while at + 8 < len(data):
        size = framer.size_at(data, at + 8)
        entry = framer.whole(data[at + 8 : at + 8 + size]) if size and at + 8 + size <= len(data) else None
        if entry is None:
            damage += 1
            at += 1
            continue
        stamp_us: int = STAMP.unpack_from(data, at)[0]
        yield Entry(stamp_us * 1000, entry)
        at += 8 + size
    damage += len(data) - at
    if damage:
        counts["garbage_bytes"] += damage
