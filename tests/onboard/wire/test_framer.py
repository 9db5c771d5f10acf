"""Frames arrive torn, forged, foreign and doubled: what is good passes, what is bad is counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.vectors import Vec
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.dialect import DialectSender, dialect, dialect_packet
from onboard.wire.mavlink.frames import CAUSES, Framer, Packet, PeerFramers, Sender
from onboard.wire.mavlink.signing import MemoryStore, Signing
from onboard.wire.mavlink.telemetry import READ
from onboard.wire.mavlink.values import Battery, RadioStatus, StatusText

AUTOPILOT = Target(1)
NOW = 1_790_000_000 * 10**9


def frames(count: int) -> list[bytes]:
    sender = Sender(1, 191)
    targets = [commands.VelocityTarget(AUTOPILOT, k * 0.05, Vec(1.0 + k, -2.0, 0.5)) for k in range(count)]
    return [sender.pack(target) for target in targets]


def test_a_truncated_datagram_does_not_take_the_next_one_with_it() -> None:
    first, second, third = frames(3)
    framer = Framer()
    assert len(framer.feed(first)) == 1
    assert framer.feed(second[:20]) == []
    assert [packet.raw for packet in framer.feed(third)] == [third]
    assert framer.causes == {"truncated": 1}


@pytest.mark.parametrize("size", [1, 7, 40, 128, 280, 1400])
@pytest.mark.parametrize("signed", [False, True])
def test_frames_that_a_bridge_cuts_between_datagrams_are_put_together(size: int, signed: bool) -> None:
    """Transparent serial-to-UDP bridges send what they have, wherever a frame ends."""
    ours, theirs = (Signing(b"k" * 32, MemoryStore()) if signed else None for _ in range(2))
    sender, framer = DialectSender(2, 1, signing=theirs), Framer(signing=ours)
    sent = [
        sender.pack(dialect.MAVLink_attitude_message(50 * k, 0.1, 0.2, 0.3, 0, 0, 0), NOW) for k in range(100)
    ]
    stream = b"".join(sent)
    got = [p.raw for at in range(0, len(stream), size) for p in framer.feed(stream[at : at + size], NOW)]
    assert got == sent
    assert not framer.causes


@given(tears=st.lists(st.integers(1, 44), min_size=1, max_size=20), signed=st.booleans())
def test_a_whole_datagram_is_heard_at_once_whatever_was_torn_before(tears: list[int], signed: bool) -> None:
    ours, theirs = (Signing(b"k" * 32, MemoryStore()) if signed else None for _ in range(2))
    sender, framer = DialectSender(2, 1, signing=theirs), Framer(signing=ours)
    for tear in tears:
        torn, whole = (
            sender.pack(dialect.MAVLink_attitude_message(1, 0.1, 0.2, 0.3, 0.4, 0, 0), NOW) for _ in range(2)
        )
        framer.feed(torn[: min(tear, len(torn) - 1)], NOW)
        assert [packet.raw for packet in framer.feed(whole, NOW)] == [whole]
    assert framer.causes == {"truncated": len(tears)}


def test_what_lies_behind_a_torn_header_is_found_when_the_next_datagram_comes() -> None:
    first, second, third = frames(3)
    framer = Framer()
    assert framer.feed(b"\xfd\xff\x00\x00\x00\x01\x01\x1e\x00\x00" + first) == []  # claims 255 bytes
    assert [packet.raw for packet in framer.feed(second + third)] == [first, second, third]


def test_peers_pieces_do_not_mix() -> None:
    first, second = frames(2)
    framers = PeerFramers(2)
    assert framers.feed("a", first[:20]) == framers.feed("b", second[:30]) == []
    assert [packet.raw for packet in framers.feed("a", first[20:])] == [first]
    assert [packet.raw for packet in framers.feed("b", second[30:])] == [second]
    framers.feed("a", first[:20])
    framers.feed("c", b"")
    framers.feed("d", b"")  # the third: "a" is forgotten
    assert framers.feed("a", first[20:]) == []
    assert (framers.causes["peers_forgotten"], framers.causes["truncated"]) == (3, 1)


def test_a_torn_frame_in_a_byte_stream_does_not_take_the_next_one_with_it() -> None:
    first, second, third = frames(3)
    framer = Framer()
    got = framer.feed(first[:31] + second) + framer.feed(third) + framer.feed(frames(1)[0])
    assert [packet.raw for packet in got] == [second, third, first]
    assert framer.causes["bad_crc"] == 1


def test_each_bad_frame_counts_once_by_its_cause() -> None:
    good = frames(1)[0]
    flipped = good[:15] + bytes([good[15] ^ 4]) + good[16:]
    unknown = good[:7] + b"\xff\xff\x7f" + good[10:]
    incompatible = good[:2] + b"\x02" + good[3:]
    key = DialectSender(1, 191).pack(dialect.MAVLink_setup_signing_message(1, 1, [7] * 32, 99))
    framer = Framer()
    for bad in (flipped, unknown, incompatible, key, b"noise", good[:-1]):
        assert framer.feed(bad) == []
    assert len(framer.feed(good)) == 1
    assert framer.causes == {
        "bad_crc": 1,
        "unknown_id": 1,
        "incompatible": 1,
        "setup_signing": 1,
        "garbage_bytes": 5,
        "truncated": 1,
    }
    assert len(framer.feed(flipped + good + unknown + good + b"xx" + good)) == 3


def test_a_key_sent_over_the_network_is_never_taken() -> None:
    key = DialectSender(255, 190).pack(dialect.MAVLink_setup_signing_message(1, 1, [7] * 32, 99))
    framer = Framer()
    assert framer.feed(key) == []
    assert framer.causes == {"setup_signing": 1}


def test_mavlink_1_is_read_too() -> None:
    mav = dialect.MAVLink(None, srcSystem=51, srcComponent=68)
    raw = dialect.MAVLink_radio_status_message(180, 170, 88, 40, 41, 3, 0).pack(mav, force_mavlink1=True)
    (packet,) = Framer().feed(raw)
    assert (packet.system, packet.component, packet.name) == (51, 68, "RADIO_STATUS")
    assert packet.value == RadioStatus(0.88, 180, 170, 3)


def test_sender_counts_its_frames_and_wraps() -> None:
    sender, framer = Sender(3, 191), Framer()
    packets = [framer.feed(sender.pack(commands.OwnHeartbeat()))[0] for _ in range(300)]
    assert [packet.sequence for packet in packets] == [k % 256 for k in range(300)]
    assert {(packet.system, packet.component) for packet in packets} == {(3, 191)}
    assert {packet.raw[0] for packet in packets} == {0xFD}


def test_messages_with_arrays_and_texts_come_back_as_they_went() -> None:
    sender, framer = DialectSender(1, 1), Framer()
    battery = dialect.MAVLink_battery_status_message(1, 2, 3, 400, [4000 + k for k in range(10)], 7, 8, 9, 55)
    (packet,) = framer.feed(sender.pack(battery))
    assert isinstance(packet.value, Battery)
    assert packet.value.voltage == pytest.approx(sum(range(4000, 4010)) * 1e-3)
    assert packet.value.remaining == 0.55
    assert dialect_packet(packet.raw).message.voltages == [4000 + k for k in range(10)]
    (packet,) = framer.feed(sender.pack(dialect.MAVLink_statustext_message(4, b"x" * 50)))
    assert packet.value == StatusText(4, "x" * 50, 0, 0)


@settings(max_examples=300, deadline=None)
@given(pieces=st.lists(st.binary(max_size=400), max_size=4))
def test_any_bytes_are_taken_without_an_exception(pieces: list[bytes]) -> None:
    framer = Framer()
    for data in pieces:
        framer.feed(data)
    assert set(framer.causes) <= set(CAUSES)


@settings(max_examples=200, deadline=None)
@given(
    junk=st.lists(st.binary(max_size=40), min_size=4, max_size=4),
    cuts=st.lists(st.integers(1, 200), min_size=1, max_size=12),
)
def test_good_frames_survive_any_junk_between_them_in_a_stream(junk: list[bytes], cuts: list[int]) -> None:
    """Junk may claim a frame of at most 280 bytes: what follows it is late by that much, never lost."""
    good = frames(4)
    data = b"".join(bad + frame for bad, frame in zip(junk, good, strict=True)) + bytes(300)
    framer, got, at = Framer(), [], 0
    for step in (cuts * (len(data) + 1))[: len(data)]:
        got += [packet.raw for packet in framer.feed(data[at : at + step])]
        at += step
        if at >= len(data):
            break
    assert Counter(got) == Counter(good)


def parts_of(value: object) -> Iterator[object]:
    """The value and everything that it holds, however deep."""
    yield value
    for part in value if isinstance(value, tuple | list) else ():
        yield from parts_of(part)


@pytest.mark.parametrize("number", sorted(dialect.mavlink_map))
def test_no_object_of_the_dialect_leaves_the_framer(number: int) -> None:
    kind = dialect.mavlink_map[number]
    payload = bytes(kind.unpacker.size)
    body = bytes([len(payload), 0, 0, 5, 1, 1, number & 255, number >> 8 & 255, number >> 16]) + payload
    crc = dialect.x25crc(body + bytes([kind.crc_extra])).crc
    packets = Framer().feed(b"\xfd" + body + crc.to_bytes(2, "little"))
    assert (packets == []) == (number == dialect.MAVLINK_MSG_ID_SETUP_SIGNING)
    for packet in packets:
        assert (packet.number, packet.name) == (number, kind.msgname)
        assert number in READ or packet.value is None
        for part in parts_of(packet):
            assert not type(part).__module__.startswith("pymavlink"), part


def test_what_is_read_has_a_value_and_the_rest_has_none() -> None:
    heartbeat = dialect.MAVLink_heartbeat_message(2, 3, 0, 4, 4, 3)
    ping = dialect.MAVLink_ping_message(1, 2, 0, 0)
    sender, framer = DialectSender(1, 1), Framer()
    (packet,) = framer.feed(sender.pack(heartbeat))
    assert packet == Packet(1, 1, 0, 0, "HEARTBEAT", packet.value, packet.raw)
    assert packet.value is not None
    (packet,) = framer.feed(sender.pack(ping))
    assert (packet.name, packet.value) == ("PING", None)
