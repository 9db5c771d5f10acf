"""Where pursuers go before the evader moves: bearings that close the ring, by a linear programme.

As seen from where the evader will be, about the line to its target, member i can be at any bearing x_i with
l_i ≤ x_i ≤ u_i when the game begins. Wanted are x_i in the members' order that minimise

    max(s, −ease) + |x_front|,   x_{i+1} − x_i ≤ h_i + h_{i+1} + s,

where h_i is half the heading that member i closes and one member stands on the line. The constraints are
differences and bounds, so that the least s is the largest (l_i − u_j − Σ h) / k over all chains of k
neighbours, and |x_front| as small as it can be is always best: pushing it costs 1 a radian and wins 1/k.
Kernel style but for local lists.
"""

from __future__ import annotations

from math import acos, asin, cos, inf, pi, sqrt
from typing import NamedTuple

from onboard.core.math.angles import TURN
from onboard.core.math.vectors import TINY, Vec, clamp, distance
from onboard.core.strategy.team.plan_types import Heights

STACK = 1.25  # times the separation: slots stay so far apart, and are so far above one another


class Ring(NamedTuple):
    """The order, the front and the least gap of a ring."""

    gap: float  # s [rad]: how much the widest pair lacks; negative: what the closest pair overlaps
    front: int  # index in order of the member on the line to the target
    off: float  # its bearing from that line [rad]


def swing(far: float, reach: float, nearest: float) -> float:
    """How far a pursuer changes its bearing on a standing evader while it flies `reach` [m]; rad, 0…π.

    It is `far` [m] away now, and `nearest` [m] at least when it arrives. It flies straight to the foot of the
    perpendicular on its new line of sight where that is far enough out, else to the circle of `nearest`.
    """
    if far <= TINY:
        return pi
    reach = max(0.0, reach)
    if reach <= 0.0:
        return 0.0
    free = asin(min(1.0, reach / far))
    if far * cos(free) >= nearest and reach < far:
        return free
    if far <= nearest and nearest - far > reach:
        return 0.0
    level = (far * far + nearest * nearest - reach * reach) / (2.0 * far * max(nearest, TINY))
    return acos(clamp(level, -1.0, 1.0))


def radius_at(far: float, swung: float, nearest: float) -> float:
    """How far from the evader the soonest slot is at a bearing `swung` [rad] from one's own."""
    return max(nearest, far * cos(swung))


def flight(far: float, swung: float, nearest: float) -> float:
    """How far it is to that slot [m]."""
    r = radius_at(far, swung, nearest)
    return sqrt(max(0.0, far * far + r * r - 2.0 * far * r * cos(swung)))


def _span(halves: list[float], first: int, steps: int) -> float:
    """What a chain of neighbours closes, from `first` over so many `steps` [rad]."""
    n = len(halves)
    found = 0.0
    for k in range(steps):
        found += halves[(first + k) % n] + halves[(first + k + 1) % n]
    return found


def least_gap(low: list[float], high: list[float], halves: list[float]) -> float:
    """The least s for which bearings between `low` and `high` exist, in order of the lists [rad]."""
    n = len(low)
    least = -inf
    for j in range(n):
        chain = 0.0
        for k in range(1, n + 1):
            i = (j + k) % n
            chain += halves[(j + k - 1) % n] + halves[i]
            over = TURN if j + k >= n else 0.0
            least = max(least, (low[i] + over - high[j] - chain) / k)
    return least


def ring_of(lows: list[float], highs: list[float], halves: list[float], ease: float, front: bool) -> Ring:
    """The best ring of members that can be between `lows` and `highs`, in order about the line to the target.

    Angles in rad; the members' own bearings, each between its low and its high, ascend in (−π, π].

    `ease` is the overlap of neighbours beyond which more is worth nothing. Without `front` nobody has to
    stand on the line.
    """
    n = len(lows)
    low = lows.copy()
    high = highs.copy()
    if not front:
        return Ring(least_gap(low, high, halves), -1, 0.0)
    best = Ring(inf, -1, 0.0)
    least = inf
    for c in range(n):
        lowest = low[c]
        highest = high[c]
        for i in range(n):  # the order is kept: whoever is before it can be before it still
            if i < c:
                lowest = max(lowest, low[i])
                highest = min(highest, high[i] + TURN)
            else:
                lowest = max(lowest, low[i] - TURN)
                highest = min(highest, high[i])
        off = clamp(0.0, lowest, highest)
        kept = (low[c], high[c])
        low[c] = off
        high[c] = off
        gap = least_gap(low, high, halves)
        low[c], high[c] = kept
        cost = max(gap, -ease) + abs(off)
        if cost < least - 1e-12:
            least = cost
            best = Ring(gap, c, off)
    return best


def slots_of(
    ring: Ring, bearings: list[float], lows: list[float], highs: list[float], halves: list[float]
) -> list[float]:
    """The bearings of a ring: of all that are as good, each as near to its member's own as can be [rad]."""
    n = len(bearings)
    s = ring.gap + 1e-12
    low = lows.copy()
    high = highs.copy()
    if ring.front >= 0:
        low[ring.front] = ring.off
        high[ring.front] = ring.off
    for i in range(n):
        lowest = low[i]
        highest = high[i]
        for k in range(1, n):
            j = (i + k) % n  # k places ahead of i
            turned = TURN if i + k >= n else 0.0
            ahead = _span(halves, i, k) + k * s
            behind = _span(halves, j, n - k) + (n - k) * s
            # x_j ≤ x_i + ahead and x_i ≤ x_j + behind, once round; and in order.
            lowest = max(lowest, low[j] + turned - ahead, low[j] + turned - TURN)
            highest = min(highest, high[j] + turned - TURN + behind, high[j] + turned)
        place = clamp(bearings[i], lowest, max(lowest, highest))
        low[i] = place
        high[i] = place
    return low


def stacked(places: list[Vec], separation: float, heights: Heights) -> list[Vec]:
    """The same places [m; NED], higher or lower where one is too near one before it: `separation` [m]."""
    keep = STACK * separation
    found = places.copy()
    n = len(places)
    for i in range(n):
        for k in range(2 * n + 1):
            z = places[i].z - keep * (0.5 * (k + 1) if k % 2 == 1 else -0.5 * k)  # up, down, twice up …
            if k > 0 and not heights.floor <= -z <= heights.ceiling:
                continue
            place = Vec(places[i].x, places[i].y, z)
            free = True
            for j in range(i):
                free = free and distance(place, found[j]) >= keep - 1e-9
            if free:
                found[i] = place
                break
    return found
