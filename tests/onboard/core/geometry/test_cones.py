"""Blocked cones and the free ray: against simulation, and against dense sampling."""

from __future__ import annotations

from math import asin, cos, pi, sin

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from onboard.core.geometry.assessment import half_angle
from onboard.core.geometry.cones import EVERYTHING, blocked_cones, is_free
from onboard.core.geometry.edges import free_ray
from onboard.core.geometry.free_ray import free_ray_limited, free_ray_plane, within
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, ZERO, Vec, along, angle_between, distance, dot, pitch_of, yaw_of
from tests.support.random_situations import angle, headings, pursuers

EVADER = Vehicle(ZERO, ZERO, 5.0)
COUNT = 6000
_i = np.arange(COUNT) + 0.5
_z = 1.0 - 2.0 * _i / COUNT
_a = 2.399963229728653 * _i
_r = np.sqrt(1.0 - _z * _z)
SPHERE = np.stack([_r * np.cos(_a), _r * np.sin(_a), _z], axis=1)  # (COUNT, 3)
RING = np.stack([np.cos(_a), np.sin(_a), np.zeros(COUNT)], axis=1)  # (COUNT, 3)


def blocked(samples, cones):
    """(n,) whether each sample lies in a cone."""
    axes = np.array([c.axis for c in cones])
    return (samples @ axes.T > np.array([c.cos for c in cones])).any(axis=1)


def best_sample(samples, free, preferred):
    """Angle of the nearest free sample to the preferred direction, π + 1 if there is none."""
    if not free.any():
        return pi + 1.0
    return float(np.arccos(np.clip(samples[free] @ np.array(preferred), -1.0, 1.0)).min())


@settings(max_examples=1000, deadline=None)
@given(pursuers(), headings())
@example(
    (Vehicle(NORTH, ZERO, 0.0), Vehicle(Vec(0.9999694825770953, 0.007812420527382833, 0.0), ZERO, 0.0)), NORTH
)
def test_free_ray_in_space_is_never_worse_than_sampling_and_never_blocked(team, preferred):
    cones = blocked_cones(EVADER, team, 4.0)
    ray = free_ray(preferred, cones)
    found = best_sample(SPHERE, ~blocked(SPHERE, cones), preferred)
    if ray.exists:
        assert is_free(ray.direction, cones)
        assert dot(ray.direction, ray.direction) == pytest.approx(1.0, abs=1e-12)
        assert angle_between(ray.direction, preferred) <= found + 1e-7
    else:
        assert found > pi


@settings(max_examples=1000, deadline=None)
@given(pursuers(planar=True), headings(planar=True))
def test_free_ray_in_the_plane_is_never_worse_than_sampling_and_never_blocked(team, preferred):
    cones = blocked_cones(EVADER, team, 4.0)
    ray = free_ray_plane(preferred, cones)
    found = best_sample(RING, ~blocked(RING, cones), preferred)
    if ray.exists:
        assert ray.direction.z == 0.0
        assert is_free(ray.direction, cones)
        assert angle_between(ray.direction, preferred) <= found + 1e-7
    else:
        assert found > pi


@settings(max_examples=1000, deadline=None)
@given(pursuers(), headings(), st.floats(-80, 60), st.floats(0, 60), angle, st.floats(0.1, 2 * pi))
def test_free_ray_within_pitch_and_heading_limits_is_exact(team, preferred, low, width, yaw_low, yaw_width):
    limits = VehicleLimits(
        pitch_min=np.radians(low),
        pitch_max=np.radians(min(low + width, 90.0)),
        yaw_min=yaw_low,
        yaw_max=yaw_low + yaw_width,
    )
    cones = blocked_cones(EVADER, team, 4.0)
    ray = free_ray_limited(preferred, cones, limits, False)
    pitch = np.arcsin(np.clip(-SPHERE[:, 2], -1, 1))
    yaw = (np.arctan2(SPHERE[:, 1], SPHERE[:, 0]) - yaw_low) % (2 * pi)
    allowed = (pitch >= limits.pitch_min) & (pitch <= limits.pitch_max) & (yaw <= yaw_width)
    found = best_sample(SPHERE, allowed & ~blocked(SPHERE, cones), preferred)
    if not ray.exists:
        assert found > pi
        return
    assert is_free(ray.direction, cones)
    assert limits.pitch_min - 2e-9 <= pitch_of(ray.direction) <= limits.pitch_max + 2e-9
    if abs(pitch_of(ray.direction)) < pi / 2 - 1e-4 and yaw_width < 2 * pi:
        turned = (yaw_of(ray.direction) - yaw_low + 1e-4) % (2 * pi)
        assert turned <= yaw_width + 2e-4
    assert angle_between(ray.direction, preferred) <= found + 1e-7


@settings(max_examples=300, deadline=None)
@given(headings(), st.floats(10.0, 200.0), st.floats(0.0, 0.95), st.floats(0.0, 5.0), st.floats(0.001, 0.2))
def test_on_a_ray_outside_the_cone_an_optimal_pursuer_never_comes_within_rho(way, far, gamma, rho, margin):
    """The cone's half-angle asin γ + asin(ρ/d), against the pursuer's best over all times."""
    pursuer = Vehicle(Vec(far, 0.0, 0.0), ZERO, gamma * 5.0)
    (cone,) = blocked_cones(EVADER, (pursuer,), rho)
    half = asin(gamma) + asin(min(1.0, rho / far))
    assert half_angle(cone) == pytest.approx(half, abs=1e-7)
    times = np.linspace(0.0, 20.0 * far, 4001) / 5.0

    def nearest(turn: float) -> float:
        x, y = 5.0 * times * cos(turn), 5.0 * times * sin(turn)
        return float((np.hypot(x - far, y) - pursuer.speed * times).min())

    assume(half + margin < pi)
    assert nearest(half + margin) >= rho - 1e-6
    if half - margin > 0.0 and far * sin(margin) > 1.0:
        assert nearest(half - margin) < rho


def test_a_ray_on_the_edge_counts_as_free():
    (cone,) = blocked_cones(EVADER, (Vehicle(Vec(50.0, 0.0, 0.0), ZERO, 4.0),), 0.0)
    half = half_angle(cone)
    for turn, free in ((half - 1e-8, False), (half - 5e-10, True), (half, True), (half + 1e-8, True)):
        assert is_free(Vec(cos(turn), sin(turn), 0.0), (cone,)) == free


def test_the_preferred_ray_itself_is_taken_when_free():
    cones = blocked_cones(EVADER, (Vehicle(Vec(-50.0, 0.0, 0.0), ZERO, 2.0),), 4.0)
    assert free_ray(NORTH, cones).direction == NORTH


def test_a_pursuer_straight_ahead_is_passed_on_its_edge():
    cones = blocked_cones(EVADER, (Vehicle(Vec(50.0, 0.0, 0.0), ZERO, 4.0),), 0.0)
    ray = free_ray(NORTH, cones)
    assert angle_between(ray.direction, NORTH) == pytest.approx(asin(0.8))


def test_four_pursuers_of_gamma_08_close_the_plane_and_three_do_not():
    """Σ 2 asin γ ≥ 2π: γ = 0.8 needs four."""
    for count, closed in ((3, False), (4, True)):
        team = tuple(
            Vehicle(Vec(40 * cos(2 * pi * k / count), 40 * sin(2 * pi * k / count), 0.0), ZERO, 4.0)
            for k in range(count)
        )
        assert free_ray_plane(NORTH, blocked_cones(EVADER, team, 0.0)).exists != closed


def test_all_rays_are_blocked_by_a_pursuer_as_fast_as_the_evader():
    for speed in (5.0, 6.0):
        cones = blocked_cones(EVADER, (Vehicle(Vec(50.0, 0.0, 0.0), ZERO, speed),), 4.0)
        assert cones == (EVERYTHING,)
        assert not free_ray(NORTH, cones).exists
        assert not free_ray_plane(NORTH, cones).exists


def test_a_pursuer_within_the_safety_distance_leaves_the_rays_on_which_the_distance_grows():
    (cone,) = blocked_cones(EVADER, (Vehicle(Vec(2.0, 0.0, 0.0), ZERO, 4.0),), 4.0)
    ray = free_ray(Vec(0.0, 1.0, 0.0), (cone,))
    assert half_angle(cone) == pytest.approx(asin(0.8) + pi / 2)
    assert ray.exists
    for t in (0.1, 0.5, 2.0):
        assert distance(along(ZERO, ray.direction, 5 * t), Vec(2.0, 0.0, 0.0)) - 4 * t >= 2.0 - 1e-9


def test_a_pursuer_in_the_same_place_blocks_everything():
    assert blocked_cones(EVADER, (Vehicle(ZERO, ZERO, 1.0),), 4.0) == (EVERYTHING,)


def test_an_empty_pitch_band_has_no_ray():
    empty = VehicleLimits(pitch_min=0.3, pitch_max=0.1)
    assert not free_ray_limited(NORTH, (), empty, False).exists
    assert within(NORTH, empty, False) == NORTH


def test_a_level_band_keeps_the_ray_level():
    level = VehicleLimits(pitch_min=0.0, pitch_max=0.0)
    steep = Vec(cos(0.7), 0.0, -sin(0.7))
    ray = free_ray_limited(steep, (), level, False)
    assert ray.exists
    assert abs(ray.direction.z) < 1e-12
    cones = blocked_cones(EVADER, (Vehicle(Vec(50.0, 0.0, 0.0), ZERO, 4.0),), 0.0)
    aside = free_ray_limited(steep, cones, level, False)
    assert abs(aside.direction.z) < 1e-12
    assert angle_between(aside.direction, NORTH) == pytest.approx(asin(0.8))


def test_straight_down_a_band_without_a_preferred_azimuth_still_answers():
    ray = free_ray_limited(Vec(0.0, 0.0, 1.0), (), VehicleLimits(pitch_min=-0.2, pitch_max=0.2), False)
    assert ray.exists
    assert pitch_of(ray.direction) == pytest.approx(-0.2)
