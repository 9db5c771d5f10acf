"""The evader beyond the paper, against what its rules promise: checked by flying, not by their formulas."""

from __future__ import annotations

from math import asin, atan2, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest

from onboard.core.game.rules import NO_TARGET, Rules, Target
from onboard.core.game.views import EvaderView, evader_view, with_limits
from onboard.core.math.states import FREE, Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.knowledge import RuleId
from onboard.core.strategy.registry import EVADERS

RULES = Rules(R=2.0, rho=4.0, planar=True)
AIR = Rules(R=25.0, rho=88.0, planar=True)
SLOW = VehicleLimits(40.0, 50.0, turn_rate=0.0785)  # an aircraft that turns at 4.5 deg/s


def at(x: float, y: float, speed: float, yaw: float = 0.0) -> Vehicle:
    return Vehicle(Vec(x, y, 0.0), Vec(speed * cos(yaw), speed * sin(yaw), 0.0), speed)


def seen(
    own: Vehicle, team: tuple[Vehicle, ...], rules: Rules, limits: VehicleLimits = FREE, goal: float = 0.0
) -> EvaderView:
    target = Target(True, Vec(goal, 0.0, 0.0)) if goal else NO_TARGET
    view = evader_view(own, limits, team, target, ZERO, rules)
    return with_limits(view, (limits,) * len(team))


def sides(name: str) -> int:
    """How often an evader changes the side on which it passes a pursuer that sways before its target."""
    decide = EVADERS[name].decide
    changes, x, y, yaw, last = 0, 0.0, 0.0, 0.0, 0.0
    for k in range(40):
        sway = 0.4 if k % 8 < 4 else -0.4
        decision = decide(seen(at(x, y, 5.0, yaw), (at(200.0, y + sway, 4.0, pi),), RULES, FREE, 400.0))
        yaw = atan2(decision.direction.y, decision.direction.x)
        changes += last * sin(yaw) < 0.0
        last = sin(yaw)
        x += 0.1 * 5.0 * cos(yaw)
    return changes


def test_an_evader_that_counts_its_turns_keeps_its_side() -> None:
    assert sides("paper") >= 8
    assert sides("hysteresis") == 0


def test_a_ray_that_is_better_by_more_than_its_turn_is_taken() -> None:
    """The pursuer stands 0.9 rad to the right of the goal, the evader flies far to its right."""
    view = seen(at(0.0, 0.0, 5.0, 1.6), (at(60.0 * cos(0.9), 60.0 * sin(0.9), 4.0),), RULES, FREE, 400.0)
    decision = EVADERS["hysteresis"].decide(view)
    assert decision.rule == RuleId.STEADY_RAY_TO_TARGET
    assert decision.direction.y < 0.0


def encircled(seed: int) -> tuple[Vehicle, ...]:
    rng = np.random.default_rng(seed)
    yaws = 2.0 * pi * np.arange(5) / 5 + rng.normal(0.0, 0.5, 5)
    return tuple(at(d * cos(a), d * sin(a), 4.0) for a, d in zip(yaws, rng.uniform(15, 60, 5), strict=True))


def test_two_legs_are_safe_whatever_the_pursuers_do() -> None:
    """By the definition of reach alone: at no time a pursuer could have come within ρ, on neither leg."""
    times = np.linspace(0.0, 200.0, 2001)
    for seed in (22, 35, 55, 102, 110, 228):  # where two legs are the way out
        team = encircled(seed)
        decision = EVADERS["two-leg"].decide(seen(at(0.0, 0.0, 5.0), team, RULES, FREE, 100.0))
        assert decision.rule == RuleId.TWO_LEGS
        legs = times[times <= decision.time]
        for p in team:
            off = np.hypot(decision.direction.x * 5.0 * legs - p.position.x,
                           decision.direction.y * 5.0 * legs - p.position.y)  # fmt: skip
            assert np.all(off - 4.0 * legs >= RULES.rho - 1e-6)
        yaws = np.linspace(-pi, pi, 1440)[:, None]
        safe = np.ones(len(yaws), bool)
        for p in team:
            x = decision.aim.x + np.cos(yaws) * 5.0 * times - p.position.x
            y = decision.aim.y + np.sin(yaws) * 5.0 * times - p.position.y
            safe &= np.all(np.hypot(x, y) - 4.0 * (decision.time + times) >= RULES.rho - 0.02, axis=1)
        assert safe.any(), seed


def chased(name: str, bearings: tuple[float, ...], far: float) -> float:
    """The smallest distance to aircraft that keep their bearing, both sides turning at 4.5 deg/s at most."""
    decide = EVADERS[name].decide
    x, y, yaw = 0.0, 0.0, 0.0
    team = [[far * cos(b), far * sin(b), b + pi] for b in bearings]
    smallest, dt = 1e9, 0.25
    for _ in range(240):
        vehicles = tuple(at(px, py, 40.0, a) for px, py, a in team)
        d = decide(seen(at(x, y, 50.0, yaw), vehicles, AIR, SLOW, 6000.0)).direction
        yaw += float(np.clip(np.angle(np.exp(1j * (atan2(d.y, d.x) - yaw))), -0.0785 * dt, 0.0785 * dt))
        x, y = x + 50.0 * dt * cos(yaw), y + 50.0 * dt * sin(yaw)
        for one in team:
            rx, ry = x - one[0], y - one[1]
            sight = atan2(ry, rx)
            cross = 50.0 * sin(yaw - sight)
            wanted = sight + (asin(cross / 40.0) if abs(cross) < 40.0 else 0.5 * pi * np.sign(cross))
            one[2] += float(np.clip(np.angle(np.exp(1j * (wanted - one[2]))), -0.0785 * dt, 0.0785 * dt))
            one[0], one[1] = one[0] + 40.0 * dt * cos(one[2]), one[1] + 40.0 * dt * sin(one[2])
            smallest = min(smallest, hypot(x - one[0], y - one[1]))
    return smallest


@pytest.mark.parametrize("phase", [0.1, 0.3, 0.9])
def test_an_early_dodge_undoes_a_ring_of_aircraft(phase: float) -> None:
    ring = tuple(phase + 2.0 * pi * k / 5 for k in range(5))
    assert chased("paper", ring, 2000.0) < AIR.R
    for name in ("dodge", "evasive"):
        assert chased(name, ring, 2000.0) > 2.0 * AIR.R, name


def test_straight_at_a_pursuer_of_the_ring_only_the_played_turn_gets_through() -> None:
    """Across its line of sight both sides of the ring are alike, and the dodge meets the next one."""
    ring = tuple(2.0 * pi * k / 5 for k in range(5))
    assert chased("paper", ring, 2000.0) < AIR.R
    assert chased("evasive", ring, 2000.0) > 2.0 * AIR.R


def test_what_gains_nothing_across_is_not_dodged() -> None:
    """Pursuers that turn at once: the way across leads nowhere, and the rule is silent."""
    team = tuple(at(60.0 * cos(a), 60.0 * sin(a), 4.0, a + pi) for a in np.arange(5) * 2.0 * pi / 5)
    decision = EVADERS["dodge"].decide(seen(at(0.0, 0.0, 5.0), team, RULES, FREE, 100.0))
    assert decision.rule == RuleId.RESULTANT_FORCE_TO_TARGET


def test_limits_hold_for_every_way_out() -> None:
    """In space, at pitches within the limits and of unit length, whatever the situation."""
    limits = VehicleLimits(40.0, 50.0, pitch_min=-0.35, pitch_max=0.35, turn_rate=0.0785)
    rules = Rules(R=25.0, rho=88.0)
    rules_seen = set()
    for seed in range(30):
        rng = np.random.default_rng(seed)
        team = []
        for k in range(6):
            a, d = 2.0 * pi * k / 6 + rng.normal(0.0, 0.2), rng.uniform(300.0, 2500.0)
            place = Vec(d * cos(a), d * sin(a), float(rng.normal(0.0, 100.0)))
            team.append(Vehicle(place, Vec(-40.0 * cos(a), -40.0 * sin(a), 0.0), 40.0))
        for name in ("hysteresis", "two-leg", "dodge", "evasive"):
            decision = EVADERS[name].decide(seen(at(0.0, 0.0, 50.0), tuple(team), rules, limits, 6000.0))
            x, y, z = decision.direction
            assert sqrt(x * x + y * y + z * z) == pytest.approx(1.0)
            assert abs(asin(-z)) <= 0.35 + 1e-9
            rules_seen.add(decision.rule)
    assert {RuleId.PLAYED, RuleId.DODGE} <= rules_seen
