"""The pseudo-target, the two strategies and the choice between them, step by step."""

from __future__ import annotations

from math import radians

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, add, distance, dot, norm, pitch_of, scale, sub, unit
from onboard.core.route.choice import (
    CHOICE,
    Choice,
    Fix,
    Situation,
    TrackMemory,
    TrackRule,
    choose,
    follow,
    fresh,
)
from onboard.core.route.tracking import (
    Setting,
    Strategy,
    Tracker,
    Waypoint,
    air_velocity,
    passed,
    point_by_point,
    pseudo_target,
    pursue,
)
from onboard.core.strategy.knowledge import Module

ROUTE = (
    Waypoint(Vec(0.0, 0.0, -100.0), 0.0),
    Waypoint(Vec(2000.0, 0.0, -100.0), 50.0),
    Waypoint(Vec(2000.0, 2000.0, -140.0), 100.0),
)
LIMITS = VehicleLimits(25.0, 55.0, radians(-20.0), radians(20.0))
SETTING = Setting(LIMITS, 40.0, 6.0, Strategy.CHOOSE)


def tracker(position: Vec, time: float, leg: int = 1, wind: Vec = ZERO) -> Tracker:
    return Tracker(position, Vec(40.0, 0.0, 0.0), SETTING, wind, time, leg, ROUTE)


def test_the_pseudo_target_is_at_every_waypoint_on_time() -> None:
    for waypoint in ROUTE:
        assert distance(pseudo_target(ROUTE, waypoint.time).position, waypoint.position) < 1e-9
    halfway = pseudo_target(ROUTE, 25.0)
    assert halfway.position == Vec(1000.0, 0.0, -100.0)
    assert halfway.velocity == Vec(40.0, 0.0, 0.0)
    assert pseudo_target(ROUTE, -5.0).position == ROUTE[0].position
    assert pseudo_target(ROUTE, 110.0).position.y == pytest.approx(2400.0)  # it flies on


def test_point_by_point_asks_for_the_speed_that_meets_the_time() -> None:
    steering = point_by_point(tracker(Vec(800.0, 0.0, -100.0), 25.0))
    assert norm(steering.velocity) == pytest.approx(1200.0 / 25.0)
    assert steering.aim == ROUTE[1].position


def test_point_by_point_allows_for_the_wind() -> None:
    wind = Vec(-5.0, 4.0, 0.0)
    steering = point_by_point(tracker(Vec(1000.0, 0.0, -100.0), 25.0, wind=wind))
    ground = add(steering.velocity, wind)
    assert ground.y == pytest.approx(0.0, abs=1e-9)
    assert ground.x == pytest.approx(40.0)


def test_pursuit_meets_the_pseudo_target_where_the_sphere_says() -> None:
    """400 m behind at full speed against 40 m/s: it meets c, and arrives there exactly at T."""
    t = tracker(Vec(600.0, 0.0, -100.0), 25.0)
    steering = pursue(t)
    assert steering.time == pytest.approx(400.0 / (55.0 - 40.0))
    reached = add(t.position, scale(steering.velocity, steering.time))
    assert distance(reached, pseudo_target(ROUTE, 25.0 + steering.time).position) < 1.0


def test_pursuit_in_wind_meets_it_too() -> None:
    wind = Vec(-3.0, 5.0, 0.0)
    t = tracker(Vec(900.0, -120.0, -100.0), 25.0, wind=wind)
    steering = pursue(t)
    reached = add(t.position, scale(add(steering.velocity, wind), steering.time))
    assert distance(reached, pseudo_target(ROUTE, 25.0 + steering.time).position) < 1.0
    assert norm(steering.velocity) <= 55.0 + 1e-9


def test_ahead_of_its_pseudo_target_pursuit_waits_without_turning_back() -> None:
    steering = pursue(tracker(Vec(900.0, 30.0, -100.0), 10.0))
    assert steering.velocity.x > 0.0
    assert norm(steering.velocity) == pytest.approx(25.0, rel=0.25)


def test_a_waypoint_counts_as_passed_beyond_its_plane_or_when_it_recedes() -> None:
    north = Vec(40.0, 0.0, 0.0)
    assert not passed(ROUTE, 1, Vec(1990.0, 20.0, -100.0), north)
    assert passed(ROUTE, 1, Vec(2001.0, 300.0, -100.0), north)
    assert passed(ROUTE, 1, Vec(1995.0, 5.0, -100.0), scale(north, -1.0))


directions = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: norm(Vec(*v)) > 0.1)


@settings(max_examples=200, deadline=None)
@given(directions, st.floats(0.0, 80.0), st.tuples(*[st.floats(-12.0, 12.0)] * 3))
def test_no_wind_takes_the_asked_velocity_out_of_the_limits(
    ground: tuple[float, float, float], speed: float, wind: tuple[float, float, float]
) -> None:
    course = unit(Vec(*ground), Vec(1.0, 0.0, 0.0))
    air = air_velocity(course, speed, Vec(*wind), LIMITS)
    assert 25.0 - 1e-9 <= norm(air) <= 55.0 + 1e-9
    assert radians(-20.0) - 1e-9 <= pitch_of(air) <= radians(20.0) + 1e-9
    level = abs(course.z) < 0.1 and abs(wind[2]) < 1.0
    if level and 30.0 + norm(Vec(*wind)) < speed < 50.0 - norm(Vec(*wind)):
        over = add(air, Vec(*wind))
        assert dot(unit(over, course), course) > 1.0 - 1e-9
        assert norm(over) == pytest.approx(speed)


def at(**known: float) -> Situation:
    strategy = Strategy(int(known.pop("strategy", 1)))
    values = {"deviation": 40.0, "time_error": 0.0, "wind_rms": 1.5, "left": 60.0, "ahead": 6.0} | known
    return Situation(
        values["deviation"],
        values["time_error"],
        values["wind_rms"],
        values["left"],
        values["ahead"],
        strategy,
    )


SAYS = [
    (at(left=10.0, deviation=500.0), Strategy.POINT_BY_POINT, TrackRule.WAYPOINT_NEAR),
    (at(deviation=200.0), Strategy.PURSUIT, TrackRule.ASTRAY),
    (at(time_error=-3.0), Strategy.PURSUIT, TrackRule.ASTRAY),
    (at(deviation=40.0, strategy=2), Strategy.PURSUIT, TrackRule.STILL_ASTRAY),
    (at(deviation=10.0, strategy=2, wind_rms=3.0), Strategy.POINT_BY_POINT, TrackRule.GUSTY_AIR),
    (at(deviation=10.0, wind_rms=0.5), Strategy.PURSUIT, TrackRule.CALM_AIR),
    (at(deviation=10.0), Strategy.POINT_BY_POINT, TrackRule.KEEP),
    (at(deviation=10.0, strategy=2), Strategy.PURSUIT, TrackRule.KEEP),
]


@pytest.mark.parametrize(("situation", "strategy", "rule"), SAYS)
def test_the_knowledge_base_says_which_strategy_and_why(
    situation: Situation, strategy: Strategy, rule: TrackRule
) -> None:
    assert choose(situation) == Choice(True, strategy, rule)


def test_every_rule_of_the_table_can_speak_and_names_its_source() -> None:
    assert {row.id for row in CHOICE} == {rule for _, _, rule in SAYS}
    assert all(row.when and row.then and row.source for row in CHOICE)
    assert {row.module for row in CHOICE} == {Module.INTELLIGENT}


def test_between_the_thresholds_the_choice_does_not_chatter() -> None:
    """A deviation that swings between 30 and 55 m: pursuit, once entered, is not left and entered again."""
    strategy = Strategy.POINT_BY_POINT
    changes = 0
    for k in range(200):
        deviation = 70.0 if k == 5 else (55.0 if k % 2 else 30.0)
        choice = choose(at(deviation=deviation, strategy=strategy))
        changes += choice.strategy != strategy
        strategy = choice.strategy
    assert strategy == Strategy.PURSUIT
    assert changes == 1


def test_a_follower_flies_the_route_and_says_so() -> None:
    """Simple motion in a steady wind: every waypoint in order, on time, and then it is finished."""
    wind = Vec(2.0, -4.0, 0.0)
    position = ROUTE[0].position
    velocity = Vec(40.0, 0.0, 0.0)
    memory = fresh()
    legs = []
    rules = set()
    time = 0.0
    for _ in range(3000):
        step = follow(ROUTE, SETTING, memory, Fix(time, position, velocity, wind))
        if step.memory.leg != memory.leg:
            legs.append((memory.leg, time, distance(position, ROUTE[memory.leg].position)))
        memory = step.memory
        rules.add(step.rule)
        if step.finished:
            break
        velocity = add(step.steering.velocity, wind)
        position = add(position, scale(velocity, 0.05))
        time += 0.05
    assert [leg for leg, _, _ in legs] == [1, 2]
    for leg, when, miss in legs:
        assert when == pytest.approx(ROUTE[leg].time, abs=0.3)
        assert miss < 3.0
    assert step.finished
    assert {TrackRule.WAYPOINT_NEAR, TrackRule.CALM_AIR} <= rules


def test_the_wind_s_rms_is_measured_from_its_estimates() -> None:
    memory = fresh()
    for k in range(4000):
        wind = Vec(5.0 + (3.0 if k % 2 else -3.0), 0.0, 0.0)
        memory = follow(ROUTE, SETTING, memory, Fix(0.05 * k, ROUTE[0].position, ZERO, wind)).memory
    assert norm(sub(memory.wind, Vec(5.0, 0.0, 0.0))) < 0.1
    assert (memory.square / 3.0) ** 0.5 == pytest.approx(3.0 / 3.0**0.5, rel=0.05)
    assert isinstance(memory, TrackMemory)
