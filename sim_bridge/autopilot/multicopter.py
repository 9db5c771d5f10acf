"""How multicopters fly what no setpoint says: hold, go to, take off, return, land.

Positions are in the frame in which motion is given [m; NED], velocities over ground [m/s; NED].
"""

from __future__ import annotations

from math import sqrt

from onboard.core.vectors import ZERO, Vec, norm, scale, sub
from sim_bridge.motion import Demand, Lateral

HOLD_GAIN = 1.0  # [1/s] of position
STOPPED = 0.2  # [m/s] below this a place to hold is taken
NEAR = 1.0  # [m] counts as there
TOUCHED = 0.05  # [m] above the ground
BRAKING = 2.0  # [m/s²] reckoned with on the way to a place


def velocity(v: Vec) -> Demand:
    """The demand for a ground velocity."""
    return Demand(Lateral.VELOCITY, v, 0.0, 0.0, 0.0)


REST = velocity(ZERO)


def towards(position: Vec, target: Vec, level: float, up: float, down: float) -> Vec:
    """Velocity that leads to a place and stops there, within a level, a climbing and a sinking speed."""
    x, y, z = target.x - position.x, target.y - position.y, target.z - position.z
    flat = sqrt(x * x + y * y)
    speed = min(level, HOLD_GAIN * flat, sqrt(2.0 * BRAKING * flat))
    k = speed / flat if flat > 1e-9 else 0.0
    vertical = HOLD_GAIN * z
    return Vec(x * k, y * k, max(-up, min(down, vertical)))


class Hold:
    """Stop, then keep the place where it stopped."""

    def __init__(self) -> None:
        self._place: Vec | None = None

    def reset(self) -> None:
        """Stop anew."""
        self._place = None

    def at(self, place: Vec) -> None:
        """Keep this place."""
        self._place = place

    def demand(self, position: Vec, v: Vec, level: float, up: float, down: float) -> Demand:
        """What keeps it there."""
        if self._place is None:
            if norm(v) > STOPPED:
                return REST
            self._place = position
        return velocity(towards(position, self._place, level, up, down))


def reached(position: Vec, target: Vec) -> bool:
    """Whether a place is reached."""
    return norm(sub(position, target)) < NEAR


def limited(v: Vec, most: float) -> Vec:
    """A velocity no faster than `most`."""
    speed = norm(v)
    return v if speed <= most else scale(v, most / speed)
