"""Limits of speed, climb, turn and acceleration: the nearest demand that keeps them."""

from __future__ import annotations

from math import atan2, cos, inf, sin, sqrt
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.each import new
from onboard.core.math.vectors import TINY, Vec, clamp, is_finite
from onboard.core.safety.policy import Cause, Envelope

TOLERANCE = 1e-6  # a clip below this relative size is rounding, not a clip


class Clipped(NamedTuple):
    """A velocity and the first limit that changed it (NONE where none did)."""

    velocity: Vec  # [m/s]
    cause: Cause


def believable(position: Vec, velocity: Vec) -> bool:
    """Whether a place lies within 10,000 km and a velocity below 10 km/s: numbers to reckon with."""
    return (
        -1e7 < position.x < 1e7 and -1e7 < position.y < 1e7 and -1e7 < position.z < 1e7
        and -1e4 < velocity.x < 1e4 and -1e4 < velocity.y < 1e4 and -1e4 < velocity.z < 1e4
    )


def bounded(v: Vec, course: Vec, e: Envelope) -> Clipped:
    """The velocity within the bounds of speed and climb; `course` gives a plane's direction where v has none.

    A plane keeps its speed when its climb is cut: the horizontal part grows.
    """
    square = v.x * v.x + v.y * v.y + v.z * v.z
    if not square < inf and is_finite(v):  # too large to square: only the direction counts
        big = max(abs(v.x), abs(v.y), abs(v.z))
        v = new(Vec, (v.x / big * e.speed_max, v.y / big * e.speed_max, v.z / big * e.speed_max))
        square = v.x * v.x + v.y * v.y + v.z * v.z
    speed = sqrt(square)
    cause = Cause.NONE
    if speed > e.speed_max:
        if speed > e.speed_max * (1.0 + TOLERANCE):
            cause = Cause.SPEED
        k = e.speed_max / speed
        v = new(Vec, (v.x * k, v.y * k, v.z * k))
        speed = e.speed_max
    low = e.speed_min if e.speed_min < e.speed_max else e.speed_max
    if speed < low:
        if speed < low * (1.0 - TOLERANCE):
            cause = Cause.SPEED
        if speed <= TINY:
            flat = _flat(course)
            v = new(Vec, (flat.x * low, flat.y * low, 0.0))
        else:
            k = low / speed
            v = new(Vec, (v.x * k, v.y * k, v.z * k))
        speed = low
    if not -e.climb_max <= v.z <= e.sink_max:
        z = clamp(v.z, -e.climb_max, e.sink_max)
        if abs(z - v.z) > TOLERANCE * max(1.0, abs(v.z)) and cause == Cause.NONE:
            cause = Cause.CLIMB
        if e.hovers:
            v = new(Vec, (v.x, v.y, z))
        else:
            level = sqrt(max(0.0, speed * speed - z * z))
            flat = _flat(v) if v.x * v.x + v.y * v.y > TINY else _flat(course)
            v = new(Vec, (flat.x * level, flat.y * level, z))
    return new(Clipped, (v, cause))


def slewed(v: Vec, before: Vec, dt: float, e: Envelope) -> Clipped:
    """The velocity nearest to `v` that the limits of turn and acceleration let `before` reach in `dt`."""
    dt = clamp(dt, 0.0, 1.0)
    if e.hovers:
        if e.acceleration <= 0.0:
            return new(Clipped, (v, Cause.NONE))
        x = v.x - before.x
        y = v.y - before.y
        z = v.z - before.z
        change = sqrt(x * x + y * y + z * z)
        most = e.acceleration * dt
        if change <= most * (1.0 + TOLERANCE):
            return new(Clipped, (v, Cause.NONE))
        k = most / change
        nearest = new(Vec, (before.x + x * k, before.y + y * k, before.z + z * k))
        return new(Clipped, (nearest, Cause.ACCELERATION))
    cause = Cause.NONE
    level = sqrt(v.x * v.x + v.y * v.y)
    flat = new(Vec, (v.x / level, v.y / level, 0.0)) if level > TINY else new(Vec, (1.0, 0.0, 0.0))
    if e.turn_rate > 0.0 and level > TINY and before.x * before.x + before.y * before.y > TINY:
        ahead = before.x * v.x + before.y * v.y
        across = before.x * v.y - before.y * v.x
        most = e.turn_rate * dt
        if abs(across) > most * ahead:  # else tan of the turn is at most `most`, and so is the turn
            turn = wrap(atan2(across, ahead))
            if abs(turn) > most * (1.0 + TOLERANCE):
                course = atan2(before.y, before.x) + clamp(turn, -most, most)
                flat = new(Vec, (cos(course), sin(course), 0.0))
                cause = Cause.TURN
    speed = sqrt(level * level + v.z * v.z)
    z = v.z
    if e.acceleration > 0.0:
        old_speed = sqrt(before.x * before.x + before.y * before.y + before.z * before.z)
        most = e.acceleration * dt
        if old_speed > TINY:
            held = clamp(speed, old_speed - most, old_speed + most)
            if abs(held - speed) > TOLERANCE * max(1.0, speed):
                cause = Cause.ACCELERATION if cause == Cause.NONE else cause
                speed = held
        z = clamp(z, before.z - most, before.z + most)
    level = sqrt(max(0.0, speed * speed - z * z))
    return new(Clipped, (new(Vec, (level * flat.x, level * flat.y, z)), cause))


def _flat(v: Vec) -> Vec:
    """Horizontal unit vector of v; north where it has none."""
    n = sqrt(v.x * v.x + v.y * v.y)
    if n <= TINY:
        return new(Vec, (1.0, 0.0, 0.0))
    return new(Vec, (v.x / n, v.y / n, 0.0))
