"""A pursuers' strategy: lead the evader by half the time it takes to reach it.

Written in kernel style (floats, NamedTuples, plain functions, no arrays, no None), so that it also
compiles; interpreted, any pure function would do.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.game.advance import PursuerStrategy
from onboard.core.game.views import PursuerView
from onboard.core.geometry.free_ray import within
from onboard.core.math.vectors import TINY, along, distance, sub, unit
from onboard.core.strategy.knowledge import Decision, RuleId


def flank(view: PursuerView) -> Decision:
    """Head for the place where the evader is after half the time of flight to it."""
    own = view.own
    far = distance(view.evader.position, own.position)
    time = 0.5 * far / own.speed if own.speed > TINY else 0.0
    aim = along(view.evader.position, view.heading, view.evader.speed * time)
    wanted = unit(sub(aim, own.position), view.heading)
    ahead = within(wanted, view.limits, view.rules.planar)  # pitch and heading limits (2)
    return Decision(True, ahead, own.speed, RuleId.CUSTOM, aim, time, 0.0)


class Strategy(NamedTuple):
    """What an entry point of `apollonius.strategies` names."""

    role: str  # "pursuer" or "evader"
    decide: PursuerStrategy


FLANK = Strategy("pursuer", flank)
