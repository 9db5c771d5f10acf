"""A team's plan: a ring before the game, nobody leaves a closed one, posts at a known target, hand-over."""

from __future__ import annotations

from math import cos, hypot, inf, pi, radians, sin

import pytest

from onboard.core.game.rules import Rules, Target
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, distance
from onboard.core.strategy.team.plan_types import (
    NOBODY,
    Heights,
    Margin,
    Member,
    Reason,
    Role,
    Situation,
)
from onboard.core.strategy.team.planner import no_plan, plan

LIMITS = VehicleLimits(40.0, 50.0, radians(-20.0), radians(20.0), turn_rate=radians(4.5))
HEIGHT = Vec(0.0, 0.0, -1500.0)


def situation(bearings: list[float], far: float, now: float, known: bool = True) -> Situation:
    """Aircraft of 40 m/s at bearings [rad] around one of 50 m/s that flies north; t₀ is at 120 s."""
    evader = Vehicle(HEIGHT, Vec(50.0, 0.0, 0.0), 50.0)
    team = tuple(
        Member(
            Vehicle(Vec(far * cos(b), far * sin(b), -1500.0), Vec(-40.0 * cos(b), -40.0 * sin(b), 0.0), 40.0),
            LIMITS,
            True,
        )
        for b in bearings
    )
    rules = Rules(25.0, 88.0, horizon=400.0, separation=100.0)
    target = Target(known, Vec(6000.0, 0.0, -1500.0))
    return Situation(
        now, 120.0, evader, LIMITS, team, target, ZERO, rules, Heights(300.0, 3000.0), Margin(0.1, 5.0),
        evader.position, 1500.0,
    )  # fmt: skip


def ring(n: int, phase: float = 0.2) -> list[float]:
    return [phase + 2.0 * pi * k / n for k in range(n)]


def without(s: Situation, index: int) -> Situation:
    team = tuple(m._replace(fit=False) if i == index else m for i, m in enumerate(s.team))
    return s._replace(team=team)


def test_before_t0_everybody_has_a_slot_far_enough_out_and_one_is_in_front() -> None:
    s = situation([0.3, 0.5, 0.9, -0.4, -0.8], 2500.0, 0.0)
    made = plan(s, no_plan(s.team, 0.0))
    assert [part.role for part in made.assignments] == [Role.RING] * 5
    assert all(part.due == 120.0 for part in made.assignments)
    for part, member in zip(made.assignments, s.team, strict=True):
        assert distance(part.aim, HEIGHT) >= 1500.0 - 1e-6
        assert distance(part.aim, member.vehicle.position) <= 40.0 * 120.0
    bearings = [(part.aim.y, part.aim.x) for part in made.assignments]
    assert min(abs(y) / hypot(x, y) for y, x in bearings if x > 0.0) < 1e-6


def test_slots_are_kept_while_the_team_is_what_it_was_and_handed_over_when_one_is_lost() -> None:
    s = situation([0.3, 0.5, 0.9, -0.4, -0.8, 3.0], 2500.0, 0.0)
    first = plan(s, no_plan(s.team, 0.0))
    later = s._replace(now=10.0)
    assert plan(later, first).assignments == first.assignments
    lone = without(later, 1)
    after = plan(lone, first)
    assert after.assignments[1].role == Role.RESERVE
    assert after.assignments[1].reason == Reason.LOST
    others = [part for i, part in enumerate(after.assignments) if i != 1]
    assert all(part.role == Role.RING for part in others)
    assert [p.aim for p in others] != [p.aim for i, p in enumerate(first.assignments) if i != 1]


def test_nobody_leaves_a_closed_ring_though_the_target_is_known() -> None:
    s = situation(ring(5), 2000.0, 120.0)
    made = plan(s, no_plan(s.team, 120.0))
    assert made.band.closed
    assert {(part.role, part.reason) for part in made.assignments} == {(Role.CHASER, Reason.ENCLOSED)}
    broken = plan(without(s, 2), made)
    assert not broken.band.closed
    assert Role.GOALKEEPER in {part.role for part in broken.assignments}


def test_an_open_band_says_where_who_and_when() -> None:
    s = situation([0.0, 1.5, 3.0, -2.2], 2000.0, 120.0, known=False)
    made = plan(s, no_plan(s.team, 120.0))
    assert not made.band.closed
    assert made.band.bearing == pytest.approx(-1.1, abs=0.05)  # their noses are not alike
    assert 0.0 < made.band.gap < 1.0
    assert made.band.closer in (0, 3)
    assert 120.0 < made.band.closes < 180.0
    assert all(part.reason == Reason.NO_GAP_IN_REACH for part in made.assignments)
    few = situation(ring(3), 2000.0, 120.0)
    three = plan(few, no_plan(few.team, 120.0)).band
    assert (three.closer, three.closes) == (NOBODY, inf)


def test_posts_go_to_who_is_there_first_and_stay_with_them() -> None:
    s = situation([0.3, -0.3, 3.0, -3.0], 3000.0, 120.0)
    made = plan(s, no_plan(s.team, 120.0))
    assert sorted(part.role for part in made.assignments[:2]) == [Role.GOALKEEPER, Role.BLOCKER]
    assert [part.role for part in made.assignments[2:]] == [Role.CHASER] * 2
    keeper = next(p for p in made.assignments if p.role == Role.GOALKEEPER)
    goal = s.target.position
    assert distance(keeper.aim, HEIGHT) < distance(goal, HEIGHT)
    assert plan(s._replace(now=120.5), made).assignments[0].role == made.assignments[0].role


def test_nobody_leaves_a_band_for_the_target_that_is_open_by_little() -> None:
    s = situation([0.3, -0.3, 2.5, -2.5], 3000.0, 120.0)
    made = plan(s, no_plan(s.team, 120.0))
    assert 0.0 < made.band.gap < 0.5
    assert {part.role for part in made.assignments} == {Role.CHASER}
