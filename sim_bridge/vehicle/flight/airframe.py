"""The transfer-function aircraft behind the seam of `sim_bridge.vehicle.motion`: demands in, motion out."""

from __future__ import annotations

from math import asin, cos, inf, sin, tan

from onboard.core.math.angles import wrap
from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.each import new
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, clamp, norm, yaw_of
from sim_bridge.vehicle.flight.aircraft import named, within
from sim_bridge.vehicle.flight.plane import (
    SLOW,
    Command,
    PathModel,
    PlaneModel,
    PlaneState,
    Steer,
    nose_yaw,
    pitch_for_climb,
    start_state,
    step_plane,
    trimmed,
    true_airspeed,
)
from sim_bridge.vehicle.motion import Air, Demand, Lateral, Motion


def course_through_air(course: float, speed: float, air: Vec) -> float:
    """Wind triangle: the course through the air [rad] that holds a course over ground."""
    across = air.y * cos(course) - air.x * sin(course)
    return course - asin(clamp(across / max(speed, SLOW), -1.0, 1.0))


def command(demand: Demand, state: PlaneState, model: PlaneModel, wind: Vec) -> Command:
    """What the aircraft is told for one sample under a demand, in air that moves with `wind` [m/s; NED].

    The carrying air is the wind and what gusts have made of the drift, as an autopilot measures them.
    """
    carried = Vec(wind.x + state.drift.x, wind.y + state.drift.y, wind.z + state.drift.z)
    pitch = pitch_for_climb(state.speed, demand.climb + carried.z, model)
    if demand.lateral == Lateral.ROLL:
        return Command(Steer.ROLL, demand.angle, pitch, demand.airspeed)
    if demand.lateral == Lateral.HEADING:
        return Command(Steer.HEADING, demand.angle, pitch, demand.airspeed)
    if demand.lateral == Lateral.COURSE:
        return Command(
            Steer.COURSE, course_through_air(demand.angle, state.speed, carried), pitch, demand.airspeed
        )
    air = Vec(*(wanted - moved for wanted, moved in zip(demand.velocity, carried, strict=True)))
    speed = norm(air)
    angle = yaw_of(air) if speed > SLOW else state.course
    return Command(Steer.COURSE, angle, pitch_for_climb(state.speed, -air.z, model), speed)


class Plane:
    """A fixed-wing vehicle (`Airframe`): the kernel stepped at its own rate whatever `dt` it is given."""

    def __init__(
        self, model: PlaneModel, position: Vec, heading: float, speed: float, wind: Vec = ZERO
    ) -> None:
        """In trimmed level flight at `position` [m; NED], `heading` [rad], `speed` [m/s; air]."""
        self._model = model
        self._state = trimmed(start_state(position, heading, speed, wind), model)
        self._due = 0.0
        self._motion = self._read(Air(wind, ZERO))

    @property
    def model(self) -> PlaneModel:
        """Everything fixed about the aircraft, as the kernel steps it."""
        return self._model

    @property
    def turn_rate(self) -> float:
        """The turn that it can hold [rad/s]: of an aircraft that turns by its rudder what that holds."""
        return inf if self._model.path == PathModel.COORDINATED else self._model.yaw_law.rate_limit

    @property
    def state(self) -> PlaneState:
        """The kernel's state at its last sample."""
        return self._state

    @property
    def motion(self) -> Motion:
        """Motion at the end of the last step."""
        return self._motion

    def step(self, demand: Demand, air: Air, dt: float) -> Motion:
        """Move on by `dt` [s]; what is left of a sample is carried to the next call."""
        model = self._model
        state = self._state
        self._due += dt
        count = int(self._due / model.dt + 1e-6)
        self._due -= count * model.dt
        for _ in range(count):
            state = step_plane(state, model, command(demand, state, model, air.wind), air.wind, air.gust)
        self._state = state
        self._motion = self._read(air)
        return self._motion

    def _read(self, air: Air) -> Motion:
        state = self._state
        model = self._model
        position = state.position
        left = self._due
        if left > 1e-9:
            (x, y, z), (vx, vy, vz) = position, state.velocity
            position = new(Vec, (x + left * vx, y + left * vy, z + left * vz))
        turning = state.yaw.rate
        if model.path == PathModel.COORDINATED:
            turning += STANDARD_GRAVITY * tan(state.bank) / max(state.speed, SLOW)
        rates = new(Vec, (state.bank_rate, state.pitch.rate, turning))
        airspeed, yaw = true_airspeed(state, air.wind, air.gust), wrap(nose_yaw(state, model))
        moved = (position, state.velocity, airspeed, state.bank, state.pitch.angle, yaw, rates)
        motion = new(Motion, moved)
        return motion


def fixed_wing(
    name: str, limits: VehicleLimits, position: Vec, heading: float, speed: float, wind: Vec = ZERO
) -> Plane:
    """The configured aircraft `name` (nose, slip, coordinated) under a vehicle's own limits.

    Raises ConfigError where the aircraft's file is at fault.
    """
    return Plane(within(named(name).model, limits), position, heading, speed, wind)
