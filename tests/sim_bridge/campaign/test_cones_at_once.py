"""Compiled cones, whose roots are drawn by vector instructions, are those of one pursuer after another."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.geometry.cones import Seen, blocked_cone, blocked_cones, cones_at_once
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec
from sim_bridge.campaign.compiled import register
from sim_bridge.campaign.kernel_cache import kernel

RHO = 4.0  # [m]


def vehicle(rng: np.random.Generator, spread: float) -> Vehicle:
    """A vehicle in the middle, within ρ or far off; at rest, slower, as fast or faster than 5 m/s."""
    place = spread * rng.standard_normal(3)
    return Vehicle(Vec(*map(float, place)), Vec(1.0, 0.0, 0.0), float(rng.choice([0.0, 2.0, 4.0, 5.0, 6.0])))


@pytest.mark.parametrize("count", [1, 5, 9])
def test_cones_at_once_are_the_cones_of_each_to_the_last_bit(count: int) -> None:
    register()
    compiled = kernel(lambda own, team, rho: blocked_cones(own, team, rho), error_model="numpy")
    rng = np.random.default_rng(count)
    for _ in range(40):
        own = Vehicle(vehicle(rng, 10.0).position, Vec(1.0, 0.0, 0.0), 5.0)
        team = tuple(vehicle(rng, float(rng.choice([0.0, 1.0, 30.0]))) for _ in range(count))
        team = (*team[:-1], Vehicle(own.position, own.velocity, 4.0)) if rng.random() < 0.2 else team
        seen = Seen(own.position, own.speed, RHO)
        one_by_one = tuple(blocked_cone(one, k, seen) for k, one in enumerate(team))
        assert blocked_cones(own, team, RHO) == one_by_one
        assert cones_at_once(team, seen) == one_by_one
        assert compiled(own, team, RHO) == one_by_one
