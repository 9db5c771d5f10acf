"""The free ray among many cones, against all candidates that there are, reckoned with arrays."""

from __future__ import annotations

from itertools import combinations
from math import cos, pi, sin

import numpy as np
import pytest

from onboard.core.geometry.cones import EDGE, Cone, blocked_cones, is_free, pitch_cones
from onboard.core.geometry.edges import free_ray
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, ZERO, Vec, dot, norm, scale, unit
from sim_bridge.campaign.compiled import register
from sim_bridge.campaign.kernel_cache import kernel

SLACK = 1e-9  # cosines; the candidates below count a ray as free that lies so deep in a cone


def closest(preferred: Vec, cones: tuple[Cone, ...]) -> float:
    """The largest cosine of a free candidate to the preferred direction; −2 if there is none.

    Candidates: the direction itself, of every circle of an edge its nearest point, and of every two circles
    the points where their planes' line meets the sphere.
    """
    p = np.array(preferred)
    axes = np.array([c.axis for c in cones])
    cosines = np.array([c.cos for c in cones])
    found = [p]
    for axis, cosine in zip(axes, cosines, strict=True):
        side = p - (p @ axis) * axis
        if np.linalg.norm(side) < 1e-9:
            side = np.cross(axis, [0.3, 0.5, 0.8])
        found.append(cosine * axis + np.sqrt(max(0.0, 1.0 - cosine**2)) * side / np.linalg.norm(side))
    for i, j in combinations(range(len(cones)), 2):
        gram = np.array([[1.0, axes[i] @ axes[j]], [axes[i] @ axes[j], 1.0]])
        if abs(np.linalg.det(gram)) < 1e-9:
            continue
        foot = np.linalg.solve(gram, cosines[[i, j]]) @ axes[[i, j]]
        rest = 1.0 - foot @ foot
        if rest >= 0.0:
            way = np.cross(axes[i], axes[j])
            way *= np.sqrt(rest) / np.linalg.norm(way)
            found += [foot + way, foot - way]
    rays = np.array(found)
    free = (rays @ axes.T <= cosines + SLACK).all(axis=1)
    return float((rays[free] @ p).max()) if free.any() else -2.0


def situation(rng: np.random.Generator, number: int) -> tuple[Vec, tuple[Cone, ...]]:
    """A direction and 8 to 40 cones: anywhere, on a lattice, or on a ring about the direction."""
    count = int(rng.integers(8, 41))
    gamma = float(rng.choice([0.1, 0.3, 0.5, 0.8]))
    tilt = float(rng.choice([0.6, 1.0, 2.4]))
    team = []
    for k in range(count):
        if number % 3 == 0:
            place = Vec(*map(float, rng.standard_normal(3)))
            place = scale(place, float(rng.uniform(5.0, 200.0)) / norm(place))
        elif number % 3 == 1:
            place = Vec(*map(float, 20 * rng.integers(-2, 3, 3)))
            place = place if norm(place) > 0.0 else Vec(20.0, 0.0, 0.0)
        else:
            turn = 2.0 * pi * k / count
            place = scale(Vec(cos(tilt), sin(tilt) * cos(turn), sin(tilt) * sin(turn)), 50.0)
        team.append(Vehicle(place, ZERO, 5.0 * gamma))
    cones = blocked_cones(Vehicle(ZERO, ZERO, 5.0), tuple(team), 4.0)
    if number % 2:
        cones = (*cones, *pitch_cones(VehicleLimits(pitch_min=-0.35, pitch_max=0.35)))
    preferred = NORTH if number % 5 < 2 else unit(Vec(*map(float, rng.standard_normal(3))), NORTH)
    return (cones[0].axis if number % 7 == 0 else preferred), cones


def test_no_candidate_is_nearer_than_the_free_ray_and_none_is_free_where_there_is_none() -> None:
    rng = np.random.default_rng(18)
    blocked = closed = 0
    for number in range(400):
        preferred, cones = situation(rng, number)
        ray = free_ray(preferred, cones)
        best = closest(preferred, cones)
        assert ray.exists == (best > -1.5)
        if ray.exists:
            assert ray.closeness == pytest.approx(best, abs=10.0 * SLACK)
            assert dot(ray.direction, preferred) == pytest.approx(ray.closeness, abs=1e-12)
            assert is_free(ray.direction, cones)
            assert norm(ray.direction) == pytest.approx(1.0, abs=1e-12)
        blocked += not is_free(preferred, cones)
        closed += not ray.exists
    assert blocked > 200
    assert closed > 20


def test_a_gap_of_a_hair_between_many_cones_is_found() -> None:
    """All directions but those within a small angle of one are blocked: the ray is on that gap's edge."""
    gap = 1e-4
    back = Cone(Vec(-1.0, 0.0, 0.0), -cos(gap), sin(gap))  # leaves a cap about north
    others = tuple(
        Cone(Vec(cos(2.0), sin(2.0) * cos(0.7 * k), sin(2.0) * sin(0.7 * k)), cos(0.5), sin(0.5))
        for k in range(11)
    )
    aside = Vec(0.0, 0.6, -0.8)
    ray = free_ray(aside, (*others, back))
    assert ray.exists
    assert dot(ray.direction, NORTH) == pytest.approx(cos(gap), abs=EDGE)
    shut = (*others, back, Cone(NORTH, cos(2.0 * gap), sin(2.0 * gap)))
    assert not free_ray(aside, shut).exists


def test_compiled_the_ray_is_the_same_to_the_last_bit() -> None:
    rng = np.random.default_rng(7)
    cases = []
    while len(cases) < 60:
        preferred, cones = situation(rng, 6 * len(cases))
        if len(cones) >= 12:
            cases.append((preferred, cones[:12]))
    register()
    compiled = kernel(lambda preferred, cones: free_ray(preferred, cones))
    differing = [c for c in cases if tuple(compiled(*c)) != tuple(free_ray(*c))]
    assert differing == []
    assert sum(not free_ray(*c).exists for c in cases) >= 1
    assert sum(free_ray(*c).closeness < 0.99 for c in cases) >= 10
