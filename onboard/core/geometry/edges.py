"""The free ray in space nearest to a preferred direction: the search over the edges of blocked cones.

The nearest free ray is the preferred one itself, the nearest point on one edge, or a crossing of two edges.
Kernel style.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

from onboard.core.geometry.cones import EDGE, Cone, Ray, is_free, perpendicular
from onboard.core.geometry.rims import Crossing, Rim, blend, crossing, nearer_crossing, on_edge, point, rim_of
from onboard.core.math.each import each, few_or_many, table
from onboard.core.math.vectors import TINY, Vec, along, cross, dot, unit

TRIES = 12  # of pairs of cones that may decide


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


def _deepest(u: Vec, edges: Sequence[Rim], count: int) -> int:
    """The cone in which a ray lies deepest, −1 if it is free."""
    x, y, z = u
    found = -1
    most = 0.0
    for k in range(count):
        ax, ay, az, _c, _s, limit, _level, _n, _near = edges[k]
        depth = x * ax + y * ay + z * az - limit
        if depth > most:
            most = depth
            found = k
    return found


def _first(x: float, y: float, z: float, edges: Sequence[Rim], count: int) -> int:
    """The first cone in which a ray lies, −1 if it is free."""
    for k in range(count):
        ax, ay, az, _c, _s, limit, _level, _n, _near = edges[k]
        if x * ax + y * ay + z * az > limit:
            return k
    return -1


def free_ray(preferred: Vec, cones: tuple[Cone, ...]) -> Ray:
    """The free direction in space nearest to `preferred` (unit), exact; `exists` False if all is blocked.

    Of few cones all pairs are tried. Of many mostly one or two decide, and that nothing is nearer is certain;
    else edges are gone round.
    """
    if is_free(preferred, cones):
        return Ray(True, preferred, 1.0)
    for cone in cones:
        if cone.cos < -1.0:
            return Ray(False, preferred, -2.0)
    return few_or_many(_by_pairs, _by_edges, cones, preferred)


def _by_edges(cones: tuple[Cone, ...], preferred: Vec) -> Ray:
    edges = table(rim_of, cones, preferred)
    count = len(cones)
    ray = _decided_by_two(preferred, edges, count)
    if ray.exists:
        return ray
    return _round_edges(preferred, edges, count)


def _by_pairs(cones: tuple[Cone, ...], preferred: Vec) -> Ray:
    """The nearest free ray among the nearest points and the crossings of all edges.

    Candidates nearer than the best so far are tested against all cones, the others never. Written out in
    floats: with few pursuers the interpreted onboard agent spends its time here.
    """
    px, py, pz = preferred
    edges = each(edge_of, cones, preferred)
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
            axis = Vec(ax, ay, az)
            side = perpendicular(axis) if n <= TINY else Vec(x / n, y / n, z / n)
            side = unit(blend(side, 1.0, axis, -dot(side, axis)), preferred)
            u = unit(blend(axis, ac, side, sine), preferred)
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


def _decided_by_two(preferred: Vec, edges: Sequence[Rim], count: int) -> Ray:
    """The nearest free ray where one or two cones decide it for certain; else none."""
    nothing = Ray(False, preferred, -2.0)
    i = _deepest(preferred, edges, count)
    j = -1
    if i < 0 or edges[i].cos < -1.0:
        return nothing
    ray = on_edge(edges[i], preferred)
    for _ in range(TRIES):
        k = _deepest(ray.direction, edges, count)
        if k < 0:
            return ray
        edge = edges[k]
        found = nothing
        if edge.cos < -1.0:
            return nothing
        one = i
        if edge.level > edge.cos:
            alone = on_edge(edge, preferred)
            u = alone.direction
            if _outside(u, edges[i]) and (j < 0 or _outside(u, edges[j])):
                found = alone
                one = -1
        if not found.exists:
            found = nearer_crossing(edges[max(i, k)], edges[min(i, k)], preferred)
            if found.exists and j >= 0 and not _outside(found.direction, edges[j]):
                found = nothing
        if not found.exists and j >= 0:
            found = nearer_crossing(edges[max(j, k)], edges[min(j, k)], preferred)
            one = j
            if found.exists and not _outside(found.direction, edges[i]):
                found = nothing
        if not found.exists or found.closeness >= ray.closeness:
            return nothing
        ray = found
        i = k
        j = one
    return nothing


def _outside(u: Vec, edge: Rim) -> bool:
    return u.x * edge.x + u.y * edge.y + u.z * edge.z <= edge.limit


def _round_edges(preferred: Vec, edges: Sequence[Rim], count: int) -> Ray:
    """The nearest free ray of all edges, going round each both ways from one blocked arc's end to the next.

    The nearest edge comes first. Of n cones that takes some n² steps where all pairs of edges take n³.
    """
    best = Ray(False, preferred, -2.0)
    order = _nearest_four(2.0, -1, edges, count)
    while order.first >= 0 and edges[order.first].near > best.closeness:  # no point of an edge is nearer
        i = order.first
        near = on_edge(edges[i], preferred)
        u = near.direction
        first = _first(u.x, u.y, u.z, edges, count)
        if first < 0:
            return near
        blocked = crossing(edges[i], edges[first], preferred)
        for side in (1.0, -1.0):
            walk = Walk(i, near.direction, side, best.closeness)
            found = _end_of_blocked(preferred, edges, count, walk, blocked)
            if found.exists:
                best = found
        if order.second >= 0:
            order = Order(order.second, order.third, order.fourth, -1)
        else:
            order = _nearest_four(edges[i].near, i, edges, count)
    return best


class Order(NamedTuple):
    """Edges one after another, the nearest first; −1 where there are no more."""

    first: int
    second: int
    third: int
    fourth: int


def _nearest_four(near: float, index: int, edges: Sequence[Rim], count: int) -> Order:
    """The edges that come after edge `index`, `near` to the preferred direction."""
    a, b, c, d = -1, -1, -1, -1
    far_a, far_b, far_c, far_d = -2.5, -2.5, -2.5, -2.5
    for k in range(count):
        other = edges[k].near
        if other > far_d and (other < near or (other == near and k > index)):
            if other > far_b:
                c, far_c, d, far_d = b, far_b, c, far_c
                if other > far_a:
                    a, far_a, b, far_b = k, other, a, far_a
                else:
                    b, far_b = k, other
            elif other > far_c:
                c, far_c, d, far_d = k, other, c, far_c
            else:
                d, far_d = k, other
    return Order(a, b, c, d)


class Walk(NamedTuple):
    """A way round an edge from its nearest point."""

    edge: int
    start: Vec  # unit
    side: float  # 1 anticlockwise about the axis, −1 clockwise
    floor: float  # closeness that a free point must exceed


def _end_of_blocked(preferred: Vec, edges: Sequence[Rim], count: int, walk: Walk, blocked: Crossing) -> Ray:
    """The first free point of an edge at most half the way round; `blocked` is the arc that it begins in."""
    edge = edges[walk.edge]
    axis = Vec(edge.x, edge.y, edge.z)
    ahead = along(walk.start, axis, -edge.cos)
    left = cross(axis, ahead)
    c = 1.0
    s = 0.0
    while True:
        closeness = blocked.level + walk.side * blocked.rise
        if not blocked.exists or closeness <= walk.floor:
            return Ray(False, preferred, -2.0)
        u = along(blocked.along, blocked.across, walk.side)
        forward = dot(u, ahead)
        turned = walk.side * dot(u, left)
        if turned < 0.0 or c * turned - s * forward <= 0.0:
            return Ray(False, preferred, -2.0)  # past the far side
        c = forward
        s = turned
        k = _first(u.x, u.y, u.z, edges, count)
        if k < 0:
            return point(blocked, walk.side, preferred)
        blocked = crossing(edge, edges[k], preferred)
