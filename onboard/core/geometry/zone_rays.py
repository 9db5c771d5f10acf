"""Free rays beside zones: what a zone blocks, seen from a place in moving air. Kernel style.

In the plane the directions from which a ray enters a convex zone before its end are an arc between two
tangents: one cone more. In space a zone blocks a pyramid: free is what lies beyond one of the planes through
the place and an edge of its outline. Each such plane is a half-space, a cone of half-angle 90° (another one
in wind), and the search tries them where the zone is in the way, the best of all branches.
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.geometry.cones import EDGE, NOTHING, Cone, Ray
from onboard.core.geometry.free_ray import free_ray_limited
from onboard.core.geometry.zones import (
    FAR,
    MOST_CORNERS,
    Area,
    Zones,
    after,
    before,
    clearance,
    corner_at,
    entry,
)
from onboard.core.math.each import each
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import NORTH, TINY, Vec, along, clamp, cross, dot, scale, sub, unit

SHARE = 0.999  # of the own clearance that is kept where the margin cannot be
FACES = 3 * MOST_CORNERS + 1  # branches of a zone, and none
TRIES = 2000  # branches of a search


class Stand(NamedTuple):
    """Where one stands among zones, and what is to be kept to them (for `each`)."""

    zones: Zones
    position: Vec  # [m; NED]
    aim: Vec  # a place that must stay in reach [m; NED]
    margin: float  # kept to zones [m]
    planar: bool
    course: Vec = NORTH  # over ground now (unit)
    turning: float = 1.0  # radius of turns [m]


class Look(NamedTuple):
    """From where one looks at zones, and how far."""

    zones: Zones
    position: Vec  # [m; NED]
    speed: float  # through the air [m/s]
    wind: Vec  # where the air moves to [m/s]
    reach: float  # over ground: what is entered beyond it does not count [m]
    margins: tuple[float, ...]  # kept to each zone [m]
    planar: bool
    course: Vec  # over ground now (unit)
    turning: float  # radius of turns [m]: of ways of one length that with less turning is taken


def margin_to(area: Area, _index: int, stand: Stand) -> float:
    """The margin kept to a zone [m] (for `each`): less where the own place or the aim lies within it."""
    own = SHARE * clearance(stand.zones, area, stand.position, stand.planar)
    aim = SHARE * clearance(stand.zones, area, stand.aim, stand.planar)
    margin = min(stand.margin, own)
    return min(margin, aim) if aim > 0.0 else margin


def looking(stand: Stand, speed: float, wind: Vec, reach: float) -> Look:
    """A look from a stand, at a speed through the air [m/s] in wind [m/s], as far as a reach [m]."""
    margins = each(margin_to, stand.zones.areas, stand)
    return Look(
        stand.zones, stand.position, speed, wind, reach, margins, stand.planar, stand.course, stand.turning
    )


def over_ground(direction: Vec, look: Look) -> Vec:
    """The velocity over ground of a direction through the air [m/s]."""
    return along(look.wind, direction, look.speed)


def held_course(course: Vec, speed: float, wind: Vec) -> Vec:
    """The direction through the air (unit) that makes good a course over ground (unit); level.

    Where the wind across is too strong for it, straight against that.
    """
    x, y = -course.y, course.x
    across = clamp(-(wind.x * x + wind.y * y) / max(speed, TINY), -1.0, 1.0)
    ahead = sqrt(1.0 - across * across)
    return Vec(ahead * course.x + across * x, ahead * course.y + across * y, 0.0)


class Sector(NamedTuple):
    """Ground courses between two tangents of a zone."""

    exists: bool  # False: nothing of the zone is in reach
    low: Vec  # unit
    high: Vec  # unit; clockwise from `low` as seen from above


def sector_of(area: Area, margin: float, look: Look) -> Sector:
    """The courses from which a zone is entered within reach: the outline of what of it lies there."""
    zones, (px, py, _pz), reach = look.zones, look.position, look.reach
    nearest = -1e300
    ref = NORTH
    for index in range(area.first, area.first + area.sides):
        _x, _y, nx, ny, level, _mx, _my = zones.walls[index]
        off = nx * px + ny * py - level
        if off > nearest:
            nearest = off
            ref = Vec(-nx, -ny, 0.0)
    low = high = NORTH
    least, most = 10.0, -10.0
    for index in range(area.first, area.first + area.sides):
        ax, ay = corner_at(zones, index, margin)
        bx, by = corner_at(zones, after(area, index), margin)
        ax, ay, bx, by = ax - px, ay - py, bx - px, by - py
        ex, ey = bx - ax, by - ay
        # Of each wall: its corner, and where it leaves the reach.
        ee = ex * ex + ey * ey
        ae = ax * ex + ay * ey
        inside = ae * ae - ee * (ax * ax + ay * ay - reach * reach)
        for part in range(3):
            share = 0.0
            if part > 0:
                if inside < 0.0 or ee <= TINY:
                    continue
                share = (-ae + (sqrt(inside) if part == 1 else -sqrt(inside))) / ee
                if share < 0.0 or share > 1.0:
                    continue
            x = ax + share * ex
            y = ay + share * ey
            far = x * x + y * y
            if far <= TINY or (part == 0 and far > reach * reach):
                continue
            angle = atan2(ref.x * y - ref.y * x, ref.x * x + ref.y * y)
            n = sqrt(far)
            if angle < least:
                least = angle
                low = Vec(x / n, y / n, 0.0)
            if angle > most:
                most = angle
                high = Vec(x / n, y / n, 0.0)
    return Sector(most > least, low, high)


def blocked_arc(area: Area, index: int, look: Look) -> Cone:
    """The arc of directions through the air that a zone blocks in the plane (for `each`)."""
    sector = sector_of(area, look.margins[index], look)
    if not sector.exists:
        return NOTHING
    low = held_course(sector.low, look.speed, look.wind)
    high = held_course(sector.high, look.speed, look.wind)
    wide = atan2(low.x * high.y - low.y * high.x, low.x * high.x + low.y * high.y)
    if wide < -EDGE:
        wide += 2.0 * pi
    if wide <= EDGE:
        return NOTHING
    c = cos(0.5 * wide)
    s = sin(0.5 * wide)
    return Cone(Vec(low.x * c - low.y * s, low.x * s + low.y * c, 0.0), c, s)


class Face(NamedTuple):
    """A plane through the own place and an edge of a zone's outline."""

    exists: bool
    outward: Vec  # unit normal, away from the zone


NO_FACE = Face(False, NORTH)


def face_of(area: Area, number: int, margin: float, look: Look) -> Face:
    """Plane `number` of a zone: through an upright edge, an upper one or a lower one, in that order.

    It is one of the outline where one of the two faces that meet in the edge is seen and the other is not.
    """
    kind = number // area.sides
    index = area.first + number % area.sides
    wall = look.zones.walls[index]
    place = look.position
    seen = wall.nx * place.x + wall.ny * place.y - wall.level > margin
    ax, ay = corner_at(look.zones, index, margin)
    up = -place.z
    if kind == 0:
        last = look.zones.walls[before(area, index)]
        if (last.nx * place.x + last.ny * place.y - last.level > margin) == seen:
            return NO_FACE
        a = Vec(ax - place.x, ay - place.y, 0.0)
        b = Vec(0.0, 0.0, 1.0)
    else:
        top = area.high + margin if kind == 1 else area.low - margin
        beyond = up > top if kind == 1 else up < top
        if abs(top) > FAR or beyond == seen:
            return NO_FACE
        bx, by = corner_at(look.zones, after(area, index), margin)
        a = Vec(ax - place.x, ay - place.y, -top - place.z)
        b = Vec(bx - ax, by - ay, 0.0)
    n = cross(a, b)
    if dot(n, n) <= TINY:
        return NO_FACE
    n = unit(n, NORTH)
    middle = clamp(up, area.low + 0.25 * min(area.high - area.low, 1.0),
                   area.high - 0.25 * min(area.high - area.low, 1.0))  # fmt: skip
    if dot(n, sub(Vec(area.x, area.y, -middle), place)) > 0.0:
        n = scale(n, -1.0)
    return Face(True, n)


def half_space(face: Face, look: Look) -> Cone:
    """What a plane leaves blocked: directions whose velocity over ground leads to its inner side."""
    if not face.exists:
        return NOTHING
    c = dot(look.wind, face.outward) / max(look.speed, TINY)
    return Cone(scale(face.outward, -1.0), c, sqrt(max(0.0, 1.0 - c * c)))


def enters(index: int, direction: Vec, look: Look) -> bool:
    """Whether a ray through the air, in space, enters a zone within reach."""
    area, margin = look.zones.areas[index], look.margins[index]
    over = over_ground(direction, look)
    end = along(look.position, unit(over, direction), look.reach)
    if entry(look.zones, area, margin, look.position, end, False) > 1.0:
        return False
    for number in range(3 * area.sides):
        face = face_of(area, number, margin, look)
        if face.exists and dot(over, face.outward) >= -EDGE * look.speed:
            return False
    return True


def first_entered(direction: Vec, look: Look) -> int:
    """The first zone that a ray enters in space, −1 where it enters none."""
    for index in range(len(look.zones.areas)):
        if enters(index, direction, look):
            return index
    return -1


class Branch(NamedTuple):
    """A branch of the search: beyond which plane of each zone, digits to the base of FACES; 0 is none."""

    look: Look
    code: int


def bound_of(area: Area, index: int, branch: Branch) -> Cone:
    """What a branch blocks for a zone (for `each`)."""
    rest = branch.code
    for _ in range(index):
        rest //= FACES
    number = rest % FACES
    if number == 0:
        return NOTHING
    return half_space(face_of(area, number - 1, branch.look.margins[index], branch.look), branch.look)


def free_ray_beside(preferred: Vec, cones: tuple[Cone, ...], limits: VehicleLimits, look: Look) -> Ray:
    """The direction nearest to `preferred` (unit) that is free of cones and of zones, within the limits."""
    zones = look.zones
    if look.planar:
        arcs = each(blocked_arc, zones.areas, look)
        return free_ray_limited(preferred, (*cones, *arcs), limits, True)
    best = Ray(False, preferred, -2.0)
    branches = [0]
    tried = 0
    while len(branches) > 0 and tried < TRIES:
        tried += 1
        code = branches.pop()
        bounds = each(bound_of, zones.areas, Branch(look, code))
        ray = free_ray_limited(preferred, (*cones, *bounds), limits, False)
        if not ray.exists or ray.closeness <= best.closeness:
            continue
        hit = first_entered(ray.direction, look)
        if hit < 0:
            best = ray
            continue
        place = 1
        for _ in range(hit):
            place *= FACES
        if code // place % FACES > 0:
            continue  # rounding: it is beyond that zone already
        for number in range(3 * zones.areas[hit].sides):
            if face_of(zones.areas[hit], number, look.margins[hit], look).exists:
                branches.append(code + (number + 1) * place)
    return best
