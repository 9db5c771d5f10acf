"""What a run left, as streams of items that can be compared: telemetry logs, the bus, what viewers see."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from struct import unpack_from
from typing import Any, NamedTuple

import msgspec
from mcap.reader import make_reader
from pymavlink.dialects.v20 import all as dialect

from tests.golden.translations import Translation, translated

MAVLINK_2 = 0xFD
SIGNED = 0x01
SIGNATURE_BYTES = 13


class Item(NamedTuple):
    """One frame or message."""

    kind: str  # of which type, or on which topic
    at_ns: int  # wall time, virtual
    data: bytes  # what is compared: a frame's bytes, or a message as canonical JSON
    decode: Callable[[bytes], Any]  # `data` for people: what JSON can hold


Streams = dict[str, list[Item]]


def canonical(value: object) -> bytes:
    """A decoded message as JSON with sorted keys: equal bytes for equal values, and for no others.

    Floats are written exactly; 1 and 1.0 differ, and so do 0.0 and -0.0. Bytes are written in hexadecimal."""
    text = json.dumps(value, sort_keys=True, ensure_ascii=False, separators=(",", ":"), default=_bytes)
    return text.encode()


def _bytes(value: object) -> str:
    if isinstance(value, bytes):
        return value.hex()
    raise TypeError(f"found {type(value).__name__}, expected what MessagePack can hold")


# ---------------------------------------------------------------------- telemetry logs


def frames(log: bytes) -> Iterator[tuple[int, bytes]]:
    """The frames of a .tlog with their stamps [ns]. Raises ValueError where the bytes are no whole frame."""
    at = 0
    while at < len(log):
        (stamp_us,) = unpack_from(">Q", log, at)
        at += 8
        size = frame_size(log, at)
        if size == 0 or at + size > len(log):
            raise ValueError(f"byte {at}: found no whole MAVLink frame, expected one after each stamp")
        yield stamp_us * 1000, log[at : at + size]
        at += size


def frame_size(data: bytes, at: int) -> int:
    """Bytes of the frame that begins at `at`; 0 where none does."""
    if len(data) < at + 3:
        return 0
    if data[at] == MAVLINK_2:
        return 12 + data[at + 1] + (SIGNATURE_BYTES if data[at + 2] & SIGNED else 0)
    return 8 + data[at + 1] if data[at] == 0xFE else 0


def kind_of(frame: bytes) -> str:
    """Message type and sender, as in `ATTITUDE from 1/1`."""
    if frame[0] == MAVLINK_2:
        system, component, number = frame[5], frame[6], int.from_bytes(frame[7:10], "little")
    else:
        system, component, number = frame[3], frame[4], frame[5]
    known = dialect.mavlink_map.get(number)
    return f"{known.msgname if known else number} from {system}/{component}"


def decode_frame(frame: bytes) -> Any:
    """A frame's fields and its sequence number; its bytes in hexadecimal where it is unsound."""
    try:
        message = dialect.MAVLink(None).decode(bytearray(frame))
    except dialect.MAVError as error:
        return {"frame": frame.hex(), "error": str(error)}
    fields: dict[str, Any] = message.to_dict()
    fields.pop("mavpackettype")
    return {"seq": message.get_seq(), **fields}


def framed(parts: Iterator[tuple[int, bytes]]) -> list[Item]:
    """Stamped frames as items."""
    return [Item(kind_of(frame), at_ns, frame, decode_frame) for at_ns, frame in parts]


# ---------------------------------------------------------------------- the bus


def game_streams(run: Path, recording: str, tables: Sequence[Sequence[Translation]]) -> Streams:
    """A run folder's streams: `vehicle-N.tlog`, `bus` (topics without the game's name) and `viewers`.

    Messages are decoded without a type and pass through the `tables` of translations."""
    found: Streams = {}
    for path in sorted(run.glob("*.tlog")):
        found[path.name] = framed(frames(path.read_bytes()))
    if not found:
        raise ValueError(f"{run}: found no .tlog, expected one a vehicle")
    found["bus"], found["viewers"] = [], []
    with (run / recording).open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        for _schema, channel, message in reader.iter_messages(log_time_order=False):
            if channel.message_encoding == "json":
                stream, topic, value = "viewers", channel.topic, json.loads(message.data)
            else:
                stream, topic = "bus", channel.topic.split("/", 2)[-1]
                value = msgspec.msgpack.decode(message.data) if message.data else None
            for table in tables:
                topic, value = translated(topic, value, table)
            found[stream].append(Item(topic, message.log_time, canonical(value), json.loads))
    return found


def kinds(items: list[Item]) -> dict[str, int]:
    """How many items of each kind."""
    return dict(sorted(Counter(item.kind for item in items).items()))
