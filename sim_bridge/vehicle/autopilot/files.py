"""File transfer over MAVLink: refused, so that clients fall back to the parameter protocol."""

from __future__ import annotations

from struct import Struct

# sequence, session, opcode, size, request opcode, burst complete, padding, offset
HEADER = Struct("<HBBBBBBI")
PAYLOAD = 251
NAK = 129
UNKNOWN_COMMAND = 7


def refusal(request: bytes) -> bytes:
    """The NAK to a request's payload."""
    sequence, session, opcode, *_ = HEADER.unpack_from(request.ljust(HEADER.size, b"\0"))
    answer = HEADER.pack((sequence + 1) & 0xFFFF, session, NAK, 1, opcode, 0, 0, 0) + bytes([UNKNOWN_COMMAND])
    return answer.ljust(PAYLOAD, b"\0")
