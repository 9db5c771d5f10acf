"""The free ray in space nearest to a preferred direction: the search over the edges of blocked cones.

The nearest free ray is the preferred one itself, the nearest point on one edge, or a crossing of two edges.
Mostly few cones decide which: the search takes one cone after another into account, each time the one in
which the nearest point left lies deepest, until that point lies in none. What is nearest outside some of the
cones and lies outside the others, too, is nearest outside all. Kernel style.
"""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence
from math import sqrt
from typing import NamedTuple

from onboard.core.geometry.cones import Cone, Ray, is_free, perpendicular
from onboard.core.geometry.rims import NOBODY, Rim, Spot, blend, crossing, on_edge, rim_of
from onboard.core.math.each import each, few_or_many, new, room, table
from onboard.core.math.vectors import TINY, Vec, dot, unit

ALIKE = 1e-9  # two rays whose closeness differs by less may both be the nearest
FLAT = 1e-15  # (n s)² m⁴ of an edge, below which one may lie on it m away: closeness falls by n s m² / 2
UNDECIDED = -2.5  # closeness below which a search says that it has not decided
TOUCH = 1e-4  # least square of the sine between the axes of two cones whose crossing is certain


class Found(NamedTuple):
    """What a search has found so far."""

    rims: MutableSequence[Rim]  # of the cones taken into account, in the order in which they were
    numbers: MutableSequence[int]  # which cones those are
    spots: MutableSequence[Spot]  # points on their edges that lie outside all of them


def free_ray(preferred: Vec, cones: tuple[Cone, ...]) -> Ray:
    """The free direction in space nearest to `preferred` (unit), exact; `exists` False if all is blocked.

    Of few cones all pairs are tried, which costs less than the search where it is interpreted. Compiled the
    search costs less, and pairs are tried where several rays may be as near: so both give the same bits.
    """
    if is_free(preferred, cones):
        return new(Ray, (True, preferred, 1.0))
    return few_or_many(by_pairs, one_by_one, of_many, cones, preferred)


def one_by_one(cones: tuple[Cone, ...], preferred: Vec) -> Ray:
    """What `by_pairs` finds, by the search."""
    found = _searched(cones, preferred, True)
    return by_pairs(cones, preferred) if found.closeness < UNDECIDED else found


def of_many(cones: tuple[Cone, ...], preferred: Vec) -> Ray:
    """The search where all pairs would be too many; of rays that are as near it takes any."""
    return _searched(cones, preferred, False)


def _searched(cones: tuple[Cone, ...], preferred: Vec, only: bool) -> Ray:
    """The nearest free ray by one cone after another; with `only`, a closeness of −3 if it may not be alone.

    The preferred one lies in a cone.
    """
    edges = table(rim_of, cones, preferred)
    total = len(cones)
    first = 0
    most = edges[0].level - edges[0].limit
    for k in range(1, total):
        depth = edges[k].level - edges[k].limit
        if depth > most:
            most = depth
            first = k
    if edges[first].cos < -1.0:
        return new(Ray, (False, preferred, -2.0))
    best = on_edge(edges[first], first, preferred)
    number = _deepest(best.x, best.y, best.z, edges, total)
    if number == first:  # all but a point is blocked, and rounding the point
        return new(Ray, (False, preferred, -3.0 if only else -2.0))
    found = new(Found, (room(edges[first], cones), room(first, cones), room(best, cones)))
    kept = 0
    if number >= 0:
        found.rims[0] = edges[first]
        found.numbers[0] = first
        found.spots[0] = best
        kept = 1
    count = 1
    while number >= 0:
        edge = edges[number]
        if edge.cos < -1.0:
            return new(Ray, (False, preferred, -2.0))
        kept = _left(found, kept, edge)
        found.rims[count] = edge
        found.numbers[count] = number
        count += 1
        kept = _added(found, count, kept, preferred)
        if kept == 0:
            return new(Ray, (False, preferred, -2.0))
        best = _nearest(found.spots, kept)
        number = _deepest(best.x, best.y, best.z, edges, total)
    if only and not _alone(best, found.spots, kept, edges, total):
        return new(Ray, (False, preferred, -3.0))
    u = new(Vec, (best.x, best.y, best.z))
    return new(Ray, (True, u if best.two == NOBODY else unit(u, preferred), best.closeness))


def _alone(best: Spot, spots: Sequence[Spot], kept: int, edges: Sequence[Rim], count: int) -> bool:
    """Whether it is certain that no other ray is as near as this one, but for rounding.

    None of the other points is; near this one there is no other edge; and its own edges lead away.
    """
    near = 0
    for k in range(kept):
        if spots[k].closeness >= best.closeness - ALIKE:
            near += 1
    if near > 1:
        return False
    margin = 2.0  # to the other cones, in cosines
    for k in range(count):
        if k != best.one and k != best.two:
            ax, ay, az, _c, _s, limit, _level = edges[k]
            margin = min(margin, limit - (best.x * ax + best.y * ay + best.z * az))
    one = edges[best.one]
    wide = margin * margin * margin * margin
    if (1.0 - one.level * one.level) * one.sin * one.sin * wide < FLAT:
        return False
    if best.two == NOBODY:
        return True
    two = edges[best.two]
    c = one.x * two.x + one.y * two.y + one.z * two.z
    return 1.0 - c * c > TOUCH and (1.0 - two.level * two.level) * two.sin * two.sin * wide >= FLAT


def _deepest(x: float, y: float, z: float, edges: Sequence[Rim], count: int) -> int:
    """The cone in which a point lies deepest, −1 if in none."""
    found = -1
    most = 0.0
    for k in range(count):
        ax, ay, az, _c, _s, limit, _level = edges[k]
        depth = x * ax + y * ay + z * az - limit
        if depth > most:
            most = depth
            found = k
    return found


def _left(found: Found, kept: int, edge: Rim) -> int:
    """Keep those points that lie outside one more cone; how many are left."""
    ax, ay, az, _c, _s, limit, _level = edge
    spots = found.spots
    left = 0
    for k in range(kept):
        x, y, z, _closeness, _one, _two = spots[k]
        if x * ax + y * ay + z * az <= limit:
            spots[left] = spots[k]
            left += 1
    return left


def _added(found: Found, count: int, kept: int, preferred: Vec) -> int:
    """Take down the points of the last edge that lie outside all cones so far; how many there are then."""
    rims, numbers, spots = found
    last = count - 1
    number = numbers[last]
    near = on_edge(rims[last], number, preferred)
    if _outside_all(near.x, near.y, near.z, rims, count):
        spots[kept] = near
        kept += 1
    for other in range(last):
        # The same bits whichever of the two was taken into account first.
        high, low = (other, last) if numbers[other] > number else (last, other)
        exists, (x, y, z), (dx, dy, dz), level, rise = crossing(rims[high], rims[low], preferred)
        if exists and _outside_all(x + dx, y + dy, z + dz, rims, count):
            spots[kept] = new(Spot, (x + dx, y + dy, z + dz, level + rise, number, numbers[other]))
            kept += 1
        if exists and _outside_all(x - dx, y - dy, z - dz, rims, count):
            spots[kept] = new(Spot, (x - dx, y - dy, z - dz, level - rise, number, numbers[other]))
            kept += 1
    return kept


def _outside_all(x: float, y: float, z: float, rims: Sequence[Rim], count: int) -> bool:
    """Whether a point lies in none of so many cones."""
    for k in range(count):
        ax, ay, az, _c, _s, limit, _level = rims[k]
        if x * ax + y * ay + z * az > limit:
            return False
    return True


def _nearest(spots: Sequence[Spot], kept: int) -> Spot:
    """The point nearest to the preferred direction, of equal ones the first."""
    best = spots[0]
    for k in range(1, kept):
        if spots[k].closeness > best.closeness:
            best = spots[k]
    return best


def _clear(x: float, y: float, z: float, edges: tuple[Rim, ...]) -> bool:
    for ax, ay, az, _c, _s, limit, _level in edges:  # noqa: SIM110
        if x * ax + y * ay + z * az > limit:
            return False
    return True


def by_pairs(cones: tuple[Cone, ...], preferred: Vec) -> Ray:
    """The nearest free ray among the nearest points and the crossings of all edges.

    Candidates nearer than the best so far are tested against all cones, the others never. Written out in
    floats: with few pursuers the interpreted onboard agent spends its time here.
    """
    for cone in cones:
        if cone.cos < -1.0:
            return new(Ray, (False, preferred, -2.0))
    px, py, pz = preferred
    edges = each(rim_of, cones, preferred)
    best = -2.0
    ray = preferred
    for i in range(len(edges)):
        ax, ay, az, ac, sine, _limit, pa = edges[i]
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
            axis = new(Vec, (ax, ay, az))
            side = perpendicular(axis) if n <= TINY else new(Vec, (x / n, y / n, z / n))
            side = unit(blend(side, 1.0, axis, -dot(side, axis)), preferred)
            u = unit(blend(axis, ac, side, sine), preferred)
        else:
            k = sine / n
            u = new(Vec, (ax * ac + x * k, ay * ac + y * k, az * ac + z * k))
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
                ray = unit(new(Vec, (lx + x, ly + y, lz + z)), preferred)
            elif level - rise > best and _clear(lx - x, ly - y, lz - z, edges):
                best = level - rise
                ray = unit(new(Vec, (lx - x, ly - y, lz - z)), preferred)
    return new(Ray, (best >= -1.5, ray, best))
