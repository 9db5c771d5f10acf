"""The search for the free ray one cone after another finds what all pairs of edges do, to the last bit."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from onboard.core.geometry.cones import Cone, Ray, blocked_cones, is_free, pitch_cones
from onboard.core.geometry.edges import by_pairs, of_many, one_by_one
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, ZERO, Vec, norm, scale, sub, unit

KINDS = ("anywhere", "on a lattice", "on a ring")


def place(kind: str, rng: np.random.Generator, k: int, tilt: float) -> Vec:
    """Where pursuer k stands: rings have equal angles between their members, and lattices many equal ones."""
    if kind == "anywhere":
        way = unit(Vec(*map(float, rng.standard_normal(3))), NORTH)
        return scale(way, float(rng.uniform(5.0, 200.0)))
    if kind == "on a lattice":
        found = Vec(*map(float, 20.0 * rng.integers(-2, 3, 3)))
        return found if norm(found) > 0.0 else Vec(20.0, 0.0, 0.0)
    turn = 0.4 * pi * k
    return scale(Vec(cos(tilt), sin(tilt) * cos(turn), sin(tilt) * sin(turn)), 50.0)


def situations(kind: str, count: int) -> list[tuple[tuple[Cone, ...], Vec]]:
    """Cones, and a direction that lies in one of them: any, north, the axis of a cone, between two axes."""
    rng = np.random.default_rng(len(kind))
    found = []
    while len(found) < count:
        gamma, tilt = float(rng.choice([0.1, 0.3, 0.5, 0.8, 0.95])), float(rng.choice([0.3, 0.6, 1.0, 2.4]))
        size = int(rng.integers(1, 8))
        team = tuple(Vehicle(place(kind, rng, k, tilt), ZERO, 5.0 * gamma) for k in range(size))
        cones = blocked_cones(Vehicle(ZERO, ZERO, 5.0), team, 4.0)
        if rng.random() < 0.3:
            cones = (*cones, *pitch_cones(VehicleLimits(pitch_min=-0.35, pitch_max=0.35)))
        any_way = unit(Vec(*map(float, rng.standard_normal(3))), NORTH)
        middle = unit(Vec(*map(sum, zip(cones[0].axis, cones[-1].axis, strict=True))), NORTH)
        preferred = (any_way, NORTH, cones[0].axis, middle)[int(rng.integers(4))]
        if not is_free(preferred, cones):
            found.append((cones, preferred))
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_of_few_cones_it_is_the_same_ray_even_where_several_are_as_near(kind: str) -> None:
    cases = situations(kind, 1500)
    assert [case for case in cases if tuple(one_by_one(*case)) != tuple(by_pairs(*case))] == []
    assert kind == "on a ring" or sum(not by_pairs(*case).exists for case in cases) > 20


def apart(a: Ray, b: Ray) -> float:
    """How far the ends of two rays are from each other."""
    return norm(sub(a.direction, b.direction))


def test_without_a_look_for_rays_as_near_it_may_be_another_of_them() -> None:
    cases = situations("on a ring", 1500)
    pairs = [(of_many(*case), by_pairs(*case)) for case in cases]
    assert all(a.exists == b.exists and abs(a.closeness - b.closeness) < 1e-12 for a, b in pairs)
    assert any(apart(a, b) > 0.1 for a, b in pairs)
