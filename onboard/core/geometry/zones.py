"""Zones that nobody flies into: convex polygons of (north, east) with a band of heights. Kernel style.

All walls of all zones stand in one flat tuple, so that any number of zones compiles. A zone may be looked at
grown by a margin: every wall moved outwards by it, corners as mitres. `clearance` is measured the same way:
the zone grown by a place's clearance has the place on its boundary.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.math.vectors import TINY, Vec

FAR = 1e8  # [m] heights beyond it are no floor and no ceiling
ENDLESS = 1e9  # [m] height of a zone without one
GRAZE = 1e-6  # [m] a path this deep in a zone touches it only
ROUND = 16  # corners of the polygon about a disc
MOST_CORNERS = ROUND
MOST_ZONES = 8
MISSES = 2.0  # share of a segment that does not enter

Corner = tuple[float, float]


class Prism(NamedTuple):
    """One zone as people write it."""

    polygon: tuple[Corner, ...]  # convex, (north, east) [m]
    low: float = -ENDLESS  # [m above the origin]
    high: float = ENDLESS  # [m above the origin]


class Area(NamedTuple):
    """One zone: which walls are its own, and its band of heights."""

    first: int  # wall
    sides: int  # walls
    low: float  # [m above the origin]
    high: float  # [m above the origin]
    x: float  # a place inside [m; north]
    y: float  # [m; east]


class Wall(NamedTuple):
    """A wall, which begins at a corner; the next wall of its zone begins where it ends."""

    x: float  # of the corner [m; north]
    y: float  # [m; east]
    nx: float  # outward normal, unit
    ny: float
    level: float  # of the wall along its normal [m]
    mx: float  # where the corner moves by a margin of 1 m
    my: float


class Zones(NamedTuple):
    """All zones of a game."""

    areas: tuple[Area, ...] = ()
    walls: tuple[Wall, ...] = ()


NO_ZONES = Zones()


class Exit(NamedTuple):
    """The shortest way out of a zone."""

    clearance: float  # of the place [m]; negative inside
    outward: Vec  # unit


def round_about(centre: Corner, radius: float) -> tuple[Corner, ...]:
    """The regular polygon about a disc: it holds the disc, and 2 % more."""
    out = radius / cos(pi / ROUND)
    turns = [2.0 * pi * k / ROUND for k in range(ROUND)]
    return tuple((centre[0] + out * cos(t), centre[1] + out * sin(t)) for t in turns)


def bent_in(polygon: Sequence[Corner]) -> int:
    """The number of a corner at which a polygon is not convex, −1 where it is convex everywhere.

    A polygon that winds about more than once counts as bent at its first corner.
    """
    n = len(polygon)
    turned = [_turn(polygon[k - 1], polygon[k], polygon[(k + 1) % n]) for k in range(n)]
    way = 1.0 if _twice_area(polygon) > 0.0 else -1.0
    for k in range(n):
        if way * turned[k] <= 0.0:
            return k
    rises = [polygon[(k + 1) % n][1] > polygon[k][1] for k in range(n)]
    return -1 if sum(rises[k] and not rises[k - 1] for k in range(n)) <= 1 else 0


def _turn(a: Corner, b: Corner, c: Corner) -> float:
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def _twice_area(polygon: Sequence[Corner]) -> float:
    n = len(polygon)
    return sum(
        polygon[k][0] * polygon[(k + 1) % n][1] - polygon[k][1] * polygon[(k + 1) % n][0] for k in range(n)
    )


def zones_of(prisms: Sequence[Prism]) -> Zones:
    """The zones for the core; every polygon convex, wound either way."""
    areas: list[Area] = []
    walls: list[Wall] = []
    for polygon, low, high in prisms:
        ring = polygon if _twice_area(polygon) > 0.0 else polygon[::-1]
        n = len(ring)
        middle = (sum(c[0] for c in ring) / n, sum(c[1] for c in ring) / n)
        areas.append(Area(len(walls), n, low, high, middle[0], middle[1]))
        normals = [_normal(ring[k], ring[(k + 1) % n]) for k in range(n)]
        for k, (x, y) in enumerate(ring):
            (ax, ay), (bx, by) = normals[k - 1], normals[k]
            bend = 1.0 + ax * bx + ay * by
            walls.append(Wall(x, y, bx, by, bx * x + by * y, (ax + bx) / bend, (ay + by) / bend))
    return Zones(tuple(areas), tuple(walls))


def _normal(a: Corner, b: Corner) -> Corner:
    x, y = b[0] - a[0], b[1] - a[1]
    n = sqrt(x * x + y * y)
    return y / n, -x / n


def corner_at(zones: Zones, index: int, margin: float) -> Corner:
    """The corner where a wall begins, of the zone grown by a margin [m]."""
    x, y, _nx, _ny, _level, mx, my = zones.walls[index]
    return x + margin * mx, y + margin * my


def after(area: Area, index: int) -> int:
    """The wall after a wall of a zone."""
    return index + 1 if index + 1 < area.first + area.sides else area.first


def before(area: Area, index: int) -> int:
    """The wall before a wall of a zone."""
    return index - 1 if index > area.first else area.first + area.sides - 1


def way_out_of(zones: Zones, area: Area, place: Vec, planar: bool) -> Exit:
    """How far a place lies outside a zone by its farthest face, and the way out through that one.

    In a plane game heights do not count.
    """
    most = -1e300
    out = Vec(1.0, 0.0, 0.0)
    for index in range(area.first, area.first + area.sides):
        _x, _y, nx, ny, level, _mx, _my = zones.walls[index]
        off = nx * place.x + ny * place.y - level
        if off > most:
            most = off
            out = Vec(nx, ny, 0.0)
    if not planar:
        up = -place.z
        if up - area.high > most:
            most = up - area.high
            out = Vec(0.0, 0.0, -1.0)
        if area.low - up > most:
            most = area.low - up
            out = Vec(0.0, 0.0, 1.0)
    return Exit(most, out)


def clearance(zones: Zones, area: Area, place: Vec, planar: bool) -> float:
    """How far a place lies outside a zone by its farthest face [m]; negative inside."""
    return way_out_of(zones, area, place, planar).clearance


def in_any(zones: Zones, place: Vec, planar: bool) -> bool:
    """Whether a place lies in a zone, its boundary not counted."""
    for area in zones.areas:  # noqa: SIM110 (a loop compiles)
        if clearance(zones, area, place, planar) < 0.0:
            return True
    return False


def least_clearance(zones: Zones, place: Vec, planar: bool) -> float:
    """The clearance of the nearest zone [m]; 1e300 where there is none."""
    least = 1e300
    for area in zones.areas:
        least = min(least, clearance(zones, area, place, planar))
    return least


def entry(zones: Zones, area: Area, margin: float, a: Vec, b: Vec, planar: bool) -> float:
    """The share of the way a–b at which it enters a zone grown by a margin [m]; MISSES if it does not.

    Touching is not entering.
    """
    low = 0.0
    high = 1.0
    keep = margin - GRAZE
    for index in range(area.first, area.first + area.sides):
        _x, _y, nx, ny, level, _mx, _my = zones.walls[index]
        off = nx * a.x + ny * a.y - level - keep
        rate = nx * (b.x - a.x) + ny * (b.y - a.y)
        if abs(rate) <= TINY:
            if off > 0.0:
                return MISSES
        elif rate < 0.0:
            low = max(low, -off / rate)
        else:
            high = min(high, -off / rate)
        if low > high:
            return MISSES
    if not planar:
        for side in (-1.0, 1.0):
            face = area.high if side > 0.0 else -area.low
            off = -side * a.z - face - keep
            rate = -side * (b.z - a.z)
            if abs(rate) <= TINY:
                if off > 0.0:
                    return MISSES
            elif rate < 0.0:
                low = max(low, -off / rate)
            else:
                high = min(high, -off / rate)
        if low > high:
            return MISSES
    return low
