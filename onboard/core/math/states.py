"""Vehicle states and their limits: (1)–(3)."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

from onboard.core.math.vectors import Vec


class VehicleLimits(NamedTuple):
    """What a vehicle may do: (2)–(3). Angles in radians, pitch up positive."""

    speed_min: float = 0.0  # [m/s; air]
    speed_max: float = 1e9  # [m/s; air]
    pitch_min: float = -pi / 2  # θ_min [rad]
    pitch_max: float = pi / 2  # θ_max [rad]
    yaw_min: float = -pi  # ψ_min [rad]
    yaw_max: float = pi  # ψ_max [rad]; a width of 2π or more means no limit


class Vehicle(NamedTuple):
    """A vehicle as the strategies see it: Q of (1), in the game frame."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; relative to the air, NED]
    speed: float  # [m/s; air] the (maximum) speed the game reckons with
