"""Fuzz the simulated autopilots: `python -m tests.fuzz.autopilots --count 3000000 --seed 1 --resume FILE`.

Frames of every kind with any payload, half of them addressed to the vehicle, from several peers; the
autopilot goes on flying, and what it sends is sound.
"""

from __future__ import annotations

from collections import Counter
from math import inf, isfinite, nan
from struct import pack

import numpy as np

from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.frames import Framer
from tests.fuzz import campaign
from tests.fuzz.frames import EXTRA, befallen
from tests.support.flown_autopilot import FlownAutopilot

STEP = 20  # frames between two ticks of the autopilot
SPEED = 200.0  # [m/s] that no vehicle exceeds


INTERESTING = (0.0, 1.0, -1.0, 4.0, 6.0, 15.0, 22.0, 90.0, 360.0, 1e-30, 3e38, -3e38, nan, inf, -inf)
WIDTH = {"char": 1, "uint8_t": 1, "int8_t": 1, "uint16_t": 2, "int16_t": 2, "uint32_t": 4, "int32_t": 4}
WIDTH |= {"float": 4, "uint64_t": 8, "int64_t": 8, "double": 8}


def aimed(rng: np.random.Generator, flown: FlownAutopilot) -> bytes:
    """A sound frame of a kind that the autopilot acts on, addressed to it: any payload, but with numbers
    likely to matter, and commands that it knows."""
    handled = sorted(flown.autopilot.handlers)
    known = sorted(flown.autopilot.commands)
    kind = dialect.mavlink_map[handled[int(rng.integers(len(handled)))]]
    if rng.random() < 0.3:
        long, integer = dialect.MAVLink_command_long_message, dialect.MAVLink_command_int_message
        kind = long if rng.random() < 0.5 else integer
    types = dict(zip(kind.fieldnames, kind.fieldtypes, strict=True))
    payload = b""
    for name, array in zip(kind.ordered_fieldnames, kind.array_lengths, strict=True):
        width = WIDTH[types[name]]
        for _ in range(max(1, array)):
            part = rng.bytes(width)
            if name == "target_system":
                part = bytes([flown.system])
            elif name == "target_component":
                part = b"\1"
            elif name == "command" and rng.random() < 0.9:
                part = known[int(rng.integers(len(known)))].to_bytes(2, "little")
            elif types[name] == "float" and rng.random() < 0.7:
                part = pack("<f", INTERESTING[int(rng.integers(len(INTERESTING)))])
            elif width < 4 and rng.random() < 0.5:
                part = int(rng.integers(16)).to_bytes(width, "little")
            payload += part
    header = bytes([len(payload), 0, 0, int(rng.integers(256)), 255, 190]) + kind.id.to_bytes(3, "little")
    crc = int(dialect.x25crc(header + payload + EXTRA[kind.id]).crc)
    return b"\xfd" + header + payload + crc.to_bytes(2, "little")


def play(rng: np.random.Generator, count: int, totals: Counter[str]) -> None:
    """`count` frames into one autopilot of each kind in turn."""
    for kind in Kind:
        flown, framer = FlownAutopilot(kind), Framer()
        for k in range(count // len(Kind)):
            data, fate = befallen(rng)
            if fate == "good":
                data = aimed(rng, flown)
                totals["addressed"] += 1
            flown.autopilot.receive(flown.now_ns, data, int(rng.integers(8)))
            totals["frames"] += 1
            if k % STEP == 0:
                flown.heard.clear()
                flown.frames.clear()
                flown.forward(0.02)
                for frame in flown.frames:
                    assert len(framer.feed(frame)) == 1
                totals["answers"] += len(flown.frames)
                motion = flown.airframe.motion
                assert all(map(isfinite, (*motion.position, *motion.velocity, motion.airspeed)))
                assert max(map(abs, motion.velocity)) < SPEED
        assert not framer.causes


if __name__ == "__main__":
    campaign.main(play, "Fuzz the simulated autopilots.")
