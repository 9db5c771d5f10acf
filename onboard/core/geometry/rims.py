"""Edges of blocked cones beside a preferred direction: their nearest points, and where two of them cross.

Kernel style.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.geometry.cones import EDGE, Cone, Ray, perpendicular
from onboard.core.math.vectors import TINY, ZERO, Vec, dot, unit

FIRM = 1e-6  # where edges cross flatter, rounding may decide


class Rim(NamedTuple):
    """A cone's edge beside a preferred direction, with its distance."""

    x: float  # axis
    y: float
    z: float
    cos: float  # of the half-angle
    sin: float
    limit: float  # cosine to the axis up to which a ray is free
    level: float  # cosine of the angle from the axis to the preferred direction
    n: float  # sine of that angle
    near: float  # cosine of the angle from the preferred direction to the edge; −3 where nothing is blocked


def rim_of(cone: Cone, _index: int, preferred: Vec) -> Rim:
    """The edge of a cone (for `table`)."""
    (ax, ay, az), c, s = cone
    px, py, pz = preferred
    level = ax * px + ay * py + az * pz
    x = px - level * ax
    y = py - level * ay
    z = pz - level * az
    n = sqrt(x * x + y * y + z * z)
    return Rim(ax, ay, az, c, s, c + EDGE * s, level, n, level * c + n * s if c <= 1.0 else -3.0)


class Crossing(NamedTuple):
    """Where the edges of two cones cross: at along + across and along − across, all but unit vectors."""

    exists: bool
    along: Vec  # in the plane of the axes
    across: Vec  # perpendicular to it, to the right-handed side of the first axis and the second
    square: float  # of across
    level: float  # the cosines of the angles to the preferred direction are level + rise and level − rise
    rise: float
    certain: bool  # nothing outside both cones is nearer to the preferred direction than the nearer point


NO_CROSSING = Crossing(False, ZERO, ZERO, 0.0, -3.0, 0.0, False)


def crossing(one: Rim, two: Rim, preferred: Vec) -> Crossing:
    """Where two edges cross.

    The nearer point is certain by the multipliers of Lagrange: p = μ u + λ₁ a₁ + λ₂ a₂ with none of them
    negative makes p·v ≤ p·u for every v with a·v ≤ a·u for both axes.
    """
    ax, ay, az, ac, _sine, _limit, pa, _n, _near = one
    bx, by, bz, bc, _sine2, _limit2, pb, _n2, _near2 = two
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
    lies = Vec(ax * alpha + bx * beta, ay * alpha + by * beta, az * alpha + bz * beta)
    high = abs(rise)
    toward_one = (pa - pb * c) * square >= high * alpha * k
    toward_two = (pb - pa * c) * square >= high * beta * k
    certain = k > FIRM and square > FIRM and toward_one and toward_two
    return Crossing(True, lies, Vec(x, y, z), square, level, rise, certain)


def point(found: Crossing, side: float, preferred: Vec) -> Ray:
    """The one of the two points at along + `side` · across, `side` 1 or −1."""
    _exists, (lx, ly, lz), (x, y, z), square, level, rise, _certain = found
    # Nearly parallel axes magnify rounding: make the candidates unit vectors again.
    n = sqrt(square + lx * lx + ly * ly + lz * lz)
    if abs(n - 1.0) > 1e-14:
        n = max(n, TINY)
        x, y, z = x / n, y / n, z / n
        lx, ly, lz = lx / n, ly / n, lz / n
    u = unit(Vec(lx + side * x, ly + side * y, lz + side * z), preferred)
    return Ray(True, u, level + side * rise)


def nearer_crossing(one: Rim, two: Rim, preferred: Vec) -> Ray:
    """The crossing of two edges nearer to the preferred direction, where that is certain."""
    found = crossing(one, two, preferred)
    if not found.certain:
        return Ray(False, preferred, -2.0)
    return point(found, -1.0 if found.rise < 0.0 else 1.0, preferred)


def on_edge(edge: Rim, preferred: Vec) -> Ray:
    """The point of a cone's edge nearest to the preferred direction."""
    ax, ay, az, ac, sine, _limit, pa, n, near = edge
    px, py, pz = preferred
    x = px - pa * ax
    y = py - pa * ay
    z = pz - pa * az
    if n < 1e-3:
        # On the axis every point of the edge is as near: take any. Near it, rounding turns the
        # side out of the perpendicular: make it so again.
        axis = Vec(ax, ay, az)
        side = perpendicular(axis) if n <= TINY else Vec(x / n, y / n, z / n)
        side = unit(blend(side, 1.0, axis, -dot(side, axis)), preferred)
        return Ray(True, unit(blend(axis, ac, side, sine), preferred), near)
    k = sine / n
    return Ray(True, Vec(ax * ac + x * k, ay * ac + y * k, az * ac + z * k), near)


def blend(a: Vec, k: float, b: Vec, m: float) -> Vec:
    """k a + m b."""
    return Vec(a.x * k + b.x * m, a.y * k + b.y * m, a.z * k + b.z * m)
