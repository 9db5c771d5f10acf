"""A situation as numbers, and numbers as a decision: what stands between a learned policy and the game.

An environment writes observations and reads actions through these functions, and a trained policy flies
through the same ones. `PURSUER_SEES`, `EVADER_SEES` and `ACTIONS` say what the numbers are; docs/gym.md has
them. Kernel style: `out` is a list or an array of floats.
"""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence
from enum import IntEnum
from math import cos, pi, sin
from typing import NamedTuple

from onboard.core.game.advance import positions
from onboard.core.game.views import EvaderView, PursuerView, heading_at, nearest_mate
from onboard.core.geometry.free_ray import within
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, TINY, Vec, along, clamp, direction, scale, sub, unit
from onboard.core.strategy.knowledge import Decision, RuleId


class Axes(IntEnum):
    """The axes of observations and actions; the third one, of games in space, points down."""

    NED = 0  # north, east
    SIGHT = 1  # level towards the evader (its own: towards its target, or along its heading), to the right


class Steering(IntEnum):
    """What an action says."""

    HEADING = 0
    VELOCITY = 1
    ACCELERATION = 2


class Row(NamedTuple):
    """One part of an observation."""

    what: str
    unit: str
    each: bool  # one such part for every pursuer, in their order


PURSUER_SEES = (
    Row("own velocity through the air", "m/s", False),
    Row("evader's place less the own", "m", False),
    Row("evader's velocity through the air", "m/s", False),
    Row("nearest team mate's place less the own; zeros for one who is alone", "m", False),
    Row("evader's target less the own place; zeros where the rules keep it from the pursuers", "m", False),
)
EVADER_SEES = (
    Row("own velocity through the air", "m/s", False),
    Row("target's place (where it is met in moving air) less the own; zeros without a target", "m", False),
    Row("pursuer's place less the own", "m", True),
    Row("pursuer's velocity through the air", "m/s", True),
)
ACTIONS = {
    Steering.HEADING: "share of π of the heading, from the first axis to the second; in space also share of"
    " π/2 of the climb angle, up positive; flown at the speed the game reckons with",
    Steering.VELOCITY: "velocity through the air in shares of the speed the game reckons with; longer than 1"
    " is cut to 1, slower than the least speed is flown at the least speed",
    Steering.ACCELERATION: "change of the velocity through the air in shares of the vehicle's acceleration,"
    " for one control step; the velocity that results is limited as above",
}


class Form(NamedTuple):
    """How observations and actions are written."""

    axes: Axes
    steering: Steering
    planar: bool  # two axes, not three
    acceleration: float  # [m/s²] of a full share, ACCELERATION
    dt: float  # [s] the control step, ACCELERATION


class Turn(NamedTuple):
    """The first of the axes: a level unit vector."""

    x: float  # north
    y: float  # east


def dimensions(form: Form) -> int:
    """Number of axes."""
    return 2 if form.planar else 3


def action_width(form: Form) -> int:
    """Numbers of an action."""
    return dimensions(form) - 1 if form.steering == Steering.HEADING else dimensions(form)


def pursuer_width(form: Form) -> int:
    """Numbers of a pursuer's observation."""
    return dimensions(form) * len(PURSUER_SEES)


def evader_width(form: Form, pursuers: int) -> int:
    """Numbers of the evader's observation."""
    return dimensions(form) * sum(pursuers if row.each else 1 for row in EVADER_SEES)


def turn_of(ahead: Vec, form: Form) -> Turn:
    """The axes of a vehicle whose line of sight is `ahead`."""
    if form.axes == Axes.NED:
        return Turn(1.0, 0.0)
    level = unit(Vec(ahead.x, ahead.y, 0.0), NORTH)
    return Turn(level.x, level.y)


def put(out: MutableSequence[float], k: int, v: Vec, turn: Turn, planar: bool) -> int:
    """Write a vector in the axes from `out[k]` on; the place behind it."""
    out[k] = turn.x * v.x + turn.y * v.y
    out[k + 1] = turn.x * v.y - turn.y * v.x
    if planar:
        return k + 2
    out[k + 2] = v.z
    return k + 3


def pursuer_features(view: PursuerView, form: Form, out: MutableSequence[float]) -> Turn:
    """Write PURSUER_SEES; the axes in which it is written and the action will be read."""
    own = view.own
    sight = sub(view.evader.position, own.position)
    turn = turn_of(sight, form)
    k = put(out, 0, own.velocity, turn, form.planar)
    k = put(out, k, sight, turn, form.planar)
    k = put(out, k, scale(view.heading, view.evader.speed), turn, form.planar)
    mate = nearest_mate(own.position, positions(view.members), view.own_index)
    k = put(out, k, sub(mate.position, own.position), turn, form.planar)
    goal = sub(view.target.position, own.position)
    put(out, k, scale(goal, 1.0 if view.target.exists else 0.0), turn, form.planar)
    return turn


def evader_features(view: EvaderView, form: Form, out: MutableSequence[float]) -> Turn:
    """Write EVADER_SEES; the axes in which it is written and the action will be read."""
    own = view.own
    goal = scale(sub(view.target.position, own.position), 1.0 if view.target.exists else 0.0)
    turn = turn_of(goal if view.target.exists else heading_at(own), form)
    k = put(out, 0, own.velocity, turn, form.planar)
    k = put(out, k, goal, turn, form.planar)
    for pursuer in view.pursuers:
        k = put(out, k, sub(pursuer.position, own.position), turn, form.planar)
        k = put(out, k, pursuer.velocity, turn, form.planar)
    return turn


def vector_in(action: Sequence[float], turn: Turn, planar: bool) -> Vec:
    """A vector that is written in the axes, in north, east, down."""
    a, b = float(action[0]), float(action[1])
    return Vec(turn.x * a - turn.y * b, turn.y * a + turn.x * b, 0.0 if planar else float(action[2]))


def asked(own: Vehicle, action: Sequence[float], turn: Turn, form: Form) -> Vec:
    """The velocity through the air that an action asks for [m/s]."""
    if form.steering == Steering.HEADING:
        yaw = pi * float(action[0])
        ahead = Vec(cos(yaw), sin(yaw), 0.0)
        if not form.planar:
            ahead = direction(0.5 * pi * clamp(float(action[1]), -1.0, 1.0), yaw)
        turned = Vec(turn.x * ahead.x - turn.y * ahead.y, turn.y * ahead.x + turn.x * ahead.y, ahead.z)
        return scale(turned, own.speed)
    given = vector_in(action, turn, form.planar)
    if form.steering == Steering.VELOCITY:
        return scale(given, own.speed)
    size = unit_share(given) * form.acceleration * form.dt
    return along(own.velocity, given, size)


def unit_share(v: Vec) -> float:
    """What a vector is scaled by so that it is no longer than 1."""
    square = v.x * v.x + v.y * v.y + v.z * v.z
    return 1.0 if square <= 1.0 else float(1.0 / square**0.5)


def answer(own: Vehicle, limits: VehicleLimits, action: Sequence[float], turn: Turn, form: Form) -> Decision:
    """The decision that an action stands for, within the vehicle's limits.

    `turn` is that of the observation which the action answers.
    """
    wanted = asked(own, action, turn, form)
    ahead = unit(wanted, heading_at(own))
    speed = own.speed
    if form.steering != Steering.HEADING:
        size = wanted.x * wanted.x + wanted.y * wanted.y + wanted.z * wanted.z
        speed = clamp(size**0.5, limits.speed_min, max(own.speed, TINY))
    ahead = within(ahead, limits, form.planar)
    return Decision(True, ahead, speed, RuleId.CUSTOM, along(own.position, ahead, speed), 1.0, 0.0)
