"""What a seed fixes of a spatial game: places, wind, random numbers, and everything up to t₀.

A seed draws where the pursuers start (about the scenario's places) and where the mean wind comes from. Gusts
and the tracks' noise are those of `fly` with the seed of `drawn_scenario`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import IntEnum
from functools import cache
from math import radians
from typing import Any, NamedTuple, TypeVar, cast

import msgspec
import numpy as np

from onboard.config.strict import ConfigError, FieldError
from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.math.vectors import Vec, sub, yaw_of
from onboard.core.safety.policy import Fence
from onboard.core.strategy.registry import EVADERS, PURSUERS, pursuer_named
from onboard.core.strategy.team.flying import pursuer_team
from onboard.core.strategy.team.planner import EVERY
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import AirframeKind, Kind, Scenario, VehicleSpec, load
from onboard.game.staging import places_of, start_headings
from onboard.pilot.kalman import Learning
from onboard.pilot.track_filter import FilterSettings
from onboard.runtime.resources import configs
from sim_bridge.campaign.aboard import Aboard, autopilot_of, boarded, policy_of
from sim_bridge.campaign.compiled import KERNELS as CORE
from sim_bridge.campaign.compiled import in_arrays, register, register_strategies
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.campaign.lanes import twins
from sim_bridge.campaign.machine import approach_in_lanes, machine
from sim_bridge.campaign.plane_in_wind import Flown, climate_of, drawn_wind, launched, wind_at
from sim_bridge.campaign.spatial_game import (
    Array,
    Chosen,
    Fleet,
    Pace,
    SpatialPlay,
    Start,
    load_aboard,
)
from sim_bridge.campaign.spatial_lanes import InLanes, in_lanes_of, players_of, tracks_of, winds_of
from sim_bridge.campaign.spatial_play import (
    LOGGED,
    Flying,
    OneByOne,
    approach,
    desk_of,
    moved_one_by_one,
    one_by_one,
)
from sim_bridge.campaign.team_play import Planning
from sim_bridge.campaign.tracks import Eye, Tracks, no_tracks
from sim_bridge.draws import Purpose, Stream, key_of
from sim_bridge.plane_game.setup import (
    conditions_of,
    game_of,
    heights_of,
    margin_of,
    nearest_of,
    turn_rate_of,
)
from sim_bridge.vehicle.flight import KERNELS as FLIGHT
from sim_bridge.vehicle.flight.aircraft import named, within
from sim_bridge.vehicle.flight.plane import Command, Steer, start_state, trimmed
from sim_bridge.vehicle.wind import KERNELS as WIND
from sim_bridge.vehicle.wind.dryden import gust_noise
from sim_bridge.vehicle.wind.estimate import Estimate, begun, drawn_errors

KERNELS = (
    *CORE,
    *FLIGHT,
    *WIND,
    "onboard.core.guidance.plane",
    "onboard.core.safety.envelope",
    "onboard.core.safety.fence",
    "onboard.core.safety.field_profile",
    "onboard.core.safety.passing",
    "onboard.core.safety.separation",
    "onboard.core.safety.supervisor",
    "onboard.pilot.kalman",
    "sim_bridge.campaign.plane_in_wind",
    "sim_bridge.campaign.aboard",
    "sim_bridge.campaign.tracks",
    "sim_bridge.campaign.lane_math",
    "sim_bridge.campaign.lanes",
    "sim_bridge.campaign.flight_lanes",
    "sim_bridge.campaign.ledger",
    "sim_bridge.campaign.envelope",
    "sim_bridge.campaign.team_play",
    "sim_bridge.campaign.spatial_game",
    "sim_bridge.campaign.spatial_play",
    "sim_bridge.campaign.spatial_lanes",
)
T0 = 6.5  # [s] from the beginning of the world to that of the game, as `fly --fast` has it
DECIDES = 2  # samples after a multiple of 50 ms at which positions come and everybody decides
PLACE_SIGMA = 300.0  # [m] by which a seed moves each pursuer's start, level
HEIGHT_SIGMA = 60.0  # [m] and in height
PLAN_LATE = 0.05  # [s] until a plan is heard over an undisturbed bus
PLAN_PATIENCE = 5.0  # [s] without a plan after which a pursuer flies alone
TURNS = 100  # draws of places within a fence

T = TypeVar("T")


class Sides(NamedTuple):
    """The strategies of a game: those that its kernel holds, and who flies by which."""

    evaders: tuple[EvaderStrategy, ...]
    pursuers: tuple[PursuerStrategy, ...]
    chosen: Chosen


class Draw(NamedTuple):
    """Everything a seed fixes, at t₀."""

    start: Start
    players: list[Flown]  # evader first
    crew: list[Aboard]
    tracks: Tracks
    steps: int  # control steps at most
    sides: Sides


def log_of(d: Draw) -> Array:
    """Room for a drawn game's log, (steps, players, LOGGED)."""
    return np.zeros((d.steps, len(d.players), LOGGED))


def spatial(name: str) -> Scenario:
    """`configs/scenarios/spatial/<name>.toml`."""
    return load(configs() / "scenarios" / "spatial" / f"{name}.toml")


class Spread(NamedTuple):
    """By how much a seed moves each pursuer's start: one sigma an axis [m]."""

    level: float = PLACE_SIGMA
    height: float = HEIGHT_SIGMA


def drawn_scenario(scenario: Scenario, seed: int, spread: Spread = Spread()) -> Scenario:  # noqa: B008
    """The scenario of a seed: its places, its wind's direction and its world's seed drawn. Seed 0 is the
    scenario itself.

    Places outside its fence are drawn again. Raises ConfigError where none was inside.
    """
    if seed == 0:
        return scenario
    replace = msgspec.structs.replace
    world = scenario.seed + seed
    streams = [Stream(key_of(world, id, Purpose.PLACE), 4, block=1) for id in scenario.ids[1:]]
    wind = replace(scenario.flight.wind, from_deg=drawn_wind(world))
    flight = replace(scenario.flight, wind=wind)
    fault: FieldError | None = None
    for turn in range(TURNS):
        pursuers = []
        for spec, stream in zip(scenario.pursuers, streams, strict=True):
            x, y, z, _spare = stream.at(turn)
            moves = (spread.level * x, spread.level * y, spread.height * z)
            place = tuple(a + move for a, move in zip(spec.position, moves, strict=False))
            pursuers.append(replace(spec, position=place))
        try:
            return replace(scenario, seed=world, pursuers=tuple(pursuers), flight=flight)
        except FieldError as error:
            fault = error
    raise ConfigError(f"{scenario.name}, seed {seed}: {fault}; so in {TURNS} draws")


def draw(scenario: Scenario, seed: int, t0: float = T0, compiled: bool = True) -> Draw:
    """The game of a seed, at t₀ [s], counted from the beginning of the world.

    Raises ConfigError for a scenario that is not the compiled game's: see `demand_spatial`.
    """
    demand_spatial(scenario)
    scenario = drawn_scenario(scenario, seed)
    conditions = conditions_of(scenario)
    climate = climate_of(scenario.flight.wind)
    places = places_of(scenario)
    aircraft = named(scenario.flight.airframe.value).model
    fleet = Fleet(*(within(aircraft, spec.limits()) for spec in scenario.vehicles[:2]))
    dt = fleet.evader.dt
    control = round(1.0 / (scenario.flight.control_rate_hz * dt))
    specs = scenario.vehicles
    fence = scenario.flight.fence
    fences = () if fence is None else (Fence(fence.polygon, fence.height_min, fence.height_max),)
    keys = tuple(key_of(scenario.seed, id, Purpose.GUST) for id in scenario.ids)
    start = Start(
        game_of(scenario),
        conditions._replace(control=conditions.control._replace(dt=control * dt)),
        fleet,
        climate,
        eye_of(scenario, dt),
        Pace(round(t0 / dt), control, DECIDES % control),
        tuple(policy_of(spec.limits(), fences, conditions.rules.separation) for spec in specs),
        tuple(autopilot_of(spec.limits(), spec.speed, radians(spec.turn_rate_deg)) for spec in specs),
        keys,
        tuple(drawn_errors(key_of(scenario.seed, id, Purpose.ESTIMATE)) for id in scenario.ids),
        planning_of(scenario, control * dt),
    )
    start = plain(start)
    players: list[Flown] = []
    level: list[Command] = []
    headings = start_headings(scenario)
    for index, (place, heading, spec) in enumerate(zip(places, headings, specs, strict=True)):
        model = fleet.pursuer if index else fleet.evader
        yaw = yaw_of(heading)
        plane = trimmed(start_state(place, yaw, spec.speed, wind_at(climate, place)), model)
        players.append(launched(plane, gust_noise(keys[index], 0)))
        level.append(Command(Steer.COURSE, yaw, 0.0, spec.speed))
    tracks = no_tracks(len(players), start.eye)
    winds = [
        begun(wind_at(climate, place), errors) for place, errors in zip(places, start.errors, strict=True)
    ]
    crew = crew_of(players, start, specs, winds)
    if compiled:
        lanes = in_lanes_of(start, players, level, crew, tracks)
        compiled_kernel(approach_in_lanes, False)(start, Flying(lanes, desk_of(len(players))))
        flown, tracks, winds = players_of(lanes), tracks_of(lanes), winds_of(lanes)
    else:
        sky = one_by_one(players, level, crew, tracks)
        approach(start, moved_one_by_one(), Flying(sky, desk_of(len(players))))
        flown, winds = sky.players, [load_aboard(sky.crew, i, 0).wind for i in range(len(players))]
    crew = crew_of(flown, start, specs, winds)
    steps = int(conditions.rules.horizon / (control * dt)) + 8
    return Draw(start, flown, crew, tracks, steps, sides_of(scenario))


def sky_of(d: Draw, compiled: bool) -> InLanes | OneByOne:
    """A draw's vehicles as its game moves them: in lanes where compiled. It shares the draw's tracks."""
    if compiled:
        return in_lanes_of(d.start, d.players, [], d.crew, d.tracks)
    return one_by_one(d.players, [], d.crew, d.tracks)


def plain(value: T) -> T:
    """A value of a NamedTuple with whole numbers in place of members of enumerations.

    Numba tells the types of such a value at a glance, where it has to look at every member.
    """
    found: Any = value
    if isinstance(value, tuple):
        parts = [plain(part) for part in value]
        found = type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    elif isinstance(value, IntEnum):
        found = int(value)
    return cast(T, found)


def planning_of(scenario: Scenario, step: float) -> Planning:
    """How the scenario's pursuers plan, as their agents do; `step` [s] is a control step.

    The plan's messages are late and lost as those of the bus, where the scenario says so.
    """
    spec = scenario.flight.impairment
    every = max(2, round(EVERY / step))
    late = PLAN_LATE + (spec.delay_s + 0.5 * spec.jitter_s if spec.bus else 0.0)
    limits = tuple(
        one.limits()._replace(turn_rate=turn_rate_of(scenario, index))
        for index, one in enumerate(scenario.vehicles)
    )
    return Planning(
        every,
        min(every - 1, max(1, round(late / step))),
        spec.loss if spec.bus else 0.0,
        round(PLAN_PATIENCE / step),
        heights_of(scenario),
        margin_of(scenario),
        nearest_of(scenario),
        limits,
        key_of(scenario.seed, 0, Purpose.PLAN),
    )


def sides_of(scenario: Scenario) -> Sides:
    """The scenario's strategies by name, and for the evader flying straight besides (number 1).

    Raises ConfigError for an unknown name.
    """
    names = [pursuer_named(spec.strategy) for spec in scenario.pursuers]
    different = list(dict.fromkeys(names))
    return Sides(
        (evader_strategy(scenario.evader.strategy), EVADERS["straight"].decide),
        tuple(pursuer_strategy(name) for name in different),
        Chosen(0, tuple(different.index(name) for name in names)),
    )


def demand_spatial(scenario: Scenario) -> None:
    """Raise ConfigError for what the compiled game does not play."""
    wind = scenario.flight.wind
    spec = scenario.flight
    faults = (
        (wind.correlation_m > 0.0, "wind.correlation_m", f"{wind.correlation_m:g}", "0"),
        (wind.recorded != "", "wind.recorded", wind.recorded, "a mean wind with gusts"),
        (spec.airframe is AirframeKind.KINEMATIC, "airframe", "kinematic", "nose, slip or coordinated"),
        (spec.autopilot is not Kind.ARDUPLANE, "autopilot", spec.autopilot.value, "arduplane"),
    )
    for wrong, key, found, expected in faults:
        if wrong:
            raise ConfigError(f"{scenario.name}: flight.{key}: found {found}, expected {expected}")


def eye_of(scenario: Scenario, dt: float) -> Eye:
    """The scenario's sensor, and the filters of its agents; `dt` [s] is a sample of the aircraft."""
    spec = scenario.flight.sensor
    f = FilterSettings()
    return Eye(
        max(1, round(1.0 / (spec.rate_hz * dt))),
        round(spec.delay_s / dt),
        spec.sigma,
        spec.sigma_velocity,
        spec.dropout,
        f.sigma_min * f.sigma_min,
        f.density,
        Learning(f.density_min, f.density_max, f.adaptation),
        tuple(key_of(scenario.seed, id, Purpose.SENSOR) for id in scenario.ids),
    )


def crew_of(
    flown: list[Flown], start: Start, specs: Sequence[VehicleSpec], winds: list[Estimate]
) -> list[Aboard]:
    """Agents and autopilots at t₀, the last order given a control step before the first of the game."""
    pace, dt = start.pace, start.fleet.evader.dt
    last = (pace.t0 - (pace.t0 - pace.decides) % pace.control) * dt
    crew = []
    for (plane, _gusts), spec, estimate in zip(flown, specs, winds, strict=True):
        air = sub(plane.velocity, wind_at(start.climate, plane.position))
        level = Vec(air.x, air.y, 0.0)  # as ordered: gusts alone make it sink or rise
        crew.append(boarded(level, last, -plane.position.z, spec.speed, estimate))
    return crew


@cache
def compiled_kernel(function: Callable[..., Any], counted: bool = True) -> Callable[..., Any]:
    """A kernel of the game compiled (`kernel`); once for each number of pursuers."""
    register(KERNELS)
    register_strategies(twins())
    for cell in function.__closure__ or ():
        register_strategies((cell.cell_contents,))
    return kernel(function, counted, "numpy")


@cache
def kernel_of(
    evaders: tuple[EvaderStrategy, ...], pursuers: tuple[PursuerStrategy, ...], compiled: bool
) -> Callable[..., Any]:
    """The whole game of these strategies: `play(start, chosen, sky, log)`; compiled, once for each number of
    pursuers.

    `log` (control steps, players, LOGGED) as `spatial_play.play` writes it; ValueError for another shape.
    """
    game = _compiled_game(evaders, pursuers) if compiled else machine(evaders, pursuers, in_lanes=False)

    def play(start: Start, chosen: Chosen, sky: InLanes | OneByOne, log: Array) -> SpatialPlay:
        players = len(start.policies)
        if log.ndim != 3 or log.shape[1:] != (players, LOGGED):
            raise ValueError(f"log: shape {log.shape}, expected (steps, {players}, {LOGGED})")
        found: SpatialPlay = game(start, chosen, Flying(sky, desk_of(players)), log)
        return found

    return play


def _compiled_game(
    evaders: tuple[EvaderStrategy, ...], pursuers: tuple[PursuerStrategy, ...]
) -> Callable[..., Any]:
    # A team keeps its plans in lists, a plug-in may make some; others play without counting references.
    known = {*(one.decide for one in (*EVADERS.values(), *PURSUERS.values()))} - {pursuer_team}
    counted = not known.issuperset((*evaders, *pursuers))
    evaders, pursuers = in_arrays(evaders), in_arrays(pursuers)
    register_strategies((*evaders, *pursuers))
    return compiled_kernel(machine(evaders, pursuers, in_lanes=True), counted)
