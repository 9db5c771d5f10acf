"""Angles of the game frame [rad]. Kernel style."""

from __future__ import annotations

from math import pi

TURN = 2.0 * pi  # [rad]


def wrap(angle: float) -> float:
    """The same direction as `angle` [rad], as an angle in (−π, π].

    An angle that lies there already is returned unchanged, to the last bit. `angle` must be finite.
    """
    if -pi < angle <= pi:
        return angle
    rest = abs(angle) % TURN  # exact, in [0, 2π)
    if rest > pi:
        rest -= TURN
    return rest if angle > 0.0 or rest == pi else -rest
