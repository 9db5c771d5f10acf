"""How near a wall is, and how fast it may be approached. Kernel style."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.math.each import new
from onboard.core.math.vectors import TINY, clamp


class Nearest(NamedTuple):
    """The point of a polygon's boundary nearest to a place."""

    distance: float  # [m]
    x: float
    y: float


def nearest_on(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> Nearest:
    """The point of the segment a–b nearest to a place."""
    ux = bx - ax
    uy = by - ay
    n = ux * ux + uy * uy
    t = clamp(((x - ax) * ux + (y - ay) * uy) / n, 0.0, 1.0) if n > TINY else 0.0
    qx = ax + t * ux
    qy = ay + t * uy
    return new(Nearest, (sqrt((x - qx) * (x - qx) + (y - qy) * (y - qy)), qx, qy))


def stopping_speed(distance: float, deceleration: float, reaction: float) -> float:
    """The fastest speed from which `distance` suffices to react and stop: v t + v²/2a = d [m/s]."""
    if distance <= 0.0 or deceleration <= 0.0:
        return 0.0
    t = reaction
    return deceleration * (sqrt(t * t + 2.0 * distance / deceleration) - t)
