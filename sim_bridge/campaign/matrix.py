"""Many games of simple motion, many strategies of both sides in one kernel.

`compiled.campaign` compiles each pair of strategies for itself: the fastest game, and the longest wait where
every strategy meets every other. Here each strategy is compiled once, out of line, and a game says by number
who flies. The games are the same.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

from onboard.core.game.advance import (
    Conditions,
    Decisions,
    EvaderStrategy,
    Field,
    Game,
    PursuerStrategy,
    moved_on,
    still_view,
    view_of_one,
)
from onboard.core.game.planning import planning_by, steps_between, unplanned
from onboard.core.game.referee import GameResult
from onboard.core.game.views import PursuerView, sighted
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import scale
from onboard.core.strategy.keep_out import evader_keeps_out, pursuer_keeps_out
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.team.plan_types import Plan
from onboard.core.strategy.team.planners import planner_for
from sim_bridge.campaign import compiled as pairs
from sim_bridge.campaign.compiled import Ends, Starts
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.campaign.machine import among, only_planner


class Meeting(NamedTuple):
    """Who meets whom: numbers into the strategies of a kernel; whether the pursuers fly by a plan."""

    evader: int
    pursuers: int
    planning: bool


class Asked(NamedTuple):
    """The pursuers' strategies, and which of them is asked (for `each`)."""

    decide: Callable[[PursuerView, int], Decision]
    number: int


def asked_of(view: PursuerView, _index: int, asked: Asked) -> Decision:
    """A pursuer's decision (for `each`)."""
    return pursuer_keeps_out(view, asked.decide(view, asked.number))


def no_plan_made(_game: Game, _conditions: Conditions, previous: Plan) -> Plan:
    """In place of the planner where no strategy flies by its plan."""
    return previous


@cache
def _player(
    evaders: tuple[EvaderStrategy, ...], pursuers: tuple[PursuerStrategy, ...], count: int, compiled: bool
) -> Callable[[Starts, Conditions, Ends, Meeting], None]:
    """Plays all games of the starts into the ends."""
    evade, pursue = among(evaders), among(pursuers)
    planner = only_planner(pursuers)
    plan_by: Any = no_plan_made if planner is None else planning_by(planner)
    team = tuple(range(1, count + 1))
    anyone = pursuers[0]  # a field has one for all; who is asked here is told by number

    def play(starts: Starts, conditions: Conditions, ends: Ends, meeting: Meeting) -> None:
        every = steps_between(conditions.control.dt)
        for number in range(starts.speeds.shape[0]):
            mine = pairs._aimed(conditions, starts.targets[number])
            start = pairs._begin(pairs._Table(starts, number), team)
            game = start
            plan = unplanned(game)
            steps = 0
            while game.score.verdict == GameResult.RUNNING:
                if meeting.planning and steps % every == 0:
                    plan = plan_by(game, mine, plan)
                view = still_view(game, mine)
                own = evader_keeps_out(view, evade(view, meeting.evader))
                turned = Vehicle(game.evader.position, scale(own.direction, own.speed), game.evader.speed)
                seen = sighted(turned, own.direction, mine.control.lookahead)
                field = Field(game, seen, mine, anyone, plan.assignments)
                views = each(view_of_one, game.pursuers, field)
                decided = Decisions(own, each(asked_of, views, Asked(pursue, meeting.pursuers)))
                now = moved_on(game, mine, decided)
                game = Game(
                    now.time, now.evader, now.pursuers, start.evader_limits, start.pursuer_limits, now.score
                )
                steps += 1
            pairs._close(ends, number, game, steps)

    if not compiled:
        return play
    pairs.register((*pairs.KERNELS, pairs.__name__, __name__))
    pairs.register_strategies((*evaders, *pursuers, evade, pursue, plan_by))
    return kernel(play)


def matrix(
    evaders: tuple[EvaderStrategy, ...], pursuers: tuple[PursuerStrategy, ...], count: int,
    compiled: bool = True,
) -> Callable[[Starts, Conditions, int, int], Ends]:
    """The play of many games of `count` pursuers under any two of the strategies.

    Returns `play(starts, conditions, evader, pursuer) -> Ends`, the strategies by their numbers. Compiles at
    the first call, once for all of them; `compiled=False` runs the same functions interpreted.
    """  # fmt: skip

    def play(starts: Starts, conditions: Conditions, evader: int, pursuer: int) -> Ends:
        ends = pairs._blank(starts, 0)
        both = (evaders, pursuers)
        if compiled:
            both = pairs.in_arrays(evaders), pairs.in_arrays(pursuers)
        run = _player(*both, count, compiled)
        run(starts, conditions, ends, Meeting(evader, pursuer, planner_for(pursuers[pursuer]) is not None))
        return ends

    return play
