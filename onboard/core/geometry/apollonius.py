"""Apollonius circles and spheres, the exact intercept and the closest approach: (11), (12), (19), (20).

Closed forms over γ = v_p / v_e, d = |p − e| and φ, the angle between the evader's heading ê and
the line of sight e→p. Angles are never formed: s = d cos φ and h = d sin φ do the work.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.math.each import new
from onboard.core.math.vectors import TINY, Vec, distance


class Sphere(NamedTuple):
    """Apollonius sphere (a circle in the plane): where both players arrive at the same time."""

    exists: bool  # equal speeds give a plane, not a sphere
    centre: Vec  # [m]
    radius: float  # [m]


class Meeting(NamedTuple):
    """Where and when a pursuer comes as near to the evader as it can."""

    exists: bool
    time: float  # T [s]
    point: Vec  # the evader's place at T, which the pursuer heads for [m]
    miss: float  # distance left at T [m]; 0 for an intercept


def in_time(place: Vec, p: Vec, v_p: float, e: Vec, v_e: float, disc: float = 0.0) -> bool:
    """Whether a pursuer can be at a place [m] no later than the evader: |p − g| / v_p ≤ |e − g| / v_e.

    The test of time to block: an evader that flies straight at the place is met there or before. Of a region,
    the disc of so many metres about the place, that must hold of every point (`disc_margin`). Where either
    speed is not known (0 or less) the two count as equally fast.
    """
    if disc > 0.0:
        known = v_p > 0.0 and v_e > 0.0
        return disc_margin(place, disc, p, v_p if known else 1.0, e, v_e if known else 1.0) >= 0.0
    if v_p <= 0.0 or v_e <= 0.0:
        return distance(p, place) <= distance(e, place)
    return distance(p, place) * v_e <= distance(e, place) * v_p


def apollonius_sphere(e: Vec, v_e: float, p: Vec, v_p: float) -> Sphere:
    """Sphere (11) of evader place `e` [m] with speed `v_e` and pursuer place `p` with `v_p` [m/s].

    The printed radius is negative for v_e > v_p: the absolute value of the denominator is meant.
    """
    a = v_e * v_e
    b = v_p * v_p
    k = a - b
    if abs(k) <= 1e-9 * (a + b) or a + b <= 0.0:
        return new(Sphere, (False, e, 0.0))
    centre = new(Vec, ((a * p.x - b * e.x) / k, (a * p.y - b * e.y) / k, (a * p.z - b * e.z) / k))
    return new(Sphere, (True, centre, v_p * v_e * distance(p, e) / abs(k)))  # (11)


def intercept(e: Vec, heading: Vec, v_e: float, p: Vec, v_p: float) -> Meeting:
    """Exact intercept (11)–(12): the first T with |e + v_e T ê − p| = v_p T.

    `heading` is the unit vector ê. Exists for γ < 1 iff φ ≤ asin γ, for γ > 1 always. The
    quadratic is written in v_e² − v_p² so that γ → 1, γ > 1 and a resting evader need no case
    of their own, and its root in the form that does not cancel.
    """
    ex, ey, ez = e
    hx, hy, hz = heading
    x, y, z = p
    x -= ex
    y -= ey
    z -= ez
    dd = x * x + y * y + z * z
    if dd <= TINY * TINY:
        return new(Meeting, (True, 0.0, e, 0.0))
    a = v_e * v_e - v_p * v_p
    b = v_e * (x * hx + y * hy + z * hz)
    inside = b * b - a * dd
    if inside < 0.0:
        return new(Meeting, (False, 0.0, e, 0.0))
    root = sqrt(inside)
    if b >= 0.0:
        bottom = b + root
        if bottom <= TINY * sqrt(dd):
            return new(Meeting, (False, 0.0, e, 0.0))
        time = dd / bottom
    elif a < 0.0:
        time = (b - root) / a
    else:
        return new(Meeting, (False, 0.0, e, 0.0))
    k = v_e * time
    return new(Meeting, (True, time, new(Vec, (ex + hx * k, ey + hy * k, ez + hz * k)), 0.0))


def closest_approach(e: Vec, heading: Vec, v_e: float, p: Vec, v_p: float) -> Meeting:
    """Optimal convergence (19)–(20) in closed form, for when no exact intercept exists.

    T = (s + hγ/√(1−γ²)) / v_e, aim e + v_e T ê, miss d sin(φ − asin γ). Exists while the evader
    comes closer (cos φ > 0) and γ < 1; a pursuer as fast as the evader intercepts instead. The
    printed (19) lacks a factor v_e in its denominator and (20) is ambiguous by 180°; the vector
    form here agrees with the corrected ones.

    What is least is the distance at T, not the integral of d² of (10): for the same T that is least on
    the way to e(2T/3). (20) does not follow from the condition printed as (18), which is empty with λ(T) = 0.
    """
    ex, ey, ez = e
    hx, hy, hz = heading
    x, y, z = p
    x -= ex
    y -= ey
    z -= ez
    s = x * hx + y * hy + z * hz
    if s <= 0.0 or v_e <= TINY or v_p >= v_e:
        return new(Meeting, (False, 0.0, e, 0.0))
    gamma = v_p / v_e
    root = sqrt(max(0.0, 1.0 - gamma * gamma))
    if root <= TINY:
        return new(Meeting, (False, 0.0, e, 0.0))
    cx = hy * z - hz * y
    cy = hz * x - hx * z
    cz = hx * y - hy * x
    h = sqrt(cx * cx + cy * cy + cz * cz)
    time = (s + h * gamma / root) / v_e  # (19)
    k = v_e * time
    aim = new(Vec, (ex + hx * k, ey + hy * k, ez + hz * k))
    return new(Meeting, (True, time, aim, max(0.0, h * root - s * gamma)))  # (20)


def disc_margin(place: Vec, radius: float, p: Vec, v_p: float, e: Vec, v_e: float) -> float:
    """By how much a disc [m] lies within what a pursuer reaches before the evader; negative: it sticks out.

    What the pursuer reaches first is the inside of its Apollonius sphere where it is slower, the outside of
    the evader's where it is faster, and its side of the bisecting plane where both are as fast.
    """
    sphere = apollonius_sphere(e, v_e, p, v_p)
    if not sphere.exists:
        far = distance(e, p)
        if far <= TINY:
            return -radius
        nearer = distance(e, place) * distance(e, place) - distance(p, place) * distance(p, place)
        return nearer / (2.0 * far) - radius
    off = distance(sphere.centre, place)
    return sphere.radius - off - radius if v_p < v_e else off - sphere.radius - radius
