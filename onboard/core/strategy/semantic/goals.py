"""What a team is after: ordered rules over what holds. The first that fires speaks.

A rule is asked of the scene and of its edges and answers with a `Choice`; `fold_goals` makes one function of
a table, as `fold` does of a strategy's. Kernel style.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from onboard.core.strategy.denial import stands
from onboard.core.strategy.semantic.graph import Edge, Scene, strength_of, strongest
from onboard.core.strategy.semantic.relations import COVERS, ENCLOSES, FREE, REACHES, THREATENS
from onboard.core.strategy.team.plan_types import Choice, Goal, target_count

WIDE = 0.5  # [rad] in space a band open by less may close in the chase: nobody leaves it for the target
SEVERAL = 2  # targets


# Numbers of the table's own rules; those of users are `CUSTOM` and above.
SETS_OUT, ENCLOSED, NEARLY_ENCLOSED, SEVERAL_TARGETS, HOPELESS_CHASE, TARGET_REACHED, NOBODY_IN_TIME = (
    1, 2, 3, 4, 5, 6, 7,
)  # fmt: skip
CUSTOM = 100

Choose = Callable[[Scene, list[Edge]], Choice]


class GoalRule(NamedTuple):
    """One row of the table of goals."""

    id: int
    name: str
    when: str  # the condition, in words
    then: str  # the goal, in words
    apply: Choose


SILENT = Choice(Goal.NONE, 0, -1, 0.0)


def enclosed(scene: Scene, edges: list[Edge]) -> Choice:
    """The band is closed."""
    if not scene.closed:
        return SILENT
    return Choice(Goal.HOLD, ENCLOSED, 0, strength_of(edges, ENCLOSES, 0, 0))


def nearly_enclosed(scene: Scene, edges: list[Edge]) -> Choice:
    """There is a target, but the band is open by little: it closes in the chase."""
    rules = scene.situation.rules
    if target_count(scene.situation) == 0 or (scene.way.gap > (0.0 if rules.planar else WIDE) and scene.free):
        return SILENT
    strength = strength_of(edges, ENCLOSES, 0, 0)
    return Choice(Goal.TIGHTEN, NEARLY_ENCLOSED, 0, strength)


def several_targets(scene: Scene, edges: list[Edge]) -> Choice:
    """More than one target is known, and somebody is in time for one: all are to be held to the end."""
    first = strongest(edges, THREATENS)
    if target_count(scene.situation) < SEVERAL or strongest(edges, REACHES).source < 0:
        return SILENT
    return Choice(Goal.DENY_ALL, SEVERAL_TARGETS, first.sink, first.strength)


def hopeless_chase(scene: Scene, edges: list[Edge]) -> Choice:
    """Somebody covers the target, and the evader has a free ray: no chase forces a capture.

    Who cannot stand, or has to come off the target's middle, has two posts there anyway.
    """
    s, first = scene.situation, strongest(edges, COVERS)
    if first.sink < 0 or not scene.free:
        return SILENT
    if not stands(s.team[first.source].limits) or s.rules.epsilon_min > s.rules.R:
        return SILENT
    return Choice(Goal.DENY_IN_DEPTH, HOPELESS_CHASE, first.sink, first.strength)


def target_reached(_scene: Scene, edges: list[Edge]) -> Choice:
    """Somebody is at the target before the evader, or nearly so."""
    first = strongest(edges, REACHES)
    if first.sink < 0:
        return SILENT
    return Choice(Goal.DENY, TARGET_REACHED, first.sink, first.strength)


def nobody_in_time(_scene: Scene, edges: list[Edge]) -> Choice:
    """Nothing better is known."""
    way = strongest(edges, FREE)
    return Choice(Goal.CHASE, NOBODY_IN_TIME, -1, way.strength)


def _row(id: int, when: str, then: str, apply: Choose) -> GoalRule:
    return GoalRule(id, apply.__name__, when, then, apply)


GOALS: tuple[GoalRule, ...] = (
    _row(ENCLOSED, "the band is closed", "hold the ring", enclosed),
    _row(NEARLY_ENCLOSED, "the band is open by so little that the chase closes it",
         "tighten the ring", nearly_enclosed),
    _row(SEVERAL_TARGETS, "more than one target is known", "deny every target", several_targets),
    _row(HOPELESS_CHASE, "the target is covered, and a chase of an evader with a free ray forces nothing",
         "deny it in depth: another comes to the target", hopeless_chase),
    _row(TARGET_REACHED, "somebody is at the target before the evader, or nearly",
         "deny the target", target_reached),
    _row(NOBODY_IN_TIME, "nothing else holds", "chase", nobody_in_time),
)  # fmt: skip


def first_goal(rule: Choose, rest: Choose) -> Choose:
    """The function that asks `rule`, and `rest` where it is silent."""

    def chosen(scene: Scene, edges: list[Edge]) -> Choice:
        choice = rule(scene, edges)
        if choice.goal != Goal.NONE:
            return choice
        return rest(scene, edges)

    return chosen


def fold_goals(table: tuple[GoalRule, ...]) -> Choose:
    """A whole table as one function."""
    choose = table[-1].apply
    for rule in table[-2::-1]:
        choose = first_goal(rule.apply, choose)
    return choose
