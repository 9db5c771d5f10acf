"""Ways round zones: the first leg of the shortest one. Kernel style but for local lists.

The shortest way round convex zones is made of tangents and of their walls. It is searched from the near end,
the shortest promise first: a leg that meets a zone is replaced by the two tangents to that.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.geometry.zone_rays import Look
from onboard.core.geometry.zones import FAR, GRAZE, Area, after, before, corner_at, entry
from onboard.core.math.vectors import TINY, Vec, add, angle_between, distance, scale, unit

LEGS = 200  # corners of a search
NOWHERE = 1e300


class Way(NamedTuple):
    """The first leg of a way round zones."""

    round: bool  # False: straight to the aim
    to: Vec  # its end [m; NED]
    length: float  # of the whole way [m]


class Node(NamedTuple):
    """A corner that is reached."""

    x: float  # [m; north]
    y: float  # [m; east]
    gone: float  # the way to it [m], with what its first turn costs
    wall: int  # that begins in it; −1: the own place
    zone: int  # whose corner it is
    side: int  # which way about the zone it was reached: 1 with its walls, −1 against them
    first_x: float  # where the first leg ends [m; north]
    first_y: float  # [m; east]
    leg: float  # how long that is [m]


def way_round(look: Look, goal: Vec) -> Way:
    """The first leg of a short way to a place; straight there where no zone is in the way, or none leads."""
    here = look.position
    hit = first_met(look, here, goal, look.planar)
    if hit < 0:
        return Way(False, goal, distance(here, goal))
    best = beside(look, goal)
    if not look.planar:
        for side in (1.0, -1.0):
            over = above(look, hit, goal, side)
            if over.length < best.length:
                best = over
    return best


def first_met(look: Look, a: Vec, b: Vec, planar: bool) -> int:
    """The first zone that the way a–b enters, −1 where it enters none."""
    nearest = 1.0
    hit = -1
    for index in range(len(look.zones.areas)):
        share = entry(look.zones, look.zones.areas[index], look.margins[index], a, b, planar)
        if share < nearest:
            nearest = share
            hit = index
    return hit


def level_met(look: Look, a: Vec, b: Vec, up: Vec) -> int:
    """The same of a level way, by the zones that reach into the heights `up.x` to `up.y` [m]."""
    nearest = 1.0
    hit = -1
    for index in range(len(look.zones.areas)):
        area = look.zones.areas[index]
        margin = look.margins[index]
        if not look.planar and (area.low - margin > up.y or area.high + margin < up.x):
            continue
        share = entry(look.zones, area, margin, a, b, True)
        if share < nearest:
            nearest = share
            hit = index
    return hit


def beside(look: Look, goal: Vec) -> Way:
    """The shortest way beside the zones, at the heights between here and there."""
    p = look.position
    up = Vec(min(-p.z, -goal.z), max(-p.z, -goal.z), 0.0)
    end = Vec(goal.x, goal.y, 0.0)
    reached = [NOWHERE for _ in look.zones.walls]
    nodes = [Node(p.x, p.y, 0.0, -1, -1, 0, goal.x, goal.y, 0.0)]
    for _ in range(LEGS):
        if len(nodes) == 0:
            break
        best = 0
        least = NOWHERE
        for k in range(len(nodes)):
            promise = nodes[k].gone + _level(nodes[k].x, nodes[k].y, end)
            if promise < least:
                least = promise
                best = k
        node = nodes.pop(best)
        here = Vec(node.x, node.y, 0.0)
        hit = level_met(look, here, end, up)
        if hit < 0:
            rise = goal.z - p.z
            z = p.z + rise * node.leg / max(least, TINY)
            to = Vec(node.first_x, node.first_y, z) if node.wall >= 0 else goal
            return Way(node.wall >= 0, to, sqrt(least * least + rise * rise))
        _spread(look, node, hit, up, nodes, reached)
    return Way(False, goal, NOWHERE)


def _spread(look: Look, node: Node, hit: int, up: Vec, nodes: list[Node], reached: list[float]) -> None:
    """Add the corners to which a corner leads where the straight way on meets a zone."""
    here = Vec(node.x, node.y, 0.0)
    count = len(look.zones.areas)
    asked = [0 for _ in range(count)]
    asked[hit] = 1
    while True:
        zone = -1
        for k in range(count):
            if asked[k] == 1:
                zone = k
        if zone < 0:
            return
        asked[zone] = 2
        for side in (1, -1):
            if zone == node.zone and side != node.side:
                continue  # back the way it came
            wall = _tangent(look, node, zone, side)
            if wall < 0:
                continue
            x, y = corner_at(look.zones, wall, look.margins[zone])
            met = level_met(look, here, Vec(x, y, 0.0), up)
            if met >= 0:
                if asked[met] == 0:
                    asked[met] = 1
                continue
            leg = _level(x, y, here)
            gone = node.gone + leg
            if node.wall < 0:
                ahead = unit(Vec(x - here.x, y - here.y, 0.0), look.course)
                gone += look.turning * angle_between(ahead, look.course)
            if gone >= reached[wall]:
                continue
            reached[wall] = gone
            if node.wall < 0:
                nodes.append(Node(x, y, gone, wall, zone, side, x, y, leg))
            else:
                nodes.append(Node(x, y, gone, wall, zone, side, node.first_x, node.first_y, node.leg))


def _tangent(look: Look, node: Node, zone: int, side: int) -> int:
    """The wall that begins in the corner where a zone is touched, on with its walls (1) or against them."""
    area = look.zones.areas[zone]
    if zone == node.zone:
        return after(area, node.wall) if side > 0 else before(area, node.wall)
    margin = look.margins[zone]
    for index in range(area.first, area.first + area.sides):
        one = before(area, index) if side > 0 else index
        two = index if side > 0 else before(area, index)
        if _off(look, one, node, margin) > 0.0 >= _off(look, two, node, margin):
            return index
    return -1  # above it or below it


def _off(look: Look, wall: int, node: Node, margin: float) -> float:
    _x, _y, nx, ny, level, _mx, _my = look.zones.walls[wall]
    return nx * node.x + ny * node.y - level - margin


def _level(x: float, y: float, to: Vec) -> float:
    return sqrt((to.x - x) * (to.x - x) + (to.y - y) * (to.y - y))


def above(look: Look, index: int, goal: Vec, side: float) -> Way:
    """The way over a zone (1) or under it (−1): to that height over its rim, along, and on to the goal."""
    area: Area = look.zones.areas[index]
    margin = look.margins[index]
    nowhere = Way(False, goal, NOWHERE)
    top = area.high + margin if side > 0.0 else area.low - margin
    p = look.position
    a = Vec(p.x, p.y, 0.0)
    b = Vec(goal.x, goal.y, 0.0)
    share = entry(look.zones, area, margin, a, b, True)
    back = entry(look.zones, area, margin, b, a, True)
    if abs(top) > FAR or share > 1.0 or back > 1.0:
        return nowhere
    if share <= 0.0:  # above it or below it already
        if side * (-p.z - top) < -GRAZE:
            return nowhere
        share = 1.0 - back
    rim = add(scale(a, 1.0 - share), scale(b, share))
    far = add(scale(b, 1.0 - back), scale(a, back))
    rim = Vec(rim.x, rim.y, -top)
    far = Vec(far.x, far.y, -top)
    if first_met(look, p, rim, False) >= 0:
        return nowhere
    return Way(True, rim, distance(p, rim) + distance(rim, far) + distance(far, goal))
