"""A relation and a rule for a team: two who are near the evader leave the target to go for it.

In kernel style (floats, NamedTuples, plain functions, no None), so that campaigns compile it too.
"""

from __future__ import annotations

from onboard.core.math.vectors import distance
from onboard.core.strategy.semantic.goals import GoalRule
from onboard.core.strategy.semantic.graph import NONE, Edge, Held, Node, Relation, Scene
from onboard.core.strategy.team.plan_types import Choice, Goal

NEAR = 101  # numbers of one's own begin at 100
ENGAGE = 101
REACH = 10.0  # safety distances ρ within which a pursuer is near
ENOUGH = 2


def near(scene: Scene, index: int, _evader: int) -> Held:
    """The pursuer is near the evader: 1 beside it, 0 from ten safety distances on."""
    s = scene.situation
    far = distance(s.team[index].vehicle.position, s.evader.position)
    reach = REACH * s.rules.rho
    if not s.team[index].fit or far >= reach:
        return NONE
    return Held(1.0 - far / reach, far)


def engage(_scene: Scene, edges: list[Edge]) -> Choice:
    """Enough are near: chase. Else the rule is silent, and the next one is asked."""
    count = 0
    for edge in edges:
        if edge.relation == NEAR:
            count += 1
    if count < ENOUGH:
        return Choice(Goal.NONE, 0, -1, 0.0)
    return Choice(Goal.CHASE, ENGAGE, -1, 1.0)


RELATIONS = (Relation(NEAR, "near", "{a} is {value:.0f} m from {b}", Node.PURSUER, Node.EVADER, near),)
GOALS = (GoalRule(ENGAGE, "engage", "two are near the evader", "chase", engage),)
