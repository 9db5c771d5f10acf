"""How bank, altitude and airspeed are made of a velocity for a plane's autopilot. Kernel style.

Onboard the adapter of ArduPlane sends them; the compiled games fly by the same functions.
"""

from __future__ import annotations

from math import atan, atan2, sqrt
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.constants import NEVER, STANDARD_GRAVITY
from onboard.core.math.vectors import Vec, clamp

GAIN = 1.1  # [1/s] turn rate for an error of the course
CREEP = 3.0  # [m/s; ground] below this there is no course: the nose counts
SLOW_EVERY = 0.5  # [s] between two commands of altitude, and of speed: at most 2 Hz
REFRESH = 3.0  # [s] after which either is said again, though unchanged
ALTITUDE_STEP = 0.5  # [m] that is a new altitude
SPEED_STEP = 0.2  # [m/s] that is a new airspeed
LOOK_AHEAD = 3.3  # [s] a climb rate is an altitude this far ahead, at rate 0
DRIFT = 8.0  # [m] by which the reference of altitude may leave the aircraft


def bank_for(course: float, velocity: Vec, yaw: float, bank_max: float) -> float:
    """Return the bank [rad, right positive] that turns the flight over ground towards a course [rad].

    φ = atan(V ψ̇ / g) with ψ̇ proportional to the error: a coordinated turn.
    """
    ground = sqrt(velocity.x * velocity.x + velocity.y * velocity.y)
    present = atan2(velocity.y, velocity.x) if ground > CREEP else yaw
    rate = GAIN * wrap(course - present)
    return clamp(atan(max(ground, CREEP) * rate / STANDARD_GRAVITY), -bank_max, bank_max)


class Said(NamedTuple):
    """What was commanded last, and when."""

    value: float = 0.0
    at: float = NEVER  # [s]


def due(said: Said, now: float, value: float, step: float, urgent: bool) -> bool:
    """Whether to command `value` now: on a change of `step`, where `urgent`, or again after REFRESH; at most
    at 2 Hz."""
    age = now - said.at
    if age < SLOW_EVERY:
        return False
    return urgent or abs(value - said.value) >= step or age >= REFRESH


class Reference(NamedTuple):
    """Where the commanded climbs lead: a reference integrates them, so that level stays level."""

    altitude: float = 0.0  # [m]
    at: float = NEVER  # [s]


def begins(reference: Reference, now: float) -> bool:
    """Whether the climbs begin anew: the last was commanded too long ago."""
    return now - reference.at > SLOW_EVERY


def followed(reference: Reference, now: float, present: float, climb: float) -> Reference:
    """The reference after a climb [m/s] commanded at `now` [s], at an altitude of `present` [m]."""
    if begins(reference, now):
        return Reference(present, now)
    altitude = reference.altitude + climb * (now - reference.at)
    return Reference(clamp(altitude, present - DRIFT, present + DRIFT), now)
