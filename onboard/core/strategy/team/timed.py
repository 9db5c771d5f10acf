"""Slots that a plane can be at when the game begins: its turns and the wind counted in. Kernel style.

Paths are those of `core/route/arrival` in the moving air, which carries the slot: two turns and straight
lines. How far out a slot lies is free, so it is put where the path takes just the time that there is.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import NamedTuple

from onboard.core.geometry.lead import lead
from onboard.core.math.angles import TURN
from onboard.core.math.vectors import Vec, yaw_of
from onboard.core.route.arrival import Pose, joined
from onboard.core.strategy.team.parts import setting_out
from onboard.core.strategy.team.plan_types import Member, Situation

WIDER = 1.1  # times the tightest turn that a path takes
LAST = 2.0  # [s] of straight flight before the slot
STEP = pi / 36.0  # [rad] between two bearings that are tried
OUTWARD = 1.25  # times the distance that is tried next
FARTHEST = 10.0  # times `nearest` that a slot lies out at most
HALVINGS = 16


class Swing(NamedTuple):
    """Between which bearings a member can be when the game begins, about its own now [rad]."""

    low: float
    high: float
    late: bool  # it can be on time nowhere, not even at its own


def length_to(member: Member, s: Situation, bearing: float, out: float) -> float:
    """The shortest way through the air to a slot `out` [m] from the evader's place at a `bearing` [rad]."""
    own = member.vehicle
    slot = Vec(s.expected.x + out * cos(bearing), s.expected.y + out * sin(bearing), s.expected.z)
    nose = yaw_of(lead(slot, own.speed, s.expected, setting_out(s)))
    left = s.t0 - s.now
    goal = Pose(
        slot.x - own.position.x - s.wind.x * left, slot.y - own.position.y - s.wind.y * left, nose
    )
    start = Pose(0.0, 0.0, yaw_of(own.velocity))
    radius = WIDER * own.speed / member.limits.turn_rate
    best = 1e18
    for k in range(4):
        first = 1.0 if k % 2 == 0 else -1.0
        second = 1.0 if k < 2 else -1.0
        path = joined(start, goal, radius, first, second, LAST * own.speed)
        if path.straight >= 0.0:
            length = radius * (abs(path.first) + abs(path.second)) + path.straight + path.last
            best = min(best, length)
    return best


def out_in_time(member: Member, s: Situation, bearing: float, wanted: float) -> float:
    """How far out a member's slot lies at a bearing, so that its way takes the time left [m].

    It is where it is `wanted` [m] where the time is enough to circle before, and never nearer than allowed.
    """
    time = member.vehicle.speed * (s.t0 - s.now)
    circle = TURN * WIDER * member.vehicle.speed / member.limits.turn_rate
    near = s.nearest
    if length_to(member, s, bearing, near) > time:
        return near
    if length_to(member, s, bearing, wanted) + circle <= time:
        return wanted
    far = near
    while far < FARTHEST * s.nearest and length_to(member, s, bearing, far) <= time:
        near = far
        far *= OUTWARD
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if length_to(member, s, bearing, middle) <= time:
            near = middle
        else:
            far = middle
    return near


def on_time(member: Member, s: Situation, bearing: float) -> bool:
    """Whether a member can be `nearest` out at a bearing in time."""
    return length_to(member, s, bearing, s.nearest) <= member.vehicle.speed * (s.t0 - s.now)


def timed_swing(member: Member, s: Situation, bearing: float) -> Swing:
    """The bearings that a member can be at in time: around its own, or else around the nearest such."""
    start = 0.0
    found = on_time(member, s, bearing)
    k = 1
    while not found and k * STEP < pi:
        for side in (1.0, -1.0):
            if not found and on_time(member, s, bearing + side * k * STEP):
                found = True
                start = side * k * STEP
        k += 1
    if not found:
        return Swing(0.0, 0.0, True)
    low = start
    while low > start - pi and on_time(member, s, bearing + low - STEP):
        low -= STEP
    high = start
    while high < start + pi and on_time(member, s, bearing + high + STEP):
        high += STEP
    return Swing(low, high, False)
