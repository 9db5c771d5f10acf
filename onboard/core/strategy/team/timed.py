"""Slots that a plane can be at when the game begins: its turns and the wind counted in. Kernel style.

Paths are those of `core/route/arrival` in the moving air, which carries the slot: two turns and straight
lines. How far out a slot lies is free, so it is put where the path takes just the time that there is.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import NamedTuple

from onboard.core.geometry.lead import lead
from onboard.core.math.angles import TURN
from onboard.core.math.vectors import Vec, along, sub, yaw_of
from onboard.core.route.arrival import Pose, ahead, legs
from onboard.core.strategy.team.parts import setting_out
from onboard.core.strategy.team.plan_types import Member, Situation

WIDER = 1.1  # times the tightest turn that a path takes
LAST = 2.0  # [s] of straight flight before the slot
STEP = pi / 36.0  # [rad] between two bearings that are tried
OUTWARD = 1.25  # times the distance that is tried next
FARTHEST = 10.0  # times `nearest` that a slot lies out at most
HALVINGS = 10  # of an OUTWARD step: within half a metre at 2 km


class Swing(NamedTuple):
    """Between which bearings a member can be when the game begins, about its own now [rad]."""

    low: float
    high: float
    late: bool  # it can be on time nowhere, not even at its own


class Leg(NamedTuple):
    """What is the same of every way of a member to a slot."""

    start: Pose
    drift: Vec  # [m] from it to the evader's place, as the air carries both
    speed: float  # [m/s]
    radius: float  # [m] of its turns
    expected: Vec  # [m; NED] the evader's place
    sets_out: Vec  # the evader's velocity when the game begins [m/s]
    length: float  # [m] that it flies until then
    nearest: float  # [m] that it stays away


def leg_of(member: Member, s: Situation) -> Leg:
    """A member's way to slots."""
    own = member.vehicle
    left = s.t0 - s.now
    drift = along(sub(s.expected, own.position), s.wind, -left)
    radius = WIDER * own.speed / member.limits.turn_rate
    start = Pose(0.0, 0.0, yaw_of(own.velocity))
    return Leg(start, drift, own.speed, radius, s.expected, setting_out(s), own.speed * left, s.nearest)


def in_reach(leg: Leg, bearing: float, out: float, length: float) -> bool:
    """Whether a slot `out` [m] from the evader's place at a `bearing` [rad] is no more than a `length` [m] of
    flight through the air away."""
    x = out * cos(bearing)
    y = out * sin(bearing)
    place = Vec(leg.expected.x + x, leg.expected.y + y, leg.expected.z)
    nose = yaw_of(lead(place, leg.speed, leg.expected, leg.sets_out))
    last = LAST * leg.speed
    entry = ahead(Pose(leg.drift.x + x, leg.drift.y + y, nose), -last)
    for k in range(4):
        first = 1.0 if k % 2 == 0 else -1.0
        second = 1.0 if k < 2 else -1.0
        a, straight, b = legs(leg.start, entry, leg.radius, first, second)
        if straight >= 0.0 and leg.radius * (a + b) + straight + last <= length:
            return True
    return False


def out_in_time(member: Member, s: Situation, bearing: float, wanted: float) -> float:
    """How far out a member's slot lies at a bearing, so that its way takes the time left [m].

    It is where it is `wanted` [m] where the time is enough to circle before, and never nearer than allowed.
    """
    leg = leg_of(member, s)
    near = s.nearest
    if not in_reach(leg, bearing, near, leg.length):
        return near
    if in_reach(leg, bearing, wanted, leg.length - TURN * leg.radius):
        return wanted
    far = near
    while far < FARTHEST * s.nearest and in_reach(leg, bearing, far, leg.length):
        near = far
        far *= OUTWARD
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if in_reach(leg, bearing, middle, leg.length):
            near = middle
        else:
            far = middle
    return near


def on_time(leg: Leg, bearing: float) -> bool:
    """Whether a member can be `nearest` out at a bearing in time."""
    return in_reach(leg, bearing, leg.nearest, leg.length)


def timed_swing(member: Member, s: Situation, bearing: float) -> Swing:
    """The bearings that a member can be at in time: around its own, or else around the nearest such."""
    leg = leg_of(member, s)
    start = 0.0
    found = on_time(leg, bearing)
    k = 1
    while not found and k * STEP < pi:
        for side in (1.0, -1.0):
            if not found and on_time(leg, bearing + side * k * STEP):
                found = True
                start = side * k * STEP
        k += 1
    if not found:
        return Swing(0.0, 0.0, True)
    low = start
    while low > start - pi and on_time(leg, bearing + low - STEP):
        low -= STEP
    high = start
    while high < start + pi and on_time(leg, bearing + high + STEP):
        high += STEP
    return Swing(low, high, False)
