"""Geofence with the way to stop, or to turn, ahead of it.

A multicopter may approach a wall as fast as it can still stop before it: for each edge the part
of the velocity towards its nearest point is bounded, which holds for polygons of any shape. A
plane cannot stop: a demand is free while, after the reaction time, a full circle to the left or
to the right still lies inside; otherwise it turns onto the circle that does.
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.each import each, new
from onboard.core.math.vectors import TINY, Vec, clamp
from onboard.core.safety.braking import Nearest, nearest_on, stopping_speed
from onboard.core.safety.policy import Cause, Envelope, Fence, Policy
from onboard.core.safety.zones_ahead import beside, inside_zone

PASSES = 4  # of projection on the walls, before what is left is scaled down
GRID = 32  # steps in which a fence is searched for its innermost place
LEAD = pi / 3  # a plane's evasive course, ahead of its present one [rad]


class Fenced(NamedTuple):
    """The velocity that keeps inside, and what changed it."""

    velocity: Vec  # [m/s; ground]
    cause: Cause


def inside(x: float, y: float, polygon: tuple[tuple[float, float], ...]) -> bool:
    """Whether a place lies inside a polygon (even-odd rule)."""
    odd = False
    px, py = polygon[-1]
    for qx, qy in polygon:
        if (qy > y) != (py > y) and x < (px - qx) * (y - qy) / (py - qy) + qx:
            odd = not odd
        px, py = qx, qy
    return odd


def nearest(x: float, y: float, polygon: tuple[tuple[float, float], ...]) -> Nearest:
    """The point of the whole boundary nearest to a place."""
    px, py = polygon[-1]
    best = new(Nearest, (1e18, x, y))
    for qx, qy in polygon:
        here = nearest_on(x, y, px, py, qx, qy)
        if here.distance < best.distance:
            best = here
        px, py = qx, qy
    return best


def depth(x: float, y: float, polygon: tuple[tuple[float, float], ...]) -> float:
    """Distance to the boundary [m], negative outside."""
    d = nearest(x, y, polygon).distance
    return d if inside(x, y, polygon) else -d


def outside_by(position: Vec, fence: Fence) -> float:
    """How far a place lies outside a fence [m], 0 inside."""
    up = -position.z
    flat = max(0.0, -depth(position.x, position.y, fence.polygon))
    return max(flat, fence.low - up, up - fence.high, 0.0)


def keep_height(v: Vec, position: Vec, fence: Fence, margin: float, reaction: float, e: Envelope) -> Fenced:
    """The velocity with its vertical part bounded by floor and ceiling; outside the band it leads back."""
    up = -position.z
    margin = min(margin, 0.25 * (fence.high - fence.low))
    climb = -v.z
    if up > fence.high:
        climb = min(climb, -min(e.sink_max, max(0.5, 0.5 * (up - fence.high + margin))))
        cause = Cause.OUTSIDE_FENCE
    elif up < fence.low:
        climb = max(climb, min(e.climb_max, max(0.5, 0.5 * (fence.low - up + margin))))
        cause = Cause.OUTSIDE_FENCE
    else:
        cause = Cause.NONE
        most = stopping_speed(fence.high - margin - up, 0.5 * e.deceleration, reaction)
        least = -stopping_speed(up - margin - fence.low, 0.5 * e.deceleration, reaction)
        if climb > most:
            climb = most
            cause = Cause.CEILING_AHEAD
        elif climb < least:
            climb = least
            cause = Cause.FLOOR_AHEAD
    return new(Fenced, (new(Vec, (v.x, v.y, -climb)), cause))


class _Braking(NamedTuple):
    """Who brakes before walls (for `each`)."""

    position: Vec
    policy: Policy


class _Wall(NamedTuple):
    """A wall's direction, and how fast it may be approached [m/s]."""

    x: float
    y: float
    most: float


class _Fencing(NamedTuple):
    """A fence, and who brakes before it (for `each`)."""

    fence: Fence
    braking: _Braking


def _walls(fence: Fence, _index: int, braking: _Braking) -> tuple[_Wall, ...]:
    """All walls of a fence (for `each`)."""
    return each(_wall, fence.polygon, new(_Fencing, (fence, braking)))


def _wall(corner: tuple[float, float], index: int, fencing: _Fencing) -> _Wall:
    """The wall that ends in a corner of a fence (for `each`)."""
    (fence, (position, policy)) = fencing
    px, py = fence.polygon[(index if index > 0 else len(fence.polygon)) - 1]
    wall = nearest_on(position.x, position.y, px, py, corner[0], corner[1])
    reaction = policy.reaction + policy.coast
    most = stopping_speed(wall.distance - policy.fence_margin, policy.envelope.deceleration, reaction)
    return new(_Wall, ((wall.x - position.x) / wall.distance, (wall.y - position.y) / wall.distance, most))


def brake(v: Vec, position: Vec, policy: Policy) -> Fenced:
    """A multicopter's velocity, slowed towards every wall it could not stop before; outside, the way back."""
    fences, margin, e = policy.fences, policy.fence_margin, policy.envelope
    for fence in fences:
        if not inside(position.x, position.y, fence.polygon):
            home = nearest(position.x, position.y, fence.polygon)
            speed = clamp(0.5 * (home.distance + margin), 0.5, e.speed_max)
            return new(Fenced, (_towards(position, home, speed, v.z), Cause.OUTSIDE_FENCE))
        px, py = fence.polygon[-1]
        for qx, qy in fence.polygon:
            wall = nearest_on(position.x, position.y, px, py, qx, qy)
            px, py = qx, qy
            if wall.distance <= TINY:
                return new(Fenced, (new(Vec, (0.0, 0.0, v.z)), Cause.FENCE_AHEAD))
    every = each(_walls, fences, new(_Braking, (position, policy)))
    x = v.x
    y = v.y
    changed = False
    for _ in range(PASSES):
        for walls in every:
            for ux, uy, most in walls:
                excess = x * ux + y * uy - most
                if excess > 0.0:
                    x -= excess * ux
                    y -= excess * uy
                    changed = changed or excess > 1e-6
    k = 1.0  # zero velocity keeps every bound, so scaling always ends well
    for walls in every:
        for ux, uy, most in walls:
            towards = x * ux + y * uy
            if towards * k > most:
                k = most / towards
    return new(Fenced, (new(Vec, (x * k, y * k, v.z)), Cause.FENCE_AHEAD if changed else Cause.NONE))


def turn(v: Vec, position: Vec, ground: Vec, wind: float, policy: Policy) -> Fenced:
    """A plane's ground velocity, turned away where its demand would leave no circle inside.

    `ground` is the present ground velocity; `wind` the wind's speed [m/s], which widens the circle.
    """
    fences, margin, reaction, e = policy.fences, policy.fence_margin, policy.reaction, policy.envelope
    if len(fences) == 0 and len(policy.zones.areas) == 0:
        return new(Fenced, (v, Cause.NONE))
    level = sqrt(v.x * v.x + v.y * v.y)
    for fence in fences:
        if not inside(position.x, position.y, fence.polygon):
            home = nearest(position.x, position.y, fence.polygon)
            return new(Fenced, (_towards(position, home, level, v.z), Cause.OUTSIDE_FENCE))
    out = inside_zone(position, policy)
    if out.x != 0.0 or out.y != 0.0:
        return new(Fenced, (new(Vec, (out.x * level, out.y * level, v.z)), Cause.INSIDE_ZONE))
    radius = turning_radius(e, wind)
    now = sqrt(ground.x * ground.x + ground.y * ground.y)
    pace = max(now, level)
    need = radius + margin
    # No centre of a circle is farther off than this: where that much is left to every wall, any circle fits.
    if _clearance(position.x, position.y, position, policy) >= pace * reaction + radius + need + 1e-3:
        return new(Fenced, (v, Cause.NONE))
    course = atan2(ground.y, ground.x) if now > TINY else atan2(v.y, v.x)
    # Where the vehicle is, and how it heads, when an answer to the next decision begins to show.
    rate = pace / radius if radius > TINY else pi
    later = course + clamp(wrap(atan2(v.y, v.x) - course), -rate * reaction, rate * reaction)
    x = position.x + pace * reaction * cos(later)
    y = position.y + pace * reaction * sin(later)
    there = new(Vec, (x, y, position.z))
    if max(_room(there, later, radius, policy), _room(there, later, -radius, policy)) >= need:
        return new(Fenced, (v, Cause.NONE))
    right = _room(position, course, radius, policy)
    left = _room(position, course, -radius, policy)
    away = course + (LEAD if right >= left else -LEAD)
    least = beside(x, y, position, policy)
    cause = Cause.ZONE_AHEAD if least < _within(x, y, fences) else Cause.FENCE_AHEAD
    return new(Fenced, (new(Vec, (level * cos(away), level * sin(away), v.z)), cause))


def turning_radius(e: Envelope, wind: float) -> float:
    """The radius of a circle over ground that the plane can hold in `wind` [m]: r (1 + w/v)²."""
    k = 1.0 + wind / max(e.speed_max, 1.0)
    return e.turn_radius * k * k


def fits(fence: Fence, e: Envelope, margin: float, wind: float) -> bool:
    """Whether a plane can circle anywhere inside a fence: some place is deeper than its circle needs."""
    if e.hovers:
        return True
    return deepest(fence) >= turning_radius(e, wind) + margin


def deepest(fence: Fence) -> float:
    """How far the innermost place of a fence lies from its walls [m], on a grid of 32 by 32."""
    xs = [corner[0] for corner in fence.polygon]
    ys = [corner[1] for corner in fence.polygon]
    best = 0.0
    for i in range(1, GRID):
        for j in range(1, GRID):
            x = min(xs) + (max(xs) - min(xs)) * i / GRID
            y = min(ys) + (max(ys) - min(ys)) * j / GRID
            best = max(best, depth(x, y, fence.polygon))
    return best


def _room(place: Vec, course: float, radius: float, policy: Policy) -> float:
    """Clearance of the centre of the circle to the right, or of negative radius to the left [m]."""
    x = place.x - radius * sin(course)
    y = place.y + radius * cos(course)
    return _clearance(x, y, place, policy)


def _clearance(x: float, y: float, position: Vec, policy: Policy) -> float:
    """Depth of a place inside all fences and outside all zones at a vehicle's height [m]."""
    return min(_within(x, y, policy.fences), beside(x, y, position, policy))


def _within(x: float, y: float, fences: tuple[Fence, ...]) -> float:
    """Depth of a place inside all fences [m]."""
    least = 1e18
    for fence in fences:
        least = min(least, depth(x, y, fence.polygon))
    return least


def _towards(position: Vec, to: Nearest, speed: float, z: float) -> Vec:
    n = max(to.distance, TINY)
    return new(Vec, ((to.x - position.x) / n * speed, (to.y - position.y) / n * speed, z))
