"""Aircraft files (`configs/aircraft/*.toml`): transfer functions, loops, limits, and how the path follows.

Angles in degrees in the file. Everything that cannot fly is refused at load with the reason.
"""

from __future__ import annotations

from enum import Enum
from functools import lru_cache
from math import exp, isinf, radians
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from msgspec import Meta

from onboard.config import strict as config
from onboard.config.bounds import (
    Acceleration,
    NotNegative,
    Positive,
    PositiveAcceleration,
    PositiveDuration,
    PositiveSpeed,
)
from onboard.config.names import Title
from onboard.config.strict import ConfigError, StrictConfig, demand
from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.states import VehicleLimits
from onboard.runtime.resources import configs
from sim_bridge.vehicle.flight.axis import AxisLaw
from sim_bridge.vehicle.flight.loop_analysis import closed_loop
from sim_bridge.vehicle.flight.plane import PathLaw, PathModel, PlaneModel, SpeedLaw
from sim_bridge.vehicle.flight.transfer import AxisTransfer, check, check_wind, sampled


class PathName(Enum):
    """How the path follows the nose, as a file names it."""

    NOSE = "nose"
    SLIP = "slip"
    COORDINATED = "coordinated"


# Ranges that only an aircraft file has.
Coefficient = Annotated[float, Meta(ge=-1e9, le=1e9, description="−1e9 to 1e9")]
Coefficients = Annotated[
    tuple[Coefficient, ...], Meta(min_length=1, max_length=20, description="1 to 20 coefficients")
]
Gain = Coefficient
SurfaceDeg = Annotated[float, Meta(gt=0, le=90, description="a positive number, at most 90 deg")]
Braking = Annotated[float, Meta(lt=0, ge=-1000, description="a negative number [m/s²], at least −1000")]
SlipDeg = Annotated[float, Meta(gt=0, lt=90, description="an angle in (0, 90) deg")]
BankDeg = Annotated[float, Meta(gt=0, lt=85, description="an angle in (0, 85) deg")]
PathDeg = Annotated[float, Meta(ge=-85, le=85, description="−85 ≤ min < max ≤ 85")]
SampleRate = Annotated[float, Meta(ge=100, le=2000, description="a rate in [100, 2000] Hz")]


class PitchFunctions(StrictConfig, frozen=True):
    """(36): over one denominator, to the pitch rate [deg/s]."""

    denominator: Coefficients
    elevator: Coefficients  # [deg]
    wind_x: Coefficients = (0.0,)  # along the heading [m/s]
    wind_y: Coefficients = (0.0,)  # up [m/s]; negative: the nose goes down


class YawFunctions(StrictConfig, frozen=True):
    """(37): over one denominator, to the yaw rate [deg/s]."""

    denominator: Coefficients
    rudder: Coefficients  # [deg]
    wind_z: Coefficients = (0.0,)  # to the right [m/s]; negative: the nose turns left


class Loop(StrictConfig, frozen=True):
    """Cascade of an axis: angle → rate → surface."""

    angle_gain: Positive  # [1/s]
    rate_limit_deg: Positive  # [deg/s]
    rate_gain: Gain  # [deg per deg/s]; its sign is the surface's
    integral_gain: Gain  # [deg per deg]; same sign
    release_s: PositiveDuration = 0.5  # time in which an unattainable command leaves the integral [s]


class Actuator(StrictConfig, frozen=True):
    """A servo: first-order lag with limits of position and rate."""

    limit_deg: SurfaceDeg
    rate_deg: Positive  # [deg/s]
    bandwidth: Positive  # [rad/s]


class SpeedSpec(StrictConfig, frozen=True):
    """Engine, drag, and the speed loop."""

    trim: PositiveSpeed  # V_b [m/s]
    gain: Positive  # [1/s]
    integral_gain: NotNegative  # [1/s²]
    acceleration_min: Braking  # [m/s²] negative
    acceleration_max: PositiveAcceleration  # [m/s²]
    engine_lag: PositiveDuration  # [s]
    drag: Positive  # a_x of (33) [1/s]
    gravity: Acceleration = STANDARD_GRAVITY  # a_θ of (33)


class FollowSpec(StrictConfig, frozen=True):
    """How the path follows the nose, and how gusts come to carry the aircraft."""

    course_lag: Positive  # k_β of (35) [1/s]
    climb_lag: Positive  # b_y of (34) [1/s]
    slip_limit_deg: SlipDeg = 27.0
    slip_gain: NotNegative = 2.0
    bank_limit_deg: BankDeg = 45.0
    bank_time_s: PositiveDuration = 0.4
    bank_rate_deg: Positive = 60.0  # [deg/s]
    turn_gain: Positive = 0.6  # [1/s]


class LimitSpec(StrictConfig, frozen=True):
    """Limits (2)–(3) of pitch [deg] and airspeed [m/s]."""

    pitch_min_deg: PathDeg = -25.0
    pitch_max_deg: PathDeg = 25.0
    speed_min: PositiveSpeed = 15.0
    speed_max: PositiveSpeed = 60.0

    def __post_init__(self) -> None:
        demand(
            self.pitch_min_deg < self.pitch_max_deg,
            "pitch_min_deg",
            f"{self.pitch_min_deg:g} with pitch_max_deg {self.pitch_max_deg:g}",
            "−85 ≤ min < max ≤ 85",
        )
        demand(self.speed_min < self.speed_max, "speed_min",
               f"{self.speed_min:g} with speed_max {self.speed_max:g}", "0 < min < max")  # fmt: skip


class Spec(StrictConfig, frozen=True, kw_only=True):
    """Everything that an aircraft file says."""

    name: Title
    path: PathName
    rate_hz: SampleRate = 100.0
    description: str = ""
    pitch: PitchFunctions
    pitch_loop: Loop
    elevator: Actuator
    yaw: YawFunctions
    yaw_loop: Loop
    rudder: Actuator
    speed: SpeedSpec
    follow: FollowSpec
    limits: LimitSpec = LimitSpec()

    def __post_init__(self) -> None:
        low, high = self.limits.speed_min, self.limits.speed_max
        demand(low <= self.speed.trim <= high, "speed.trim", self.speed.trim,
               f"within the limits {low:g} to {high:g} m/s")  # fmt: skip


class Aircraft(NamedTuple):
    """An aircraft as loaded: its file's contents, its transfer functions and the model the kernel steps."""

    spec: Spec
    pitch: AxisTransfer
    yaw: AxisTransfer
    model: PlaneModel


def pitch_transfer(spec: Spec) -> AxisTransfer:
    """The pitch axis's transfer functions (36) of an aircraft file."""
    p = spec.pitch
    return AxisTransfer(p.denominator, p.elevator, p.wind_x, p.wind_y)


def yaw_transfer(spec: Spec) -> AxisTransfer:
    """The yaw axis's transfer functions (37) of an aircraft file."""
    y = spec.yaw
    return AxisTransfer(y.denominator, y.rudder, y.wind_z, (0.0,))


@lru_cache(maxsize=32)
def load(path: Path) -> Aircraft:
    """Read, check and discretise an aircraft file. Raises ConfigError."""
    return build(config.read(path, Spec), str(path))


def named(name: str) -> Aircraft:
    """The aircraft of `configs/aircraft/<name>.toml` (`nose`, `slip`, `coordinated`)."""
    return load(configs() / "aircraft" / f"{name}.toml")


def build(spec: Spec, name: str) -> Aircraft:
    """Check an aircraft and build its model. Raises ConfigError with file, key and reason."""
    pitch = pitch_transfer(spec)
    yaw = yaw_transfer(spec)
    check(pitch, name, ("pitch.denominator", "pitch.elevator", "pitch.wind_x", "pitch.wind_y"))
    check(yaw, name, ("yaw.denominator", "yaw.rudder", "yaw.wind_z", "yaw"))
    check_wind(pitch, pitch.wind2, spec.speed.trim, f"{name}: pitch.wind_y")
    check_wind(yaw, yaw.wind1, spec.speed.trim, f"{name}: yaw.wind_z")
    for key, transfer, loop in (("pitch_loop", pitch, spec.pitch_loop), ("yaw_loop", yaw, spec.yaw_loop)):
        sign = 1.0 if transfer.steady > 0 else -1.0
        if loop.rate_gain * sign <= 0 or loop.integral_gain * sign < 0:
            raise ConfigError(
                f"{name}: {key}.rate_gain: found {loop.rate_gain:g} with integral_gain "
                f"{loop.integral_gain:g}, expected the sign of the surface's steady effect "
                f"({transfer.steady:+.3g})"
            )
    dt = 1.0 / spec.rate_hz
    s, f = spec.speed, spec.follow
    model = PlaneModel(
        path=int(PathModel[spec.path.name]),
        dt=dt,
        pitch=sampled(pitch, dt),
        pitch_law=_law(spec.pitch_loop, spec.elevator, dt),
        yaw=sampled(yaw, dt),
        yaw_law=_law(spec.yaw_loop, spec.rudder, dt),
        speed=SpeedLaw(
            s.gain,
            s.integral_gain * dt,
            s.acceleration_min,
            s.acceleration_max,
            _share(dt / s.engine_lag),
            s.engine_lag,
            s.drag,
            s.gravity,
            s.trim,
        ),
        follow=PathLaw(
            _share(dt * f.course_lag),
            _share(dt * f.climb_lag),
            radians(f.slip_limit_deg),
            f.slip_gain,
            radians(f.bank_limit_deg),
            _share(dt / f.bank_time_s),
            radians(f.bank_rate_deg) * dt,
            f.turn_gain,
            _share(dt * s.drag),
            _share(dt * f.course_lag),
            _share(dt * f.climb_lag),
        ),
        pitch_min=radians(spec.limits.pitch_min_deg),
        pitch_max=radians(spec.limits.pitch_max_deg),
        speed_min=spec.limits.speed_min,
        speed_max=spec.limits.speed_max,
    )
    _demand_stable(model, name)
    return Aircraft(spec, pitch, yaw, model)


def _demand_stable(model: PlaneModel, name: str) -> None:
    """Raise ConfigError unless every mode of both closed loops decays."""
    for key, axis, law in (
        ("pitch_loop", model.pitch, model.pitch_law),
        ("yaw_loop", model.yaw, model.yaw_law),
    ):
        largest = float(np.max(np.abs(np.linalg.eigvals(closed_loop(axis, law)))))
        if largest >= 1.0:
            raise ConfigError(
                f"{name}: {key}: unstable: found a closed-loop mode that grows by {largest:.4f} a sample, "
                "expected every mode to decay"
            )


def within(model: PlaneModel, limits: VehicleLimits) -> PlaneModel:
    """The same aircraft under a vehicle's own limits (2)–(3): the narrower of both."""
    high = model.speed_max if isinf(limits.speed_max) else min(model.speed_max, limits.speed_max)
    return model._replace(
        pitch_min=max(model.pitch_min, limits.pitch_min),
        pitch_max=min(model.pitch_max, limits.pitch_max),
        speed_min=min(max(model.speed_min, limits.speed_min), high),
        speed_max=high,
    )


def _share(x: float) -> float:
    """Share of a first-order lag's error removed in x time constants."""
    return 1.0 - exp(-x)


def _law(loop: Loop, servo: Actuator, dt: float) -> AxisLaw:
    share = _share(dt * servo.bandwidth)
    return AxisLaw(
        angle_gain=loop.angle_gain,
        rate_limit=radians(loop.rate_limit_deg),
        rate_gain=loop.rate_gain,
        integral_gain=loop.integral_gain * dt,
        release=dt / loop.release_s,
        surface_limit=radians(servo.limit_deg),
        servo=share,
        servo_reach=radians(servo.rate_deg) * dt / share,
    )
