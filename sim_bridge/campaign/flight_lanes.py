"""Aircraft, gusts, sensor, track filters and estimates of the wind of a spatial game, in lanes.

What `spatial_game` does vehicle by vehicle is done for eight at a time here, by the twins of the same
functions: what stands in this file is where their numbers lie. Kernel style over flat arrays (`lanes`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.guidance.plane import Reference, Said
from onboard.core.math.vectors import ZERO, Vec
from onboard.pilot.kalman import Axis, Filtered, Measured, carry, corrected
from sim_bridge.campaign.aboard import Aboard, Autopilot, commanded
from sim_bridge.campaign.envelope import Envelope, widened
from sim_bridge.campaign.lanes import LANES, in_lanes, lane_normal, packing
from sim_bridge.campaign.plane_in_wind import Climate, Flown, blown, fly, gust_at, wind_at
from sim_bridge.campaign.tracks import Eye
from sim_bridge.draws import WORD, threefry, uniform
from sim_bridge.vehicle.flight.plane import Command, PlaneModel, nose_yaw, true_airspeed
from sim_bridge.vehicle.wind.dryden import GUST_WORDS, GustNoise, GustState
from sim_bridge.vehicle.wind.estimate import ARDUPILOT, Errors, Estimate, Sensed, estimated

Array = NDArray[np.float64]
Words = NDArray[np.int64]


class Limits(NamedTuple):
    """What differs between the aircraft models of a game, in the order of `PlaneModel`."""

    pitch_min: float  # [rad]
    pitch_max: float
    speed_min: float  # [m/s; air]
    speed_max: float


class Told(NamedTuple):
    """What agent and autopilot of an aircraft hold to between two decisions."""

    altitude: float  # [m]
    airspeed: float  # [m/s]
    bank: float  # [rad]


class Sensing(NamedTuple):
    """What measures and hears."""

    air: Array  # (blocks, BLOCK)
    words: Words  # (blocks, WORD_BLOCK) of the sensor
    waiting: Array  # (slots, blocks, MEASURED * LANES)


class Instant(NamedTuple):
    """When a measurement was taken."""

    sample: int
    dt: float  # [s] a sample


FLOWN = packing(Flown, LANES)
GUSTS = packing(GustState, LANES)
TOLD = packing(Told, LANES)
AUTOPILOT = packing(Autopilot, LANES)
LIMITS = packing(Limits, LANES)
WIND = packing(Estimate, LANES)
ERRORS = packing(Errors, LANES)
FILTER = packing(Filtered, LANES)
REACH = packing(Envelope, LANES)
COMMAND = packing(Command, LANES)
NOISE = packing(GustNoise, LANES)

load_flown, store_flown = FLOWN.load, FLOWN.store
load_gusts, store_gusts = GUSTS.load, GUSTS.store
load_told, store_told = TOLD.load, TOLD.store
load_autopilot, store_autopilot = AUTOPILOT.load, AUTOPILOT.store
load_limits, store_limits = LIMITS.load, LIMITS.store
load_wind, store_wind = WIND.load, WIND.store
load_errors, store_errors = ERRORS.load, ERRORS.store
load_filter, store_filter = FILTER.load, FILTER.store
load_reach, store_reach = REACH.load, REACH.store
load_command, store_command = COMMAND.load, COMMAND.store
load_noise = NOISE.load

FILTER_WIDTH = FILTER.width
MEASURED = 7  # numbers of a measurement: place, velocity, 1 where it was not lost

# Where they lie in a block: numbers of lane 0.
AT_GUSTS = (FLOWN.width - GUSTS.width) * LANES  # the last of `Flown`
AT_TOLD = FLOWN.width * LANES
AT_AUTOPILOT = AT_TOLD + TOLD.width * LANES
AT_LIMITS = AT_AUTOPILOT + AUTOPILOT.width * LANES
AT_WIND = AT_LIMITS + LIMITS.width * LANES
AT_ERRORS = AT_WIND + WIND.width * LANES
AT_FILTER = AT_ERRORS + ERRORS.width * LANES
AT_STAMP = AT_FILTER + FILTER.width * LANES
AT_NOISE = AT_STAMP + LANES
AT_DECLARED = AT_NOISE + MEASURED * LANES
AT_REACH = AT_DECLARED + LANES
AT_COMMAND = AT_REACH + REACH.width * LANES
BLOCK = AT_COMMAND + COMMAND.width * LANES  # numbers of a block

# The same of the whole numbers that draw: a key, then eight words.
AT_WORDS = 2 * LANES
WORD_BLOCK = AT_WORDS + 8 * LANES

lane_commanded = in_lanes(commanded)
lane_fly = in_lanes(fly)
lane_blown = in_lanes(blown)
lane_wind_at = in_lanes(wind_at)
lane_gust_at = in_lanes(gust_at)
lane_airspeed = in_lanes(true_airspeed)
lane_yaw = in_lanes(nose_yaw)
lane_estimated = in_lanes(estimated)
lane_widened = in_lanes(widened)
lane_carry = in_lanes(carry)
lane_corrected = in_lanes(corrected)


def limited(model: PlaneModel, limits: Limits) -> PlaneModel:
    """An aircraft model under other limits."""
    return PlaneModel(
        model.path, model.dt, model.pitch, model.pitch_law, model.yaw, model.yaw_law, model.speed,
        model.follow, limits.pitch_min, limits.pitch_max, limits.speed_min, limits.speed_max,
    )  # fmt: skip


def draw_six(words: Words, block: int, counter: int) -> None:
    """Draw six words a lane of a block at a `counter`, by the keys there.

    Pair beside pair in one loop: each is a long chain, of which a processor runs several at once.
    """
    for i in range(LANES):
        first = words[block, i]
        second = words[block, i + LANES]
        a, b = threefry(first, second, counter & WORD, 0)
        c, d = threefry(first, second, counter & WORD, 1)
        e, f = threefry(first, second, counter & WORD, 2)
        words[block, i + AT_WORDS] = a
        words[block, i + AT_WORDS + LANES] = b
        words[block, i + AT_WORDS + 2 * LANES] = c
        words[block, i + AT_WORDS + 3 * LANES] = d
        words[block, i + AT_WORDS + 4 * LANES] = e
        words[block, i + AT_WORDS + 5 * LANES] = f


def draw_seven(words: Words, block: int, counter: int) -> None:
    """Draw seven words a lane of a block at a `counter`, by the keys there."""
    for i in range(LANES):
        first = words[block, i]
        second = words[block, i + LANES]
        a, b = threefry(first, second, counter & WORD, 0)
        c, d = threefry(first, second, counter & WORD, 1)
        e, f = threefry(first, second, counter & WORD, 2)
        g, _spare = threefry(first, second, counter & WORD, 3)
        words[block, i + AT_WORDS] = a
        words[block, i + AT_WORDS + LANES] = b
        words[block, i + AT_WORDS + 2 * LANES] = c
        words[block, i + AT_WORDS + 3 * LANES] = d
        words[block, i + AT_WORDS + 4 * LANES] = e
        words[block, i + AT_WORDS + 5 * LANES] = f
        words[block, i + AT_WORDS + 6 * LANES] = g


def blow(air: Array, words: Words, b: int, tick: int, model: PlaneModel, climate: Climate) -> None:
    """The gusts of a block's aircraft after a tick of their grid; `words` are of the gusts."""
    draw_six(words, b, tick)
    for i in range(GUST_WORDS * LANES):
        air[b, i + AT_NOISE] = lane_normal(words[b, i + AT_WORDS])
    for i in range(LANES):
        mine = limited(model, load_limits(air, b, i + AT_LIMITS))
        noise = load_noise(air, b, i + AT_NOISE)
        store_gusts(air, b, i + AT_GUSTS, lane_blown(load_flown(air, b, i), mine, climate, noise).gusts)


def fly_ordered(air: Array, b: int, model: PlaneModel, climate: Climate) -> None:
    """One sample of a block's aircraft as their autopilots fly them."""
    for i in range(LANES):
        mine = limited(model, load_limits(air, b, i + AT_LIMITS))
        flown = load_flown(air, b, i)
        told = load_told(air, b, i + AT_TOLD)
        down = lane_wind_at(climate, flown.plane.position).z
        aboard = Aboard(
            ZERO, 0.0, Reference(0.0, 0.0), Said(told.altitude, 0.0), Said(told.airspeed, 0.0), told.bank,
            Estimate(0.0, 0.0, 0.0, 0.0, 0.0),
        )  # fmt: skip
        command = lane_commanded(aboard, flown.plane, mine, load_autopilot(air, b, i + AT_AUTOPILOT), down)
        store_flown(air, b, i, lane_fly(flown, mine, command, climate))


def fly_commanded(air: Array, b: int, model: PlaneModel, climate: Climate) -> None:
    """One sample of a block's aircraft under the commands that stand in their lanes."""
    for i in range(LANES):
        mine = limited(model, load_limits(air, b, i + AT_LIMITS))
        command = load_command(air, b, i + AT_COMMAND)
        store_flown(air, b, i, lane_fly(load_flown(air, b, i), mine, command, climate))


def weather(air: Array, b: int, model: PlaneModel, climate: Climate) -> None:
    """The estimates of the wind of a block's autopilots after one more update."""
    for i in range(LANES):
        flown = load_flown(air, b, i)
        plane = flown.plane
        gust = lane_gust_at(climate, flown, model)
        speed = lane_airspeed(plane, lane_wind_at(climate, plane.position), gust)
        sensed = Sensed(plane.velocity, speed, lane_yaw(plane, model))
        before = load_wind(air, b, i + AT_WIND)
        errors = load_errors(air, b, i + AT_ERRORS)
        store_wind(air, b, i + AT_WIND, lane_estimated(before, ARDUPILOT, errors, sensed))


def measure(sky: Sensing, slot: int, b: int, eye: Eye, number: int) -> None:
    """Measurement `number` of a block's aircraft into a slot of what waits."""
    air, words, waiting = sky
    draw_seven(words, b, number)
    for i in range(6 * LANES):
        air[b, i + AT_NOISE] = lane_normal(words[b, i + AT_WORDS + LANES])
    for i in range(3 * LANES):
        waiting[slot, b, i] = air[b, i] + eye.sigma * air[b, i + AT_NOISE]
    for i in range(3 * LANES):
        j = i + 3 * LANES
        waiting[slot, b, j] = air[b, j] + eye.sigma_velocity * air[b, j + AT_NOISE]
    for i in range(LANES):
        waiting[slot, b, i + 6 * LANES] = 0.0 if uniform(words[b, i + AT_WORDS]) < eye.dropout else 1.0


def hear(sky: Sensing, slot: int, b: int, eye: Eye, instant: Instant) -> None:
    """Give the measurement in a slot of what waits, taken at an instant, to a block's filters."""
    air, _words, waiting = sky
    now, dt = instant
    for i in range(MEASURED * LANES):
        air[b, i + AT_NOISE] = waiting[slot, b, i]
    p = max(eye.sigma * eye.sigma, eye.floor)
    v = max(eye.sigma_velocity * eye.sigma_velocity, eye.floor)
    for i in range(LANES):
        m = i + AT_NOISE
        place = Vec(air[b, m], air[b, m + LANES], air[b, m + 2 * LANES])
        velocity = Vec(air[b, m + 3 * LANES], air[b, m + 4 * LANES], air[b, m + 5 * LANES])
        heard = air[b, m + 6 * LANES] != 0.0
        stamp = air[b, i + AT_STAMP]
        first = stamp < 0.0
        old = load_filter(air, b, i + AT_FILTER)
        density = eye.density if first else old.density
        carried = lane_carry(old.axes, (now - stamp) * dt, density)
        measured = Measured(place, velocity, (p, p, p, v, v, v))
        new = lane_corrected(carried, density, measured, eye.learning)
        north = chosen(new.axes[0], Axis(place.x, velocity.x, p, 0.0, v), old.axes[0], first, heard)
        east = chosen(new.axes[1], Axis(place.y, velocity.y, p, 0.0, v), old.axes[1], first, heard)
        down = chosen(new.axes[2], Axis(place.z, velocity.z, p, 0.0, v), old.axes[2], first, heard)
        density = eye.density if first else new.density
        store_filter(air, b, i + AT_FILTER, Filtered((north, east, down), density if heard else old.density))
        air[b, i + AT_STAMP] = float(now) if heard else stamp


def chosen(new: Axis, begun: Axis, old: Axis, first: bool, heard: bool) -> Axis:
    """An axis after a measurement that may be its first, and may be lost."""
    return Axis(
        (begun.x if first else new.x) if heard else old.x,
        (begun.v if first else new.v) if heard else old.v,
        (begun.xx if first else new.xx) if heard else old.xx,
        (begun.xv if first else new.xv) if heard else old.xv,
        (begun.vv if first else new.vv) if heard else old.vv,
    )


def widen(air: Array, b: int, model: PlaneModel) -> None:
    """How far each of a block's aircraft went, its state now included."""
    for i in range(LANES):
        reach = lane_widened(
            load_reach(air, b, i + AT_REACH), load_flown(air, b, i), model, air[b, i + AT_DECLARED]
        )
        store_reach(air, b, i + AT_REACH, reach)
