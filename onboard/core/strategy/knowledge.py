"""The knowledge base: ordered tables of named rules, folded into one function a strategy.

A table is read from the top: the first rule whose condition holds speaks. `fold` turns the
table into one function (`first(rule, rest)`), so that the table a reader sees is the program
that both the interpreted and the compiled mode run.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import Generic, NamedTuple, TypeVar

from onboard.core.math.each import new
from onboard.core.math.vectors import Vec

View = TypeVar("View", contravariant=True)


class RuleId(IntEnum):
    """Every rule there is; 0 means that none fired."""

    NONE = 0
    FREE_RAY_TO_TARGET = 1
    FREE_RAY_FROM_PURSUERS = 2
    RESULTANT_FORCE_TO_TARGET = 3
    RESULTANT_FORCE = 4
    STRAIGHT_TO_TARGET = 5
    STRAIGHT_ON = 6
    KEEP_OFF_MATE = 10
    INTERCEPT = 11
    CLOSEST_APPROACH = 12
    PARALLEL = 13
    PREDICTED_PLACE = 14
    STRAIGHT_AT_EVADER = 15
    PURE_PURSUIT = 16
    PARALLEL_PURSUIT = 17
    PROPORTIONAL_NAVIGATION = 18
    POINT_BY_POINT = 19
    KEEP_GOAL = 20
    HOLD_LINE = 21
    STEADY_RAY_TO_TARGET = 30
    STEADY_RAY_FROM_PURSUERS = 31
    TWO_LEGS = 32
    DODGE = 33
    PLAYED = 34
    RING_SLOT = 40
    GUARD_TARGET = 41
    BLOCK_CORRIDOR = 42
    ABREAST = 43
    ROUND_ZONE = 50
    LEAVE_ZONE = 51
    CUSTOM = 100


class Level(IntEnum):
    """Level of the intelligent-geometric architecture (Figure 1)."""

    STRATEGIC = 1
    TACTICAL = 2
    EXECUTIVE = 3


STRATEGIC = (
    RuleId.KEEP_GOAL, RuleId.HOLD_LINE, RuleId.RING_SLOT, RuleId.GUARD_TARGET, RuleId.BLOCK_CORRIDOR,
    RuleId.ABREAST,
)  # rules that place a pursuer for its team  # fmt: skip


def level_of(rule: RuleId) -> Level:
    """The level on which a rule speaks: what places a pursuer for its team is strategic, else tactical."""
    return Level.STRATEGIC if rule in STRATEGIC else Level.TACTICAL


class Module(IntEnum):
    """Module of the architecture that a rule belongs to (Figure 1)."""

    INTELLIGENT = 1  # heuristic rules
    GEOMETRIC = 2  # exact optimisation


class Decision(NamedTuple):
    """What a strategy decides, and why."""

    fires: bool  # whether the rule's condition held
    direction: Vec  # unit [game frame]
    speed: float  # [m/s; air]
    rule: RuleId
    aim: Vec  # the point it heads for [m]
    time: float  # until then [s]
    miss: float  # predicted distance left then [m]


class Rule(NamedTuple, Generic[View]):
    """One row of the knowledge base."""

    id: RuleId
    when: str  # the condition, in words
    then: str  # the action, in words
    source: str  # where the paper says so
    module: Module
    apply: Callable[[View], Decision]


def first(
    rule: Callable[[View], Decision], rest: Callable[[View], Decision]
) -> Callable[[View], Decision]:
    """The function that asks `rule`, and `rest` where it does not fire."""

    def either(view: View) -> Decision:
        decision = rule(view)
        if decision.fires:
            return decision
        return rest(view)

    return either


def fold(table: tuple[Rule[View], ...]) -> Callable[[View], Decision]:
    """The whole table as one function; the last rule's answer stands where none fires."""
    decide = table[-1].apply
    for rule in table[-2::-1]:
        decide = first(rule.apply, decide)
    return decide


def silent(direction: Vec, aim: Vec) -> Decision:
    """What a rule answers that does not fire."""
    return new(Decision, (False, direction, 0.0, RuleId.NONE, aim, 0.0, 0.0))
