"""The free direction nearest to a preferred one: in space, in the plane, and within limits (2)–(3)."""

from __future__ import annotations

from math import pi

from onboard.core.geometry.cones import NOTHING, Cone, Ray, is_free, pitch_cones, yaw_cones
from onboard.core.geometry.edges import free_ray
from onboard.core.math.each import new
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import Vec, dot


def free_ray_plane(preferred: Vec, cones: tuple[Cone, ...]) -> Ray:
    """The free direction of the north–east plane nearest to `preferred`, exact: it, or an edge of a cone.

    The axes of all cones lie in the plane.
    """
    if is_free(preferred, cones):
        return new(Ray, (True, preferred, 1.0))
    best = -2.0
    ray = preferred
    for cone in cones:
        if cone.cos < -1.0:
            return new(Ray, (False, preferred, -2.0))
        if cone.cos > 1.0:
            continue
        ax = cone.axis.x * cone.cos
        ay = cone.axis.y * cone.cos
        bx = -cone.axis.y * cone.sin
        by = cone.axis.x * cone.sin
        left = new(Vec, (ax - bx, ay - by, 0.0))
        right = new(Vec, (ax + bx, ay + by, 0.0))
        near = dot(left, preferred)
        if near > best and is_free(left, cones):
            best = near
            ray = left
        near = dot(right, preferred)
        if near > best and is_free(right, cones):
            best = near
            ray = right
    return new(Ray, (best >= -1.5, ray, best))


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
        return new(Ray, (False, preferred, -2.0))
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
    return nearest_allowed(preferred, limits, planar)


def nearest_allowed(preferred: Vec, limits: VehicleLimits, planar: bool) -> Vec:
    """`within` of a vehicle that has limits: the search among their cones alone."""
    width = limits.yaw_max - limits.yaw_min
    if width >= 2.0 * pi:
        return free_ray(preferred, (NOTHING, NOTHING, *pitch_cones(limits))).direction
    if width < 0.0:
        return preferred
    if width <= pi:
        return _between(preferred, limits, limits.yaw_min, limits.yaw_max, planar).direction
    middle = 0.5 * (limits.yaw_min + limits.yaw_max)
    one = _between(preferred, limits, limits.yaw_min, middle, planar)
    two = _between(preferred, limits, middle, limits.yaw_max, planar)
    return two.direction if two.closeness > one.closeness else one.direction


def _between(preferred: Vec, limits: VehicleLimits, low: float, high: float, planar: bool) -> Ray:
    """The nearest direction of a heading wedge at most π wide, within the limits of pitch."""
    if planar:
        return free_ray_plane(preferred, yaw_cones(low, high))
    return free_ray(preferred, (*yaw_cones(low, high), *pitch_cones(limits)))
