"""Blocked cones: which directions of the evader's are closed to it.

A ray from the evader keeps the safety distance ρ of (4) from a pursuer that moves optimally
iff φ ≥ asin γ + asin(ρ/d). So each pursuer blocks a circular cone around its line of sight, and a
pitch or heading limit blocks two more. `free_ray` has the direction that they leave.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.math.each import each, each_at_once, inverses, new, roots
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import DOWN, NORTH, TINY, Vec

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
    square = x * x + y * y + z * z
    d = sqrt(square)
    if speed >= evader_speed or d <= TINY:
        return EVERYTHING
    sa = speed / evader_speed  # γ
    ca = sqrt(1.0 - sa * sa)
    k = 1.0 / d
    sb = rho * k if rho < d else 1.0
    cb = sqrt(max(0.0, square - rho * rho)) * k
    return new(Cone, (new(Vec, (x * k, y * k, z * k)), ca * cb - sa * sb, sa * cb + ca * sb))


def blocked_cones(evader: Vehicle, pursuers: tuple[Vehicle, ...], rho: float) -> tuple[Cone, ...]:
    """The cones of all pursuers, seen from the evader; `rho` is ρ of (4) [m]."""
    seen = new(Seen, (evader.position, evader.speed, rho))
    return each_at_once(blocked_cone, cones_at_once, pursuers, seen)


class Distances(NamedTuple):
    """What all cones need the roots and the quotients of."""

    seen: Seen
    far: tuple[float, ...]  # d of all pursuers [m]
    inverse: tuple[float, ...]  # 1 / d
    rest: tuple[float, ...]  # √(d² − ρ²), 0 within ρ


def cones_at_once(pursuers: tuple[Vehicle, ...], seen: Seen) -> tuple[Cone, ...]:
    """What `blocked_cone` gives of all pursuers, to the last bit, with all roots at once."""
    squares = each(_square_to, pursuers, seen)
    far = roots(squares)
    rest = roots(each(_beyond, squares, seen.rho))
    return each(_cone_at, pursuers, new(Distances, (seen, far, inverses(far), rest)))


def _square_to(pursuer: Vehicle, _index: int, seen: Seen) -> float:
    x = pursuer.position.x - seen.position.x
    y = pursuer.position.y - seen.position.y
    z = pursuer.position.z - seen.position.z
    return x * x + y * y + z * z


def _beyond(square: float, _index: int, rho: float) -> float:
    return max(0.0, square - rho * rho)


def _cone_at(pursuer: Vehicle, index: int, at: Distances) -> Cone:
    e, evader_speed, rho = at.seen
    p, speed = pursuer.position, pursuer.speed
    d, k = at.far[index], at.inverse[index]
    if speed >= evader_speed or d <= TINY:
        return EVERYTHING
    sa = speed / evader_speed
    ca = sqrt(1.0 - sa * sa)
    sb = rho * k if rho < d else 1.0
    cb = at.rest[index] * k
    axis = new(Vec, ((p.x - e.x) * k, (p.y - e.y) * k, (p.z - e.z) * k))
    return new(Cone, (axis, ca * cb - sa * sb, sa * cb + ca * sb))


def is_free(u: Vec, cones: tuple[Cone, ...]) -> bool:
    """Whether a unit vector lies in no cone, edges counting as free."""
    ux, uy, uz = u
    for axis, c, s in cones:  # noqa: SIM110 (a loop compiles, and costs less)
        if ux * axis.x + uy * axis.y + uz * axis.z > c + EDGE * s:
            return False
    return True


def pitch_cones(limits: VehicleLimits) -> tuple[Cone, Cone]:
    """What a pitch band [θ_min, θ_max] blocks: a cone around up and one around down."""
    up = new(Vec, (0.0, 0.0, -1.0))
    return (
        Cone(up, sin(limits.pitch_max), cos(limits.pitch_max)) if limits.pitch_max < pi / 2 else NOTHING,
        Cone(DOWN, -sin(limits.pitch_min), cos(limits.pitch_min)) if limits.pitch_min > -pi / 2 else NOTHING,
    )


def yaw_cones(low: float, high: float) -> tuple[Cone, Cone]:
    """What a heading wedge [low, high] at most π wide [rad] blocks: two half-spaces."""
    return (
        new(Cone, (new(Vec, (sin(low), -cos(low), 0.0)), 0.0, 1.0)),
        new(Cone, (new(Vec, (-sin(high), cos(high), 0.0)), 0.0, 1.0)),
    )


def perpendicular(a: Vec) -> Vec:
    """Some unit vector perpendicular to a; level where it can be."""
    flat = a.x * a.x + a.y * a.y
    if flat <= TINY:
        return NORTH
    n = sqrt(flat)
    return new(Vec, (-a.y / n, a.x / n, 0.0))
