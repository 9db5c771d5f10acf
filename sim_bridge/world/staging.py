"""From a scenario to what is flown: starts, kinds, airframes, and generators by concern."""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, inf
from pathlib import Path
from zlib import crc32

import numpy as np
from msgspec import convert
from msgspec.structs import replace
from numpy.random import Generator, SeedSequence

from onboard.core.math.vectors import yaw_of
from onboard.game.scenario import AirframeKind, Kind, Scenario, VehicleSpec, WindSpec
from onboard.game.staging import staging_place, start_headings
from onboard.runtime.impairment import Impairment
from onboard.wire.geodesy import Frame
from sim_bridge.draws import Purpose, key_of
from sim_bridge.vehicle.flight.kinematic import kinematic, start_motion
from sim_bridge.vehicle.motion import CALM, Air, Airframe, Motion
from sim_bridge.vehicle.wind.estimate import Errors, drawn_errors
from sim_bridge.vehicle.wind.field import WindField

Wind = Callable[[int, Motion, float], Air]  # (vehicle id, its motion, time since the start [s]) → its air


def calm(id: int, motion: Motion, t: float) -> Air:
    """Air that does not move: a `Wind` for games without wind."""
    return CALM


def generator(seed: int, concern: str) -> Generator:
    """The random generator of one concern: the same whichever other concerns there are."""
    return np.random.default_rng(SeedSequence(seed, spawn_key=(crc32(concern.encode()),)))


def wind_of(scenario: Scenario, seed: int, folder: Path | None = None) -> Wind:
    """The scenario's wind; a recording's path is relative to `folder`. Raises ConfigError."""
    spec = scenario.flight.wind
    if not blows(spec):
        return calm
    field = WindField(spec, seed, scenario.ids, folder)
    numbers = {id: number for number, id in enumerate(scenario.ids)}

    def air(id: int, motion: Motion, t: float) -> Air:
        return field.air(numbers[id], motion, t)

    return air


def blows(spec: WindSpec) -> bool:
    """Whether a wind moves the air at all."""
    return spec.speed > 0.0 or spec.gust_sigma > 0.0 or bool(spec.recorded)


def wind_errors_of(scenario: Scenario, seed: int, id: int) -> Errors | None:
    """What is wrong with a vehicle's estimate of the wind; None in still air, which everybody knows."""
    return drawn_errors(key_of(seed, id, Purpose.ESTIMATE)) if blows(scenario.flight.wind) else None


def impairment_of(scenario: Scenario) -> Impairment:
    """What happens to datagrams between each autopilot and whoever hears it, in both directions."""
    return convert(scenario.flight.impairment, Impairment, from_attributes=True)


def frame_of(scenario: Scenario) -> Frame:
    """The game frame: NED at the scenario's origin."""
    origin = scenario.flight.origin
    return Frame(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)


def kind_of(scenario: Scenario, spec: VehicleSpec) -> Kind:
    """Which autopilot flies a vehicle."""
    return scenario.flight.autopilot if spec.autopilot is None else spec.autopilot


def starts(scenario: Scenario, wind: Wind) -> dict[int, Motion]:
    """The motion of every vehicle at the start, in the air that is there."""
    motions: dict[int, Motion] = {}
    for id, spec, heading in zip(scenario.ids, scenario.vehicles, start_headings(scenario), strict=True):
        place, kind, yaw = staging_place(scenario, spec), kind_of(scenario, spec), yaw_of(heading)
        airborne = not scenario.flight.ground_start
        still = start_motion(place, yaw, kind, spec.speed, CALM, airborne)
        motions[id] = start_motion(place, yaw, kind, spec.speed, wind(id, still, 0.0), airborne)
    return motions


def holding(spec: VehicleSpec, airframe: Airframe) -> VehicleSpec:
    """A vehicle as its autopilot is set up: with no more than the turn that its airframe can hold."""
    rate = degrees(getattr(airframe, "turn_rate", inf))
    return spec if rate >= spec.turn_rate_deg else replace(spec, turn_rate_deg=rate)


def airframe_of(scenario: Scenario, spec: VehicleSpec, start: Motion, air: Air) -> Airframe:
    """The airframe of a vehicle."""
    kind = kind_of(scenario, spec)
    airframe = scenario.flight.airframe if spec.airframe is None else spec.airframe
    if airframe is AirframeKind.KINEMATIC:
        return kinematic(spec, kind, start, air)
    from sim_bridge.vehicle.flight.airframe import fixed_wing

    return fixed_wing(airframe.value, spec.limits(), start.position, start.yaw, start.airspeed, air.wind)
