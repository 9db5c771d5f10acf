"""Aircraft files (`configs/aircraft/*.toml`): transfer functions, loops, limits, and how the path follows.

Angles in degrees in the file. Everything that cannot fly is refused at load with the reason.
"""

from __future__ import annotations

from functools import lru_cache
from math import exp, isinf, radians
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np

from onboard.config import strict as config
from onboard.config.strict import ConfigError
from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.states import VehicleLimits
from onboard.runtime.resources import configs
from sim_bridge.vehicle.flight.axis import AxisLaw
from sim_bridge.vehicle.flight.loop_analysis import closed_loop
from sim_bridge.vehicle.flight.plane import PathLaw, PathModel, PlaneModel, SpeedLaw
from sim_bridge.vehicle.flight.transfer import AxisTransfer, check, sampled


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Base of all parts of an aircraft file: frozen and strict."""


class PitchFunctions(Part, frozen=True, kw_only=True):
    """(36): over one denominator, to the pitch rate [deg/s]."""

    denominator: tuple[float, ...]
    elevator: tuple[float, ...]  # [deg]
    wind_x: tuple[float, ...] = (0.0,)  # along the heading [m/s]
    wind_y: tuple[float, ...] = (0.0,)  # up [m/s]


class YawFunctions(Part, frozen=True, kw_only=True):
    """(37): over one denominator, to the yaw rate [deg/s]."""

    denominator: tuple[float, ...]
    rudder: tuple[float, ...]  # [deg]
    wind_z: tuple[float, ...] = (0.0,)  # to the right [m/s]


class Loop(Part, frozen=True, kw_only=True):
    """Cascade of an axis: angle → rate → surface."""

    angle_gain: float  # [1/s]
    rate_limit_deg: float  # [deg/s]
    rate_gain: float  # [deg per deg/s]; its sign is the surface's
    integral_gain: float  # [deg per deg]; same sign
    release_s: float = 0.5  # time in which an unattainable command leaves the integral [s]


class Actuator(Part, frozen=True, kw_only=True):
    """A servo: first-order lag with limits of position and rate."""

    limit_deg: float
    rate_deg: float  # [deg/s]
    bandwidth: float  # [rad/s]


class SpeedSpec(Part, frozen=True, kw_only=True):
    """Engine, drag, and the speed loop."""

    trim: float  # V_b [m/s]
    gain: float  # [1/s]
    integral_gain: float  # [1/s²]
    acceleration_min: float  # [m/s²] negative
    acceleration_max: float  # [m/s²]
    engine_lag: float  # [s]
    drag: float  # a_x of (33) [1/s]
    gravity: float = STANDARD_GRAVITY  # a_θ of (33)


class FollowSpec(Part, frozen=True, kw_only=True):
    """How the path follows the nose, and how gusts come to carry the aircraft."""

    course_lag: float  # k_β of (35) [1/s]
    climb_lag: float  # b_y of (34) [1/s]
    slip_limit_deg: float = 27.0
    slip_gain: float = 2.0
    bank_limit_deg: float = 45.0
    bank_time_s: float = 0.4
    bank_rate_deg: float = 60.0  # [deg/s]
    turn_gain: float = 0.6  # [1/s]


class LimitSpec(Part, frozen=True, kw_only=True):
    """(2)–(3)."""

    pitch_min_deg: float = -25.0
    pitch_max_deg: float = 25.0
    speed_min: float = 15.0
    speed_max: float = 60.0


class Spec(Part, frozen=True, kw_only=True):
    """An aircraft file."""

    name: str
    path: str  # nose | slip | coordinated
    rate_hz: float = 100.0
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


class Aircraft(NamedTuple):
    """An aircraft as loaded: its file's contents, its transfer functions and the model the kernel steps."""

    spec: Spec
    pitch: AxisTransfer
    yaw: AxisTransfer
    model: PlaneModel


PATHS = {path.name.lower(): path for path in PathModel}


def pitch_transfer(spec: Spec) -> AxisTransfer:
    """(36) of a file."""
    p = spec.pitch
    return AxisTransfer(p.denominator, p.elevator, p.wind_x, p.wind_y)


def yaw_transfer(spec: Spec) -> AxisTransfer:
    """(37) of a file."""
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
    _check_numbers(spec, name)
    pitch = pitch_transfer(spec)
    yaw = yaw_transfer(spec)
    check(pitch, name, ("pitch.denominator", "pitch.elevator", "pitch.wind_x", "pitch.wind_y"))
    check(yaw, name, ("yaw.denominator", "yaw.rudder", "yaw.wind_z", "yaw"))
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
        path=int(PATHS[spec.path]),
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
    return Aircraft(spec, pitch, yaw, model)


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


def _check_numbers(spec: Spec, name: str) -> None:
    def demand(ok: bool, key: str, found: object, expected: str) -> None:
        if not ok:
            raise ConfigError(f"{name}: {key}: found {found}, expected {expected}")

    demand(spec.path in PATHS, "path", spec.path, "one of " + ", ".join(PATHS))
    demand(100.0 <= spec.rate_hz <= 2000.0, "rate_hz", spec.rate_hz, "a rate in [100, 2000] Hz")
    positive: list[tuple[str, msgspec.Struct, tuple[str, ...]]] = [
        ("pitch_loop", spec.pitch_loop, ("angle_gain", "rate_limit_deg", "release_s")),
        ("yaw_loop", spec.yaw_loop, ("angle_gain", "rate_limit_deg", "release_s")),
        ("elevator", spec.elevator, ("limit_deg", "rate_deg", "bandwidth")),
        ("rudder", spec.rudder, ("limit_deg", "rate_deg", "bandwidth")),
        ("speed", spec.speed, ("trim", "gain", "acceleration_max", "engine_lag")),
        ("follow", spec.follow, ("course_lag", "climb_lag", "bank_time_s", "bank_rate_deg", "turn_gain")),
    ]
    for part, struct, keys in positive:
        for key in keys:
            demand(getattr(struct, key) > 0, f"{part}.{key}", getattr(struct, key), "a positive number")
    demand(spec.elevator.limit_deg <= 90, "elevator.limit_deg", spec.elevator.limit_deg, "at most 90 deg")
    demand(spec.rudder.limit_deg <= 90, "rudder.limit_deg", spec.rudder.limit_deg, "at most 90 deg")
    s, f, m = spec.speed, spec.follow, spec.limits
    demand(s.acceleration_min < 0, "speed.acceleration_min", s.acceleration_min, "a negative number [m/s²]")
    demand(s.integral_gain >= 0, "speed.integral_gain", s.integral_gain, "zero or more")
    demand(s.drag > 0, "speed.drag", s.drag, "a positive number [1/s]")
    demand(s.gravity >= 0, "speed.gravity", s.gravity, "zero or more [m/s²]")
    demand(0 < f.bank_limit_deg < 85, "follow.bank_limit_deg", f.bank_limit_deg, "an angle in (0, 85) deg")
    demand(0 < f.slip_limit_deg < 90, "follow.slip_limit_deg", f.slip_limit_deg, "an angle in (0, 90) deg")
    demand(f.slip_gain >= 0, "follow.slip_gain", f.slip_gain, "zero or more")
    demand(
        -85 <= m.pitch_min_deg < m.pitch_max_deg <= 85,
        "limits.pitch_min_deg",
        f"{m.pitch_min_deg:g} with pitch_max_deg {m.pitch_max_deg:g}",
        "−85 ≤ min < max ≤ 85",
    )
    demand(
        0 < m.speed_min < m.speed_max,
        "limits.speed_min",
        f"{m.speed_min:g} with speed_max {m.speed_max:g}",
        "0 < min < max",
    )
    demand(
        m.speed_min <= s.trim <= m.speed_max,
        "speed.trim",
        s.trim,
        f"within the limits {m.speed_min:g} to {m.speed_max:g} m/s",
    )
