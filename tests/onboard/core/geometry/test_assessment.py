"""Gaps, caps, denial and intercept times, without simulation."""

from __future__ import annotations

from math import asin, atan2, cos, pi, sin

import numpy as np
import pytest
from hypothesis import example, given, settings

from onboard.core.geometry.assessment import NO_GOAL, Goal, assess, gaps, half_angle, largest_free_cap
from onboard.core.geometry.cones import blocked_cones, is_free
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec, scale
from tests.onboard.core.geometry.test_cones import EVADER, SPHERE
from tests.support.random_situations import pursuers

HEADINGS = np.linspace(-pi, pi, 3600, endpoint=False)


@settings(max_examples=300, deadline=None)
@given(pursuers(planar=True))
def test_gaps_are_the_free_headings(team):
    cones = blocked_cones(EVADER, team, 4.0)
    found = gaps(cones)
    for heading in HEADINGS[::7]:
        inside = any((heading - gap.start) % (2 * pi) < gap.width for gap in found)
        near = any(
            abs((heading - edge + pi) % (2 * pi) - pi) < 1e-6
            for gap in found
            for edge in (gap.start, gap.start + gap.width)
        )
        assert near or inside == is_free(Vec(cos(heading), sin(heading), 0.0), cones)


@settings(max_examples=300, deadline=None)
@given(pursuers())
@example((Vehicle(Vec(5.0, 0.0, 0.0), ZERO, 0.0), Vehicle(Vec(-1.0, 1.2e-16, 0.0), ZERO, 0.0)))  # opposite
def test_no_sample_lies_in_a_larger_free_cap(team):
    cones = blocked_cones(EVADER, team, 4.0)
    cap = largest_free_cap(cones)
    axes = np.array([c.axis for c in cones])
    halves = np.array([half_angle(c) for c in cones])
    room = (np.arccos(np.clip(SPHERE @ axes.T, -1.0, 1.0)) - halves).min(axis=1)
    assert cap.radius >= room.max() - 1e-6 or room.max() <= 0.0
    if cap.radius > 0.0:
        own = np.arccos(np.clip(axes @ np.array(cap.axis), -1.0, 1.0)) - halves
        assert own.min() >= cap.radius - 1e-6


def octahedron(far):
    return tuple(
        Vehicle(scale(Vec(*axis), far), ZERO, 40.0)
        for axis in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
    )


def test_six_pursuers_close_space_only_when_the_safety_distance_is_large():
    """γ = 0.8: six caps of 53.13° leave rays free; from ρ/d ≥ 0.028 on they do not."""
    evader = Vehicle(ZERO, ZERO, 50.0)
    assert largest_free_cap(blocked_cones(evader, octahedron(1000.0), 0.0)).radius == pytest.approx(
        atan2(2**0.5, 1.0) - asin(0.8), abs=1e-9
    )
    assert largest_free_cap(blocked_cones(evader, octahedron(1000.0), 27.0)).radius > 0.0
    assert largest_free_cap(blocked_cones(evader, octahedron(1000.0), 29.0)).radius == 0.0


def test_who_denies_the_target_and_who_intercepts():
    evader = Vehicle(ZERO, scale(NORTH, 5.0), 5.0)
    guard = Vehicle(Vec(90.0, 5.0, 0.0), ZERO, 4.0)
    far = Vehicle(Vec(-300.0, 0.0, 0.0), ZERO, 4.0)
    seen = assess(evader, (guard, far), 4.0, Goal(True, Vec(100.0, 0.0, 0.0)), True)
    assert [p.denies_target for p in seen.prospects] == [True, False]
    assert [p.intercepts for p in seen.prospects] == [True, False]
    assert seen.prospects[0].time > 0.0
    assert seen.prospects[1].time == -1.0
    assert seen.target_denied
    assert not seen.encircled
    assert len(seen.gaps) == 2
    assert seen.largest_gap == max(gap.width for gap in seen.gaps)


def test_encirclement_is_told_in_plane_and_space():
    evader = Vehicle(ZERO, scale(NORTH, 5.0), 5.0)
    ring = tuple(Vehicle(Vec(40 * cos(k * pi / 2), 40 * sin(k * pi / 2), 0.0), ZERO, 4.0) for k in range(4))
    assert assess(evader, ring, 4.0, NO_GOAL, True).encircled
    space = assess(evader, ring, 4.0, NO_GOAL, False)
    assert not space.encircled
    assert abs(space.cap.axis.z) == pytest.approx(1.0, abs=1e-9)


def test_without_cones_everything_is_free():
    idle = blocked_cones(EVADER, (Vehicle(Vec(50.0, 0.0, 0.0), ZERO, 0.0),), 0.0)
    assert gaps(idle)[0].width == pytest.approx(2 * pi)
    assert largest_free_cap(idle).radius == pytest.approx(pi)
