"""The plane game of one evader with up to two targets, whose pursuers may be lost: one compiled kernel.

It is the core's game (`advance`, `judge_any`) but for who is lost: from then on that pursuer is far away, not
seen, captures nobody, and its team knows. Kernel style but for the arrays.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import (
    Conditions,
    EvaderStrategy,
    Game,
    PursuerStrategy,
    decide_by_plan,
    move_one,
    moved,
    positions,
    speed_of,
    still_view,
)
from onboard.core.game.planning import situation_of, steps_between, unplanned, with_targets
from onboard.core.game.referee import GameResult, Step, judge_any
from onboard.core.game.rules import Rules, Target
from onboard.core.game.targets import NONE, at, chosen
from onboard.core.game.views import told
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.team.plan_types import Member
from onboard.core.strategy.team.planner import Planner
from sim_bridge.campaign import compiled as pairs
from sim_bridge.campaign.compiled import Starts
from sim_bridge.campaign.kernel_cache import kernel

Array = NDArray[np.float64]
TARGETS = (0, 1)
FAR = Vec(1e7, 1e7, 0.0)  # [m] where the lost are
STILL = 1e-9  # [m/s] their speed


class Trials(NamedTuple):
    """Games before their first step."""

    starts: Starts
    targets: Array  # (games, 2, 3) [m]; NaN: there is none
    lost: Array  # (games, pursuers) when each is lost [s]; inf: never


class Ended(NamedTuple):
    """How they ended."""

    verdicts: NDArray[np.int64]  # (games,) of `GameResult`
    times: Array  # (games,) [s]


class Place(NamedTuple):
    """A game of the trials, and the rules that say what pursuers know (for `each`)."""

    trials: Trials
    game: int
    time: float


def target_of(number: int, _index: int, place: Place) -> Target:
    """A target of the game (for `each`)."""
    p = place.trials.targets[place.game, number]
    if np.isnan(p[0]):
        return Target(False, ZERO)
    return Target(True, Vec(float(p[0]), float(p[1]), float(p[2])))


def known(target: Target, _index: int, rules: Rules) -> Target:
    """A target as the pursuers know it (for `each`)."""
    return told(target, rules)


def there(vehicle: Vehicle, index: int, place: Place) -> Vehicle:
    """A pursuer where it is, or away once it is lost (for `each`)."""
    if place.time >= place.trials.lost[place.game, index]:
        return Vehicle(FAR, ZERO, STILL)
    return vehicle


def member(vehicle: Vehicle, index: int, place: Place) -> Member:
    """A pursuer as its team knows it (for `each`)."""
    limits = pairs._limits(index + 1, 0, pairs._Table(place.trials.starts, place.game))
    return Member(vehicle, limits, place.time < place.trials.lost[place.game, index])


@cache
def player(
    ways: tuple[EvaderStrategy, PursuerStrategy], planner: Planner, count: int, compiled: bool = True
) -> Callable[[Trials, Conditions, Ended], None]:
    """Plays all games of trials of `count` pursuers into their ends."""
    decide_evader, decide_pursuer = ways
    team = tuple(range(1, count + 1))

    def play(trials: Trials, conditions: Conditions, ends: Ended) -> None:
        every = steps_between(conditions.control.dt)
        for number in range(trials.starts.speeds.shape[0]):
            game = pairs._begin(pairs._Table(trials.starts, number), team)
            targets = each(target_of, TARGETS, Place(trials, number, 0.0))
            plan = unplanned(game)
            aim = NONE
            steps = 0
            while game.score.verdict == GameResult.RUNNING:
                place = Place(trials, number, game.time)
                game = Game(
                    game.time, game.evader, each(there, game.pursuers, place), game.evader_limits,
                    game.pursuer_limits, game.score,
                )  # fmt: skip
                view = still_view(game, conditions)
                aim = chosen(view.own, view.limits, view.cones, targets, conditions.rules.planar, aim)
                mine = Conditions(conditions.rules, at(targets, aim), conditions.control)
                if steps % every == 0:
                    seats = each(member, game.pursuers, place)
                    alone = situation_of(game, mine, seats)
                    plan = planner(with_targets(alone, each(known, targets, mine.rules)), plan)
                made = decide_by_plan(game, mine, decide_evader, decide_pursuer, plan.assignments)
                dt = mine.control.dt
                evader = moved(game.evader, made.evader, dt)
                pursuers = each_pair(move_one, game.pursuers, made.pursuers, dt)
                step = Step(
                    game.time, dt, game.evader.position, evader.position, positions(game.pursuers),
                    positions(pursuers), game.evader.speed, each(speed_of, game.pursuers, 0.0),
                )  # fmt: skip
                score = judge_any(game.score, step, mine.rules, targets)
                game = Game(
                    game.time + dt, evader, pursuers, game.evader_limits, game.pursuer_limits, score
                )
                steps += 1
            ends.verdicts[number] = game.score.verdict
            ends.times[number] = game.score.time

    if not compiled:
        return play
    pairs.register((*pairs.KERNELS, "onboard.core.game.targets", pairs.__name__))
    of_here: tuple[Callable[..., Any], ...] = (target_of, known, there, member)
    pairs.register_strategies((*ways, planner, *of_here))
    ready: Callable[[Trials, Conditions, Ended], None] = kernel(play, True, "numpy")
    return ready
