"""How the simulated autopilots of planes steer: onto and around circles, and what a climb may be."""

from __future__ import annotations

from math import atan, atan2, hypot, pi

from onboard.core.math.vectors import Vec

ALTITUDE_S = 3.3  # [s] climb rate per altitude error
CIRCLE_GAIN = 2.0  # how steeply it turns towards a circle, per radius


def circling_course(position: Vec, yaw: float, centre: Vec, radius: float, turn: float) -> float:
    """Course over ground [rad] that leads onto and around a circle; `turn` is 1 clockwise, −1 against."""
    north, east = position.x - centre.x, position.y - centre.y
    if hypot(north, east) < 1.0:
        return yaw
    outward = atan2(east, north)
    inward = atan(CIRCLE_GAIN * (hypot(north, east) - radius) / radius)
    return outward + turn * (0.5 * pi + inward)
