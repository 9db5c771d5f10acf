"""Edges of blocked cones beside a preferred direction: their nearest points, and where two of them cross.

Kernel style.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.geometry.cones import EDGE, Cone, perpendicular
from onboard.core.math.each import new
from onboard.core.math.vectors import TINY, ZERO, Vec, dot, unit


class Rim(NamedTuple):
    """A cone's edge beside a preferred direction."""

    x: float  # axis
    y: float
    z: float
    cos: float  # of the half-angle
    sin: float
    limit: float  # cosine to the axis up to which a ray is free
    level: float  # cosine of the angle from the axis to the preferred direction


def rim_of(cone: Cone, _index: int, preferred: Vec) -> Rim:
    """The edge of a cone (for `table`)."""
    (x, y, z), c, s = cone
    px, py, pz = preferred
    return new(Rim, (x, y, z, c, s, c + EDGE * s, px * x + py * y + pz * z))


class Spot(NamedTuple):
    """A point that is the nearest free ray unless it lies in a cone, or another one is nearer."""

    x: float  # all but a unit vector
    y: float
    z: float
    closeness: float  # cosine of the angle to the preferred direction
    one: int  # the cone on whose edge it lies
    two: int  # and the one whose edge crosses there; NOBODY where none does


NOBODY = -1


def on_edge(edge: Rim, number: int, preferred: Vec) -> Spot:
    """The point of the edge of cone `number` nearest to the preferred direction."""
    ax, ay, az, ac, sine, _limit, pa = edge
    px, py, pz = preferred
    x = px - pa * ax
    y = py - pa * ay
    z = pz - pa * az
    n = sqrt(x * x + y * y + z * z)
    near = pa * ac + n * sine
    if n < 1e-3:
        # On the axis every point of the edge is as near: take any. Near it, rounding turns the
        # side out of the perpendicular: make it so again.
        axis = new(Vec, (ax, ay, az))
        side = perpendicular(axis) if n <= TINY else new(Vec, (x / n, y / n, z / n))
        side = unit(blend(side, 1.0, axis, -dot(side, axis)), preferred)
        u = unit(blend(axis, ac, side, sine), preferred)
        return new(Spot, (u.x, u.y, u.z, near, number, NOBODY))
    k = sine / n
    return new(Spot, (ax * ac + x * k, ay * ac + y * k, az * ac + z * k, near, number, NOBODY))


class Crossing(NamedTuple):
    """Where the edges of two cones cross: at middle + aside, and less near at middle − aside."""

    exists: bool
    middle: Vec  # in the plane of the axes
    aside: Vec  # perpendicular to it, to the side of the preferred direction
    level: float  # the cosines of the angles to the preferred direction are level + rise and level − rise
    rise: float  # not negative


NO_CROSSING = Crossing(False, ZERO, ZERO, -3.0, 0.0)


def crossing(one: Rim, two: Rim, preferred: Vec) -> Crossing:
    """Where two edges cross; `by_pairs` of `edges` has it once more, written out."""
    ax, ay, az, ac, _sine, _limit, pa = one
    bx, by, bz, bc, _sine2, _limit2, pb = two
    px, py, pz = preferred
    c = ax * bx + ay * by + az * bz
    k = 1.0 - c * c
    if k <= TINY:
        return NO_CROSSING
    alpha = (ac - bc * c) / k
    beta = (bc - ac * c) / k
    square = 1.0 - alpha * alpha - beta * beta - 2.0 * alpha * beta * c
    if square < 0.0:
        return NO_CROSSING
    t = sqrt(square / k)
    x = t * (ay * bz - az * by)
    y = t * (az * bx - ax * bz)
    z = t * (ax * by - ay * bx)
    level = alpha * pa + beta * pb
    rise = px * x + py * y + pz * z
    if rise < 0.0:
        rise, x, y, z = -rise, -x, -y, -z
    lx = ax * alpha + bx * beta
    ly = ay * alpha + by * beta
    lz = az * alpha + bz * beta
    # Nearly parallel axes magnify rounding: make the points unit vectors again.
    n = sqrt(square + lx * lx + ly * ly + lz * lz)
    if abs(n - 1.0) > 1e-14:
        n = max(n, TINY)
        x, y, z = x / n, y / n, z / n
        lx, ly, lz = lx / n, ly / n, lz / n
    return new(Crossing, (True, new(Vec, (lx, ly, lz)), new(Vec, (x, y, z)), level, rise))


def blend(a: Vec, k: float, b: Vec, m: float) -> Vec:
    """k a + m b."""
    return new(Vec, (a.x * k + b.x * m, a.y * k + b.y * m, a.z * k + b.z * m))
