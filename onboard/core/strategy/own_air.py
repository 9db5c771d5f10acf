"""Pursuit in the air around oneself: what gusts make of the own way is taken out. Kernel style.

The wind that an autopilot estimates is a mean. What the air does now is the own velocity over ground less
V·(cos θ cos χ, cos θ sin χ), the airspeed along the nose: in that air the evader's velocity is seen, the
rules are asked, and their direction is carried over ground with it. The level part alone: what a nose is
above the path is not known. Airspeed is the one that the game reckons with: a pitot tube feels the fast
gusts, which do not carry the vehicle.
"""

from __future__ import annotations

from collections.abc import Callable

from onboard.core.game.views import PursuerView
from onboard.core.geometry.free_ray import within
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import TINY, Vec, add, along, dot, norm, scale, sub, unit
from onboard.core.strategy.knowledge import Decision


def drift(view: PursuerView) -> Vec:
    """What the air does beyond the estimated wind [m/s; level]; nothing where the nose is not known."""
    if dot(view.nose, view.nose) <= TINY:
        return Vec(0.0, 0.0, 0.0)
    beyond = sub(view.own.velocity, scale(view.nose, view.own.speed))
    return Vec(beyond.x, beyond.y, 0.0)


def seen_in(view: PursuerView, moving: Vec) -> PursuerView:
    """The situation in air that moves with a velocity [m/s] beyond the estimated wind."""
    own, e = view.own, view.evader
    motion = sub(scale(view.heading, e.speed), moving)
    if dot(e.velocity, e.velocity) > TINY:
        motion = sub(e.velocity, moving)
    return PursuerView(
        Vehicle(own.position, sub(own.velocity, moving), own.speed),
        view.limits,
        Vehicle(e.position, motion, norm(motion)),
        unit(motion, view.heading),
        view.has_prediction,
        along(view.prediction, moving, -view.control.lookahead),
        view.mate,
        view.control,
        view.rules,
        view.members,
        view.own_index,
        view.target,
        view.held,
        view.part,
        view.nose,
        add(view.wind, moving),
    )


def in_own_air(decide: Callable[[PursuerView], Decision]) -> Callable[[PursuerView], Decision]:
    """A strategy of pursuers that is asked in the air around the vehicle."""

    def decided(view: PursuerView) -> Decision:
        moving = drift(view)
        d = decide(seen_in(view, moving))
        carried = unit(add(scale(d.direction, d.speed), moving), d.direction)
        ahead = within(carried, view.limits, view.rules.planar)
        return Decision(d.fires, ahead, d.speed, d.rule, along(d.aim, moving, d.time), d.time, d.miss)

    return decided
