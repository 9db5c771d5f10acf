"""The seam between autopilots and airframes: what is demanded, and how the vehicle moves.

An autopilot turns setpoints and modes into a `Demand`; an `Airframe` turns demands and air
into `Motion`. Kinematic and transfer-function airframes share this one Protocol.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple, Protocol

from onboard.core.math.vectors import ZERO, Vec


class Lateral(IntEnum):
    """How the lateral demand is given."""

    VELOCITY = 0  # multicopters: `velocity` holds the whole demand
    ROLL = 1  # `angle` is a bank angle
    HEADING = 2  # `angle` is a heading (of the nose)
    COURSE = 3  # `angle` is a course over ground


class Demand(NamedTuple):
    """What an autopilot asks of its airframe."""

    lateral: Lateral
    velocity: Vec  # [m/s; ground, NED], VELOCITY only
    angle: float  # [rad]
    climb: float  # [m/s; up]
    airspeed: float  # [m/s]
    facing: float | None = None  # [rad] where the nose is to point, VELOCITY only; None: along the path


class Motion(NamedTuple):
    """The true motion of a vehicle in the game frame."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground, NED]
    airspeed: float  # [m/s]
    roll: float  # [rad]
    pitch: float  # [rad, up]
    yaw: float  # [rad]
    rates: Vec = ZERO  # roll, pitch, yaw rate [rad/s]


class Air(NamedTuple):
    """The air at a vehicle: mean wind with shear carries it, gusts also disturb it."""

    wind: Vec  # [m/s; NED, where the air moves to]
    gust: Vec  # [m/s; NED]


CALM = Air(ZERO, ZERO)


class Airframe(Protocol):
    """A vehicle that turns demands and air into motion."""

    @property
    def motion(self) -> Motion:
        """Motion at the end of the last step."""
        ...

    def step(self, demand: Demand, air: Air, dt: float) -> Motion:
        """Move on by `dt` seconds under a demand in the given air; deterministic."""
        ...
