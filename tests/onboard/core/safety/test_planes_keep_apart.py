"""Planes that cannot brake keep apart, as flown out by an oracle of its own, and are else left alone."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, radians, sin

import numpy as np
import pytest

from onboard.core.math.states import Mate
from onboard.core.math.vectors import Vec
from onboard.core.safety.policy import Fence
from onboard.core.safety.separation import Separated, kept_apart
from tests.support import encounters
from tests.support.encounters import CLIMB, KEEP, PLANE, SPEED, Aircraft, Wish

Drawn = Callable[[np.random.Generator, int], tuple[list[Aircraft], Wish]]


@pytest.mark.parametrize("drawn", [encounters.to_a_place, encounters.after_one, encounters.anyhow])
@pytest.mark.parametrize("count", [2, 3])
def test_aircraft_never_come_nearer_than_the_separation(drawn: Drawn, count: int) -> None:
    """In gusts, with mates known 0.3 s late. Bound for one place two came within 44 m and three within 13 m
    by a rule that reckoned with straight ways alone."""
    for seed in (4, 20, 38):
        rng = np.random.default_rng([seed, count])
        a = float(rng.uniform(-pi, pi))
        team, wish = drawn(rng, count)
        while not encounters.clear(team):
            team, wish = drawn(rng, count)
        assert encounters.nearest(team, wish, Vec(5.0 * cos(a), 5.0 * sin(a), 0.0), 50.0) >= KEEP


@pytest.mark.parametrize("lateral", [0.0, 40.0, -40.0])
@pytest.mark.parametrize("angle", [180.0, 150.0, 90.0, 30.0])
def test_two_that_would_meet_pass_each_other(angle: float, lateral: float) -> None:
    """Head on, crossing and converging, without gusts; the meeting would be in 25 s."""
    a = radians(angle)
    team = [
        Aircraft(Vec(-1000.0, 0.0, -1500.0), 0.0, 1, 0.0),
        Aircraft(Vec(-1000.0 * cos(a), -1000.0 * sin(a) + lateral, -1500.0), a, 2, 0.0),
    ]
    courses = (0.0, a)

    def wish(_now: float, who: int, _place: Vec) -> Vec:
        return Vec(SPEED * cos(courses[who]), SPEED * sin(courses[who]), 0.0)

    assert encounters.nearest(team, wish, Vec(0.0, 0.0, 0.0), 45.0) >= KEEP


def kept(asked: Vec, own: Vec, own_id: int, *mates: Mate) -> Separated:
    return kept_apart(asked, own, asked, own_id, mates, PLANE)


def test_converging_planes_that_pass_clear_are_left_alone() -> None:
    """Two at right angles that close at 57 m/s, and will be 201 m apart at the nearest."""
    own, mate = Vec(-800.0, 0.0, -1500.0), Mate(3, Vec(0.0, -1085.0, -1500.0), Vec(0.0, SPEED, 0.0), 0.05)
    asked = Vec(SPEED, 0.0, 0.0)
    for after in (0.0, 5.0, 10.0, 15.0, 18.0):
        there = Vec(own.x + SPEED * after, 0.0, -1500.0)
        moved = mate._replace(position=Vec(0.0, -1085.0 + SPEED * after, -1500.0))
        assert not kept(asked, there, 2, moved).changed


def test_who_will_be_too_near_in_long_has_time() -> None:
    own, mate = Vec(-800.0, 0.0, -1500.0), Mate(3, Vec(0.0, -820.0, -1500.0), Vec(0.0, SPEED, 0.0), 0.05)
    assert not kept(Vec(SPEED, 0.0, 0.0), own, 2, mate).changed


def first_change(own_id: int, other: int, age: float = 0.05) -> float:
    """How long before they meet at right angles a plane gives way to a mate [s]."""
    for tenths in range(200, 0, -1):
        left = 0.1 * tenths
        own, there = Vec(-SPEED * left, 0.0, -1500.0), Vec(0.0, -SPEED * left, -1500.0)
        if kept(Vec(SPEED, 0.0, 0.0), own, own_id, Mate(other, there, Vec(0.0, SPEED, 0.0), age)).changed:
            return left
    return 0.0


def test_the_lower_id_keeps_its_course_while_the_higher_gives_way() -> None:
    lower, higher = first_change(2, 3), first_change(3, 2)
    assert 3.0 < lower < higher < 12.0
    assert first_change(2, 3, age=2.0) > lower  # unheard for two seconds: twice the distance


def test_who_is_too_near_parts() -> None:
    """80 m abreast on one course: each ways out, the two of them away from each other."""
    asked = Vec(SPEED, 0.0, 0.0)
    own, mate = Vec(0.0, 0.0, -1500.0), Vec(0.0, 80.0, -1500.0)
    left = kept(asked, own, 2, Mate(3, mate, asked, 0.05)).velocity
    right = kept(asked, mate, 3, Mate(2, own, asked, 0.05)).velocity
    assert right.y - left.y > 5.0 or abs(right.z - left.z) > 5.0


def test_nobody_sinks_below_the_floor_to_pass() -> None:
    """Head on, 50 m above the floor; the higher id would sink."""
    low = PLANE._replace(fences=(Fence(((-9e3, -9e3), (9e3, -9e3), (9e3, 9e3), (-9e3, 9e3)), 300.0, 3000.0),))
    asked, own = Vec(SPEED, 0.0, 0.0), Vec(0.0, 0.0, -350.0)
    mates = (Mate(2, Vec(420.0, 10.0, -350.0), Vec(-SPEED, 0.0, 0.0), 0.05),)
    assert kept_apart(asked, own, asked, 3, mates, PLANE).velocity.z > 0.5 * CLIMB
    found = kept_apart(asked, own, asked, 3, mates, low)
    assert found.changed
    assert found.velocity.z <= 0.0
