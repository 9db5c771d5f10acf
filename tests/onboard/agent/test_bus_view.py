"""What one agent makes of the bus, message by message."""

from __future__ import annotations

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.events import Instant, Outbox, Subscribe, Unsubscribe
from onboard.agent.core.journal import Journal
from onboard.wire.bus.messages import Role, State, Track
from onboard.wire.bus.topics import STATE, TRACK

EPOCH_NS = 1_700_000_000_000_000_000


def opened() -> tuple[BusView, Outbox]:
    """The view of pursuer 2, which follows vehicle 3."""
    config, out = AgentConfig(id=2, game="g"), Outbox()
    view = BusView(config, 1, out, Journal(2, "g", 1))
    view.open()
    view.follow((2, 3))
    return view, out


def state(id: int, stamp_ns: int) -> bytes:
    """A vehicle at 10 m north that flies east at 4 m/s."""
    place, velocity, still = (10.0, 0.0, -50.0), (0.0, 4.0, 0.0), (0.0, 0.0, 0.0)
    it = State(id, Role.PURSUER, stamp_ns, place, velocity, 4.0, still, 0.0, 0.0, 0.0, "GUIDED", True, id)
    return STATE.encode(it)


@pytest.mark.parametrize("off_s", [-5.0, 0.0, 5.0])
def test_a_mate_is_carried_from_when_it_was_heard_whatever_its_clock_says(off_s: float) -> None:
    view, _ = opened()
    view.take(STATE.key("g", 3), state(3, EPOCH_NS + round(off_s * 1e9)), Instant(100.0, EPOCH_NS))
    (mate,) = view.mates_at(100.4)
    assert mate.position == pytest.approx((10.0, 1.6, -50.0))
    assert mate.age == pytest.approx(0.4)
    (later,) = view.mates_at(103.0)  # for no longer than a second
    assert later.position == pytest.approx((10.0, 4.0, -50.0))
    assert later.age == pytest.approx(3.0)


def test_what_a_mate_says_meanwhile_counts_at_the_same_instant() -> None:
    view, _ = opened()
    assert view.mates_at(100.0) == ()
    view.take(STATE.key("g", 3), state(3, EPOCH_NS), Instant(100.0, EPOCH_NS))
    assert [mate.id for mate in view.mates_at(100.0)] == [3]
    view.follow((2,))
    assert view.mates_at(100.0) == ()


def test_who_is_no_longer_a_mate_is_neither_heard_nor_kept() -> None:
    view, out = opened()
    view.take(STATE.key("g", 3), state(3, EPOCH_NS), Instant(100.0, EPOCH_NS))
    out.take()
    view.follow((4,))
    assert view.mates_at(100.0) == ()
    assert out.take() == [Unsubscribe(STATE.key("g", 3)), Subscribe(STATE.key("g", 4))]
    view.take(STATE.key("g", 3), state(3, EPOCH_NS), Instant(101.0, EPOCH_NS))  # was on its way
    assert view.mates_at(101.0) == ()


def test_tracks_of_itself_and_of_mates_say_nothing_those_of_others_do() -> None:
    view, _ = opened()
    now = Instant(100.0, EPOCH_NS)

    def told(id: int) -> bool:
        track = Track(id, EPOCH_NS, (1.0, 2.0, -3.0), (0.0, 4.0, 0.0), (1.0,) * 6, "radar")
        return view.take(TRACK.key("g", id), TRACK.encode(track), now) == track

    assert {id: told(id) for id in (1, 2, 3, 4)} == {1: True, 2: False, 3: False, 4: True}
    view.follow((2, 4))
    assert {id: told(id) for id in (1, 2, 3, 4)} == {1: True, 2: False, 3: True, 4: False}
    assert view.take(TRACK.key("g", 1), b"\x00", now) is None
    assert view.drops.total() == 1


def test_tracks_are_asked_for_one_by_one_once_the_opponents_are_known() -> None:
    view, out = opened()
    all_there_are = TRACK.key("g")
    assert all_there_are in set(view.keys())
    out.take()
    view.watch((1, 7))
    one, seven, eight = (TRACK.key("g", id) for id in (1, 7, 8))
    assert out.take() == [Unsubscribe(all_there_are), Subscribe(one), Subscribe(seven)]
    view.watch((7, 8))  # of the next game
    assert out.take() == [Unsubscribe(one), Subscribe(eight)]
    assert {seven, eight} <= set(view.keys())
    assert {one, all_there_are}.isdisjoint(view.keys())
    view.watch(tuple(range(10, 30)))  # so many keys would cost more than what comes beside them
    assert out.take() == [Unsubscribe(seven), Unsubscribe(eight), Subscribe(all_there_are)]
    view.watch(())
    assert out.take() == [Unsubscribe(all_there_are)]
