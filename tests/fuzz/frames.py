"""Frames for fuzzing: valid ones of every kind with arbitrary payloads, and what befalls them."""

from __future__ import annotations

import numpy as np

from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.telemetry import READ

KINDS = sorted(dialect.mavlink_map)
DECODED = sorted(READ)
EXTRA = {number: bytes([dialect.mavlink_map[number].crc_extra]) for number in KINDS}
SENDERS = ((1, 1), (1, 191), (2, 1), (255, 190))  # an autopilot, its companion, a neighbour, a ground station
FATES = ("good", "bad_crc", "truncated", "flipped", "unknown", "junk", "long", "incompatible")


def frame(rng: np.random.Generator, number: int, *, size: int | None = None, flags: int = 0) -> bytes:
    """A frame with a right checksum and any payload, NaN and infinities included."""
    size = int(rng.integers(0, 256)) if size is None else size
    system, component = SENDERS[int(rng.integers(len(SENDERS)))]
    header = bytes([size, flags, 0, int(rng.integers(256)), system, component])
    body = header + number.to_bytes(3, "little") + rng.bytes(size)
    crc = dialect.x25crc(body + EXTRA.get(number, b"\0")).crc
    return b"\xfd" + body + int(crc).to_bytes(2, "little")


def befallen(rng: np.random.Generator) -> tuple[bytes, str]:
    """A frame and its fate."""
    fate = FATES[int(rng.integers(len(FATES)))]
    kinds = KINDS if rng.random() < 0.5 else DECODED
    number = kinds[int(rng.integers(len(kinds)))]
    if fate == "junk":
        return rng.bytes(int(rng.integers(1, 300))), fate
    if fate == "unknown":
        return frame(rng, int(rng.integers(1 << 20, 1 << 24))), fate
    if fate == "incompatible":
        return frame(rng, number, flags=int(rng.integers(2, 256)) & ~1), fate
    whole = frame(rng, number, size=255 if fate == "long" else None)
    if fate == "bad_crc":
        return whole[:-1] + bytes([whole[-1] ^ int(rng.integers(1, 256))]), fate
    if fate == "truncated":
        return whole[: int(rng.integers(1, len(whole)))], fate
    if fate == "flipped":
        bit = int(rng.integers(8, len(whole) * 8))
        at = bit // 8
        return whole[:at] + bytes([whole[at] ^ 1 << bit % 8]) + whole[at + 1 :], fate
    return whole, fate
