"""The plan of a team: from everybody's place to a part for each pursuer, with its reason.

Before the evader sets out: a ring that closes its band when it does. After that the team's goal comes from
its knowledge model (`strategy/semantic`), and the parts from the goal: nobody leaves a closed ring; while the
band is open and a target is known, who is there before the evader guards it, and the others chase. A plan
follows from the situation and the plan before, and from nothing else. Kernel style but for local lists.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from onboard.core.math.each import each
from onboard.core.strategy.semantic.goals import SETS_OUT, fold_goals
from onboard.core.strategy.semantic.graph import Scene, knowing
from onboard.core.strategy.semantic.model import MODEL, Model
from onboard.core.strategy.team.closure import escapes, way_out
from onboard.core.strategy.team.guarding import Duty, guarded
from onboard.core.strategy.team.parts import chasing, lost
from onboard.core.strategy.team.plan_types import (
    NO_GOAL,
    NOBODY,
    OPEN,
    Assignment,
    Band,
    Choice,
    Goal,
    Member,
    Plan,
    Reason,
    Situation,
    idle,
    target_at,
    target_count,
)
from onboard.core.strategy.team.ring import closing, staged

EVERY = 0.5  # [s] between two plans
KEEP = 0.09  # [rad] a ring that was closed counts as closed until it is open by this, in space
WIDE = 0.5  # [rad] in space a band open by less may close in the chase: nobody leaves it for the target

Planner = Callable[[Situation, Plan], Plan]


def no_plan(team: tuple[Member, ...], now: float) -> Plan:
    """The plan before the first: nobody has a part."""
    return Plan(now, each(idle, team, 0.0), OPEN, NO_GOAL)


def scene_of(s: Situation, previous: Plan) -> Scene:
    """The situation with the evader's ways out, as the knowledge model asks for it."""
    way = way_out(s)
    was = previous.band.closed and previous.time >= s.t0
    free = escapes(s)
    closed = way.closed or (was and way.gap <= KEEP and not (free and s.rules.planar))
    return Scene(s, way, free, closed, previous)


def _band(scene: Scene) -> Band:
    """The band as the plan tells it."""
    s, way = scene.situation, scene.way
    if scene.closed:
        return Band(True, way.gap, way.bearing, way.pitch, NOBODY, s.now)
    return closing(s, way)


def planner_of(model: Model) -> Planner:
    """What a team that knows this model does once the evader has set out."""
    know, choose = knowing(model.relations), fold_goals(model.goals)

    def engaged(s: Situation, previous: Plan) -> Plan:
        scene = scene_of(s, previous)
        choice = choose(scene, know(scene))
        return Plan(s.now, parts_for(scene, choice), _band(scene), choice)

    return engaged


def parts_for(scene: Scene, choice: Choice) -> tuple[Assignment, ...]:
    """Everybody's part for a goal."""
    s, goal = scene.situation, choice.goal
    if goal == Goal.DENY or goal == Goal.DENY_ALL or goal == Goal.DENY_IN_DEPTH:
        number = choice.about if 0 <= choice.about < target_count(s) else 0
        duty = Duty(goal == Goal.DENY_ALL, target_at(s, number), goal == Goal.DENY_IN_DEPTH)
        return guarded(s, scene.previous, duty)
    reason = Reason.ENCLOSED if goal == Goal.HOLD else Reason.NO_GAP_IN_REACH
    return each(_chase, s.team, _Shared(s, reason))


engaged = planner_of(MODEL)


def engaged_plainly(s: Situation, previous: Plan) -> Plan:
    """The same without a knowledge model: a team knows one target, and nothing of losses to come."""
    scene = scene_of(s, previous)
    band = _band(scene)
    if scene.closed:
        return Plan(s.now, each(_chase, s.team, _Shared(s, Reason.ENCLOSED)), band, NO_GOAL)
    if s.target.exists and scene.way.gap > (0.0 if s.rules.planar else WIDE) and scene.free:
        return Plan(s.now, guarded(s, previous, Duty(False, s.target, False)), band, NO_GOAL)
    return Plan(s.now, each(_chase, s.team, _Shared(s, Reason.NO_GAP_IN_REACH)), band, NO_GOAL)


def plan(s: Situation, previous: Plan, under_way: Planner = engaged) -> Plan:
    """What the team does from now on. `previous` is what it does now (`no_plan` where there is none)."""
    if s.now < s.t0:
        choice = Choice(Goal.RING, SETS_OUT, -1, 1.0)
        return Plan(s.now, staged(s, previous), closing(s, way_out(s)), choice)
    return under_way(s, previous)


class _Shared(NamedTuple):
    """What a chase is given with (for `each`)."""

    situation: Situation
    reason: Reason


def _chase(member: Member, _index: int, shared: _Shared) -> Assignment:
    """The chase as a part, or none for who is lost (for `each`)."""
    s = shared.situation
    if not member.fit:
        return lost(member, s.now)
    return chasing(member, s, shared.reason)
