"""pymavlink's dialect and what handles its objects: for this folder and the simulated autopilots alone.

The rest of the program reads typed values (`frames.Packet`) and sends typed values (`commands.Outgoing`).
The dialect module is imported, never mavutil, which blocks and is heavy.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from pymavlink.dialects.v20 import ardupilotmega as dialect

from onboard.wire.mavlink.signing import Signing

__all__ = [
    "HEADER_1",
    "HEADER_2",
    "SIGNATURE",
    "DialectPacket",
    "DialectSender",
    "MavMessage",
    "dialect",
    "dialect_packet",
    "layout_of",
]

HEADER_1, HEADER_2 = 6, 10
"""Bytes of a MAVLink 1 and a MAVLink 2 frame before the payload."""
SIGNATURE: int = dialect.MAVLINK_SIGNATURE_BLOCK_LEN
"""Bytes of a signature at the end of a MAVLink 2 frame."""


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
    """How the payload of one kind of message is read: precomputed, so that a frame costs few steps."""

    __slots__ = ("crc_extra", "kind", "name", "order", "size", "spans", "unpack")

    def __init__(self, kind: Any) -> None:
        self.kind = kind
        self.name: str = kind.msgname
        self.crc_extra = bytes([kind.crc_extra])
        self.size: int = kind.unpacker.size
        self.unpack = kind.unpacker.unpack
        plain = all(length == 1 for length in kind.lengths)
        self.order: tuple[int, ...] = tuple(kind.orders) if plain else ()
        starts = [sum(kind.lengths[:i]) for i in range(len(kind.lengths))]
        # (first value, number of values) of each field, in the order of the constructor
        self.spans = tuple((starts[i], kind.lengths[i]) for i in kind.orders)

    def message(self, payload: bytes) -> Any:
        """Return the dialect's message of a payload of any length: cut, or filled up with zeros."""
        if len(payload) < self.size:
            payload += bytes(self.size - len(payload))
        elif len(payload) > self.size:
            payload = payload[: self.size]  # extension fields newer than this dialect
        values = self.unpack(payload)
        if self.order:
            message = self.kind(*[values[i] for i in self.order])
        else:
            message = self.kind(*[values[i] if n == 1 else list(values[i : i + n]) for i, n in self.spans])
        message._payload = payload
        return message


_LAYOUTS: dict[int, Layout] = {}


def layout_of(number: int) -> Layout | None:
    """Return the layout of a message by its number, None where the dialect has no such message."""
    found = _LAYOUTS.get(number)
    if found is None and number in dialect.mavlink_map:
        found = _LAYOUTS[number] = Layout(dialect.mavlink_map[number])
    return found


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
        self._signing = signing
        self._mav = dialect.MAVLink(None, srcSystem=system, srcComponent=component)
        self._mav.seq = sequence
        if signing is not None:
            self._mav.signing.secret_key = signing.key
            self._mav.signing.link_id = link_id
            self._mav.signing.sign_outgoing = True

    def pack(self, message: MavMessage, wall_ns: int = 0) -> bytes:
        """Return the frame of a message; `wall_ns` [ns since the epoch] counts for signing alone."""
        if self._signing is not None:
            self._mav.signing.timestamp = self._signing.next_stamp(wall_ns)
        frame = message.pack(self._mav)
        self._mav.seq = (self._mav.seq + 1) & 0xFF
        return frame
