"""Blocked cones and the free ray nearest to a preferred direction.

A ray from the evader keeps the safety distance ρ of (4) from a pursuer that moves optimally
iff φ ≥ asin γ + asin(ρ/d). So each pursuer blocks a circular cone around its line of sight, a
pitch or heading limit blocks two more, and the free direction nearest to a preferred one is
exact without sampling: the preferred one itself, the nearest point on one edge, or an
intersection of two edges.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.math.each import each
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import DOWN, NORTH, TINY, Vec, dot, unit

EDGE = 1e-9  # a ray within this angle of an edge counts as free [rad]


class Cone(NamedTuple):
    """A blocked set of directions: all within the half-angle of the axis."""

    axis: Vec  # unit
    cos: float  # of the half-angle; −2 blocks everything, 2 nothing
    sin: float  # of the half-angle


class Ray(NamedTuple):
    """The free direction nearest to the preferred one."""

    exists: bool
    direction: Vec  # unit
    closeness: float  # cosine of the angle to the preferred direction


NOTHING = Cone(DOWN, 2.0, 0.0)
EVERYTHING = Cone(DOWN, -2.0, 0.0)


class Seen(NamedTuple):
    """From where, and how, the evader looks at its pursuers."""

    position: Vec  # e [m]
    speed: float  # v_e [m/s; air]
    rho: float  # safety distance ρ [m]


def blocked_cone(pursuer: Vehicle, _index: int, seen: Seen) -> Cone:
    """The cone that a pursuer blocks: half-angle asin γ + asin(ρ/d).

    A pursuer as fast as the evader (γ ≥ 1), or in the same place, blocks everything. Within the
    safety distance, ρ/d counts as 1: what is left are the rays on which the distance grows.
    """
    (px, py, pz), _velocity, speed = pursuer
    (ex, ey, ez), evader_speed, rho = seen
    x = px - ex
    y = py - ey
    z = pz - ez
    d = sqrt(x * x + y * y + z * z)
    if speed >= evader_speed or d <= TINY:
        return EVERYTHING
    sa = speed / evader_speed  # γ
    ca = sqrt(1.0 - sa * sa)
    sb = rho / d if rho < d else 1.0
    cb = sqrt(1.0 - sb * sb)
    return Cone(Vec(x / d, y / d, z / d), ca * cb - sa * sb, sa * cb + ca * sb)


def blocked_cones(evader: Vehicle, pursuers: tuple[Vehicle, ...], rho: float) -> tuple[Cone, ...]:
    """The cones of all pursuers, seen from the evader; `rho` is ρ of (4) [m]."""
    return each(blocked_cone, pursuers, Seen(evader.position, evader.speed, rho))


def is_free(u: Vec, cones: tuple[Cone, ...]) -> bool:
    """Whether a unit vector lies in no cone, edges counting as free."""
    ux, uy, uz = u
    for axis, c, s in cones:  # noqa: SIM110 (a loop compiles, and costs less)
        if ux * axis.x + uy * axis.y + uz * axis.z > c + EDGE * s:
            return False
    return True


class Edge(NamedTuple):
    """A cone's edge beside a preferred direction: what every candidate needs of it."""

    x: float  # axis
    y: float
    z: float
    cos: float  # of the half-angle
    sin: float
    limit: float  # cosine to the axis up to which a ray is free
    level: float  # cosine of the angle from the axis to the preferred direction


def edge_of(cone: Cone, _index: int, preferred: Vec) -> Edge:
    """The edge of a cone (for `each`)."""
    (x, y, z), c, s = cone
    return Edge(x, y, z, c, s, c + EDGE * s, x * preferred.x + y * preferred.y + z * preferred.z)


def _clear(x: float, y: float, z: float, edges: tuple[Edge, ...]) -> bool:
    for ax, ay, az, _c, _s, limit, _level in edges:  # noqa: SIM110
        if x * ax + y * ay + z * az > limit:
            return False
    return True


def free_ray(preferred: Vec, cones: tuple[Cone, ...]) -> Ray:
    """The free direction in space nearest to `preferred` (unit), exact; `exists` False if all is blocked.

    Candidates nearer than the best so far are tested against all cones, the others never. Written
    out in floats: the interpreted onboard agent spends its time here.
    """
    if is_free(preferred, cones):
        return Ray(True, preferred, 1.0)
    px, py, pz = preferred
    edges = each(edge_of, cones, preferred)
    best = -2.0
    ray = preferred
    for i in range(len(edges)):
        ax, ay, az, ac, sine, _limit, pa = edges[i]
        if ac < -1.0:
            return Ray(False, preferred, -2.0)
        if ac > 1.0:
            continue
        # The nearest point on the edge of cone i.
        x = px - pa * ax
        y = py - pa * ay
        z = pz - pa * az
        n = sqrt(x * x + y * y + z * z)
        near = pa * ac + n * sine
        if near <= best:
            continue  # no point of this edge is nearer than its nearest
        if n < 1e-3:
            # On the axis every point of the edge is as near: take any. Near it, rounding turns the
            # side out of the perpendicular: make it so again.
            axis = Vec(ax, ay, az)
            side = perpendicular(axis) if n <= TINY else Vec(x / n, y / n, z / n)
            side = unit(_blend(side, 1.0, axis, -dot(side, axis)), preferred)
            u = unit(_blend(axis, ac, side, sine), preferred)
        else:
            k = sine / n
            u = Vec(ax * ac + x * k, ay * ac + y * k, az * ac + z * k)
        if _clear(u.x, u.y, u.z, edges):
            best = near
            ray = u
            continue
        # Where the edges of cones i and j < i cross.
        for j in range(i):
            bx, by, bz, bc, _sine, _limit, pb = edges[j]
            c = ax * bx + ay * by + az * bz
            k = 1.0 - c * c
            if bc > 1.0 or k <= TINY:
                continue
            alpha = (ac - bc * c) / k
            beta = (bc - ac * c) / k
            square = 1.0 - alpha * alpha - beta * beta - 2.0 * alpha * beta * c
            if square < 0.0:
                continue
            t = sqrt(square / k)
            x = t * (ay * bz - az * by)
            y = t * (az * bx - ax * bz)
            z = t * (ax * by - ay * bx)
            level = alpha * pa + beta * pb
            rise = px * x + py * y + pz * z
            if rise < 0.0:
                rise = -rise
                x = -x
                y = -y
                z = -z
            if level + rise <= best:
                continue
            lx = ax * alpha + bx * beta
            ly = ay * alpha + by * beta
            lz = az * alpha + bz * beta
            # Nearly parallel axes magnify rounding: make the candidates unit vectors again.
            n = sqrt(square + lx * lx + ly * ly + lz * lz)
            if abs(n - 1.0) > 1e-14:
                n = max(n, TINY)
                x, y, z = x / n, y / n, z / n
                lx, ly, lz = lx / n, ly / n, lz / n
            if _clear(lx + x, ly + y, lz + z, edges):
                best = level + rise
                ray = unit(Vec(lx + x, ly + y, lz + z), preferred)
            elif level - rise > best and _clear(lx - x, ly - y, lz - z, edges):
                best = level - rise
                ray = unit(Vec(lx - x, ly - y, lz - z), preferred)
    return Ray(best >= -1.5, ray, best)


def free_ray_plane(preferred: Vec, cones: tuple[Cone, ...]) -> Ray:
    """The free direction of the north–east plane nearest to `preferred`, exact: it, or an edge of a cone.

    The axes of all cones lie in the plane.
    """
    if is_free(preferred, cones):
        return Ray(True, preferred, 1.0)
    best = -2.0
    ray = preferred
    for cone in cones:
        if cone.cos < -1.0:
            return Ray(False, preferred, -2.0)
        if cone.cos > 1.0:
            continue
        ax = cone.axis.x * cone.cos
        ay = cone.axis.y * cone.cos
        bx = -cone.axis.y * cone.sin
        by = cone.axis.x * cone.sin
        left = Vec(ax - bx, ay - by, 0.0)
        right = Vec(ax + bx, ay + by, 0.0)
        near = dot(left, preferred)
        if near > best and is_free(left, cones):
            best = near
            ray = left
        near = dot(right, preferred)
        if near > best and is_free(right, cones):
            best = near
            ray = right
    return Ray(best >= -1.5, ray, best)


def pitch_cones(limits: VehicleLimits) -> tuple[Cone, Cone]:
    """What a pitch band [θ_min, θ_max] blocks: a cone around up and one around down."""
    up = Vec(0.0, 0.0, -1.0)
    return (
        Cone(up, sin(limits.pitch_max), cos(limits.pitch_max)) if limits.pitch_max < pi / 2 else NOTHING,
        Cone(DOWN, -sin(limits.pitch_min), cos(limits.pitch_min)) if limits.pitch_min > -pi / 2 else NOTHING,
    )


def yaw_cones(low: float, high: float) -> tuple[Cone, Cone]:
    """What a heading wedge [low, high] at most π wide [rad] blocks: two half-spaces."""
    return (
        Cone(Vec(sin(low), -cos(low), 0.0), 0.0, 1.0),
        Cone(Vec(-sin(high), cos(high), 0.0), 0.0, 1.0),
    )


def free_ray_limited(preferred: Vec, cones: tuple[Cone, ...], limits: VehicleLimits, planar: bool) -> Ray:
    """The free direction nearest to `preferred` within the limits (2), exact.

    In the plane only the heading limits count. A heading wedge wider than π is the union of two
    that are not: the nearer of both answers is the answer.
    """
    width = limits.yaw_max - limits.yaw_min
    if width >= 2.0 * pi:
        if planar:
            return free_ray_plane(preferred, cones)
        if limits.pitch_min <= -pi / 2 and limits.pitch_max >= pi / 2:
            return free_ray(preferred, cones)
        return free_ray(preferred, (*cones, *pitch_cones(limits)))
    if width < 0.0:
        return Ray(False, preferred, -2.0)
    if width <= pi:
        return _in_wedge(preferred, cones, limits, limits.yaw_min, limits.yaw_max, planar)
    middle = 0.5 * (limits.yaw_min + limits.yaw_max)
    one = _in_wedge(preferred, cones, limits, limits.yaw_min, middle, planar)
    two = _in_wedge(preferred, cones, limits, middle, limits.yaw_max, planar)
    if two.closeness > one.closeness:
        return two
    return one


def _in_wedge(
    preferred: Vec, cones: tuple[Cone, ...], limits: VehicleLimits, low: float, high: float, planar: bool
) -> Ray:
    if planar:
        return free_ray_plane(preferred, (*cones, *yaw_cones(low, high)))
    return free_ray(preferred, (*cones, *yaw_cones(low, high), *pitch_cones(limits)))


def within(preferred: Vec, limits: VehicleLimits, planar: bool) -> Vec:
    """The direction nearest to `preferred` that the limits (2)–(3) allow (`preferred` if none is)."""
    _slow, _fast, pitch_min, pitch_max, yaw_min, yaw_max, _turn = limits
    if yaw_max - yaw_min >= 2.0 * pi and (planar or (pitch_min <= -pi / 2 and pitch_max >= pi / 2)):
        return preferred
    ray = free_ray_limited(preferred, (NOTHING,), limits, planar)
    return ray.direction


def _blend(a: Vec, k: float, b: Vec, m: float) -> Vec:
    return Vec(a.x * k + b.x * m, a.y * k + b.y * m, a.z * k + b.z * m)


def perpendicular(a: Vec) -> Vec:
    """Some unit vector perpendicular to a; level where it can be."""
    flat = a.x * a.x + a.y * a.y
    if flat <= TINY:
        return NORTH
    n = sqrt(flat)
    return Vec(-a.y / n, a.x / n, 0.0)
