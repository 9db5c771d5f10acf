"""A trial of whole games beside each other: cones and referee of many games at once, decisions one by one.

It is `advance` of the core, taken apart: the same functions in the same order for each game, so that every
number is that of a game played alone. What has no branch worth one stands in loops over games, of which a
compiler makes vector instructions; strategies, of which nothing is known, are asked game by game. What comes
of it is in benchmarks/results/lanes-over-games.md: campaigns do not play so.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

from onboard.core.game.advance import (
    Conditions,
    EvaderStrategy,
    Game,
    PursuerStrategy,
    decide_pursuers,
    judged,
    move_one,
    moved,
)
from onboard.core.game.referee import NEARLY, GameResult, Score, closest
from onboard.core.game.rules import Rules, Target
from onboard.core.game.views import EvaderView, sighted, turn_rate_of
from onboard.core.geometry.cones import Cone, Seen, blocked_cone
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, scale
from sim_bridge.campaign import compiled
from sim_bridge.campaign.compiled import (
    KERNELS,
    Ends,
    Starts,
    _aimed,
    _begin,
    _close,
    _Table,
    register,
    register_strategies,
)
from sim_bridge.campaign.kernel_cache import kernel

Array = NDArray[np.float64]
ACROSS = 16  # games beside each other: two vectors of eight; their numbers fit the nearest cache
# Numbers of a row, a row a player, the evader's last; each of ACROSS games, one after the other.
NOW, SPEED, BEFORE, SEEN, OTHER, CONE, SQUARE, VELOCITY = (
    k * ACROSS for k in (0, 3, 4, 7, 11, 14, 19, 20)
)  # SEEN: the evader's place and speed; OTHER: its place before
NUMBERS = 23 * ACROSS
# In the evader's row, in place of what only pursuers have.
TIME, SMALLEST, UNSAFE, STEPS = (k * ACROSS for k in (14, 15, 16, 17))


class Block(NamedTuple):
    """Games beside each other."""

    air: Array  # (players, NUMBERS)
    games: NDArray[np.int64]  # (ACROSS,) number of each; −1: no more


class Lane(NamedTuple):
    """One game of a block (for `each`)."""

    air: Array
    i: int
    limits: Array  # (games, players, 7)
    game: int


def block_of(players: int) -> Block:
    """Room for games."""
    return Block(np.zeros((players, NUMBERS)), np.full(ACROSS, -1))


def place_at(air: Array, row: int, at: int) -> Vec:
    """Three numbers of a game."""
    return Vec(air[row, at], air[row, at + ACROSS], air[row, at + 2 * ACROSS])


def put_place(air: Array, row: int, at: int, place: Vec) -> None:
    """Write three numbers of a game."""
    air[row, at] = place.x
    air[row, at + ACROSS] = place.y
    air[row, at + 2 * ACROSS] = place.z


def vehicle_of(player: int, _index: int, lane: Lane) -> Vehicle:
    """A player now (for `each`); pursuer p is row p − 1."""
    air, i = lane.air, lane.i
    row = player - 1
    return Vehicle(place_at(air, row, i + NOW), place_at(air, row, i + VELOCITY), air[row, i + SPEED])


def limits_of(player: int, _index: int, lane: Lane) -> VehicleLimits:
    """What a player may do (for `each`)."""
    a, g, p = lane.limits, lane.game, player
    return VehicleLimits(
        a[g, p, 0], a[g, p, 1], a[g, p, 2], a[g, p, 3], a[g, p, 4], a[g, p, 5], a[g, p, 6]
    )  # fmt: skip


def cone_of(player: int, _index: int, lane: Lane) -> Cone:
    """The cone that a pursuer blocks (for `each`)."""
    air, row, i = lane.air, player - 1, lane.i
    at = i + CONE
    return Cone(place_at(air, row, at), air[row, at + 3 * ACROSS], air[row, at + 4 * ACROSS])


def block_cones(air: Array, row: int, rho: float) -> None:
    """The cones that a pursuer blocks, in all games."""
    for i in range(ACROSS):
        pursuer = Vehicle(place_at(air, row, i + NOW), ZERO, air[row, i + SPEED])
        seen = Seen(place_at(air, row, i + SEEN), air[row, i + SEEN + 3 * ACROSS], rho)
        cone = blocked_cone(pursuer, 0, seen)
        put_place(air, row, i + CONE, cone.axis)
        air[row, i + CONE + 3 * ACROSS] = cone.cos
        air[row, i + CONE + 4 * ACROSS] = cone.sin


def look_closely(air: Array, row: int) -> None:
    """How near a pursuer came in the step, in all games."""
    for i in range(ACROSS):
        p0, p1 = place_at(air, row, i + BEFORE), place_at(air, row, i + NOW)
        e0, e1 = place_at(air, row, i + OTHER), place_at(air, row, i + SEEN)
        air[row, i + SQUARE] = closest(p0, p1, e0, e1).square


def load(block: Block, i: int, game: Game) -> None:
    """Put a game before its first step into a lane."""
    air, last = block.air, block.air.shape[0] - 1
    for k in range(len(game.pursuers)):
        put_vehicle(air, k, i, game.pursuers[k])
        put_place(air, k, i + SEEN, game.evader.position)
        air[k, i + SEEN + 3 * ACROSS] = game.evader.speed
    put_vehicle(air, last, i, game.evader)
    air[last, i + TIME] = 0.0
    air[last, i + SMALLEST] = game.score.smallest
    air[last, i + UNSAFE] = 0.0
    air[last, i + STEPS] = 0.0


def put_vehicle(air: Array, row: int, i: int, vehicle: Vehicle) -> None:
    """Write a vehicle down."""
    put_place(air, row, i + NOW, vehicle.position)
    put_place(air, row, i + VELOCITY, vehicle.velocity)
    air[row, i + SPEED] = vehicle.speed


def game_at(lane: Lane, team: tuple[int, ...]) -> Game:
    """The game of a lane as it stands."""
    air, i, last = lane.air, lane.i, lane.air.shape[0] - 1
    evader = vehicle_of(last + 1, 0, lane)
    score = Score(GameResult.RUNNING, air[last, i + TIME], -1, air[last, i + SMALLEST], air[last, i + UNSAFE])
    return Game(
        air[last, i + TIME],
        evader,
        each(vehicle_of, team, lane),
        limits_of(0, 0, lane),
        each(limits_of, team, lane),
        score,
    )


def decide_and_move(
    lane: Lane, game: Game, conditions: Conditions, decide_evader: Any, decide_pursuer: Any, team: Any
) -> None:
    """Everybody's decision and move: `advance` up to the referee, with the cones that are there."""
    air, i, last = lane.air, lane.i, lane.air.shape[0] - 1
    dt = conditions.control.dt
    rates = each(turn_rate_of, game.pursuer_limits, 0.0)
    cones = each(cone_of, team, lane)
    view = EvaderView(
        game.evader, game.evader_limits, game.pursuers, cones, conditions.target, conditions.rules, rates
    )
    own = decide_evader(view)
    turned = Vehicle(game.evader.position, scale(own.direction, own.speed), game.evader.speed)
    seen = sighted(turned, own.direction, conditions.control.lookahead)
    evader = moved(game.evader, own, dt)
    pursuers = each_pair(move_one, game.pursuers, decide_pursuers(game, seen, conditions, decide_pursuer), dt)
    put_place(air, last, i + BEFORE, game.evader.position)
    put_vehicle(air, last, i, evader)
    for k in range(len(pursuers)):
        put_place(air, k, i + BEFORE, game.pursuers[k].position)
        put_place(air, k, i + OTHER, game.evader.position)
        put_vehicle(air, k, i, pursuers[k])
        put_place(air, k, i + SEEN, evader.position)


def before_step(vehicle: Vehicle, index: int, lane: Lane) -> Vehicle:
    """A pursuer where the step began (for `each`)."""
    return Vehicle(place_at(lane.air, index, lane.i + BEFORE), vehicle.velocity, vehicle.speed)


def judge_lane(lane: Lane, conditions: Conditions, team: tuple[int, ...]) -> Game:
    """The game of a lane after the step."""
    air, i, last = lane.air, lane.i, lane.air.shape[0] - 1
    after = game_at(lane, team)
    least = air[0, i + SQUARE]
    for k in range(1, last):
        least = min(least, air[k, i + SQUARE])
    rules, dt = conditions.rules, conditions.control.dt
    e0 = place_at(air, last, i + BEFORE)
    if may_end(least, after.time, dt, (e0, after.evader.position), rules, conditions.target):
        evader = Vehicle(e0, after.evader.velocity, after.evader.speed)
        before = Game(
            after.time,
            evader,
            each(before_step, after.pursuers, lane),
            after.evader_limits,
            after.pursuer_limits,
            after.score,
        )
        after = judged(before, after.evader, after.pursuers, conditions)
    else:
        score = passed(after.score, after.time, dt, sqrt(least), rules)
        after = Game(
            after.time + dt, after.evader, after.pursuers, after.evader_limits, after.pursuer_limits, score
        )
    air[last, i + TIME] = after.time
    air[last, i + SMALLEST] = after.score.smallest
    air[last, i + UNSAFE] = after.score.unsafe
    air[last, i + STEPS] += 1.0
    return after


def passed(score: Score, start: float, dt: float, nearest: float, rules: Rules) -> Score:
    """The score after a step that decided nothing, in which a pursuer came as near as `nearest` [m]."""
    unsafe = score.unsafe + dt if nearest < rules.rho else score.unsafe
    return Score(GameResult.RUNNING, start + dt, -1, min(score.smallest, nearest), unsafe)


def may_end(
    least: float, start: float, dt: float, way: tuple[Vec, Vec], rules: Rules, target: Target
) -> bool:
    """Whether a step may decide a game: not where `judge` would find nothing but that it passed.

    `least` is the square of the smallest distance of any pursuer in it [m²], `way` the evader's.
    """
    if least <= NEARLY * rules.R * rules.R or (rules.horizon - start) / dt <= 1.0 + 1e-9:
        return True
    reach = rules.epsilon_min
    if not target.exists:
        return False
    return closest(target.position, target.position, way[0], way[1]).square <= NEARLY * reach * reach


def lane_player(
    decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy, team: tuple[int, ...]
) -> Callable[[Starts, Conditions, Ends, Block], None]:
    """The play of all games of the starts into the ends, compiled."""

    def enter(block: Block, i: int, number: int, starts: Starts) -> None:
        block.games[i] = number
        load(block, i, _begin(_Table(starts, number), team))

    def step(block: Block, i: int, starts: Starts, conditions: Conditions) -> None:
        number = block.games[i]
        lane = Lane(block.air, i, starts.limits, number)
        mine = _aimed(conditions, starts.targets[number])
        decide_and_move(lane, game_at(lane, team), mine, decide_evader, decide_pursuer, team)

    def judge(block: Block, i: int, starts: Starts, conditions: Conditions, ends: Ends) -> bool:
        number = block.games[i]
        lane = Lane(block.air, i, starts.limits, number)
        game = judge_lane(lane, _aimed(conditions, starts.targets[number]), team)
        if game.score.verdict == GameResult.RUNNING:
            return False
        _close(ends, number, game, int(block.air[len(team), i + STEPS]))
        return True

    def play(starts: Starts, conditions: Conditions, ends: Ends, block: Block) -> None:
        following, last, running = 0, starts.speeds.shape[0], 0
        for i in range(ACROSS):
            block.games[i] = -1
            if following < last:
                enter(block, i, following, starts)
                following += 1
                running += 1
        while running > 0:
            for k in range(len(team)):
                block_cones(block.air, k, conditions.rules.rho)
            for i in range(ACROSS):
                if block.games[i] >= 0:
                    step(block, i, starts, conditions)
            for k in range(len(team)):
                look_closely(block.air, k)
            for i in range(ACROSS):
                if block.games[i] >= 0 and judge(block, i, starts, conditions, ends):
                    block.games[i] = -1
                    running -= 1
                    if following < last:
                        enter(block, i, following, starts)
                        following += 1
                        running += 1

    register((*KERNELS, compiled.__name__))
    for one in (block_cones, look_closely):  # else the loops over games are no longer seen as such
        register_jitable(one)
    apart = (block_cones, look_closely, lane_player)
    mine = [one for one in globals().values() if isinstance(one, FunctionType) and one.__module__ == __name__]
    register_strategies(one for one in mine if one not in apart)
    register_strategies((enter, step, judge, decide_evader, decide_pursuer))
    return kernel(play, False, "numpy")
