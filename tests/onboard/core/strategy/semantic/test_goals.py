"""What a team is after follows from what it knows; two targets are both kept; rules of one's own count."""

from __future__ import annotations

from math import cos, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.game.rules import NO_TARGET, Rules, Target
from onboard.core.math.states import FREE, Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, ZERO, Vec, along, distance, scale, sub, unit
from onboard.core.strategy.semantic.goals import CUSTOM, GOALS, GoalRule
from onboard.core.strategy.semantic.graph import Edge, Held, Node, Relation, Scene, strongest
from onboard.core.strategy.semantic.model import MODEL, extended
from onboard.core.strategy.semantic.relations import RELATIONS
from onboard.core.strategy.team.guarding import halfway
from onboard.core.strategy.team.plan_types import (
    Choice,
    Goal,
    Heights,
    Margin,
    Member,
    Plan,
    Reason,
    Role,
    Situation,
)
from onboard.core.strategy.team.planner import engaged, engaged_plainly, no_plan, plan, planner_of

RULES = Rules(2.0, 4.0, horizon=300.0, planar=True, target_known=True)


def vehicle(x: float, y: float, speed: float) -> Vehicle:
    return Vehicle(Vec(x, y, 0.0), scale(NORTH, speed), speed)


def situation(pursuers: list[Vehicle], *goals: tuple[float, float], evader: Vec = ZERO) -> Situation:
    team = tuple(Member(one, FREE, True) for one in pursuers)
    targets = tuple(Target(True, Vec(x, y, 0.0)) for x, y in goals) or (NO_TARGET,)
    return Situation(
        1.0, 0.0, Vehicle(evader, scale(NORTH, 5.0), 5.0), FREE, team, targets[0], ZERO, RULES, Heights(),
        Margin(), evader, 40.0, targets,
    )  # fmt: skip


def made(s: Situation) -> Plan:
    return engaged(s, no_plan(s.team, s.now))


RING = [vehicle(40.0 * cos(a), 40.0 * sin(a), 4.0) for a in (0.1 + 2.0 * pi * k / 5 for k in range(5))]
FAR_OFF = [vehicle(-90.0, 8.0 * k, 4.0) for k in range(3)]


def test_each_situation_has_its_goal() -> None:
    assert made(situation(RING, (150.0, 0.0))).choice.goal == Goal.HOLD
    assert made(situation(RING[:4], (150.0, 0.0))).choice.goal == Goal.DENY_IN_DEPTH
    kept = situation([vehicle(100.0, 0.0, 4.0), *FAR_OFF], (120.0, 0.0))
    assert made(kept).choice.goal == Goal.DENY_IN_DEPTH
    late = situation([vehicle(15.0, 20.0, 4.0), *FAR_OFF], (60.0, 0.0))  # in time by little, not for certain
    assert made(late).choice.goal == Goal.DENY
    assert made(situation(FAR_OFF, (150.0, 0.0))).choice.goal == Goal.CHASE
    assert made(situation(FAR_OFF)).choice.goal == Goal.CHASE
    two = situation([vehicle(100.0, 0.0, 4.0), *FAR_OFF], (120.0, 0.0), (0.0, 120.0))
    assert made(two).choice.goal == Goal.DENY_ALL
    before = two._replace(now=-5.0)
    assert plan(before, no_plan(before.team, -5.0)).choice.goal == Goal.RING


def test_of_one_target_the_parts_are_those_of_a_team_without_a_model_but_for_the_second() -> None:
    for team in (RING, RING[:4], FAR_OFF, [vehicle(100.0, 0.0, 4.0), *FAR_OFF]):
        for goal in ((120.0, 0.0), (-60.0, 30.0)):
            s = situation(team, goal)
            start = no_plan(s.team, s.now)
            one, other = engaged(s, start), engaged_plainly(s, start)
            assert one.band == other.band
            differs = [a for a, b in zip(one.assignments, other.assignments, strict=True) if a != b]
            in_depth = one.choice.goal == Goal.DENY_IN_DEPTH
            assert [part.reason for part in differs] == ([Reason.SECOND] if in_depth else [])


def test_when_the_keeper_is_lost_the_second_is_at_the_target_first() -> None:
    """Both come from behind the evader's back; without a model only one of them goes to the target."""
    team = [vehicle(100.0, 0.0, 4.0), vehicle(40.0, 60.0, 4.0), vehicle(-60.0, 0.0, 4.0)]
    s = situation(team, (110.0, 0.0))
    parts = made(s).assignments
    assert [part.role for part in parts] == [Role.GOALKEEPER, Role.BLOCKER, Role.CHASER]
    assert parts[1].reason == Reason.SECOND
    assert distance(parts[1].aim, s.target.position) <= RULES.rho + 1e-9
    lost = s._replace(team=(s.team[0]._replace(fit=False), *s.team[1:]))
    after = engaged(lost, made(s)).assignments
    assert (after[0].reason, after[1].role) == (Reason.LOST, Role.GOALKEEPER)


def test_of_two_targets_each_has_its_keeper() -> None:
    s = situation([vehicle(100.0, 5.0, 4.0), vehicle(5.0, 100.0, 4.0), *FAR_OFF], (120.0, 0.0), (0.0, 120.0))
    parts = made(s).assignments
    assert [part.role for part in parts[:2]] == [Role.GOALKEEPER, Role.GOALKEEPER]
    assert {part.aim for part in parts[:2]} == {Vec(120.0, 0.0, 0.0), Vec(0.0, 120.0, 0.0)}
    assert [part.role for part in parts[2:]] == [Role.CHASER] * 3
    plain = engaged_plainly(s, no_plan(s.team, s.now)).assignments
    assert sum(part.role == Role.GOALKEEPER for part in plain) == 1


def test_one_that_reaches_both_keeps_both_from_between_while_that_is_possible() -> None:
    """Outside the ellipse d₁ + d₂ ≥ L / γ it is in time for either target, and its place moves no faster than
    it can, whatever the evader does."""
    goals = ((120.0, 20.0), (120.0, -20.0))
    s = situation([vehicle(110.0, 0.0, 4.0), *FAR_OFF], *goals)
    part = made(s).assignments[0]
    assert (part.role, part.reason) == (Role.GOALKEEPER, Reason.BETWEEN)
    one, other = (Vec(x, y, 0.0) for x, y in goals)
    e, before = Vec(0.0, 0.0, 0.0), part.aim
    member = s.team[0]
    for k in range(400):
        aside = Vec(90.0 + 10.0 * sin(0.03 * k), 120.0 * sin(0.11 * k), 0.0)
        e = along(e, unit(sub(aside, e), NORTH), 0.5)  # 5 m/s for 0.1 s
        if distance(e, one) + distance(e, other) < distance(one, other) / 0.8:
            continue
        here = halfway(s._replace(evader=Vehicle(e, ZERO, 5.0)), member, one, other)
        assert distance(here, before) <= 4.0 * 0.1 + 1e-9
        for goal in (one, other):
            assert distance(here, goal) / 4.0 <= distance(e, goal) / 5.0 + 1e-9
        before = here


WINDY = CUSTOM + 1


def leftmost(scene: Scene, index: int, _target: int) -> Held:
    """The pursuer is west of the target."""
    s = scene.situation
    west = s.target.position.y - s.team[index].vehicle.position.y
    return Held(1.0 if west > 0.0 else 0.0, west)


def wait(_scene: Scene, edges: list[Edge]) -> Choice:
    """Chase while somebody is west of the target."""
    found = strongest(edges, WINDY)
    if found.source < 0:
        return Choice(Goal.NONE, 0, -1, 0.0)
    return Choice(Goal.CHASE, WINDY, found.source, found.strength)


WEST = Relation(WINDY, "leftmost", "{a} is {value:.0f} m west of {b}", Node.PURSUER, Node.TARGET, leftmost)
WAIT = GoalRule(WINDY, "wait", "somebody is west of the target", "chase", wait)


def test_a_relation_and_a_rule_of_ones_own_change_the_plan() -> None:
    planner = planner_of(extended((WEST,), (WAIT,)))
    for y, role in ((-10.0, Role.CHASER), (10.0, Role.GOALKEEPER)):
        s = situation([vehicle(100.0, y, 4.0)], (120.0, 0.0))
        assert engaged(s, no_plan(s.team, s.now)).assignments[0].role == Role.GOALKEEPER
        mine = planner(s, no_plan(s.team, s.now))
        assert mine.assignments[0].role == role
        assert (mine.choice.rule == WINDY) == (y < 0.0)


def test_numbers_of_ones_own_begin_at_a_hundred_and_are_given_once() -> None:
    with pytest.raises(ValueError, match="relation leftmost: found number 9, expected a free one from 100"):
        extended((WEST._replace(id=9),))
    with pytest.raises(ValueError, match="rule wait: found number 101"):
        extended((), (WAIT, WAIT))
    for table in (RELATIONS, GOALS):
        numbers = [row.id for row in table]
        assert len(set(numbers)) == len(numbers)
        assert max(numbers) < CUSTOM
    assert extended() == MODEL


@given(
    st.lists(st.tuples(st.floats(-4e3, 4e3), st.floats(-4e3, 4e3), st.floats(30.0, 49.0)), min_size=3,
             max_size=7),
    st.tuples(st.floats(-8e3, 8e3), st.floats(-8e3, 8e3)),
    st.sets(st.integers(0, 6), max_size=1),
)  # fmt: skip
@settings(max_examples=150, deadline=None)
def test_who_cannot_stand_flies_with_one_target_as_a_team_without_a_model(
    who: list[tuple[float, float, float]], goal: tuple[float, float], lost: set[int]
) -> None:
    """But for a blocker without a keeper, where nobody reaches the target itself: there all chase."""
    limits = VehicleLimits(30.0, 50.0, -0.36, 0.36, turn_rate=0.08)
    team = tuple(
        Member(Vehicle(Vec(x, y, -1500.0), Vec(v, 0.0, 0.0), v), limits, i not in lost)
        for i, (x, y, v) in enumerate(who)
    )
    evader = Vehicle(Vec(0.0, 0.0, -1500.0), Vec(50.0, 0.0, 0.0), 50.0)
    target = Target(True, Vec(*goal, -1500.0))
    s = Situation(
        1.0, 0.0, evader, limits, team, target, ZERO, Rules(25.0, 88.0, horizon=400.0, target_known=True),
        Heights(300.0, 3000.0), Margin(0.1, 5.0), evader.position, 1500.0,
    )  # fmt: skip
    mine, plain = no_plan(team, 0.5), no_plan(team, 0.5)
    for now in (1.0, 1.5):
        mine, plain = engaged(s._replace(now=now), mine), engaged_plainly(s._replace(now=now), plain)
        assert mine.band == plain.band
        if mine.assignments != plain.assignments:
            assert mine.choice.goal == Goal.CHASE
            assert Role.GOALKEEPER not in {part.role for part in plain.assignments}
            break
