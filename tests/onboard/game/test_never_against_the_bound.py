"""Nothing claims a capture that the bound forbids: random situations, the bound from first principles.

A pursuer of speed ratio γ < 1 at a distance d blocks headings over an angle of 2 (asin γ + asin(R/d)) and no
more: flights straight on beyond it are never met. So where these angles do not add up to a turn, some heading
is free, whatever the pursuers do, and nobody may be told that the band is closed or that it is a go.
"""

from __future__ import annotations

from math import asin, hypot, pi, radians

import msgspec
import numpy as np
import pytest

from onboard.config.strict import ConfigError
from onboard.core.game.rules import Rules, Target
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import Vec
from onboard.core.strategy.team.closure import way_out
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Situation
from onboard.core.strategy.team.planner import no_plan, plan
from onboard.game.odds import Chances, Estimate, Odds, judgement, odds
from sim_bridge.campaign.spatial_draw import spatial
from sim_bridge.programs.scenario_band import staged


def drawn(rng: np.random.Generator, planar: bool) -> Situation:
    """One to eight pursuers anywhere about an evader; in space aircraft at heights of their own."""
    scale = 1.0 if planar else 25.0
    v = 5.0 if planar else 50.0
    limits = VehicleLimits() if planar else VehicleLimits(0.8 * v, v, -0.35, 0.35, turn_rate=radians(4.5))
    ring = rng.random() < 0.5  # the hardest to tell: all round, evenly
    count = int(rng.integers(1, 9))
    phase, out = rng.uniform(-pi, pi), scale * rng.uniform(20.0, 120.0)
    members = []
    for k in range(count):
        a = phase + 2.0 * pi * k / count if ring else rng.uniform(-pi, pi)
        r = out if ring else scale * rng.uniform(20.0, 120.0)
        up = 0.0 if planar else rng.uniform(-300.0, 300.0)
        u = v * rng.uniform(0.3, 0.95)
        place = Vec(float(r * np.cos(a)), float(r * np.sin(a)), -1500.0 * (not planar) - up)
        nose = Vec(float(-u * np.cos(a)), float(-u * np.sin(a)), 0.0)
        members.append(Member(Vehicle(place, nose, u), limits._replace(speed_min=0.8 * u, speed_max=u), True))
    middle = Vec(0.0, 0.0, -1500.0 * (not planar))
    rules = Rules(2.0 * scale if planar else 25.0, 4.0 if planar else 88.0, horizon=300.0, planar=planar)
    target = Target(True, Vec(scale * 150.0, 0.0, middle.z))
    evader = Vehicle(middle, Vec(v, 0.0, 0.0), v)
    return Situation(
        0.0, 0.0, evader, limits, tuple(members), target, Vec(0.0, 0.0, 0.0), rules, Heights(), Margin(),
        middle, 10.0 * rules.rho,
    )  # fmt: skip


def blocked(s: Situation) -> float:
    """The most of the level headings that all pursuers together can block [rad]."""
    total = 0.0
    for member in s.team:
        far = hypot(member.vehicle.position.x, member.vehicle.position.y)
        total += 2.0 * (asin(member.vehicle.speed / s.evader.speed) + asin(min(1.0, s.rules.R / far)))
    return total


@pytest.mark.parametrize("planar", [True, False])
def test_nothing_is_closed_and_nothing_a_go_where_a_heading_must_be_free(planar: bool) -> None:
    rng = np.random.default_rng(int(planar))
    few = 0
    for _ in range(120):
        s = drawn(rng, planar)
        if blocked(s) >= 2.0 * pi:
            continue
        few += 1
        way = way_out(s)
        assert not way.closed
        assert way.gap > 0.0
        assert not plan(s, no_plan(s.team, s.now)).band.closed
        assert judgement(odds(s, changes=False), len(s.team)) != "go"
    assert few > 30


@pytest.mark.parametrize("count", [1, 2, 3])
def test_no_scenario_is_staged_with_fewer_than_the_bound(count: int) -> None:
    """Three level pursuers of γ = 0.8 block 3 · 106° of level headings, but not those at a pitch of 20°."""
    base = spatial("five")
    few = msgspec.structs.replace(base, pursuers=base.pursuers[:count])
    with pytest.raises(ConfigError, match="bound"):
        staged(few, 120.0)


@pytest.mark.parametrize(
    ("closed", "needed", "count", "word"),
    [(False, 4, 3, "open"), (False, 0, 9, "open"), (False, 4, 4, "go"), (True, 4, 3, "go")],
)
def test_no_chance_is_a_go_where_the_bound_forbids_it(
    closed: bool, needed: int, count: int, word: str
) -> None:
    sure = Estimate(0.97, 0.93, 0.99)
    found = Odds(needed, closed, 0.1, {"paper": Chances(sure, sure)}, "", ())
    assert judgement(found, count) == word
