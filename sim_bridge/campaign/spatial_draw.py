"""What a seed fixes of a spatial game: places, wind, random numbers, and everything up to t₀.

A seed draws where the pursuers start (about the scenario's places) and where the mean wind comes from. Gusts
and the tracks' noise are those of `fly` with the seed of `drawn_scenario`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import msgspec
import numpy as np

from onboard.config.strict import ConfigError, FieldError
from onboard.core.game.advance import EvaderStrategy, PursuerStrategy, begin
from onboard.core.math.vectors import Vec, sub, yaw_of
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.core.strategy.team.planners import planner_for
from onboard.game.scenario import Scenario, VehicleSpec, demand_one_evader, load
from onboard.game.staging import places_of, start_headings
from onboard.runtime.resources import configs
from sim_bridge.campaign.aboard import Aboard, boarded
from sim_bridge.campaign.compiled import KERNELS as CORE
from sim_bridge.campaign.compiled import in_arrays, register, register_strategies
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.campaign.lanes import twins
from sim_bridge.campaign.machine import approach_in_lanes, machine
from sim_bridge.campaign.plane_in_wind import Flown, climate_of, drawn_wind, launched, wind_at
from sim_bridge.campaign.spatial_fixed import Sides, demand_spatial, fixed_of, plain
from sim_bridge.campaign.spatial_game import (
    Array,
    Chosen,
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
from sim_bridge.campaign.tracks import Tracks, no_tracks
from sim_bridge.draws import Purpose, key_of, normal, threefry
from sim_bridge.plane_game.setup import (
    vehicles_of,
)
from sim_bridge.vehicle.flight import KERNELS as FLIGHT
from sim_bridge.vehicle.flight.plane import Command, Steer, start_state, trimmed
from sim_bridge.vehicle.wind import KERNELS as WIND
from sim_bridge.vehicle.wind.dryden import gust_noise
from sim_bridge.vehicle.wind.estimate import Estimate, begun, drawn_errors

KERNELS = (
    *CORE,
    *FLIGHT,
    *WIND,
    "onboard.core.guidance.plane",
    "onboard.core.safety.braking",
    "onboard.core.safety.envelope",
    "onboard.core.safety.fence",
    "onboard.core.safety.field_profile",
    "onboard.core.safety.passing",
    "onboard.core.safety.separation",
    "onboard.core.safety.supervisor",
    "onboard.core.safety.zones_ahead",
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
TURNS = 100  # draws of places within a fence


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
    keys = [key_of(world, id, Purpose.PLACE) for id in scenario.pursuer_ids]
    wind = replace(scenario.flight.wind, from_deg=drawn_wind(world))
    flight = replace(scenario.flight, wind=wind)
    fault: FieldError | None = None
    for turn in range(TURNS):
        pursuers = []
        for spec, key in zip(scenario.pursuers, keys, strict=True):
            a, b = threefry(key.a, key.b, turn, 0)
            c, _spare = threefry(key.a, key.b, turn, 1)
            moves = (spread.level * normal(a), spread.level * normal(b), spread.height * normal(c))
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
    demand_one_evader(scenario, scenario.name)
    demand_spatial(scenario)
    fixed = fixed_of(scenario)
    scenario = drawn_scenario(scenario, seed)
    climate = climate_of(scenario.flight.wind)
    places = places_of(scenario)
    fleet, dt, specs, world = fixed.fleet, fixed.fleet.evader.dt, scenario.vehicles, scenario.seed
    keys = tuple(key_of(world, id, Purpose.GUST) for id in scenario.ids)
    evader, *pursuers = vehicles_of(scenario, places)
    game = begin(evader, tuple(pursuers), fixed.limits[0], fixed.limits[1:])
    start = Start(
        game._replace(score=plain(game.score)),
        fixed.conditions,
        fleet,
        climate,
        fixed.eye._replace(keys=tuple(key_of(world, id, Purpose.SENSOR) for id in scenario.ids)),
        Pace(round(t0 / dt), fixed.control, DECIDES % fixed.control),
        fixed.policies,
        fixed.autopilots,
        keys,
        tuple(drawn_errors(key_of(world, id, Purpose.ESTIMATE)) for id in scenario.ids),
        fixed.planning._replace(key=key_of(world, 0, Purpose.PLAN)),
    )
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
    return Draw(start, flown, crew, tracks, fixed.steps, fixed.sides)


def sky_of(d: Draw, compiled: bool) -> InLanes | OneByOne:
    """A draw's vehicles as its game moves them: in lanes where compiled. It shares the draw's tracks."""
    if compiled:
        return in_lanes_of(d.start, d.players, [], d.crew, d.tracks)
    return one_by_one(d.players, [], d.crew, d.tracks)


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
        run = game
        if compiled and start.conditions.rules.zones.areas:
            run = _compiled_game(evaders, pursuers, True)
        found: SpatialPlay = run(start, chosen, Flying(sky, desk_of(players)), log)
        return found

    return play


@cache
def _compiled_game(
    evaders: tuple[EvaderStrategy, ...], pursuers: tuple[PursuerStrategy, ...], lists: bool = False
) -> Callable[..., Any]:
    # A team keeps its plans in lists, the way round zones is searched in some (`lists`), a plug-in may make
    # some; others play without counting references.
    own: set[Any] = {one.decide for one in EVADERS.values()} | {one.decide for one in PURSUERS.values()}
    free = {one for one in own if planner_for(one) is None}
    counted = lists or not free.issuperset((*evaders, *pursuers))
    evaders, pursuers = in_arrays(evaders), in_arrays(pursuers)
    register_strategies((*evaders, *pursuers))
    return compiled_kernel(machine(evaders, pursuers, in_lanes=True), counted)
