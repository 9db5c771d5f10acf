"""MAVLink frames ↔ typed values: bytes in, packets out; values in, frames out.

Sans I/O. One `Framer` per peer, so that one peer's torn frame never destroys another's good one. What
arrives never raises: bad frames are counted by cause.
"""

from __future__ import annotations

from collections import Counter, OrderedDict
from collections.abc import Hashable
from struct import Struct
from typing import NamedTuple

from onboard.core.math.each import new
from onboard.wire.mavlink.commands import Outgoing
from onboard.wire.mavlink.dialect import (
    HEADER_1,
    HEADER_2,
    KNOWN,
    SIGNATURE,
    DialectSender,
    checksum,
    dialect,
    layout_of,
)
from onboard.wire.mavlink.encoding import written
from onboard.wire.mavlink.signing import SignatureCheck, Signing
from onboard.wire.mavlink.telemetry import value_of
from onboard.wire.mavlink.values import Value

MAGIC_1, MAGIC_2 = dialect.PROTOCOL_MARKER_V1, dialect.PROTOCOL_MARKER_V2  # 0xFE, 0xFD
FIELDS_1, FIELDS_2 = Struct("<BBBBBB"), Struct("<BBBBBBBHB")
SIGNED = dialect.MAVLINK_IFLAG_SIGNED
SETUP_SIGNING: int = dialect.MAVLINK_MSG_ID_SETUP_SIGNING

SIGNATURES = tuple(f"signature_{check.value}" for check in SignatureCheck if check is not SignatureCheck.GOOD)
CAUSES = (
    "bad_crc",  # checksum wrong
    "truncated",  # a frame that the next piece does not continue
    "unknown_id",  # message id not of the dialect: its checksum cannot be known
    "incompatible",  # incompatibility flags that nobody has defined yet
    "garbage_bytes",  # bytes outside any frame
    "setup_signing",  # a key is never taken from the network
    *SIGNATURES,
)


class Packet(NamedTuple):
    """One good frame. Whose it is must be checked by the reader: links carry foreign systems too."""

    system: int  # of the sender
    component: int  # of the sender
    sequence: int  # 0…255: the sender's running number of its frames
    number: int  # of the message
    name: str  # of the message, in capitals
    value: Value | None  # what the message says; None: nobody reads it, or it is not sound
    raw: bytes  # the whole frame, for logs
    signed: bool = False  # verified, not only marked


class Framer:
    """Finds the frames in what one peer sends.

    `feed(data, wall_ns)` takes whatever pieces a link brings: whole datagrams, chunks of a serial line or a
    TCP connection, or datagrams that a bridge cut anywhere out of a stream of bytes. Bytes of an unfinished
    frame wait for the next piece. Where that begins with a good frame of its own, they were torn
    (`truncated`) and wait no longer, so that a torn datagram delays nothing. After a bad frame the search
    goes on at its second byte, so that it cannot take the next good one with it; inner look-alikes do not
    count twice.

    With `signing`, only frames that it verifies pass, and `wall_ns` must be the true time.
    """

    def __init__(
        self, *, signing: Signing | None = None, causes: Counter[str] | None = None, takes_keys: bool = False
    ) -> None:
        """`takes_keys`: SETUP_SIGNING passes, signed or not, as at an autopilot's own port."""
        self.causes: Counter[str] = Counter() if causes is None else causes
        self._signing = signing
        self._takes_keys = takes_keys
        self._rest = b""
        self._blamed = 0  # bytes at the head of `_rest` that belong to a frame already counted as bad

    def feed(self, data: bytes, wall_ns: int = 0) -> list[Packet]:
        """Return the good packets in `data` and in what was left over before, heard at `wall_ns`.

        Never raises: what is bad is counted in `causes`.
        """
        if not self._rest and _is_frame(data):  # most often: one frame, and good
            packet, cause = self._open(data, wall_ns)
            if packet is not None:
                return [packet]
            if cause in _WHOLE:
                self.causes[cause] += 1
                return []
        blamed = self._blamed
        torn = len(self._rest) if self._rest and self._begins_well(data) else 0  # no frame goes over this end
        if self._rest:
            data = self._rest + data
        packets: list[Packet] = []
        at, garbage, end = 0, 0, len(data)
        while at < end:
            if data[at] != MAGIC_2 and data[at] != MAGIC_1:
                garbage += at >= blamed
                at += 1
                continue
            stop = torn if at < torn else end
            size = self.size_at(data, at, stop)
            cause = "" if size else self._misfit(data, at, stop)
            if not cause and (size == 0 or at + size > stop):
                if stop == end:
                    break
                cause = "truncated"
            if not cause:
                raw = data[at : at + size] if size != end else data
                packet, cause = self._open(raw, wall_ns)
                if packet is not None:
                    packets.append(packet)
                    at += size
                    continue
                if cause in _WHOLE:  # a whole frame with a good checksum, refused: nothing to search in it
                    self.causes[cause] += 1
                    at += size
                    continue
            if at >= blamed:
                self.causes[cause] += 1
                blamed = at + max(size, _declared(data, at))
                blamed = min(blamed, torn) if at < torn else blamed
            at += 1
        if garbage:
            self.causes["garbage_bytes"] += garbage
        self._rest = data[at:]
        self._blamed = max(0, blamed - at)
        return packets

    def _begins_well(self, data: bytes) -> bool:
        """Whether a piece begins with a whole frame with a good checksum."""
        size = self.size_at(data, 0)
        return 0 < size <= len(data) and _summed(data[:size])

    def end(self) -> None:
        """No more comes: an unfinished frame stays so."""
        if self._rest and not self._blamed:
            self.causes["truncated"] += 1
        self._rest, self._blamed = b"", 0

    def whole(self, raw: bytes, wall_ns: int = 0) -> Packet | None:
        """Return the packet of exactly one frame, or None for anything else; a refused frame is counted."""
        if self.size_at(raw, 0) != len(raw):
            return None
        packet, cause = self._open(raw, wall_ns)
        if cause:
            self.causes[cause] += 1
        return packet

    @staticmethod
    def size_at(data: bytes, at: int, end: int = -1) -> int:
        """Return the length of the frame whose header starts at `at`, 0 for no header or only part of one.

        What lies from `end` on is not looked at (−1: all of `data` is)."""
        left = (len(data) if end < 0 else end) - at
        if left >= HEADER_2 and data[at] == MAGIC_2:
            flags = data[at + 2]
            number = data[at + 7] | data[at + 8] << 8 | data[at + 9] << 16
            if flags & ~SIGNED or (number not in KNOWN and layout_of(number) is None):
                return 0
            return HEADER_2 + data[at + 1] + 2 + (SIGNATURE if flags else 0)
        if left >= HEADER_1 and data[at] == MAGIC_1 and layout_of(data[at + 5]) is not None:
            return HEADER_1 + data[at + 1] + 2
        return 0

    @staticmethod
    def _misfit(data: bytes, at: int, end: int) -> str:
        """Why `size_at` gave 0: the cause, or "" where the header is not yet whole."""
        left = end - at
        if data[at] == MAGIC_2:
            if left >= 3 and data[at + 2] & ~SIGNED:
                return "incompatible"
            return "unknown_id" if left >= HEADER_2 else ""
        return "unknown_id" if left >= HEADER_1 else ""

    def _open(self, raw: bytes, wall_ns: int) -> tuple[Packet | None, str]:
        """The packet of one whole frame of a known kind, or the cause against it."""
        if raw[0] == MAGIC_2:
            _, length, flags, _, sequence, system, component, low, high = FIELDS_2.unpack_from(raw)
            number, start = low | high << 16, HEADER_2
        else:
            _, length, sequence, system, component, number = FIELDS_1.unpack_from(raw)
            flags, start = 0, HEADER_1
        layout = KNOWN.get(number) or layout_of(number)
        if layout is None:
            return None, "unknown_id"
        end = start + length
        if checksum(raw[1:end] + layout.crc_extra) != raw[end] | raw[end + 1] << 8:
            return None, "bad_crc"
        if number == SETUP_SIGNING and not self._takes_keys:
            return None, "setup_signing"
        if self._signing is not None and number != SETUP_SIGNING:
            verdict = self._signing.verify(raw, bool(flags & SIGNED), system, component, wall_ns)
            if verdict is not SignatureCheck.GOOD:
                return None, f"signature_{verdict.value}"
        value = value_of(layout, raw[start:end])
        signed = self._signing is not None
        said = (system, component, sequence, number, layout.name, value, raw, signed)
        return new(Packet, said), ""


def first_number(data: bytes) -> int:
    """The message that a datagram begins with, by its number as it says itself; -1 where with none."""
    if len(data) > 9 and data[0] == MAGIC_2:
        return data[7] | data[8] << 8 | data[9] << 16
    return data[5] if len(data) > 5 and data[0] == MAGIC_1 else -1


_WHOLE = frozenset({*SIGNATURES, "setup_signing"})


def _is_frame(data: bytes) -> bool:
    """Whether a datagram is one whole frame by its header."""
    size = len(data)
    plain = size >= HEADER_2 + 2 and data[0] == MAGIC_2 and not data[2]
    if plain and (data[7] | data[8] << 8 | data[9] << 16) in KNOWN:
        return HEADER_2 + data[1] + 2 == size
    return size > 0 and Framer.size_at(data, 0) == size


def marked_signed(raw: bytes) -> bool:
    """Return whether a whole frame says that it carries a signature, right or wrong."""
    return raw[0] == MAGIC_2 and bool(raw[2] & SIGNED)


def _summed(raw: bytes) -> bool:
    """Whether the checksum of a whole frame of a known kind is right."""
    if raw[0] == MAGIC_2:
        number, end = raw[7] | raw[8] << 8 | raw[9] << 16, HEADER_2 + raw[1]
    else:
        number, end = raw[5], HEADER_1 + raw[1]
    layout = layout_of(number)
    found: int = raw[end] | raw[end + 1] << 8
    return layout is not None and checksum(raw[1:end] + layout.crc_extra) == found


def _declared(data: bytes, at: int) -> int:
    """The length that a misfit's header claims, as far as it can be read."""
    header = HEADER_2 if data[at] == MAGIC_2 else HEADER_1
    return header + 2 + data[at + 1] if len(data) > at + 1 else header


class PeerFramers:
    """A framing state for each peer of one or several links, so that nobody's pieces mix with another's."""

    def __init__(
        self, most: int = 256, *, signing: Signing | None = None, causes: Counter[str] | None = None,
        takes_keys: bool = False,
    ) -> None:  # fmt: skip
        """`most` peers are told apart; the one that was silent for the longest is forgotten first."""
        self.causes: Counter[str] = Counter() if causes is None else causes
        self._most = most
        self._signing, self._takes_keys = signing, takes_keys
        self._framers: OrderedDict[Hashable, Framer] = OrderedDict()

    def feed(self, peer: Hashable, data: bytes, wall_ns: int = 0) -> list[Packet]:
        """Return the good packets in what `peer` sent, heard at `wall_ns`, as `Framer.feed` does."""
        framer = self._framers.get(peer)
        if framer is None:
            while len(self._framers) >= self._most:
                self._framers.popitem(last=False)[1].end()
                self.causes["peers_forgotten"] += 1
            framer = self._framers[peer] = Framer(
                signing=self._signing, causes=self.causes, takes_keys=self._takes_keys
            )
        self._framers.move_to_end(peer)
        return framer.feed(data, wall_ns)

    def clear(self) -> None:
        """Forget everybody."""
        self._framers.clear()


class Sender:
    """One MAVLink component of this program: values → frames, with the running sequence number.

    With `signing` every frame is signed for `link_id`, stamped by max(last + 1, clock).
    """

    def __init__(
        self, system: int, component: int, *, signing: Signing | None = None, link_id: int = 0
    ) -> None:
        self._frames = DialectSender(system, component, signing=signing, link_id=link_id)

    def pack(self, message: Outgoing, wall_ns: int = 0) -> bytes:
        """Return the frame of a message; `wall_ns` [ns since the epoch] counts for signing alone."""
        layout, payload = written(message)
        return self._frames.frame(layout, payload, wall_ns)
