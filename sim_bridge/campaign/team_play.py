"""The team's planner in a compiled game: plans at their own rate, heard late or not at all.

Kernel style but for the lists and arrays, which it changes in place.

The planner sees the evader's track as everybody does and its mates as they tell. What it plans reaches each
pursuer by a message of its own, after a delay, or is lost; who has heard nothing for long flies alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.strategy.team.plan_types import (
    IDLE,
    Assignment,
    Heights,
    Margin,
    Member,
    Plan,
)
from sim_bridge.draws import WORD, Key, threefry, uniform

Array = NDArray[np.float64]


class Planning(NamedTuple):
    """How a team plans."""

    every: int  # control steps between two plans
    delay: int  # control steps until a pursuer hears a plan; less than `every`
    loss: float  # share of the messages that are lost
    patience: int  # control steps without a plan after which a pursuer flies alone
    heights: Heights
    margin: Margin
    nearest: float  # [m] of the ring's slots to the evader
    limits: tuple[VehicleLimits, ...]  # evader first; with the turn that the aircraft can hold
    key: Key  # of the random numbers of loss


class Talk(NamedTuple):
    """What has been planned and heard. Each list is of the pursuers, but for `made`."""

    made: list[Plan]  # the planner's last, alone in its list
    coming: list[Assignment]
    parts: list[Assignment]  # as last heard
    heard: Array  # control step of that
    lost: Array  # 1 where the message that is under way is lost


class Messages(NamedTuple):
    """What passes between the pursuers of a game."""

    begin: Callable[[tuple[Vehicle, ...], Planning], Any]  # what is kept of it
    exchange: Callable[[Any, int], None]  # at a control step, of everybody who decides
    part: Callable[[Any, int], Assignment]  # of a pursuer


def nothing_kept(_pursuers: tuple[Vehicle, ...], _planning: Planning) -> int:
    """`Messages.begin` of pursuers that fly each for itself."""
    return 0


def nothing_said(_team: Any, _step: int) -> None:
    """`Messages.exchange` of pursuers that fly each for itself."""


def no_part(_talk: int, _index: int) -> Assignment:
    """`Messages.part` of pursuers that fly each for itself."""
    return IDLE


SILENT = Messages(nothing_kept, nothing_said, no_part)


def opened(first: Plan) -> Talk:
    """Before the first plan: nobody has a part."""
    count = len(first.assignments)
    nothing = [first.assignments[i] for i in range(count)]
    return Talk([first], nothing, nothing.copy(), np.full(count, -1.0), np.zeros(count))


def seat(vehicle: Vehicle, index: int, planning: Planning) -> Member:
    """A pursuer as a member of the team (for `each`)."""
    return Member(vehicle, planning.limits[index + 1], True)


def posted(talk: Talk, planning: Planning, plan: Plan, step: int) -> None:
    """A new plan sets out to everybody."""
    talk.made[0] = plan
    for i in range(len(talk.coming)):
        talk.coming[i] = plan.assignments[i]
        a, _b = threefry(planning.key.a, planning.key.b, step & WORD, i)
        talk.lost[i] = 1.0 if uniform(a) < planning.loss else 0.0


def arrived(talk: Talk, planning: Planning, step: int) -> None:
    """What of the last plan is heard at a control step, and who gives up waiting."""
    for i in range(len(talk.parts)):
        if step % planning.every == planning.delay and talk.lost[i] == 0.0:
            talk.parts[i] = talk.coming[i]
            talk.heard[i] = step
        if step - talk.heard[i] > planning.patience:
            talk.parts[i] = IDLE
