"""What agents know and what they decided, as rows of arrays, one a player, evader first. Kernel style.

`states` (players, 9): position [m; NED], velocity over ground and wind as estimated [m/s], course through
the air [rad] of the last decision. `decided` (players, 6): course [rad], rule, aim [m; NED] and time until
then [s].
"""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.views import Held
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import TINY, Vec, clamp, yaw_of
from onboard.core.strategy.choosing import held_after
from onboard.core.strategy.knowledge import Decision
from sim_bridge.campaign.plane_in_wind import Flown
from sim_bridge.vehicle.wind.estimate import Estimate

Array = NDArray[np.float64]
KNOWS = 9  # numbers of a row of `states`
DECIDES = 6  # numbers of a row of `decided`


def known(states: Array, index: int) -> Vehicle:
    """Player `index` as its agent knows it: place and velocity over ground (its speed is nobody's)."""
    i, s = index, states  # no row of its own: compiled code would count who refers to it
    return Vehicle(Vec(s[i, 0], s[i, 1], s[i, 2]), Vec(s[i, 3], s[i, 4], s[i, 5]), 0.0)


def known_wind(states: Array, index: int) -> Vec:
    """The wind as player `index`'s autopilot estimates it [m/s; NED]."""
    return Vec(states[index, 6], states[index, 7], 0.0)


def known_nose(states: Array, index: int, speed: float) -> Vec:
    """Where the nose of player `index` points (unit), which flies at `speed` through the air [m/s]."""
    up = clamp(-states[index, 5] / max(speed, TINY), -1.0, 1.0)
    flat = sqrt(max(0.0, 1.0 - up * up))
    return Vec(flat * cos(states[index, 8]), flat * sin(states[index, 8]), -up)


def note(states: Array, index: int, flown: Flown) -> None:
    """Write down where aircraft `index` is, and its velocity over ground."""
    plane = flown.plane
    states[index, 0] = plane.position.x
    states[index, 1] = plane.position.y
    states[index, 2] = plane.position.z
    states[index, 3] = plane.velocity.x
    states[index, 4] = plane.velocity.y
    states[index, 5] = plane.velocity.z


def note_wind(states: Array, index: int, wind: Estimate) -> None:
    """Write down the wind as the autopilot of aircraft `index` estimates it."""
    states[index, 6] = wind.north
    states[index, 7] = wind.east


def held_by(decided: Array, index: int, since: float, wind: Vec) -> Held:
    """What player `index` decided `since` [s] ago leaves to its next decision."""
    i, d = index, decided
    aim = Vec(d[i, 2], d[i, 3], d[i, 4])
    return held_after(int(d[i, 1]), aim, d[i, 5], since, wind)


def write_down(decided: Array, index: int, decision: Decision) -> None:
    """Keep what player `index` decided: see `decide_all`."""
    decided[index, 0] = yaw_of(decision.direction)
    decided[index, 1] = decision.rule * 1  # a number, which an IntEnum is not to numba
    decided[index, 2] = decision.aim.x
    decided[index, 3] = decision.aim.y
    decided[index, 4] = decision.aim.z
    decided[index, 5] = decision.time
