"""A fixed-wing aircraft in wind, one sample at a time: the stabilised axes, speed and path.

Kernel style. Three models of how the path follows the nose (`PathModel`):

* NOSE: the paper's games (7)–(8): the velocity lies along (ψ, θ).
* SLIP: the path lags behind the nose by k_β of (35) and b_y of (34).
* COORDINATED: bank to turn, course rate g tan φ / V; the yaw axis holds the nose on the course.

Gusts enter the axes through their transfer functions and carry the aircraft only through the lags
of (33)–(35): a_x along, k_β across, b_y vertically. Mean wind and shear carry it at once.
"""

from __future__ import annotations

from enum import IntEnum
from math import asin, atan, cos, sin, sqrt, tan
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import ZERO, Vec, clamp
from sim_bridge.vehicle.flight.axis import AxisLaw, AxisModel, AxisState, rate_asked, step_axis

SLOW = 1.0  # [m/s] below it a turn is reckoned at this speed


class PathModel(IntEnum):
    """How the path follows the nose."""

    NOSE = 0
    SLIP = 1
    COORDINATED = 2


class Steer(IntEnum):
    """What the lateral angle of a command is."""

    HEADING = 0  # of the nose
    COURSE = 1  # of the path through the air
    ROLL = 2  # bank angle


class SpeedLaw(NamedTuple):
    """First equation of (33) with an engine lag, and the loop around it."""

    gain: float  # [1/s]
    integral_gain: float  # per sample [1/s]
    acceleration_min: float  # [m/s²] of the engine (and brakes), negative
    acceleration_max: float  # [m/s²]
    lag: float  # share of the engine's error removed per sample
    lead: float  # [s] the engine's time constant: what the feed-forward looks ahead
    drag: float  # a_x of (33) [1/s]
    gravity: float  # a_θ of (33) [m/s² per unit of sin θ]
    trim: float  # V_b [m/s]: the speed at which drag is balanced


class PathLaw(NamedTuple):
    """How the path and the bank follow; lags as the share of the difference removed per sample."""

    course: float  # k_β, SLIP
    climb: float  # b_y, SLIP and COORDINATED
    slip_limit: float  # [rad] largest sideslip asked for to turn the path, SLIP
    slip_gain: float  # sideslip asked per course error, SLIP
    bank_limit: float  # [rad]
    bank: float  # lag of the bank, COORDINATED
    bank_step: float  # [rad] largest change of bank per sample
    turn_gain: float  # [1/s] course rate per course error, COORDINATED
    carry_along: float  # a_x: how gusts come to carry the aircraft, in heading axes
    carry_across: float  # k_β
    carry_up: float  # b_y


class PlaneModel(NamedTuple):
    """Everything fixed about an aircraft."""

    path: int  # PathModel
    dt: float  # [s] the sample
    pitch: AxisModel
    pitch_law: AxisLaw
    yaw: AxisModel
    yaw_law: AxisLaw
    speed: SpeedLaw
    follow: PathLaw
    pitch_min: float  # [rad]
    pitch_max: float  # [rad]
    speed_min: float  # [m/s; air]
    speed_max: float  # [m/s; air]


class PlaneState(NamedTuple):
    """State of an aircraft in the game frame."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground, NED]
    speed: float  # [m/s] through the air that carries it
    thrust: float  # [m/s²]
    thrust_integral: float  # [m/s²]
    pitch: AxisState
    yaw: AxisState  # COORDINATED: its angle is the nose's offset from the course
    course: float  # χ of the path through the air [rad], not wrapped
    climb: float  # γ of the path through the air [rad, up]
    bank: float  # φ [rad]
    bank_rate: float  # [rad/s]
    drift: Vec  # [m/s; NED] how gusts carry it


class Command(NamedTuple):
    """What an aircraft is told for one sample."""

    steer: int  # Steer
    angle: float  # [rad] heading, course through the air or bank
    pitch: float  # θ demanded [rad, up]
    speed: float  # [m/s; air]


def start_state(position: Vec, heading: float, speed: float, wind: Vec) -> PlaneState:
    """Level, trimmed flight through air that moves with `wind`."""
    velocity = Vec(speed * cos(heading) + wind.x, speed * sin(heading) + wind.y, wind.z)
    still = AxisState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    nose = AxisState(0.0, 0.0, heading, 0.0, 0.0, 0.0)
    return PlaneState(position, velocity, speed, 0.0, 0.0, still, nose, heading, 0.0, 0.0, 0.0, ZERO)


def trimmed(state: PlaneState, model: PlaneModel) -> PlaneState:
    """A start state made ready for its model: offset of the nose (COORDINATED), thrust against drag."""
    thrust = model.speed.drag * (state.speed - model.speed.trim)
    offset = 0.0 if model.path == PathModel.COORDINATED else state.course
    yaw = AxisState(0.0, 0.0, offset, 0.0, 0.0, 0.0)
    return PlaneState(
        state.position, state.velocity, state.speed, thrust, 0.0, state.pitch, yaw, state.course, state.climb,
        state.bank, state.bank_rate, state.drift,
    )  # fmt: skip


def placed(state: PlaneState, position: Vec) -> PlaneState:
    """The same aircraft elsewhere [m; NED]."""
    return PlaneState(
        position, state.velocity, state.speed, state.thrust, state.thrust_integral, state.pitch, state.yaw,
        state.course, state.climb, state.bank, state.bank_rate, state.drift,
    )  # fmt: skip


def nose_yaw(state: PlaneState, model: PlaneModel) -> float:
    """ψ of the nose [rad], not wrapped."""
    return state.course + state.yaw.angle if model.path == PathModel.COORDINATED else state.yaw.angle


def pitch_for_climb(speed: float, climb: float, model: PlaneModel) -> float:
    """θ that climbs at `climb` [m/s; up, through the air] at `speed`, within the limits [rad]."""
    share = climb / (speed if speed > SLOW else SLOW)
    return clamp(asin(clamp(share, -1.0, 1.0)), model.pitch_min, model.pitch_max)


def step_speed(state: PlaneState, model: PlaneModel, demand: float) -> tuple[float, float, float]:
    """One sample of engine and speed loop: (speed, thrust, integral)."""
    law = model.speed
    wanted = clamp(demand, model.speed_min, model.speed_max)
    weight = law.gravity * sin(state.pitch.angle)
    error = wanted - state.speed
    rising = law.gravity * cos(state.pitch.angle) * state.pitch.rate
    known = law.drag * (wanted - law.trim) + weight + law.lead * rising  # fed forward, as by total energy
    asked = law.gain * error + state.thrust_integral + known
    given = clamp(asked, law.acceleration_min, law.acceleration_max)
    integral = state.thrust_integral
    if given == asked:  # no integration against a limit
        integral += law.integral_gain * error
    thrust = state.thrust + law.lag * (given - state.thrust)
    change = thrust - law.drag * (state.speed - law.trim) - weight  # first equation of (33)
    speed = state.speed + model.dt * change
    return (speed if speed > 0.0 else 0.0), thrust, integral


def step_turn(
    state: PlaneState, model: PlaneModel, command: Command, across: float
) -> tuple[AxisState, float, float, float]:
    """One sample of the lateral motion: (yaw axis, course, bank, bank rate)."""
    follow = model.follow
    speed = state.speed if state.speed > SLOW else SLOW
    if model.path == PathModel.COORDINATED:
        if command.steer == Steer.ROLL:
            wanted = command.angle
        else:
            error = wrap(command.angle - state.course)
            wanted = atan(speed * follow.turn_gain * error / STANDARD_GRAVITY)
        wanted = clamp(wanted, -follow.bank_limit, follow.bank_limit)
        step = clamp(follow.bank * (wanted - state.bank), -follow.bank_step, follow.bank_step)
        bank = state.bank + step
        yaw = step_axis(
            state.yaw, model.yaw, model.yaw_law, rate_asked(model.yaw_law, -state.yaw.angle), across, 0.0
        )
        return yaw, state.course + model.dt * STANDARD_GRAVITY * tan(bank) / speed, bank, step / model.dt
    if command.steer == Steer.ROLL:  # the turn a bank would give, within what the rudder holds
        bank = clamp(command.angle, -follow.bank_limit, follow.bank_limit)
        limit = model.yaw_law.rate_limit
        rate = clamp(STANDARD_GRAVITY * tan(bank) / speed, -limit, limit)
    elif (
        model.path == PathModel.SLIP and command.steer == Steer.COURSE
    ):  # lead with the nose: sideslip turns the path
        error = wrap(command.angle - state.course)
        lead = clamp(follow.slip_gain * error, -follow.slip_limit, follow.slip_limit)
        rate = rate_asked(model.yaw_law, wrap(state.course + error + lead - state.yaw.angle))
    else:
        rate = rate_asked(model.yaw_law, wrap(command.angle - state.yaw.angle))
    yaw = step_axis(state.yaw, model.yaw, model.yaw_law, rate, across, 0.0)
    if model.path == PathModel.SLIP:
        return yaw, state.course + follow.course * (yaw.angle - state.course), 0.0, 0.0
    return yaw, yaw.angle, 0.0, 0.0


def carried(old: Vec, gust: Vec, shares: Vec, c: float, s: float) -> Vec:
    """The drift [m/s; NED] one sample on: (33)–(35) let gusts carry an aircraft through the path's own lags.

    `shares` of what is missing, along, across and down, in heading axes; `c`, `s`: cosine and sine of the
    heading.
    """
    along = gust.x * c + gust.y * s
    across = gust.y * c - gust.x * s
    behind_along = shares.x * (along - (old.x * c + old.y * s))
    behind_across = shares.y * (across - (old.y * c - old.x * s))
    return Vec(
        old.x + behind_along * c - behind_across * s,
        old.y + behind_along * s + behind_across * c,
        old.z + shares.z * (gust.z - old.z),
    )


def step_plane(state: PlaneState, model: PlaneModel, command: Command, wind: Vec, gust: Vec) -> PlaneState:
    """One sample in air that moves with `wind` (mean and shear) and gusts [m/s; NED]."""
    follow = model.follow
    heading = nose_yaw(state, model)
    c = cos(heading)
    s = sin(heading)
    along = gust.x * c + gust.y * s  # w_x of (36): heading axes
    across = gust.y * c - gust.x * s  # w_z of (37), to the right
    wanted = clamp(command.pitch, model.pitch_min, model.pitch_max)
    pitch = step_axis(
        state.pitch,
        model.pitch,
        model.pitch_law,
        rate_asked(model.pitch_law, wanted - state.pitch.angle),
        along,
        -gust.z,
    )
    yaw, course, bank, bank_rate = step_turn(state, model, command, across)
    speed, thrust, integral = step_speed(state, model, command.speed)
    climb = pitch.angle
    if model.path != PathModel.NOSE:
        climb = state.climb + follow.climb * (pitch.angle - state.climb)
    shares = Vec(follow.carry_along, follow.carry_across, follow.carry_up)
    drift = carried(state.drift, gust, shares, c, s)
    level = speed * cos(climb)
    velocity = Vec(
        level * cos(course) + wind.x + drift.x,
        level * sin(course) + wind.y + drift.y,
        -speed * sin(climb) + wind.z + drift.z,
    )
    half = 0.5 * model.dt
    position = Vec(
        state.position.x + half * (state.velocity.x + velocity.x),
        state.position.y + half * (state.velocity.y + velocity.y),
        state.position.z + half * (state.velocity.z + velocity.z),
    )
    return PlaneState(
        position, velocity, speed, thrust, integral, pitch, yaw, course, climb, bank, bank_rate, drift
    )


def true_airspeed(state: PlaneState, wind: Vec, gust: Vec) -> float:
    """Speed against the air where the aircraft is, gusts included: what a pitot tube feels [m/s]."""
    x = state.velocity.x - wind.x - gust.x
    y = state.velocity.y - wind.y - gust.y
    z = state.velocity.z - wind.z - gust.z
    return sqrt(x * x + y * y + z * z)
