"""Where many games of simple motion stand, and how each begins. Kernel style, but for the arrays."""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import Conditions, Game, positions
from onboard.core.game.referee import GameResult, Score, opening
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import NORTH, Vec, distance, scale, sub, unit
from onboard.core.strategy.features import Form
from sim_bridge.campaign.plane_in_wind import drawn_wind
from sim_bridge.campaign.tracks import Eye
from sim_bridge.draws import Purpose, key_of, normal, threefry
from sim_bridge.gym.exchange import Rewards

Array = NDArray[np.float64]
REDRAWN = 16  # times at most that a pursuer's start within the safety distance is drawn again


class World(NamedTuple):
    """What all games of a task share."""

    template: Game  # places without spread, speeds and limits
    conditions: Conditions
    wind: float  # mean [m/s]; where it comes from is drawn
    eye: Eye  # its keys are each game's own
    noisy: bool  # whether everybody is known by tracks
    form: Form
    rewards: Rewards
    spread: float  # [m] of the pursuers' starts, one sigma, level
    rise: float  # [m] and in height
    headings: Array  # (players,) declared [rad]; NaN: towards target or evader
    ids: NDArray[np.int64]  # (players,) whose random numbers
    seed: int  # of the scenario
    learns: NDArray[np.bool_]  # (players,) whose decisions come from outside
    team_learns: bool  # some pursuer's do
    team_plays: bool  # some pursuer's do not


class Table(NamedTuple):
    """Where the games stand."""

    places: Array  # (games, players, 3) [m; NED]
    velocities: Array  # (games, players, 3) through the air [m/s]
    clock: Array  # (games, 3): time [s], smallest distance [m], time within the safety distance [s]
    steps: NDArray[np.int64]  # (games,) played
    seeds: NDArray[np.int64]  # (games,)
    winds: Array  # (games, 2) north and east [m/s], where the air moves to
    decided: Array  # (games, 4): decided direction and speed of an evader that does not learn
    turns: Array  # (games, players, 2): axes of the observation
    keys: NDArray[np.int64]  # (games, players, 2) of the sensor's random numbers
    waiting: Array  # (games, slots, players, 7) measurements under way
    filters: Array  # (games, players, WIDTH)
    stamps: Array  # (games, players)
    states: Array  # (players, 6) of a thread: a game's places and velocities over ground, for the sensor
    words: NDArray[np.int64]  # (blocks, WORD_BLOCK) of a thread: where a game's noise is drawn
    noise: Array  # (blocks, 6 · LANES) of a thread: the same


class Here(NamedTuple):
    """One game of the table (for `each`)."""

    table: Table
    world: World
    game: int


def vec_of(row: Array) -> Vec:
    """A vector in an array."""
    return Vec(float(row[0]), float(row[1]), float(row[2]))


def wind_of(here: Here) -> Vec:
    """The wind of a game [m/s; NED, where the air moves to]."""
    row = here.table.winds[here.game]
    return Vec(row[0], row[1], 0.0)


def write(row: Array, v: Vec) -> None:
    """A vector into an array."""
    row[0] = v.x
    row[1] = v.y
    row[2] = v.z


def player_of(vehicle: Vehicle, index: int, here: Here) -> Vehicle:
    """Pursuer `index` where it is (for `each`)."""
    t, g = here.table, here.game
    return Vehicle(vec_of(t.places[g, index + 1]), vec_of(t.velocities[g, index + 1]), vehicle.speed)


def loaded(here: Here) -> Game:
    """A game of the table."""
    t, g, template = here.table, here.game, here.world.template
    evader = Vehicle(vec_of(t.places[g, 0]), vec_of(t.velocities[g, 0]), template.evader.speed)
    score = Score(GameResult.RUNNING, t.clock[g, 0], -1, t.clock[g, 1], t.clock[g, 2])
    pursuers = each(player_of, template.pursuers, here)
    return Game(t.clock[g, 0], evader, pursuers, template.evader_limits, template.pursuer_limits, score)


def store(game: Game, here: Here) -> None:
    """Write a game down."""
    t, g = here.table, here.game
    write(t.places[g, 0], game.evader.position)
    write(t.velocities[g, 0], game.evader.velocity)
    for k in range(len(game.pursuers)):
        write(t.places[g, k + 1], game.pursuers[k].position)
        write(t.velocities[g, k + 1], game.pursuers[k].velocity)
    t.clock[g, 0] = game.time
    t.clock[g, 1] = game.score.smallest
    t.clock[g, 2] = game.score.unsafe


def drawn_place(seed: int, id: int, base: Vec, world: World) -> Vec:
    """Where a seed puts a pursuer: about its place, outside the safety distance, as campaigns draw it."""
    key = key_of(seed, id, Purpose.PLACE)
    place = base
    for trial in range(REDRAWN):
        a, b = threefry(key.a, key.b, trial, 0)
        c, _spare = threefry(key.a, key.b, trial, 1)
        place = Vec(
            base.x + world.spread * normal(a),
            base.y + world.spread * normal(b),
            base.z - world.rise * normal(c),
        )
        if distance(place, world.template.evader.position) > world.conditions.rules.rho:
            break
    return place


def faced(declared: float, line: Vec) -> Vec:
    """A start's heading: as declared [rad], else level along a line."""
    if declared == declared:
        return Vec(cos(declared), sin(declared), 0.0)
    return unit(Vec(line.x, line.y, 0.0), NORTH)


def drawn(vehicle: Vehicle, index: int, here: Here) -> Vehicle:
    """Pursuer `index` at the start of its game's seed (for `each`)."""
    world = here.world
    place = vehicle.position
    if world.spread > 0.0:
        place = drawn_place(here.table.seeds[here.game] + world.seed, world.ids[index + 1], place, world)
    line = sub(world.template.evader.position, place)
    ahead = faced(world.headings[index + 1], line)
    return Vehicle(place, scale(ahead, vehicle.speed), vehicle.speed)


def restart(here: Here) -> None:
    """The start of the game's seed."""
    t, g, world = here.table, here.game, here.world
    e = world.template.evader
    target = world.conditions.target
    line = scale(sub(target.position, e.position), 1.0 if target.exists else 0.0)
    evader = Vehicle(e.position, scale(faced(world.headings[0], line), e.speed), e.speed)
    pursuers = each(drawn, world.template.pursuers, here)
    score = opening(e.position, positions(pursuers))
    template = world.template
    store(Game(0.0, evader, pursuers, template.evader_limits, template.pursuer_limits, score), here)
    t.steps[g] = 0
    if world.wind > 0.0:
        towards = radians(drawn_wind(t.seeds[g] + world.seed)) + pi
        t.winds[g, 0] = world.wind * cos(towards)
        t.winds[g, 1] = world.wind * sin(towards)
    if world.noisy:
        for i in range(t.stamps.shape[1]):
            t.stamps[g, i] = -1.0
            key = key_of(t.seeds[g] + world.seed, world.ids[i], Purpose.SENSOR)
            t.keys[g, i, 0] = key.a
            t.keys[g, i, 1] = key.b
