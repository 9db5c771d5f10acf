"""Cars that cannot turn at once: the homicidal chauffeur and two identical cars, in the plane.

Both work in the pursuer's frame in units of its turning circle: x to its right, y ahead [turning radii],
time in turning radii over its speed. Angles are clockwise as seen from above, as yaw is in the game frame.
"""

from __future__ import annotations

from math import atan2, cos, hypot, inf, pi, sin, sqrt
from typing import NamedTuple

TURNS = (-1.0, 0.0, 1.0)  # hard left, straight on, hard right
PARTS = 12  # instants of half a circle at which a turn may end
SAMPLES = 60  # instants of a hard turn of half a circle


class Tangent(NamedTuple):
    """How a car comes to follow an agile evader: a hard turn, then straight on behind it."""

    exists: bool  # not for an evader within the turning circle
    turn: float  # angle of the turn, right positive [rad]
    straight: float  # from the end of the turn to where the evader began [radii]


def tangent(x: float, y: float) -> Tangent:
    """The turn whose end points at the evader's present place: a tangent of the turning circle."""
    side = 1.0 if x >= 0.0 else -1.0
    across = abs(x) - 1.0
    square = across * across + y * y - 1.0
    if square < 0.0:
        return Tangent(False, 0.0, 0.0)
    length = sqrt(square)
    turn = atan2(y + length * across, length * y - across) % (2.0 * pi)
    return Tangent(True, side * turn, length)


def chauffeur_time(x: float, y: float, w: float, radius: float) -> float:
    """Time to capture of the homicidal chauffeur [radii / pursuer's speed]; NaN within the turning circle.

    Isaacs 10.2, the tributaries of the universal line; Merz 1971; Patsko and Turova 2001: the car turns until
    it points at the place where the evader was, the evader runs along that line. `w` is the evader's speed
    and `radius` that of capture, in the same units. It holds where that play crosses no barrier: at three
    turning radii or more within 60° of the nose, and everywhere in front when `radius` is large.
    """
    found = tangent(x, y)
    if not found.exists:
        return float("nan")
    turn = abs(found.turn)
    return turn + max(0.0, found.straight + w * turn - radius) / (1.0 - w)


class Miss(NamedTuple):
    """How near an identical car comes when both turn as is best for each."""

    distance: float  # smallest [radii]
    evader: float  # its turn: −1, 0 or 1
    pursuer: float
    when: float  # [radii / speed]
    guaranteed: float  # what the pursuer is sure of by turns that do not change; `distance` at a saddle
    margin: float  # by how much the evader's next best turn is worse [radii]


def apart(x: float, y: float, heading: float, turns: tuple[float, float], t: float) -> float:
    """Distance of two identical cars after `t` of constant turns (evader's, pursuer's) [radii]."""
    e, p = turns
    ex, ey = x, y
    if e == 0.0:
        ex += t * sin(heading)
        ey += t * cos(heading)
    else:
        ex += (cos(heading) - cos(heading + e * t)) / e
        ey += (sin(heading + e * t) - sin(heading)) / e
    if p == 0.0:
        return hypot(ex, ey - t)
    return hypot(ex - (1.0 - cos(p * t)) / p, ey - sin(p * t) / p)


def nearest_pass(x: float, y: float, heading: float, turns: tuple[float, float]) -> tuple[float, float]:
    """The least of `apart` over half a turn, and when: sampled, then refined by golden section."""
    step = pi / SAMPLES
    best, when = inf, 0.0
    for k in range(SAMPLES + 1):
        d = apart(x, y, heading, turns, k * step)
        if d < best:
            best, when = d, k * step
    low, high = max(0.0, when - step), min(pi, when + step)
    for _ in range(20):
        a, b = high - 0.618033988749895 * (high - low), low + 0.618033988749895 * (high - low)
        if apart(x, y, heading, turns, a) <= apart(x, y, heading, turns, b):
            high = b
        else:
            low = a
    middle = 0.5 * (low + high)
    return min(best, apart(x, y, heading, turns, middle)), middle


def straightened(x: float, y: float, heading: float, found: Miss) -> float:
    """How near the pursuer comes if it ends its turn early and goes straight on [radii].

    Less than `found.distance` where the play crosses Merz's universal surface: turns that are kept are not
    the pursuer's best there.
    """
    best = found.distance
    for part in range(1, PARTS):
        t = pi * part / PARTS
        e, p = found.evader, found.pursuer
        ex = x + (cos(heading) - cos(heading + e * t)) / e if e else x + t * sin(heading)
        ey = y + (sin(heading + e * t) - sin(heading)) / e if e else y + t * cos(heading)
        px, py = ((1.0 - cos(p * t)) / p, sin(p * t) / p) if p else (0.0, t)
        a, dx, dy = p * t, ex - px, ey - py
        left = dx * cos(a) - dy * sin(a), dx * sin(a) + dy * cos(a)
        best = min(best, nearest_pass(*left, heading + e * t - a, (e, 0.0))[0])
    return best


def two_cars(x: float, y: float, heading: float) -> Miss:
    """How near two identical cars come: the evader at (x, y), its heading less the pursuer's [rad].

    Merz 1972; Buzikov and Galyaev, arXiv 2206.10199: on the barrier both turn as hard as they can up to the
    nearest pass. The least over the pursuer's turns, the most over the evader's, each kept for half a circle.
    Where `guaranteed` equals `distance` and both turn, it agrees with a level-set solve to 0.06 radii in nine
    of ten states and 0.25 in all (tests); beyond, one of the two changes its turn under way.
    """
    passes = {(e, p): nearest_pass(x, y, heading, (e, p)) for e in TURNS for p in TURNS}
    answers = [min((passes[e, p][0], p) for p in TURNS) for e in TURNS]
    ranked = sorted(zip((d for d, _p in answers), TURNS, (p for _d, p in answers), strict=True), reverse=True)
    (best, e, p), (second, _e, _p) = ranked[:2]
    sure = min(max(passes[e, p][0] for e in TURNS) for p in TURNS)
    return Miss(best, e, p, passes[e, p][1], sure, best - second)
