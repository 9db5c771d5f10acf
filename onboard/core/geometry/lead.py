"""The direction in which a pursuer keeps its line of sight to the evader parallel to itself. Kernel style."""

from __future__ import annotations

from math import sqrt

from onboard.core.math.each import new
from onboard.core.math.vectors import Vec, along, dot, sub, unit


def lead(place: Vec, speed: float, evader: Vec, velocity: Vec) -> Vec:
    """The direction of parallel pursuit (unit): the evader's velocity across the line of sight is matched.

    From `place` [m] at `speed` [m/s], of an evader there with that velocity [m/s]. Where the evader crosses
    faster than the pursuer flies, all of the speed goes across.
    """
    sight = unit(sub(evader, place), unit(velocity, new(Vec, (1.0, 0.0, 0.0))))
    across = along(velocity, sight, -dot(velocity, sight))
    lateral = dot(across, across)
    if lateral >= speed * speed:
        return unit(across, sight)
    return unit(along(across, sight, sqrt(max(0.0, speed * speed - lateral))), sight)
