"""Fuzz signature verification: `python -m tests.fuzz.signing --count N --seed S --resume FILE`.

`--count` frames of each kind of forgery (forged, replayed, truncated, unsigned, far future) are put between
the frames of a legitimate sender: none is accepted, and that sender is heard every time.
"""

from __future__ import annotations

from collections import Counter
from hashlib import sha256

import numpy as np

from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.signing import EPOCH_NS, TICK_NS, MemoryStore, Signing, ticks
from tests.fuzz import campaign
from tests.fuzz.frames import EXTRA, KINDS

KEY = sha256(b"the legitimate key").digest()
START = EPOCH_NS + 350_000_000 * 10**9
KINDS_OF_FORGERY = ("forged", "replayed", "truncated", "unsigned", "far_future")


def signed(rng: np.random.Generator, stamp: int, key: bytes, link: int) -> bytes:
    """A frame of any kind but SETUP_SIGNING, stamped and signed."""
    number = KINDS[int(rng.integers(len(KINDS)))]
    if number == dialect.MAVLINK_MSG_ID_SETUP_SIGNING:
        number = 0
    size = int(rng.integers(1, 64))
    body = bytes([size, 1, 0, int(rng.integers(256)), 1, 1]) + number.to_bytes(3, "little") + rng.bytes(size)
    crc = int(dialect.x25crc(body + EXTRA[number]).crc)
    frame = b"\xfd" + body + crc.to_bytes(2, "little") + bytes([link]) + stamp.to_bytes(6, "little")
    whole: bytes = frame + sha256(key + frame).digest()[:6]
    return whole


def forgery(rng: np.random.Generator, kind: str, heard: list[bytes], now: int) -> bytes:
    """One frame that must not pass, made with all that an eavesdropper has."""
    last = heard[int(rng.integers(len(heard)))]
    stamp = ticks(now) + int(rng.integers(1, 5_000_000))
    if kind == "replayed":
        return last
    if kind == "truncated":
        return last[: int(rng.integers(1, len(last)))]
    if kind == "unsigned":
        body = last[1:-13]
        body = bytes([body[0], 0]) + body[2:-2]
        number = int.from_bytes(body[6:9], "little")
        return b"\xfd" + body + int(dialect.x25crc(body + EXTRA[number]).crc).to_bytes(2, "little")
    if kind == "far_future":  # another stamp under the same signature, or a right signature years ahead
        if rng.random() < 0.5:
            return last[:-12] + int(rng.integers(1 << 47, 1 << 48)).to_bytes(6, "little") + last[-6:]
        return signed(rng, ticks(now) + int(rng.integers(10**7, 1 << 47)), KEY, int(rng.integers(256)))
    choice = int(rng.integers(4))
    if choice == 0:  # another key
        return signed(rng, stamp, rng.bytes(32), int(rng.integers(256)))
    if choice == 1:  # a guessed signature
        return signed(rng, stamp, KEY, 1)[:-6] + rng.bytes(6)
    if choice == 2:  # another link under the same signature
        return last[:-13] + bytes([last[-13] ^ int(rng.integers(1, 256))]) + last[-12:]
    bit = int(rng.integers(8, len(last) * 8))
    at = bit // 8
    return last[:at] + bytes([last[at] ^ 1 << bit % 8]) + last[at + 1 :]


def play(rng: np.random.Generator, count: int, totals: Counter[str]) -> None:
    """`count` forgeries of each kind; a legitimate frame after every ten."""
    store = MemoryStore()
    framer = Framer(signing=Signing(KEY, store))
    sender = DialectSender(1, 1, signing=Signing(KEY, MemoryStore()), link_id=1)
    now = START
    heard: list[bytes] = []
    for k in range(count):
        now += int(rng.integers(1, 1000)) * TICK_NS
        if k % 2 == 0 or not heard:
            frame = sender.pack(dialect.MAVLink_attitude_message(k, *rng.normal(size=6)), now)
            assert len(framer.feed(frame, now)) == 1, "the legitimate sender was locked out"
            heard = [*heard[-20:], frame]
            totals["legitimate"] += 1
        for kind in KINDS_OF_FORGERY:
            assert framer.feed(forgery(rng, kind, heard, now), now) == [], kind
            totals[kind] += 1
    for cause, number in framer.causes.items():
        totals[f"counted_{cause}"] += number


if __name__ == "__main__":
    campaign.main(play, "Fuzz the verification of MAVLink signatures.")
