"""pymavlink's dialect and what handles its objects: for this folder and the simulated autopilots alone.

The rest of the program reads typed values (`frames.Packet`) and sends typed values (`commands.Outgoing`).
The dialect module is imported, never mavutil, which blocks and is heavy.
"""

from __future__ import annotations

from collections.abc import Callable
from hashlib import sha256
from operator import attrgetter
from struct import Struct
from typing import Any, NamedTuple, Protocol

from pymavlink.dialects.v20 import ardupilotmega as dialect

from onboard.wire.mavlink.signing import Signing

__all__ = [
    "HEADER_1",
    "HEADER_2",
    "KNOWN",
    "SIGNATURE",
    "DialectPacket",
    "DialectSender",
    "Layout",
    "MavMessage",
    "Said",
    "checksum",
    "dialect",
    "dialect_packet",
    "layout_of",
]

HEADER_1, HEADER_2 = 6, 10
"""Bytes of a MAVLink 1 and a MAVLink 2 frame before the payload."""
SIGNATURE: int = dialect.MAVLINK_SIGNATURE_BLOCK_LEN
"""Bytes of a signature at the end of a MAVLink 2 frame."""


_HEADER = Struct("<BBBBBBBHB")  # of MAVLink 2


def _checksum(data: bytes) -> int:
    crc: int = dialect.x25crc(data).crc
    return crc


checksum: Callable[[bytes], int] = dialect.mcrf4xx or _checksum
"""The checksum of a frame: of its bytes from the length on, and its message's extra byte (X.25)."""


class MavMessage(Protocol):
    """A message object of pymavlink's dialect."""

    def get_msgId(self) -> int:
        """Return the number of the message."""
        ...

    def get_type(self) -> str:
        """Return the name of the message in capitals."""
        ...

    def pack(self, mav: Any, force_mavlink1: bool = False) -> bytes:
        """Return the frame of the message, numbered and signed as `mav` says."""
        ...

    def __getattr__(self, field: str) -> Any:
        """Return a field of the message, in the wire's units."""
        ...


class Layout:
    """How the payload of one kind of message is read and written: precomputed, so that it costs few steps."""

    __slots__ = (
        "crc_extra", "fields", "kind", "name", "number", "order", "plain", "size", "spans", "unpacker"
    )  # fmt: skip

    def __init__(self, kind: Any) -> None:
        self.kind = kind
        self.name: str = kind.msgname
        self.number: int = kind.id
        self.crc_extra = bytes([kind.crc_extra])
        self.unpacker: Struct = kind.unpacker
        self.size = self.unpacker.size
        self.plain = all(length == 1 for length in kind.lengths)  # one value a field: no arrays
        self.order: tuple[int, ...] = tuple(kind.orders) if self.plain else ()
        starts = [sum(kind.lengths[:i]) for i in range(len(kind.lengths))]
        # (first value, number of values) of each field, in the order of the constructor
        self.spans = tuple((starts[i], kind.lengths[i]) for i in kind.orders)
        types = dict(zip(kind.fieldnames, kind.fieldtypes, strict=True))
        sizes = dict(zip(kind.ordered_fieldnames, kind.array_lengths, strict=True))
        # in the order of the wire; texts are kept as they came beside what people read
        names = [f"_{name}_raw" if types[name] == "char" and sizes[name] else name for name in sizes]
        several, one = attrgetter(*names), attrgetter(names[0])
        self.fields: Callable[[Any], tuple[Any, ...]] = (
            several if len(names) > 1 else lambda message: (one(message),)
        )

    def values(self, payload: bytes) -> tuple[Any, ...]:
        """Return the values of a payload of any length, cut or filled up with zeros, in the wire's order."""
        size = self.size
        if len(payload) < size:
            payload = payload.ljust(size, b"\0")
        elif len(payload) > size:
            payload = payload[:size]  # extension fields newer than this dialect
        return self.unpacker.unpack(payload)

    def message(self, payload: bytes) -> Any:
        """Return the dialect's message of a payload of any length."""
        values = self.values(payload)
        if self.order:
            message = self.kind(*[values[i] for i in self.order])
        else:
            message = self.kind(*[values[i] if n == 1 else list(values[i : i + n]) for i, n in self.spans])
        message._payload = payload
        return message

    def payload(self, message: MavMessage) -> bytes:
        """Return the whole payload of a message. Raises struct.error for what its fields cannot hold."""
        fields = self.fields(message)
        if self.plain:
            return self.unpacker.pack(*fields)
        values: list[Any] = []
        for value, length in zip(fields, self.kind.lengths, strict=True):
            if length == 1:
                values.append(value)
            else:
                values += value[:length]
        return self.unpacker.pack(*values)


KNOWN: dict[int, Layout] = {}
"""The layouts that were asked for so far."""


def layout_of(number: int) -> Layout | None:
    """Return the layout of a message by its number, None where the dialect has no such message."""
    found = KNOWN.get(number)
    if found is None and number in dialect.mavlink_map:
        found = KNOWN[number] = Layout(dialect.mavlink_map[number])
    return found


class Said(NamedTuple):
    """A message as its values in the order of the wire: what streams is told so, without a message object."""

    number: int
    values: tuple[float, ...]


class DialectPacket(NamedTuple):
    """A frame as a simulated autopilot reads it, with every field that any message has."""

    system: int  # of the sender
    component: int  # of the sender
    message: MavMessage


def dialect_packet(raw: bytes) -> DialectPacket:
    """Return the message of one whole frame that a `Framer` has checked already.

    KeyError for a message that the dialect does not have.
    """
    if raw[0] == dialect.PROTOCOL_MARKER_V2:
        start, number = HEADER_2, raw[7] | raw[8] << 8 | raw[9] << 16
        sequence, system, component = raw[4:7]
    else:
        start, number = HEADER_1, raw[5]
        sequence, system, component = raw[2:5]
    layout = layout_of(number)
    if layout is None:
        raise KeyError(f"message {number}: not of the dialect {dialect.__name__}")
    message = layout.message(raw[start : start + raw[1]])
    header = message._header
    header.seq, header.srcSystem, header.srcComponent = sequence, system, component
    return DialectPacket(system, component, message)


class DialectSender:
    """One MAVLink component: the dialect's messages → frames, with the running sequence number.

    `sequence` is the number of the first frame. With `signing` every frame is signed for `link_id`, stamped
    by max(last + 1, clock).
    """

    def __init__(
        self,
        system: int,
        component: int,
        *,
        signing: Signing | None = None,
        link_id: int = 0,
        sequence: int = 0,
    ) -> None:
        self.system = system
        self.component = component
        self._sequence = sequence
        self._signing = signing
        self._link_id = link_id

    def pack(self, message: MavMessage | Said, wall_ns: int = 0) -> bytes:
        """Return the frame of a message; `wall_ns` [ns since the epoch] counts for signing alone."""
        if isinstance(message, Said):
            layout = layout_of(message.number)
            assert layout is not None, message
            return self.frame(layout, layout.unpacker.pack(*message.values), wall_ns)
        layout = layout_of(message.get_msgId())
        assert layout is not None, message
        return self.frame(layout, layout.payload(message), wall_ns)

    def frame(self, layout: Layout, payload: bytes, wall_ns: int = 0) -> bytes:
        """Return the frame of a whole payload. MAVLink 2 leaves out the zeros at its end, but for a first."""
        payload = payload.rstrip(b"\0") or b"\0"
        signing, number = self._signing, layout.number
        flags = 0 if signing is None else dialect.MAVLINK_IFLAG_SIGNED
        sequence, self._sequence = self._sequence, (self._sequence + 1) & 0xFF
        head = (dialect.PROTOCOL_MARKER_V2, len(payload), flags, 0, sequence, self.system, self.component)
        frame = _HEADER.pack(*head, number & 0xFFFF, number >> 16) + payload
        frame += checksum(frame[1:] + layout.crc_extra).to_bytes(2, "little")
        if signing is None:
            return frame
        frame += bytes((self._link_id,)) + signing.next_stamp(wall_ns).to_bytes(6, "little")
        return frame + sha256(signing.key + frame).digest()[:6]
