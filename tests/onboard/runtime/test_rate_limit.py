"""Floods: what one sender brings of one kind is bounded and counted, and takes nothing from the others."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onboard.runtime.rate_limit import BUCKETS_MAX, PAYLOAD_MAX, BusLimit, Rate, RateLimit
from onboard.wire.bus.topics import (
    COMMAND,
    DECISION,
    EVENTS,
    HEALTH,
    IDS_MOST,
    PLACES_KEPT,
    PLAN,
    STATE,
    TOPICS,
    Delivery,
)

GAME = "range"


@given(
    st.floats(1.0, 500.0),
    st.floats(1.0, 500.0),
    st.lists(st.floats(0.0, 0.05), min_size=1, max_size=400),
)
def test_no_more_than_rate_and_burst_ever_come_through(
    per_s: float, burst: float, gaps: list[float]
) -> None:
    limit, now, through = RateLimit(), 50.0, 0
    for gap in gaps:
        now += gap
        through += limit.admits("a", "kind", Rate(per_s, burst), now)
    assert through <= burst + per_s * sum(gaps) + 1e-6
    assert through + limit.limited["kind"] == len(gaps)


def test_the_flood_of_one_takes_nothing_from_another_or_from_another_kind_of_its_own() -> None:
    limit = BusLimit()
    for n in range(50_000):  # in one second, by vehicle 2
        limit.admits(STATE.key(GAME, 2), 200, n / 50_000)
    assert limit.counters()["limited_vehicles_state"] > 49_000
    assert limit.admits(STATE.key(GAME, 3), 200, 1.0)
    assert limit.admits(EVENTS.key(GAME, 2), 200, 1.0)
    assert limit.admits(COMMAND.key(GAME, 2), 200, 1.0)


@pytest.mark.parametrize("topic", [pytest.param(topic, id=topic.suffix) for topic in TOPICS])
def test_what_the_product_itself_sends_is_never_limited(topic: object) -> None:
    """Four times the nominal rate, as after a pause, and all that a publisher keeps at once."""
    limit = BusLimit()
    key = topic.key(GAME)  # type: ignore[attr-defined]
    key = key.replace("*", "2")
    kept = topic.delivery is Delivery.EVENT  # type: ignore[attr-defined]
    at_once = 256 if kept else 2
    assert all(limit.admits(key, 1500, 10.0) for _ in range(at_once))
    rate = topic.rate_hz or 1.0  # type: ignore[attr-defined]
    assert all(limit.admits(key, 1500, 20.0 + n / (4 * rate)) for n in range(1000))
    assert limit.counters() == {}


@pytest.mark.parametrize("vehicles", [250, IDS_MOST])
def test_everybody_in_the_largest_game_has_a_bound_of_its_own(vehicles: int) -> None:
    """Five kinds of each vehicle, in the same instant of every second."""
    limit = BusLimit()
    for second in range(3):
        for id in range(1, vehicles + 1):
            for topic in (STATE, DECISION, HEALTH, PLAN, EVENTS):
                assert limit.admits(topic.key(GAME, id), 200, float(second))
    assert limit.counters() == {}


def test_a_huge_payload_and_strange_keys_are_bounded() -> None:
    limit = BusLimit()
    assert not limit.admits(STATE.key(GAME, 2), PAYLOAD_MAX + 1, 0.0)
    admitted = sum(limit.admits(f"apollonius/range/strange/{n}", 10, 1.0) for n in range(10_000))
    assert admitted <= 100
    assert limit.counters()["limited_payload"] == 1
    assert limit.counters()["limited_foreign"] == 10_000 - admitted


def test_memory_is_bounded_whoever_comes() -> None:
    limit = RateLimit()
    for n in range(20_000):
        limit.admits(n, "kind", Rate(1.0, 1.0), 0.0)
    assert len(limit._buckets) <= BUCKETS_MAX + 1
    bus = BusLimit()
    for n in range(PLACES_KEPT + 5000):  # in as many games
        bus.admits(STATE.key(f"game{n}", 2), 200, 0.0)
    assert len(bus._limit._buckets) <= PLACES_KEPT + 1
