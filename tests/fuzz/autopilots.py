"""Fuzz the simulated autopilots: `python -m tests.fuzz.autopilots --count 3000000 --seed 1 --resume FILE`.

Frames of every kind with any payload, half of them addressed to the vehicle, from several peers; the
autopilot goes on flying, and what it sends is sound.
"""

from __future__ import annotations

from collections import Counter
from math import isfinite

import numpy as np

from onboard.runtime.scenario import Kind
from onboard.wire.mavlink import Framer, dialect
from tests.fuzz import campaign
from tests.fuzz.frames import EXTRA, befallen
from tests.support.flown import Flown

STEP = 20  # frames between two ticks of the autopilot
SPEED = 200.0  # [m/s] that no vehicle exceeds


def addressed(data: bytes, system: int) -> bytes:
    """The frame of a known kind with its target fields, if it has any, set to the vehicle."""
    if len(data) < 12 or data[0] != 0xFD:
        return data
    kind = dialect.mavlink_map.get(int.from_bytes(data[7:10], "little"))
    size = data[1]
    if kind is None or len(data) != 12 + size:
        return data
    payload = bytearray(data[10 : 10 + size])
    at = 0
    for field, length in zip(kind.ordered_fieldnames, widths(kind), strict=True):
        if field == "target_system" and at < size:
            payload[at] = system
        if field == "target_component" and at < size:
            payload[at] = 1
        at += length
    body = data[1:10] + bytes(payload)
    return b"\xfd" + body + int(dialect.x25crc(body + EXTRA[kind.id]).crc).to_bytes(2, "little")


_WIDTH = {"char": 1, "uint8_t": 1, "int8_t": 1, "uint16_t": 2, "int16_t": 2, "uint32_t": 4, "int32_t": 4}
_WIDTH |= {"float": 4, "uint64_t": 8, "int64_t": 8, "double": 8}


def widths(kind: type[dialect.MAVLink_message]) -> list[int]:
    """Bytes of each field in the order of the wire."""
    types = dict(zip(kind.fieldnames, kind.fieldtypes, strict=True))
    return [
        _WIDTH[types[name]] * max(1, array)
        for name, array in zip(kind.ordered_fieldnames, kind.array_lengths, strict=True)
    ]


def play(rng: np.random.Generator, count: int, totals: Counter[str]) -> None:
    """`count` frames into one autopilot of each kind in turn."""
    for kind in Kind:
        flown, framer = Flown(kind), Framer()
        for k in range(count // len(Kind)):
            data, fate = befallen(rng)
            if fate == "good" and rng.random() < 0.5:
                data = addressed(data, flown.system)
                totals["addressed"] += 1
            flown.autopilot.receive(flown.now_ns, data, int(rng.integers(8)))
            totals["frames"] += 1
            if k % STEP == 0:
                flown.heard.clear()
                flown.frames.clear()
                flown.fly(0.02)
                for frame in flown.frames:
                    assert len(framer.feed(frame)) == 1
                totals["answers"] += len(flown.frames)
                motion = flown.airframe.motion
                assert all(map(isfinite, (*motion.position, *motion.velocity, motion.airspeed)))
                assert max(map(abs, motion.velocity)) < SPEED
        assert not framer.causes


if __name__ == "__main__":
    campaign.main(play, "Fuzz the simulated autopilots.")
