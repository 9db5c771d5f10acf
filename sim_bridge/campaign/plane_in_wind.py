"""An aircraft in its air, as one value: the kernel that campaigns step. Kernel style.

One `fly` is one sample of the aircraft; the gusts advance on their own grid, every `GUST_EVERY`
samples, as `sim_bridge.vehicle.wind.field` does.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.math.vectors import NORTH, Vec, norm, pitch_of, unit, yaw_of
from onboard.game.scenario import WindSpec
from sim_bridge.draws import Purpose, key_of, threefry, uniform
from sim_bridge.vehicle.flight.plane import (
    Command,
    PlaneModel,
    PlaneState,
    Steer,
    nose_yaw,
    step_plane,
    true_airspeed,
)
from sim_bridge.vehicle.wind.dryden import GustAxes, GustNoise, GustState, first_gust, gust_of, step_gust
from sim_bridge.vehicle.wind.field import wind_vector
from sim_bridge.vehicle.wind.shear import ROUGHNESS, mean_wind

GUST_EVERY = 2  # samples of the aircraft between two of the gusts (100 Hz and 50 Hz)


def gust_tick(sample: int) -> int:
    """The tick of the gusts that comes with a sample of the aircraft, −1 where none does.

    Samples are counted from the beginning of the world, whose first step is from sample 0 to 1, and its air
    is that of the step's end.
    """
    step = sample + 1
    return step // GUST_EVERY if step % GUST_EVERY == 0 else -1


class Climate(NamedTuple):
    """The wind of a scenario."""

    reference: Vec  # mean at 20 ft [m/s; NED]
    shear: bool
    sigma: float  # rms of the gusts, an axis [m/s]
    axis_x: float  # level unit vector along the mean wind
    axis_y: float


class Flown(NamedTuple):
    """An aircraft and the gusts it meets."""

    plane: PlaneState
    gusts: GustState


def climate_of(wind: WindSpec) -> Climate:
    """The wind of a scenario for the kernels."""
    reference = wind_vector(wind.speed, wind.from_deg)
    axis = unit(reference, NORTH)
    return Climate(reference, wind.shear, wind.gust_sigma, axis.x, axis.y)


def drawn_wind(seed: int) -> float:
    """Where a seed's wind comes from [deg]."""
    key = key_of(seed, 0, Purpose.WIND)
    a, _b = threefry(key.a, key.b, 0, 0)
    return 360.0 * float(uniform(a))


def wind_at(climate: Climate, position: Vec) -> Vec:
    """Mean wind with shear [m/s; NED]; ground at the height of the origin."""
    return mean_wind(climate.reference, -position.z, climate.shear, ROUGHNESS)


def gust_at(climate: Climate, flown: Flown, model: PlaneModel) -> Vec:
    """The gust that the aircraft meets now [m/s; NED]."""
    plane = flown.plane
    yaw = nose_yaw(plane, model)
    axes = GustAxes(climate.axis_x, climate.axis_y, yaw, plane.pitch.angle, -plane.position.z)
    return gust_of(flown.gusts, climate.sigma, axes)


def launched(plane: PlaneState, noise: GustNoise) -> Flown:
    """At the start: gusts from their stationary distribution."""
    return Flown(plane, first_gust(noise))


def command_for(velocity: Vec, course: float) -> Command:
    """What an autopilot makes of a decided velocity through the air [m/s; NED], on `course` [rad] now."""
    speed = norm(velocity)
    if speed <= 0.0:
        return Command(Steer.COURSE, course, 0.0, 0.0)
    return Command(Steer.COURSE, yaw_of(velocity), pitch_of(velocity), speed)


def blown(flown: Flown, model: PlaneModel, climate: Climate, noise: GustNoise) -> Flown:
    """The gusts after one tick of their grid."""
    plane = flown.plane
    gust = gust_at(climate, flown, model)
    speed = true_airspeed(plane, wind_at(climate, plane.position), gust)
    dt = GUST_EVERY * model.dt
    return Flown(plane, step_gust(flown.gusts, speed, -plane.position.z, dt, noise))


def fly(flown: Flown, model: PlaneModel, command: Command, climate: Climate) -> Flown:
    """One sample of the aircraft."""
    wind = wind_at(climate, flown.plane.position)
    return Flown(step_plane(flown.plane, model, command, wind, gust_at(climate, flown, model)), flown.gusts)
