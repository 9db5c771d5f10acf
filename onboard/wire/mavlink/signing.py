"""MAVLink 2 signing: verification of what arrives, and the time stamps of this program's signatures.

A signature is the first 48 bits of SHA-256(key, frame up to the checksum, link id, time stamp); stamps
count 10 µs since 2015-01-01 (https://mavlink.io/en/guide/message_signing.html). Order of checks: the
signature first, in constant time; only then the stamp, and only a frame that passes both moves any
state. So a forged stamp from the far future cannot lock the true sender out.

Stamps are kept per stream (link id, system, component) and persisted with a reserve: what is stored lies
`RESERVE` ahead and is stored again when `SAVE_EVERY` of it is used, so that after a crash nothing that was
once accepted, or sent, comes again, also where the disk takes a second to store it. The price is that a
sender may go unheard for those two seconds after a restart. Where our clock is by then more than a minute
behind what was stored, it was ahead before, and so are the senders that followed it: their stamps creep on by
a tick a frame, and two seconds would be an hour. Then what lies within the reserve counts.
"""

from __future__ import annotations

from enum import Enum
from hashlib import sha256
from hmac import compare_digest
from typing import NamedTuple, Protocol

EPOCH_NS = 1_420_070_400 * 10**9  # 2015-01-01 UTC
TICK_NS = 10_000  # 10 µs
SECOND = 100_000  # ticks
WINDOW = 60 * SECOND  # a new stream may lag our clock by this (the standard), any may lead it by this
SAVE_EVERY = 1 * SECOND
RESERVE = 2 * SECOND
STREAMS = 1024  # bound on streams kept
LAST_STAMP = (1 << 48) - 1

Stream = tuple[int, int, int]  # link id, system, component


class SignatureCheck(Enum):
    """What verification finds of one frame."""

    GOOD = "good"
    UNSIGNED = "unsigned"
    WRONG = "wrong"  # the signature does not fit: forged, damaged, or another key
    REPLAYED = "replayed"  # its stream has been further already
    STALE = "stale"  # a new stream that lags more than a minute
    FUTURE = "future"  # rightly signed, but more than a minute ahead of our clock
    CROWDED = "crowded"  # more streams than there can be


class Stamps(NamedTuple):
    """What is persisted."""

    own: int  # ticks: no signature of ours may be stamped below
    streams: dict[Stream, int]  # ticks: nothing of that stream is accepted up to here


class StampStore(Protocol):
    """Where stamps outlive the process."""

    def load(self) -> Stamps:
        """Return what was saved last; `Stamps(0, {})` at the very first start."""
        ...

    def save(self, stamps: Stamps) -> None:
        """Keep the stamps, atomically."""
        ...


class MemoryStore:
    """A store for one process: simulation and tests."""

    def __init__(self) -> None:
        self.stamps = Stamps(0, {})
        self.saves = 0

    def load(self) -> Stamps:
        """Return what was saved last."""
        return self.stamps

    def save(self, stamps: Stamps) -> None:
        """Keep it, and count how often."""
        self.stamps = stamps
        self.saves += 1


def ticks(wall_ns: int) -> int:
    """Return the signing time of a wall instant [ns since the epoch]: units of 10 µs since 2015."""
    return max(0, (wall_ns - EPOCH_NS) // TICK_NS)


class Signing:
    """One key's state, shared by all links that use it."""

    def __init__(self, key: bytes, store: StampStore) -> None:
        if len(key) != 32:
            raise ValueError(f"a signing key has 32 bytes, not {len(key)}")
        self.key = key
        self._store = store
        saved = store.load()
        self._own = saved.own
        self._own_reserved = saved.own
        self._streams = dict(saved.streams)
        self._reserved = dict(saved.streams)
        self._stored = set(saved.streams)  # of them nothing was accepted since

    def next_stamp(self, wall_ns: int) -> int:
        """Return the stamp of the next signature: max(last + 1, `wall_ns` [ns since the epoch])."""
        self._own = min(LAST_STAMP, max(self._own + 1, ticks(wall_ns)))
        if self._own >= self._own_reserved:
            self._save()
        return self._own

    def verify(self, frame: bytes, signed: bool, system: int, component: int, wall_ns: int) -> SignatureCheck:
        """Judge one whole frame with a good checksum, heard at `wall_ns` [ns since the epoch].

        Only a frame that is GOOD changes what is kept.
        """
        if not signed:
            return SignatureCheck.UNSIGNED
        if not compare_digest(sha256(self.key + frame[:-6]).digest()[:6], frame[-6:]):
            return SignatureCheck.WRONG
        stream = (frame[-13], system, component)
        stamp = int.from_bytes(frame[-12:-6], "little")
        now = ticks(wall_ns)  # own stamps may lead it: they never run back, a clock that is set right does
        last = self._streams.get(stream)
        if last is not None and stream in self._stored and last > now + WINDOW:
            last -= RESERVE
        if last is not None and stamp <= last:
            return SignatureCheck.REPLAYED
        if stamp > max(now, self._own, last or 0) + WINDOW:
            return SignatureCheck.FUTURE
        if last is None:
            if stamp + WINDOW < now:
                return SignatureCheck.STALE
            if len(self._streams) >= STREAMS:
                return SignatureCheck.CROWDED
        self._streams[stream] = stamp
        self._stored.discard(stream)
        if stamp >= self._reserved.get(stream, 0):
            self._save()
        return SignatureCheck.GOOD

    def _save(self) -> None:
        self._own_reserved = self._own + SAVE_EVERY
        self._reserved = {stream: stamp + SAVE_EVERY for stream, stamp in self._streams.items()}
        ahead = RESERVE - SAVE_EVERY
        kept = {stream: stamp + ahead for stream, stamp in self._reserved.items()}
        self._store.save(Stamps(self._own_reserved + ahead, kept))
