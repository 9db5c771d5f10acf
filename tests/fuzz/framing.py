"""Fuzz the framer and the decoder: `python -m tests.fuzz.framing --count 10000000 --seed 1 --resume FILE`."""

from __future__ import annotations

from collections import Counter
from math import isfinite

import numpy as np

from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.frames import CAUSES, Framer
from tests.fuzz import campaign
from tests.fuzz.frames import befallen

SWALLOWED = 23  # frames that one bad frame of 280 bytes can hide, if its checksum fits by chance (1 in 65536)


def play(rng: np.random.Generator, count: int, totals: Counter[str]) -> None:
    """`count` frames into a datagram framer and a stream framer, in torn chunks; asserts what holds."""
    datagrams, stream = Framer(), Framer()
    sent_whole: Counter[bytes] = Counter()
    pending = b""
    for _ in range(count):
        data, fate = befallen(rng)
        totals[fate] += 1
        got = datagrams.feed(data)
        if fate in ("good", "long"):
            if int.from_bytes(data[7:10], "little") == dialect.MAVLINK_MSG_ID_SETUP_SIGNING:
                assert got == []
            else:
                assert [packet.raw for packet in got] == [data]
                sent_whole[data] += 1
        elif fate in ("bad_crc", "flipped"):
            assert all(packet.raw != data for packet in got)
        for packet in got:
            value = packet.value
            totals["values"] += value is not None
            for field in value or ():
                for number in field if isinstance(field, tuple) else (field,):
                    assert not isinstance(number, float) or isfinite(number)
        pending += data
        cut = int(rng.integers(0, len(pending) + 1))
        for packet in stream.feed(pending[:cut]):
            sent_whole[packet.raw] -= 1
        pending = pending[cut:]
    for packet in stream.feed(pending + bytes(600)):
        sent_whole[packet.raw] -= 1
    lost = sum(left for left in sent_whole.values() if left > 0)
    chance = -sum(left for left in sent_whole.values() if left < 0)  # bad ones whose 16-bit checksum fits
    totals["lost"], totals["passed_by_chance"] = totals["lost"] + lost, totals["passed_by_chance"] + chance
    assert lost <= SWALLOWED * chance, "a good frame was lost in the stream"
    assert set(datagrams.causes) | set(stream.causes) <= set(CAUSES)
    totals["bad"] += datagrams.causes.total() - datagrams.causes["garbage_bytes"]


if __name__ == "__main__":
    campaign.main(play, "Fuzz the MAVLink framer and decoder.")
