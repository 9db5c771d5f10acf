"""The intelligent module of 4.3 for a route: it chooses between Strategies 1 and 2 by the measured situation.

The knowledge base is an ordered table of rules (`CHOICE`), folded into one function. Hysteresis lies in
the memory: rules look at the strategy in force, and leave it later than they would enter it. Kernel style.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from math import sqrt
from typing import NamedTuple

from onboard.core.math.vectors import TINY, ZERO, Vec, dot, norm, sub
from onboard.core.route.tracking import (
    Setting,
    Steering,
    Strategy,
    Tracker,
    Waypoint,
    passed,
    pseudo_target,
    steer,
)
from onboard.core.strategy.knowledge import Module

NEAR_TIMES = 3.5  # times `ahead` before a waypoint is due: from here on it is met exactly
ASTRAY = 60.0  # [m] from the pseudo-target: pursue it
FOUND = 25.0  # [m] from it: pursuit has done its work
LATE = 2.0  # [s] off the route's time: pursue
ON_TIME = 0.6  # [s]
GUSTY = 2.0  # [m/s] rms an axis: the meeting point cannot be trusted
CALM = 1.0  # [m/s]
MEAN_TIME = 8.0  # [s] of the running mean of the wind
RMS_TIME = 20.0  # [s] of the running mean square about it


class TrackRule(IntEnum):
    """Every rule that can choose."""

    NONE = 0
    WAYPOINT_NEAR = 201
    ASTRAY = 202
    STILL_ASTRAY = 203
    GUSTY_AIR = 204
    CALM_AIR = 205
    KEEP = 206
    FIXED = 207  # no choice: one strategy was ordered


class Situation(NamedTuple):
    """What the choice is made by."""

    deviation: float  # from the pseudo-target [m]
    time_error: float  # behind the route's time, by the distance along it [s]; negative = ahead
    wind_rms: float  # an axis, about the running mean [m/s]
    left: float  # until the next waypoint is due [s]
    ahead: float  # that pursuit looks ahead [s]
    strategy: Strategy  # in force


class Choice(NamedTuple):
    """What a rule says."""

    fires: bool
    strategy: Strategy
    rule: TrackRule


class ChoiceRule(NamedTuple):
    """One row of the knowledge base."""

    id: TrackRule
    when: str
    then: str
    source: str
    module: Module
    apply: Callable[[Situation], Choice]


def waypoint_near(s: Situation) -> Choice:
    """A waypoint is due soon: Strategy 1 meets it exactly."""
    return Choice(s.left < NEAR_TIMES * s.ahead, Strategy.POINT_BY_POINT, TrackRule.WAYPOINT_NEAR)


def astray(s: Situation) -> Choice:
    """Far from the pseudo-target, or off its time: Strategy 2 catches it soonest."""
    off = s.deviation > ASTRAY or s.time_error > LATE or s.time_error < -LATE
    return Choice(off, Strategy.PURSUIT, TrackRule.ASTRAY)


def still_astray(s: Situation) -> Choice:
    """Pursuit goes on until the pseudo-target is met closely (hysteresis)."""
    off = s.deviation > FOUND or s.time_error > ON_TIME or s.time_error < -ON_TIME
    return Choice(s.strategy == Strategy.PURSUIT and off, Strategy.PURSUIT, TrackRule.STILL_ASTRAY)


def gusty_air(s: Situation) -> Choice:
    """Gusts spoil the computed meeting point: correct point by point."""
    return Choice(s.wind_rms > GUSTY, Strategy.POINT_BY_POINT, TrackRule.GUSTY_AIR)


def calm_air(s: Situation) -> Choice:
    """In calm air the pseudo-target is followed closely."""
    return Choice(s.wind_rms < CALM, Strategy.PURSUIT, TrackRule.CALM_AIR)


def keep(s: Situation) -> Choice:
    """Between the thresholds nothing changes (hysteresis)."""
    return Choice(True, s.strategy, TrackRule.KEEP)


CHOICE: tuple[ChoiceRule, ...] = (
    ChoiceRule(
        TrackRule.WAYPOINT_NEAR,
        f"the next waypoint is due within {NEAR_TIMES:g} times the time ahead",
        "Strategy 1: meet it",
        "3.6 (30)",
        Module.INTELLIGENT,
        waypoint_near,
    ),
    ChoiceRule(
        TrackRule.ASTRAY,
        f"more than {ASTRAY:g} m from the pseudo-target or {LATE:g} s off the time",
        "Strategy 2: catch it",
        "3.6 (31)",
        Module.INTELLIGENT,
        astray,
    ),
    ChoiceRule(
        TrackRule.STILL_ASTRAY,
        f"in pursuit, and still more than {FOUND:g} m or {ON_TIME:g} s off",
        "Strategy 2",
        "3.6 (31)",
        Module.INTELLIGENT,
        still_astray,
    ),
    ChoiceRule(
        TrackRule.GUSTY_AIR,
        f"wind rms above {GUSTY:g} m/s",
        "Strategy 1: correct the deviation",
        "3.6, significant wind loads",
        Module.INTELLIGENT,
        gusty_air,
    ),
    ChoiceRule(
        TrackRule.CALM_AIR,
        f"wind rms below {CALM:g} m/s",
        "Strategy 2: stay with the pseudo-target",
        "3.6",
        Module.INTELLIGENT,
        calm_air,
    ),
    ChoiceRule(TrackRule.KEEP, "always", "the strategy in force", "hysteresis", Module.INTELLIGENT, keep),
)


def either(
    rule: Callable[[Situation], Choice], rest: Callable[[Situation], Choice]
) -> Callable[[Situation], Choice]:
    """The function that asks `rule`, and `rest` where it does not fire."""

    def ask(situation: Situation) -> Choice:
        choice = rule(situation)
        if choice.fires:
            return choice
        return rest(situation)

    return ask


def fold_choice(table: tuple[ChoiceRule, ...]) -> Callable[[Situation], Choice]:
    """The whole table as one function."""
    decide = table[-1].apply
    for row in table[-2::-1]:
        decide = either(row.apply, decide)
    return decide


choose = fold_choice(CHOICE)


class TrackMemory(NamedTuple):
    """What a tracker remembers from step to step."""

    leg: int  # index of the next waypoint
    strategy: Strategy  # in force
    wind: Vec  # running mean [m/s; NED]
    square: float  # running mean square about it, all axes [m²/s²]
    time: float  # of the last step [s]; negative = none yet


def fresh() -> TrackMemory:
    """The memory before the first step."""
    return TrackMemory(1, Strategy.POINT_BY_POINT, ZERO, 0.0, -1.0)


class Followed(NamedTuple):
    """One step of following a route, and why."""

    steering: Steering
    finished: bool  # the last waypoint lies behind
    strategy: Strategy  # that steers
    rule: TrackRule  # that chose it
    situation: Situation
    memory: TrackMemory


def weather(memory: TrackMemory, wind: Vec, time: float) -> TrackMemory:
    """The memory with one more wind estimate: running mean and mean square about it."""
    if memory.time < 0.0:
        return TrackMemory(memory.leg, memory.strategy, wind, 0.0, time)
    since = max(0.0, time - memory.time)
    off = sub(wind, memory.wind)
    a = since / (MEAN_TIME + since)
    b = since / (RMS_TIME + since)
    mean = Vec(memory.wind.x + a * off.x, memory.wind.y + a * off.y, memory.wind.z + a * off.z)
    square = memory.square + b * (dot(off, off) - memory.square)
    return TrackMemory(memory.leg, memory.strategy, mean, square, time)


def situation_of(
    route: tuple[Waypoint, ...], leg: int, time: float, position: Vec, ahead: float, memory: TrackMemory
) -> Situation:
    """The measured situation of a vehicle at `position` [m; NED], `time` [s] after the route's start."""
    c = pseudo_target(route, time)
    behind = sub(c.position, position)
    pace = norm(c.velocity)
    late = dot(behind, c.velocity) / max(pace * pace, TINY)
    rms = sqrt(max(0.0, memory.square / 3.0))
    return Situation(norm(behind), late, rms, route[leg].time - time, ahead, memory.strategy)


class Fix(NamedTuple):
    """Where a vehicle is at one instant."""

    time: float  # [s since the route's start]
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground, NED]
    wind: Vec  # momentary estimate [m/s; NED, where the air moves to]


def follow(route: tuple[Waypoint, ...], setting: Setting, memory: TrackMemory, fix: Fix) -> Followed:
    """One control step along a route of two waypoints or more."""
    time, position, velocity, wind = fix
    known = weather(memory, wind, time)
    last = len(route) - 1
    leg = known.leg
    finished = leg > last
    if not finished and passed(route, leg, position, velocity):
        leg += 1
        finished = leg > last
    goal = last if finished else leg
    seen = situation_of(route, goal, time, position, setting.ahead, known)
    choice = choose(seen)
    if setting.ordered != Strategy.CHOOSE:
        choice = Choice(True, setting.ordered, TrackRule.FIXED)
    tracker = Tracker(position, velocity, setting, known.wind, time, goal, route)
    steering = steer(choice.strategy, tracker)
    after = TrackMemory(leg, choice.strategy, known.wind, known.square, known.time)
    return Followed(steering, finished, choice.strategy, choice.rule, seen, after)
