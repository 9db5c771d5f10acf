"""Signing, ours and pymavlink's: who has the key is heard, and nobody else, and nothing twice."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path

import pytest

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec
from onboard.runtime.signing_keys import StampFile, read_key
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.frames import Framer, Sender
from onboard.wire.mavlink.signing import (
    EPOCH_NS,
    RESERVE,
    MemoryStore,
    SignatureCheck,
    Signing,
    Stamps,
    ticks,
)

KEY = bytes(range(32))
NOW = EPOCH_NS + 300_000_000 * 10**9  # some day in 2024
S = 10**9


def sender(key: bytes = KEY, link_id: int = 3, system: int = 1) -> Sender:
    return Sender(system, 191, signing=Signing(key, MemoryStore()), link_id=link_id)


def receiver(store: MemoryStore | None = None) -> Framer:
    return Framer(signing=Signing(KEY, store or MemoryStore()))


def test_stamps_count_10_microseconds_since_the_first_of_january_2015() -> None:
    day = datetime(2024, 7, 1, 12, 0, 0, tzinfo=UTC)
    since = day - datetime(2015, 1, 1, tzinfo=UTC)
    tenths = (since.days * 86400 + since.seconds) * 100_000
    assert ticks(round(day.timestamp()) * 10**9) == tenths
    frame = sender().pack(commands.OwnHeartbeat(), round(day.timestamp()) * 10**9)
    assert int.from_bytes(frame[-12:-6], "little") == tenths
    assert ticks(0) == 0  # a clock that starts in 1970


def test_a_clock_in_the_far_future_still_makes_stamps_that_fit() -> None:
    far = EPOCH_NS + (1 << 48) * 10_000 + 5 * S  # 48 bits of 10 µs end in the year 2104
    last = bytes.fromhex("ffffffffffff")
    assert sender().pack(commands.OwnHeartbeat(), far)[-12:-6] == last
    assert sender().pack(commands.OwnHeartbeat(), far - 6 * S)[-12:-6] < last


def test_what_is_stored_is_above_all_that_was_heard_and_ahead_by_the_reserve() -> None:
    store = MemoryStore()
    hearing = Signing(KEY, store)
    for k in (0, 1, 3, 7, 1000, 99_999):  # ticks: bits that carry, and bits that do not
        assert judged(hearing, NOW + 10_000 * k) is SignatureCheck.GOOD
        kept = store.stamps.streams[(3, 1, 191)]
        if k == 0:
            assert kept == ticks(NOW) + RESERVE
        assert kept > ticks(NOW) + k
        assert kept <= ticks(NOW) + k + RESERVE


def test_a_key_has_32_bytes() -> None:
    for length in (0, 31, 33):
        with pytest.raises(ValueError, match="32 bytes"):
            Signing(bytes(length), MemoryStore())
    assert MemoryStore().load() == Stamps(0, {})


def test_stamps_are_stored_once_a_second_and_two_seconds_ahead() -> None:
    second, tick = 100_000, 10_000  # ticks in a second, nanoseconds in a tick
    heard, own = MemoryStore(), MemoryStore()
    hearing, signing = Signing(KEY, heard), Signing(KEY, own)
    for after, saves in ((0, 1), (second - 1, 1), (second, 2), (2 * second - 1, 2), (2 * second, 3)):
        assert judged(hearing, NOW + after * tick) is SignatureCheck.GOOD
        assert signing.next_stamp(NOW + after * tick) == ticks(NOW) + after
        assert (heard.saves, own.saves) == (saves, saves)
        base = ticks(NOW) + (saves - 1) * second
        assert heard.stamps.streams[(3, 1, 191)] == base + 2 * second
        assert own.stamps.own == base + 2 * second


def test_a_signed_stream_passes_and_an_unsigned_one_does_not() -> None:
    tx, rx = sender(), receiver()
    for k in range(50):
        (packet,) = rx.feed(tx.pack(commands.OwnHeartbeat(), NOW + k * S), NOW + k * S)
        assert packet.signed
    assert rx.feed(Sender(1, 191).pack(commands.OwnHeartbeat()), NOW + 60 * S) == []
    assert rx.causes == {"signature_unsigned": 1}


def test_a_replayed_frame_is_heard_once() -> None:
    tx, rx = sender(), receiver()
    old = [tx.pack(commands.OwnHeartbeat(), NOW + k) for k in range(20)]
    assert len([packet for frame in old for packet in rx.feed(frame, NOW)]) == 20
    assert [packet for frame in old for packet in rx.feed(frame, NOW)] == []
    assert rx.causes == {"signature_replayed": 20}


def test_a_forged_frame_from_the_far_future_does_not_lock_the_sender_out() -> None:
    tx, rx = sender(), receiver()
    assert rx.feed(tx.pack(commands.OwnHeartbeat(), NOW), NOW)
    future = bytearray(tx.pack(commands.OwnHeartbeat(), NOW))
    future[-12:-6] = b"\xff" * 6
    assert rx.feed(bytes(future), NOW) == []
    rightly_signed_but_years_ahead = sender().pack(commands.OwnHeartbeat(), NOW + 10**9 * S)
    assert rx.feed(rightly_signed_but_years_ahead, NOW) == []
    assert rx.causes == {"signature_wrong": 1, "signature_future": 1}
    assert rx.feed(tx.pack(commands.OwnHeartbeat(), NOW + S), NOW + S)


def test_an_old_recording_opens_no_new_stream() -> None:
    old = sender(link_id=9).pack(commands.OwnHeartbeat(), NOW - 61 * S)
    rx = receiver()
    assert rx.feed(old, NOW) == []
    assert rx.causes == {"signature_stale": 1}


def test_each_stream_has_its_own_clock() -> None:
    rx = receiver()
    ahead, behind, other = sender(link_id=1), sender(link_id=2), sender(link_id=1, system=2)
    assert rx.feed(ahead.pack(commands.OwnHeartbeat(), NOW + 30 * S), NOW)
    assert rx.feed(behind.pack(commands.OwnHeartbeat(), NOW - 30 * S), NOW)
    assert rx.feed(other.pack(commands.OwnHeartbeat(), NOW), NOW)


def test_every_bit_of_a_signed_frame_matters() -> None:
    frame = sender().pack(commands.VelocityTarget(Target(1), 1.0, Vec(1, 2, 3)), NOW)
    for at in range(len(frame) * 8):
        torn = bytearray(frame)
        torn[at // 8] ^= 1 << at % 8
        assert receiver().feed(bytes(torn), NOW) == []
    assert receiver().feed(frame, NOW)


def test_after_a_crash_nothing_heard_before_is_heard_again_and_the_sender_soon_is() -> None:
    store, tx = MemoryStore(), sender()
    rx = receiver(store)
    heard = [tx.pack(commands.OwnHeartbeat(), NOW + k * S // 10) for k in range(100)]
    for frame in heard:
        assert rx.feed(frame, NOW + 10 * S)
    assert store.saves <= 12  # about once a second, not once a frame
    again = receiver(store)
    assert [packet for frame in heard for packet in again.feed(frame, NOW + 10 * S)] == []
    assert again.feed(tx.pack(commands.OwnHeartbeat(), NOW + 12 * S), NOW + 12 * S)


def test_after_a_crash_with_a_clock_set_back_our_own_stamps_still_rise() -> None:
    store = MemoryStore()
    first = Signing(KEY, store)
    last = max(first.next_stamp(NOW + k) for k in range(1000))
    assert last == ticks(NOW) + 999
    assert Signing(KEY, store).next_stamp(NOW - 3600 * S) > last
    assert Signing(KEY, store).next_stamp(NOW) <= last + 2 * RESERVE + 2  # two starts, each with its reserve


def test_pymavlink_hears_us_and_we_hear_pymavlink() -> None:
    theirs = dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    theirs.signing.secret_key, theirs.signing.sign_outgoing = KEY, True
    theirs.signing.link_id, theirs.signing.timestamp = 4, ticks(NOW)
    tx, rx = sender(), receiver()
    beat = dialect.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3)
    for k in range(20):
        message = theirs.decode(bytearray(tx.pack(commands.OwnHeartbeat(), NOW + k)))
        assert message.get_signed()
        frame = beat.pack(theirs)
        (packet,) = rx.feed(frame, NOW)
        assert packet.signed
    with pytest.raises(dialect.MAVError):
        theirs.decode(bytearray(sender(bytes(32)).pack(commands.OwnHeartbeat(), NOW + S)))
    theirs.signing.secret_key = bytes(32)
    assert rx.feed(beat.pack(theirs), NOW) == []
    assert rx.causes == {"signature_wrong": 1}


def test_a_key_that_others_can_read_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "signing.key"
    path.write_bytes(KEY.hex().encode() + b"\n")
    path.chmod(0o600)
    assert read_key(path) == KEY
    path.write_bytes(KEY)
    assert read_key(path) == KEY
    for mode in (0o640, 0o604, 0o620, 0o666):
        path.chmod(mode)
        with pytest.raises(ConfigError, match="expected 0600"):
            read_key(path)
    path.chmod(0o600)
    path.write_bytes(b"too short")
    with pytest.raises(ConfigError, match="found 9 bytes, expected 32 bytes"):
        read_key(path)
    with pytest.raises(ConfigError, match="no such file"):
        read_key(tmp_path / "none")


def test_stamps_outlive_the_process_in_a_file(tmp_path: Path) -> None:
    path = tmp_path / "stamps.json"
    tx = sender()
    rx = Framer(signing=Signing(KEY, StampFile(path)))
    frame = tx.pack(commands.OwnHeartbeat(), NOW)
    assert rx.feed(frame, NOW)
    assert path.stat().st_mode & 0o077 == 0
    again = Framer(signing=Signing(KEY, StampFile(path)))
    assert again.feed(frame, NOW) == []
    path.write_bytes(b"{")
    with pytest.raises(ConfigError, match="damaged"):
        Signing(KEY, StampFile(path))
    lost = StampFile(tmp_path / "nowhere" / "stamps.json")
    assert Framer(signing=Signing(KEY, lost)).feed(tx.pack(commands.OwnHeartbeat(), NOW + S), NOW + S)
    assert lost.failures == 1


def test_stamps_follow_no_link_and_a_pipe_for_a_key_is_not_waited_for(tmp_path: Path) -> None:
    treasure = tmp_path / "treasure"
    treasure.write_text("mine", encoding="utf-8")
    stamps = tmp_path / "key.stamps"
    (tmp_path / "key.stamps.new").symlink_to(treasure)
    stamps.symlink_to(treasure)
    file = StampFile(stamps)
    file.save(Stamps(5, {}))
    assert treasure.read_text(encoding="utf-8") == "mine"
    assert not stamps.is_symlink()
    assert stamps.stat().st_mode & 0o777 == 0o600
    assert file.load() == Stamps(5, {})
    assert file.failures == 0
    os.mkfifo(tmp_path / "pipe", 0o600)
    with pytest.raises(ConfigError, match="found no regular file"):
        read_key(tmp_path / "pipe")


def test_a_signed_frame_from_the_future_is_refused_from_one_minute_on_and_moves_nothing() -> None:
    for ahead, check in ((60 * S, SignatureCheck.GOOD), (60 * S + 10_000, SignatureCheck.FUTURE)):
        hearing = Signing(KEY, MemoryStore())
        assert judged(hearing, NOW + ahead) is check
        now_fine = judged(hearing, NOW) is SignatureCheck.GOOD
        assert now_fine == (check is SignatureCheck.FUTURE)


def test_a_new_stream_may_lag_one_minute_and_an_old_one_any_time() -> None:
    assert judged(Signing(KEY, MemoryStore()), NOW - 60 * S) is SignatureCheck.GOOD
    assert judged(Signing(KEY, MemoryStore()), NOW - 60 * S - 10_000) is SignatureCheck.STALE
    hearing = Signing(KEY, MemoryStore())
    assert judged(hearing, NOW - 50 * S) is SignatureCheck.GOOD
    assert judged(hearing, NOW - 49 * S, now_ns=NOW + 3600 * S) is SignatureCheck.GOOD
    assert judged(hearing, NOW - 49 * S, now_ns=NOW + 3600 * S) is SignatureCheck.REPLAYED


def test_there_are_at_most_1024_streams_and_those_known_stay_heard() -> None:
    hearing = Signing(KEY, MemoryStore())
    senders = [(link, system) for link in range(5) for system in range(1, 251)][:1025]
    checks = [judged(hearing, NOW, link_id=link, system=system) for link, system in senders]
    assert checks[:1024] == [SignatureCheck.GOOD] * 1024
    assert checks[1024] is SignatureCheck.CROWDED
    assert judged(hearing, NOW + S, link_id=senders[0][0], system=senders[0][1]) is SignatureCheck.GOOD


def judged(
    hearing: Signing, stamp_ns: int, *, now_ns: int = NOW, link_id: int = 3, system: int = 1
) -> SignatureCheck:
    """What is found of a frame that was signed at `stamp_ns` and arrives at `now_ns`."""
    frame = sender(link_id=link_id, system=system).pack(commands.OwnHeartbeat(), stamp_ns)
    return hearing.verify(frame, True, system, 191, now_ns)
