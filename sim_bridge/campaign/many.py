"""Many games of several evaders, in simple motion and compiled: `onboard.core.game.many` as one kernel.

Players are in order the evaders, then the pursuers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.game.many import (
    EvaderStrategies,
    ManyConditions,
    ManyGame,
    begin_many,
    decide_many,
    deserted,
    moved_many,
    over,
    planned_many,
    prepared,
    unplanned_many,
)
from onboard.core.game.planning import steps_between
from onboard.core.game.rules import Target
from onboard.core.math.each import each
from onboard.core.math.vectors import Vec
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.team.plan_types import Plan
from onboard.core.strategy.team.planner import Planner
from onboard.core.strategy.team.planners import planner_for
from onboard.core.strategy.team.quarry import Assign, quarries_of
from sim_bridge.campaign import compiled as pairs
from sim_bridge.campaign.compiled import Starts
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.campaign.machine import among

KERNELS = (
    *pairs.KERNELS, "onboard.core.game.targets", "onboard.core.strategy.team.quarry",
    "onboard.core.game.many", pairs.__name__, __name__,
)  # fmt: skip

Array = NDArray[np.float64]


class Size(NamedTuple):
    """How many there are in each game of a call."""

    evaders: int
    pursuers: int
    targets: int  # of each evader; some may not exist


class ManyEnds(NamedTuple):
    """How the games ended, evader by evader."""

    verdicts: NDArray[np.int64]  # (games, evaders) of `GameResult`
    times: Array  # (games, evaders) of the verdicts [s]
    captors: NDArray[np.int64]  # (games, evaders) index of the pursuer, −1 = none
    smallest: Array  # (games, evaders) smallest distance of any pursuer [m]
    unsafe: Array  # (games, evaders) time within the safety distance [s]
    steps: NDArray[np.int64]  # (games,) played
    trace: Array  # (games, kept + 1, players, 3) places at the start and after every step, NaN after the end


def starts_of(games: Sequence[ManyGame], targets: Sequence[tuple[tuple[Target, ...], ...]]) -> Starts:
    """The starts of games made elsewhere (from `begin_many`) with their evaders' targets.

    `targets` becomes an array (games, evaders, targets, 4): whether it exists, and its place [m; NED].
    """
    teams = [(*game.evaders, *game.pursuers) for game in games]
    limits = [(*game.evader_limits, *game.pursuer_limits) for game in games]
    goals = [[[(float(t.exists), *t.position) for t in own] for own in one] for one in targets]
    return Starts(
        np.array([[v.position for v in team] for team in teams], dtype=float),
        np.array([[v.velocity for v in team] for team in teams], dtype=float),
        np.array([[v.speed for v in team] for team in teams], dtype=float),
        np.array(limits, dtype=float),
        np.array(goals, dtype=float),
    )


class _Goals(NamedTuple):
    """The targets of an evader of a game."""

    starts: Starts
    game: int
    evader: int
    numbers: tuple[int, ...]


def _target(number: int, _index: int, goals: _Goals) -> Target:
    """A target (for `each`)."""
    t = goals.starts.targets[goals.game, goals.evader, number]
    return Target(t[0] > 0.0, Vec(float(t[1]), float(t[2]), float(t[3])))


def _targets(evader: int, _index: int, goals: _Goals) -> tuple[Target, ...]:
    """An evader's targets (for `each`)."""
    return each(_target, goals.numbers, _Goals(goals.starts, goals.game, evader, goals.numbers))


def _note(game: ManyGame, places: Array) -> None:
    """Write everybody's place down, (players, 3)."""
    count = len(game.evaders)
    for k in range(count):
        _put(game.evaders[k].position, places, k)
    for k in range(len(game.pursuers)):
        _put(game.pursuers[k].position, places, count + k)


def _put(place: Vec, places: Array, row: int) -> None:
    places[row, 0] = place.x
    places[row, 1] = place.y
    places[row, 2] = place.z


def _close(ends: ManyEnds, number: int, game: ManyGame, steps: int) -> None:
    """Write down how a game ended."""
    for k in range(len(game.scores)):
        score = game.scores[k]
        ends.verdicts[number, k] = score.verdict
        ends.times[number, k] = score.time
        ends.captors[number, k] = score.captor
        ends.smallest[number, k] = score.smallest
        ends.unsafe[number, k] = score.unsafe
    ends.steps[number] = steps


def no_plans(_game: ManyGame, _conditions: ManyConditions, previous: tuple[Plan, ...]) -> tuple[Plan, ...]:
    """In place of the planner where nobody flies by its plan."""
    return previous


def planning_by(planner: Planner) -> Callable[..., tuple[Plan, ...]]:
    """`planned_many` by one planner."""

    def plans_by(
        game: ManyGame, conditions: ManyConditions, previous: tuple[Plan, ...]
    ) -> tuple[Plan, ...]:
        return planned_many(game, conditions, previous, planner)

    return plans_by


def by_number(decide: Callable[[Any, int], Decision], which: tuple[int, ...]) -> EvaderStrategies:
    """Each evader by its own strategy of several: `which` says its number among them."""

    def each_by_its_own(view: Any, evader: int) -> Decision:
        return decide(view, which[evader])

    return each_by_its_own


@cache
def _player(
    decide_evader: EvaderStrategies,
    decide_pursuer: PursuerStrategy,
    size: Size,
    assign: Assign,
    compiled: bool,
) -> Callable[..., None]:
    """Plays games first…last − 1 of the starts into the ends."""
    fleeing = tuple(range(size.evaders))
    chasing = tuple(range(size.evaders, size.evaders + size.pursuers))
    goals = tuple(range(size.targets))
    planner = planner_for(decide_pursuer)
    plan_by: Any = no_plans if planner is None else planning_by(planner)

    def play(
        starts: Starts, conditions: ManyConditions, ends: ManyEnds, first: int, last: int
    ) -> None:
        kept = ends.trace.shape[1]
        every = steps_between(conditions.control.dt)
        for number in range(first, last):
            table = pairs._Table(starts, number)
            targets = each(_targets, fleeing, _Goals(starts, number, 0, goals))
            mine = ManyConditions(conditions.rules, targets, conditions.control)
            start = begin_many(
                each(pairs._vehicle, fleeing, table), each(pairs._vehicle, chasing, table),
                each(pairs._limits, fleeing, table), each(pairs._limits, chasing, table),
            )  # fmt: skip
            game = start
            plans = unplanned_many(game)
            steps = 0
            if kept > 0:
                _note(game, ends.trace[number, 0])
            while not over(game):
                due = steps % every == 0 or deserted(game)
                now = prepared(game, mine, due, assign)
                if due:
                    plans = plan_by(now, mine, plans)
                decided = decide_many(now, mine, decide_evader, decide_pursuer, plans)
                now = moved_many(now, mine, decided)
                # Limits never change: taken from the start, they stay out of the compiled loop.
                game = ManyGame(
                    now.time, now.evaders, now.pursuers, start.evader_limits, start.pursuer_limits,
                    now.scores, now.aims, now.quarries,
                )  # fmt: skip
                steps += 1
                if steps < kept:
                    _note(game, ends.trace[number, steps])
            _close(ends, number, game, steps)

    if not compiled:
        return play
    pairs.register(KERNELS)
    pairs.register_strategies((decide_evader, decide_pursuer, plan_by, assign))
    return kernel(play, True, "numpy")


@cache
def _evaders(strategies: tuple[EvaderStrategy, ...]) -> EvaderStrategies:
    """Each evader's strategy as one function."""
    different = tuple(dict.fromkeys(strategies))
    return by_number(among(different), tuple(different.index(one) for one in strategies))


def many_campaign(
    decide_evaders: tuple[EvaderStrategy, ...], decide_pursuer: PursuerStrategy, size: Size,
    compiled: bool = True, assign: Assign = quarries_of,
) -> Callable[..., ManyEnds]:
    """The play of many games of one size, each evader by its strategy and all pursuers by one.

    `assign` says who goes for whom.

    Returns `play(starts, conditions, keep=0) -> ManyEnds`; `keep` records everybody's places over the first
    so many steps. The games differ in their starts, speeds, limits and targets (`starts_of`); the rest of the
    conditions is common. `compiled=False` runs the same functions interpreted. Raises ValueError where the
    arrays' shapes disagree.
    """  # fmt: skip

    def play(starts: Starts, conditions: ManyConditions, keep: int = 0) -> ManyEnds:
        games, players = starts.positions.shape[0], size.evaders + size.pursuers
        shapes = (
            (players, 3), (players, 3), (players,), (players, starts.limits.shape[-1]),
            (size.evaders, size.targets, 4),
        )  # fmt: skip
        for name, array, shape in zip(Starts._fields, starts, shapes, strict=True):
            if array.shape != (games, *shape):
                raise ValueError(f"{name}: shape {array.shape}, expected {(games, *shape)}")
        starts = Starts(*(np.ascontiguousarray(array, dtype=np.float64) for array in starts))
        rows, each_evader = keep + 1 if keep > 0 else 0, (games, size.evaders)
        ends = ManyEnds(
            np.zeros(each_evader, np.int64), np.zeros(each_evader), np.zeros(each_evader, np.int64),
            np.zeros(each_evader), np.zeros(each_evader), np.zeros(games, np.int64),
            np.full((games, rows, players, 3), np.nan),
        )  # fmt: skip
        ways: tuple[Any, ...] = (*decide_evaders, decide_pursuer)
        *evaders, pursuer = pairs.in_arrays(ways) if compiled else ways
        _player(_evaders(tuple(evaders)), pursuer, size, assign, compiled)(starts, conditions, ends, 0, games)
        return ends

    return play
