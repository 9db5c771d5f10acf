"""Whatever a strategy wants, no vehicle under supervision flies into a zone; and zones and fences agree."""

from __future__ import annotations

from math import cos, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.geometry.zones import (
    NO_ZONES,
    Prism,
    clearance,
    least_clearance,
    round_about,
    way_out_of,
    zones_of,
)
from onboard.core.math.vectors import Vec, norm
from onboard.core.safety.fence import outside_by
from onboard.core.safety.policy import Action, Cause
from tests.support.supervised_vehicle import COPTER, FIELD, PLANE, SQUARE, SupervisedVehicle

SHED = Prism(((-20.0, -15.0), (25.0, -25.0), (30.0, 20.0), (-10.0, 30.0)), high=35.0)
MAST = Prism(round_about((70.0, 60.0), 12.0))
SMALL = zones_of([SHED, MAST])
MOUNTAIN = Prism(((-200.0, -300.0), (250.0, -250.0), (300.0, 200.0), (-100.0, 300.0)), high=160.0)
TOWER = Prism(round_about((900.0, 500.0), 150.0))
LARGE = zones_of([MOUNTAIN, TOWER])
sane = st.floats(-60.0, 60.0)
wishes = st.lists(st.builds(Vec, sane, sane, st.floats(-6.0, 6.0)), min_size=1, max_size=8)


@settings(max_examples=8, deadline=None)
@given(wishes=wishes, north=st.floats(-90.0, -40.0), up=st.floats(20.0, 50.0))
def test_no_multicopter_enters_a_zone_nor_leaves_its_fence(
    wishes: list[Vec], north: float, up: float
) -> None:
    flight = SupervisedVehicle(COPTER._replace(zones=SMALL), Vec(north, 0.0, -up))
    for n in range(600):
        at = flight.seen.position
        wish = wishes[(n // 60) % len(wishes)]
        if n // 200 == 1:  # straight at the shed, then at the mast
            wish = Vec(-at.x, -at.y, wish.z)
        elif n // 200 == 2:
            wish = Vec(70.0 - at.x, 60.0 - at.y, wish.z)
        flight.step(wish)
        assert least_clearance(SMALL, flight.seen.position, False) > 0.0
        assert outside_by(flight.seen.position, SQUARE) == 0.0


@settings(max_examples=5, deadline=None)
@given(
    wishes=wishes,
    heading=st.floats(-pi, pi),
    wind=st.builds(Vec, st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.just(0.0)),
    up=st.sampled_from([100.0, 150.0, 170.0, 250.0]),
)
def test_no_plane_enters_a_zone_in_wind(wishes: list[Vec], heading: float, wind: Vec, up: float) -> None:
    start = Vec(20.0 * cos(heading) + wind.x, 20.0 * sin(heading) + wind.y, 0.0)
    flight = SupervisedVehicle(PLANE._replace(zones=LARGE), Vec(-700.0, 200.0, -up), start, wind)
    for n in range(2000):
        at = flight.seen.position
        goal = (0.0, 0.0) if n < 1000 else (900.0, 500.0)
        wish = Vec(goal[0] - at.x, goal[1] - at.y, 0.0) if n % 400 > 150 else wishes[(n // 100) % len(wishes)]
        flight.step(Vec(25.0 * wish.x / max(norm(wish), 1e-3), 25.0 * wish.y / max(norm(wish), 1e-3), wish.z))
        assert least_clearance(LARGE, flight.seen.position, False) > 0.0
        assert outside_by(flight.seen.position, FIELD) == 0.0


def test_a_zone_is_approached_as_fast_as_a_fence_is() -> None:
    """v t + v²/2a = d with the time until the vehicle answers: that of a dead agent's last word included."""
    policy = COPTER._replace(zones=zones_of([SHED]), coast=1.0)
    east = -22.0  # of the shed's nearest wall there, about
    flight = SupervisedVehicle(policy, Vec(0.0, -60.0, -20.0), Vec(0.0, 5.0, 0.0))
    verdict = flight.step(Vec(0.0, 5.0, 0.0))
    for _ in range(200):
        verdict = flight.step(Vec(0.0, 5.0, 0.0))
        if verdict.cause is Cause.ZONE_AHEAD:
            break
    gap = way_out_of(policy.zones, policy.zones.areas[0], flight.seen.position, True).clearance - 5.0
    v, t, a = norm(verdict.ground), policy.reaction + policy.coast, policy.envelope.deceleration
    assert flight.seen.position.y < east
    assert v * t + v * v / (2.0 * a) == pytest.approx(gap, abs=1.0)


def test_who_slides_along_a_zone_is_not_stopped() -> None:
    flight = SupervisedVehicle(COPTER._replace(zones=zones_of([SHED])), Vec(-60.0, -60.0, -20.0))
    flight.fly(60.0, Vec(4.0, 4.0, 0.0))  # the shed lies across the way
    at = flight.seen.position
    assert at.x > 20.0 or at.y > 20.0, "on one side or the other it came past"


def test_in_a_zone_the_way_out_is_flown_and_named() -> None:
    zones = zones_of([SHED])
    flight = SupervisedVehicle(COPTER._replace(zones=zones), Vec(20.0, 0.0, -20.0))
    verdict = flight.step(Vec(-5.0, 0.0, 0.0))
    assert (verdict.action, verdict.cause) == (Action.CLIP, Cause.INSIDE_ZONE)
    flight.fly(20.0, Vec(-5.0, 0.0, 0.0))
    assert least_clearance(zones, flight.seen.position, False) > 0.0
    plane = SupervisedVehicle(PLANE._replace(zones=LARGE), Vec(0.0, 150.0, -100.0), Vec(0.0, -20.0, 0.0))
    assert plane.step(Vec(0.0, -20.0, 0.0)).cause is Cause.INSIDE_ZONE
    plane.fly(60.0, lambda _t: Vec(0.0, -20.0, 0.0))
    assert least_clearance(LARGE, plane.seen.position, False) > 0.0


def test_over_a_zone_and_below_one_it_is_levelled_off() -> None:
    over = SupervisedVehicle(COPTER._replace(zones=zones_of([SHED])), Vec(5.0, 0.0, -50.0))
    verdict = over.fly(30.0, Vec(0.0, 0.0, 2.0))
    assert verdict.cause is Cause.ZONE_AHEAD
    assert 35.0 < -over.seen.position.z < 39.0
    hangar = zones_of([Prism(MOUNTAIN.polygon, low=200.0)])
    under = SupervisedVehicle(PLANE._replace(zones=hangar), Vec(-100.0, 0.0, -120.0), Vec(20.0, 0.0, 0.0))
    for n in range(600):
        course = 0.01 * n
        under.step(Vec(20.0 * cos(course), 20.0 * sin(course), -4.0))
        assert clearance(hangar, hangar.areas[0], under.seen.position, False) > 0.0


@pytest.mark.parametrize("policy", [COPTER, PLANE])
def test_without_zones_every_verdict_is_the_same_to_the_last_bit(policy: object) -> None:
    assert COPTER.zones == NO_ZONES
    far = zones_of([Prism(round_about((5e4, 5e4), 10.0))])
    one = SupervisedVehicle(policy, Vec(-50.0, 3.0, -55.0), Vec(20.0, 0.0, 0.0))  # type: ignore[arg-type]
    two = SupervisedVehicle(policy._replace(zones=far), Vec(-50.0, 3.0, -55.0), Vec(20.0, 0.0, 0.0))  # type: ignore[attr-defined]
    for n in range(400):
        wish = Vec(20.0 * cos(0.02 * n), 20.0 * sin(0.03 * n), 0.5)
        assert one.step(wish).ground == two.step(wish).ground
