"""How a pursuer flies its part of the team's plan: the table `TEAM` of the knowledge base.

A chaser pursues; the others go to their aim. Who has no part, or has not heard of a plan for long, chases.
Kernel style.
"""

from __future__ import annotations

from onboard.core.game.views import PursuerView
from onboard.core.geometry.cones import within
from onboard.core.math.vectors import TINY, Vec, distance, sub, unit
from onboard.core.strategy.knowledge import Decision, Module, Rule, RuleId, fold, silent
from onboard.core.strategy.pursuit import BEARING
from onboard.core.strategy.team.plan_types import Role

NEAR = 1.5  # turning radii, or safety distances ρ, from its aim within which a pursuer circles or waits


def to_aim(view: PursuerView, rule: RuleId) -> Decision:
    """Straight to the aim of the part; there who can stand waits, and who cannot circles it."""
    own, aim = view.own, view.part.aim
    line = sub(aim, own.position)
    if view.rules.planar:
        line = Vec(line.x, line.y, 0.0)
    far = distance(line, Vec(0.0, 0.0, 0.0))
    ahead = unit(line, view.heading)
    speed = own.speed
    turn = view.limits.turn_rate
    radius = own.speed / turn if turn > TINY else 0.0
    if view.limits.speed_min <= 0.0:
        speed = min(speed, far / max(view.control.dt, TINY))
    elif far < NEAR * radius:
        flat = unit(Vec(line.x, line.y, 0.0), ahead)
        inward = far / radius - 1.0
        ahead = unit(Vec(-flat.y + inward * flat.x, flat.x + inward * flat.y, line.z / radius), ahead)
    time = far / own.speed if own.speed > TINY else 0.0
    return Decision(True, within(ahead, view.limits, view.rules.planar), speed, rule, aim, time, 0.0)


def to_slot(view: PursuerView) -> Decision:
    """A slot of the ring."""
    if view.part.role != Role.RING:
        return silent(view.heading, view.own.position)
    return to_aim(view, RuleId.RING_SLOT)


def keep_goal(view: PursuerView) -> Decision:
    """The goalkeeper's post."""
    if view.part.role != Role.GOALKEEPER:
        return silent(view.heading, view.own.position)
    return to_aim(view, RuleId.GUARD_TARGET)


def block(view: PursuerView) -> Decision:
    """The blocker's post."""
    if view.part.role != Role.BLOCKER:
        return silent(view.heading, view.own.position)
    return to_aim(view, RuleId.BLOCK_CORRIDOR)


def _row(rule: RuleId, when: str, then: str, apply: object) -> Rule[PursuerView]:
    return Rule(rule, when, then, "2.2; conclusions", Module.INTELLIGENT, apply)  # type: ignore[arg-type]


TEAM: tuple[Rule[PursuerView], ...] = (
    BEARING[0],
    _row(RuleId.RING_SLOT, "the plan gives it a slot of the ring", "to its slot", to_slot),
    _row(RuleId.GUARD_TARGET, "the plan makes it goalkeeper", "to its post at the target", keep_goal),
    _row(RuleId.BLOCK_CORRIDOR, "the plan makes it blocker", "to its post beside the keeper's", block),
    *BEARING[1:],
)

pursuer_team = fold(TEAM)
