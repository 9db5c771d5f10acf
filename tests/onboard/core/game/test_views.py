"""What a player sees: the target in the moving air, the nearest mate, and mates carried to now."""

from __future__ import annotations

from math import inf

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.game.views import (
    Nearest,
    Team,
    evader_view,
    heading_at,
    level,
    nearest_mate,
    pursuer_view,
    sighted,
    target_in_air,
)
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.states import CARRIED_MAX, FREE, MateState, Vehicle, carried
from onboard.core.math.vectors import NORTH, ZERO, Vec, along, distance, norm, sub
from tests.support.random_situations import points, pursuers

RULES = Rules(R=2.0, rho=4.0)
OWN = Vehicle(ZERO, Vec(5.0, 0.0, 0.0), 5.0)
ALONE = Team(Nearest(False, ZERO), (OWN,), 0, NO_TARGET)


@settings(max_examples=200, deadline=None)
@given(points(), points())
def test_the_vehicle_and_a_target_on_the_ground_meet_at_the_point_shown(place: Vec, way: Vec) -> None:
    """Flown straight at it through the air, the wind has carried the vehicle to the target."""
    wind = Vec(way.x * 0.008, way.y * 0.008, 0.0)  # up to 5.7 m/s: sometimes faster than the vehicle
    goal = target_in_air(Target(True, place), OWN, wind)
    if goal.position == place:
        return
    time = norm(goal.position) / OWN.speed
    assert distance(along(goal.position, wind, time), place) <= 1e-6 * max(1.0, norm(goal.position))


def test_still_air_and_no_target_change_nothing() -> None:
    goal = Target(True, Vec(100.0, 0.0, 0.0))
    assert target_in_air(goal, OWN, ZERO) == goal
    assert target_in_air(NO_TARGET, OWN, Vec(3.0, 0.0, 0.0)) == NO_TARGET


def test_a_target_that_is_blown_away_faster_than_the_vehicle_flies_stays_where_it_is() -> None:
    goal = Target(True, Vec(100.0, 0.0, 0.0))
    assert target_in_air(goal, OWN, Vec(-6.0, 0.0, 0.0)) == goal


@settings(max_examples=100, deadline=None)
@given(pursuers())
def test_an_evader_sees_the_cones_of_the_safety_distance(team: tuple[Vehicle, ...]) -> None:
    view = evader_view(OWN, FREE, team, NO_TARGET, ZERO, RULES)
    assert view.cones == blocked_cones(OWN, team, RULES.rho)
    assert (view.rules, view.limits) == (RULES, FREE)


@settings(max_examples=200, deadline=None)
@given(points(), st.lists(points(), max_size=6).map(tuple), st.integers(-1, 5))
def test_the_nearest_mate_is_nearest_and_not_the_one_left_out(
    own: Vec, mates: tuple[Vec, ...], but: int
) -> None:
    found = nearest_mate(own, mates, but)
    others = [mate for index, mate in enumerate(mates) if index != but]
    assert found.exists == bool(others)
    assert distance(own, found.position) == pytest.approx(
        min((distance(own, mate) for mate in others), default=0.0)
    )


def test_a_pursuer_sees_the_evader_and_where_it_will_be() -> None:
    evader = Vehicle(Vec(10.0, 0.0, 0.0), Vec(0.0, 4.0, 0.0), 4.0)
    seen = sighted(evader, heading_at(evader), 2.0)
    view = pursuer_view(OWN, FREE, seen, ALONE, Control(0.05, 2.0), RULES)
    assert view.prediction == Vec(10.0, 8.0, 0.0)
    assert (view.evader, view.heading, view.has_prediction) == (evader, Vec(0.0, 1.0, 0.0), True)


def test_a_vehicle_at_rest_heads_north_and_a_plane_game_has_no_heights() -> None:
    assert heading_at(Vehicle(ZERO, ZERO, 5.0)) == NORTH
    assert level(Vec(1.0, 2.0, -50.0), True) == Vec(1.0, 2.0, 0.0)
    assert level(Vec(1.0, 2.0, -50.0), False) == Vec(1.0, 2.0, -50.0)


@settings(max_examples=200, deadline=None)
@given(points(), points(), st.floats(-5.0, 5.0))
def test_a_mate_is_carried_forward_once_never_back_and_not_for_long(
    place: Vec, way: Vec, age: float
) -> None:
    state = MateState(3, 100.0, place, way)
    mate = carried(state, 100.0 + age)
    seconds = min(max(0.0, age), CARRIED_MAX)
    assert distance(mate.position, along(place, way, seconds)) <= 1e-9 * (1.0 + norm(way))
    assert (mate.id, mate.velocity) == (3, way)
    assert mate.age == pytest.approx(age)
    assert norm(sub(mate.position, place)) <= CARRIED_MAX * norm(way) + 1e-9
    assert carried(state, inf).position == along(place, way, CARRIED_MAX)
