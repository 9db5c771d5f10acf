"""How a pursuer flies its part of the team's plan: the table `TEAM` of the knowledge base.

A chaser pursues; the others go to their aim. Who has no part, or has not heard of a plan for long, chases.
Kernel style.
"""

from __future__ import annotations

from onboard.core.game.views import PursuerView
from onboard.core.strategy.denial import at_post
from onboard.core.strategy.knowledge import Decision, Module, Rule, RuleId, fold, silent
from onboard.core.strategy.pursuit import PURSUER_PARALLEL
from onboard.core.strategy.team.abreast import abreast
from onboard.core.strategy.team.plan_types import Role


def to_slot(view: PursuerView) -> Decision:
    """A slot of the ring."""
    if view.part.role != Role.RING:
        return silent(view.heading, view.own.position)
    return at_post(view, view.part.aim, RuleId.RING_SLOT)


def keep_goal(view: PursuerView) -> Decision:
    """The goalkeeper's post."""
    if view.part.role != Role.GOALKEEPER:
        return silent(view.heading, view.own.position)
    return at_post(view, view.part.aim, RuleId.GUARD_TARGET)


def block(view: PursuerView) -> Decision:
    """The blocker's post."""
    if view.part.role != Role.BLOCKER:
        return silent(view.heading, view.own.position)
    return at_post(view, view.part.aim, RuleId.BLOCK_CORRIDOR)


def _row(rule: RuleId, when: str, then: str, apply: object) -> Rule[PursuerView]:
    return Rule(rule, when, then, "2.2; conclusions", Module.INTELLIGENT, apply)  # type: ignore[arg-type]


TEAM: tuple[Rule[PursuerView], ...] = (
    PURSUER_PARALLEL[0],
    _row(RuleId.RING_SLOT, "the plan gives it a slot of the ring", "to its slot", to_slot),
    _row(RuleId.GUARD_TARGET, "the plan makes it goalkeeper", "to its post at the target", keep_goal),
    _row(RuleId.BLOCK_CORRIDOR, "the plan makes it blocker", "to its post beside the keeper's", block),
    *PURSUER_PARALLEL[1:],
)

ABREAST: tuple[Rule[PursuerView], ...] = (
    PURSUER_PARALLEL[0],
    Rule(
        RuleId.ABREAST,
        "mates come from the same side, and it is not yet on it to go for the evader",
        "to its place in their wall, a spacing beside the next",
        "answer to a dodge: ½ (ω_e v_e − ω_p v_p) t² = R",
        Module.INTELLIGENT,
        abreast,
    ),
    *PURSUER_PARALLEL[1:],
)

pursuer_team = fold(TEAM)
pursuer_abreast = fold(ABREAST)
