"""States of vehicles and their limits: (1)–(3)."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

from onboard.core.math.each import new
from onboard.core.math.vectors import Vec

CARRIED_MAX = 1.0  # a team mate is carried forward for no longer than this [s]


class VehicleLimits(NamedTuple):
    """What a vehicle may do: (2)–(3). Angles in radians, pitch up positive, yaw from north to east."""

    speed_min: float = 0.0  # [m/s; air]
    speed_max: float = 1e9  # [m/s; air]
    pitch_min: float = -pi / 2  # θ_min [rad]
    pitch_max: float = pi / 2  # θ_max [rad]
    yaw_min: float = -pi  # ψ_min [rad]
    yaw_max: float = pi  # ψ_max [rad]; a width of 2π or more means no limit
    turn_rate: float = 0.0  # of the course, at most [rad/s]; 0 = not declared


FREE = VehicleLimits()  # a vehicle that may do anything


class Vehicle(NamedTuple):
    """A vehicle as the strategies see it: Q of (1), in the game frame."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; relative to the air, NED]
    speed: float  # [m/s; air] the (maximum) speed the game reckons with


class MateState(NamedTuple):
    """What a team mate said of itself."""

    id: int
    t: float  # the instant that it is of [s]
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]


class Mate(NamedTuple):
    """A team mate, carried forward to now."""

    id: int
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    age: float  # since it was heard, or since the instant that its state is of [s]


def carried(mate: MateState, now: float) -> Mate:
    """A team mate where it is at `now` [s, the clock of its `t`], on at constant velocity.

    It is carried forward for CARRIED_MAX at most, and never back: an instant in the future (two clocks that
    differ) counts as now. The strategy and the supervisor are both given this one result.
    """
    age = now - mate.t
    ahead = 0.0 if age < 0.0 else (CARRIED_MAX if age > CARRIED_MAX else age)
    p, v = mate.position, mate.velocity
    return new(Mate, (mate.id, new(Vec, (p.x + v.x * ahead, p.y + v.y * ahead, p.z + v.z * ahead)), v, age))
