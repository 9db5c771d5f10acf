"""Authenticated datagrams: what is damaged, forged, turned round or played back has no effect."""

from __future__ import annotations

from itertools import count

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onboard.wire.bus.datagram import HEAD_SIZE, SILENT_S, SIZE_MAX, Challenge, Content, Kind, Opened, Pair

KEY = bytes(range(32))
PUT = Content(Kind.PUT, 0, "apollonius/game/vehicles/2/state", b"state")


T = 100.0  # [s]


class End:
    """One end, with numbers drawn in order: predictable here, so that a test would see them repeated."""

    def __init__(self, listens: bool, first: int, key: bytes = KEY) -> None:
        draw = count(first)
        self.pair = Pair(key, listens=listens, draw=lambda: next(draw))
        self.other = 0

    def put(self, content: Content = PUT) -> bytes:
        """A datagram for the other end."""
        data = self.pair.seal(content, self.pair.hearing(T)[0])
        assert data is not None
        return data

    def hears(self, data: bytes, at: float = T) -> object:
        """What becomes of a datagram."""
        return self.pair.open(data, at)


def acquainted(first: int = 1000, member: int = 5000, at: float = T) -> tuple[End, End]:
    listener, member_ = End(True, first), End(False, member)
    meet(listener, member_, at)
    return listener, member_


def meet(listener: End, member: End, at: float = T) -> None:
    challenge = listener.hears(member.pair.hello(), at)  # it may be an old one: not believed yet
    assert isinstance(challenge, Challenge)
    back = member.hears(challenge.data, at)
    assert isinstance(back, Challenge)
    proof = listener.hears(back.data, at)
    assert isinstance(proof, Opened)
    assert isinstance(member.hears(listener.put(Content(Kind.BEAT)), at), Opened)


def test_two_ends_get_acquainted_and_hear_each_other_once() -> None:
    listener, member = acquainted()
    data = member.put()
    opened = listener.hears(data)
    assert isinstance(opened, Opened)
    assert opened.content == PUT
    assert listener.hears(data) is None
    assert listener.pair.causes["repeated"] == 1


def test_what_was_recorded_says_nothing_to_a_process_that_was_started_anew() -> None:
    listener, member = acquainted()
    recorded = [member.put() for _ in range(5)]
    again = End(True, 9000)
    assert not any(isinstance(again.hears(data), Opened) for data in recorded)
    assert again.pair.hearing(T) == []
    assert isinstance(listener.hears(recorded[-1]), Opened)


def test_what_was_recorded_of_a_member_says_nothing_after_it_was_silent() -> None:
    """An order held back and let through later: the sender's process may have ended long ago."""
    listener, member = acquainted()
    held_back = member.put()
    assert not isinstance(listener.hears(held_back, T + SILENT_S + 0.1), Opened)
    assert listener.pair.hearing(T + SILENT_S + 0.1) == []


def test_a_member_that_restarts_is_heard_again_and_two_processes_of_one_are_heard_both() -> None:
    listener, member = acquainted()
    beside = End(False, 7000)
    meet_beside(listener, beside)
    for end in (member, beside, member, beside):
        assert isinstance(listener.hears(end.put()), Opened)


def meet_beside(listener: End, member: End) -> None:
    challenge = listener.hears(member.pair.hello())
    assert isinstance(challenge, Challenge)
    back = member.hears(challenge.data)
    assert isinstance(back, Challenge)
    assert isinstance(listener.hears(back.data), Opened)
    data = listener.pair.seal(Content(Kind.BEAT), listener.pair.hearing(T)[-1])
    assert isinstance(member.hears(data or b""), Opened)


def test_after_silence_both_ends_find_each_other_again() -> None:
    listener, member = acquainted()
    later = T + 60.0
    assert isinstance(challenge := listener.hears(member.pair.hello(), later), Challenge)
    assert isinstance(back := member.hears(challenge.data, later), Challenge)
    assert isinstance(listener.hears(back.data, later), Opened)


def test_a_datagram_thrown_back_at_its_sender_is_forged() -> None:
    _, member = acquainted()
    assert member.hears(member.put()) is None
    assert member.pair.causes["forged"] == 1


def test_another_key_is_forged() -> None:
    other = End(True, 1, bytes(32))
    _, member = acquainted()
    assert other.hears(member.put()) is None
    assert other.pair.causes["forged"] == 1


@given(st.data())
def test_no_changed_bit_has_an_effect(data: st.DataObject) -> None:
    listener, member = acquainted()
    frame = bytearray(member.put())
    bit = data.draw(st.integers(0, len(frame) * 8 - 1))
    frame[bit // 8] ^= 1 << bit % 8
    assert listener.hears(bytes(frame)) is None


@given(st.binary(max_size=SIZE_MAX + 10))
def test_anything_at_all_is_taken_without_a_fault(data: bytes) -> None:
    listener, _ = acquainted()
    assert listener.hears(data) is None
    assert listener.hears(b"APD1" + data) is None


@pytest.mark.parametrize("length", [0, 1, SIZE_MAX - HEAD_SIZE - 1, SIZE_MAX - HEAD_SIZE])
def test_a_payload_comes_whole_or_not_at_all(length: int) -> None:
    listener, member = acquainted()
    content = Content(Kind.PUT, 0, "k", bytes(length))
    data = member.pair.seal(content, member.pair.hearing(T)[0])
    if length + 1 + HEAD_SIZE > SIZE_MAX:
        assert data is None
        assert member.pair.causes["too_long"] == 1
    else:
        assert data is not None
        assert len(data) <= SIZE_MAX
        opened = listener.hears(data)
        assert isinstance(opened, Opened)
        assert opened.content == content
