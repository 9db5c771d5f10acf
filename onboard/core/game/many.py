"""A game of several evaders as values, and its step: everybody decides, moves, and each evader is judged.

At each moment every pursuer has one quarry (`core/strategy/team/quarry`), and what it sees, decides and
plans is a game against that one: `advance`'s own. Every evader sees all pursuers. Who is captured or has
arrived leaves the game, and the game is over when nobody is left or at the horizon. Of one evader with one
target it is, bit for bit, the game of `advance`. Kernel style.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from onboard.core.game.advance import (
    Conditions,
    Game,
    PursuerStrategy,
    move_one,
    moved,
    positions,
    speed_of,
    still_view,
    team_of,
)
from onboard.core.game.planning import seat, situation_of, unplanned, with_targets
from onboard.core.game.referee import GameResult, Score, Step, judge_any, opening
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.game.targets import NONE, at, chosen
from onboard.core.game.views import NO_MEMBER, EvaderView, Sighting, Team, pursuer_view, sighted, told
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import Vec, scale
from onboard.core.strategy.keep_out import evader_keeps_out, pursuer_keeps_out
from onboard.core.strategy.knowledge import Decision, silent
from onboard.core.strategy.team.plan_types import NOBODY, Assignment, Member, Plan
from onboard.core.strategy.team.planner import Planner
from onboard.core.strategy.team.quarry import Assign, Quarry


class ManyConditions(NamedTuple):
    """What a game of several evaders is played under."""

    rules: Rules
    targets: tuple[tuple[Target, ...], ...]  # each evader's; as many for all, some may not exist
    control: Control  # its `dt` is the time step of the game


class ManyGame(NamedTuple):
    """A game of several evaders at one instant."""

    time: float  # since the start [s]
    evaders: tuple[Vehicle, ...]
    pursuers: tuple[Vehicle, ...]
    evader_limits: tuple[VehicleLimits, ...]
    pursuer_limits: tuple[VehicleLimits, ...]
    scores: tuple[Score, ...]  # of each evader
    aims: tuple[int, ...]  # number of the target that each evader goes for, NONE = none
    quarries: tuple[int, ...]  # number of each pursuer's evader, NOBODY = none yet


class ManyDecisions(NamedTuple):
    """What everybody decided in a step."""

    evaders: tuple[Decision, ...]
    pursuers: tuple[Decision, ...]


EvaderStrategies = Callable[[EvaderView, int], Decision]
"""All evaders' strategies: a view and the evader's number."""


def opened(evader: Vehicle, _index: int, places: tuple[Vec, ...]) -> Score:
    """An evader's score before the first step (for `each`)."""
    return opening(evader.position, places)


def no_number(_vehicle: Vehicle, _index: int, number: int) -> int:
    """No target or no quarry yet (for `each`)."""
    return number


def begin_many(
    evaders: tuple[Vehicle, ...],
    pursuers: tuple[Vehicle, ...],
    evader_limits: tuple[VehicleLimits, ...],
    pursuer_limits: tuple[VehicleLimits, ...],
) -> ManyGame:
    """A game before its first step."""
    return ManyGame(
        0.0,
        evaders,
        pursuers,
        evader_limits,
        pursuer_limits,
        each(opened, evaders, positions(pursuers)),
        each(no_number, evaders, NONE),
        each(no_number, pursuers, NOBODY),
    )


def live(score: Score) -> bool:
    """Whether an evader of that score is still in the game."""
    return score.verdict == GameResult.RUNNING


def over(game: ManyGame) -> bool:
    """Whether no evader is left in the game."""
    for k in range(len(game.scores)):  # noqa: SIM110 (a loop compiles)
        if live(game.scores[k]):
            return False
    return True


def alone(game: ManyGame, number: int) -> Game:
    """The game of one of the evaders, with all pursuers."""
    return Game(
        game.time,
        game.evaders[number],
        game.pursuers,
        game.evader_limits[number],
        game.pursuer_limits,
        game.scores[number],
    )


def conditions_alone(game: ManyGame, number: int, conditions: ManyConditions) -> Conditions:
    """What the game of one of the evaders is played under: its target is the one that it goes for."""
    target = at(conditions.targets[number], game.aims[number])
    return Conditions(conditions.rules, target, conditions.control)


class Whole(NamedTuple):
    """A game with its conditions (for `each`)."""

    game: ManyGame
    conditions: ManyConditions


def aim_of(_evader: Vehicle, number: int, shared: Whole) -> int:
    """The number of the target that an evader goes for from now on (for `each`)."""
    game, conditions = shared
    before = game.aims[number]
    if not live(game.scores[number]):
        return before
    targets = conditions.targets[number]
    if len(targets) == 1:
        return 0 if targets[0].exists else NONE
    view = still_view(alone(game, number), conditions_alone(game, number, conditions))
    return chosen(view.own, view.limits, view.cones, targets, conditions.rules.planar, before)


def quarry_seen(_evader: Vehicle, number: int, shared: Whole) -> Quarry:
    """An evader as the pursuers know it (for `each`)."""
    game, conditions = shared
    target = told(at(conditions.targets[number], game.aims[number]), conditions.rules)
    return Quarry(game.evaders[number], game.evader_limits[number], live(game.scores[number]), target)


def aimed(game: ManyGame, conditions: ManyConditions) -> ManyGame:
    """The game in which every evader has chosen where it goes."""
    return ManyGame(
        game.time, game.evaders, game.pursuers, game.evader_limits, game.pursuer_limits, game.scores,
        each(aim_of, game.evaders, Whole(game, conditions)), game.quarries,
    )  # fmt: skip


def regrouped(game: ManyGame, conditions: ManyConditions, assign: Assign) -> ManyGame:
    """The game in which every pursuer has its quarry anew; of an `aimed` game."""
    seats: tuple[Member, ...] = each_pair(seat, game.pursuers, game.pursuer_limits, 0.0)
    seen = each(quarry_seen, game.evaders, Whole(game, conditions))
    left = conditions.rules.horizon - game.time
    return ManyGame(
        game.time, game.evaders, game.pursuers, game.evader_limits, game.pursuer_limits, game.scores,
        game.aims, assign(seats, seen, game.quarries, conditions.rules, left),
    )  # fmt: skip


def prepared(game: ManyGame, conditions: ManyConditions, due: bool, assign: Assign) -> ManyGame:
    """The game before everybody decides: aims chosen, and where that is due quarries, by `quarries_of` or
    another such function."""
    now = aimed(game, conditions)
    return regrouped(now, conditions, assign) if due else now


def deserted(game: ManyGame) -> bool:
    """Whether a pursuer has no quarry that is still in the game."""
    for k in range(len(game.quarries)):
        if game.quarries[k] == NOBODY or not live(game.scores[game.quarries[k]]):
            return True
    return False


class Group(NamedTuple):
    """Who has a quarry (for `each`)."""

    game: ManyGame
    number: int


def of_group(vehicle: Vehicle, index: int, group: Group) -> Vehicle:
    """A pursuer of that quarry, or what counts for nothing (for `each`)."""
    if group.game.quarries[index] == group.number:
        return vehicle
    return NO_MEMBER


def no_plan_for(_evader: Vehicle, number: int, game: ManyGame) -> Plan:
    """An evader's plan before the first (for `each`)."""
    return unplanned(alone(game, number))


def unplanned_many(game: ManyGame) -> tuple[Plan, ...]:
    """The plans before the first, one an evader."""
    return each(no_plan_for, game.evaders, game)


class Planning(NamedTuple):
    """What plans follow from (for `each`)."""

    game: ManyGame
    conditions: ManyConditions
    planner: Planner


def planned_for(previous: Plan, number: int, shared: Planning) -> Plan:
    """The next plan of those who have an evader as their quarry (for `each`)."""
    game, conditions, planner = shared
    if not live(game.scores[number]):
        return previous
    team = each(seat_in, game.pursuers, Group(game, number))
    mine = conditions_alone(game, number, conditions)
    known = each(target_told, conditions.targets[number], conditions.rules)
    return planner(with_targets(situation_of(alone(game, number), mine, team), known), previous)


def target_told(target: Target, _number: int, rules: Rules) -> Target:
    """One of several targets as the pursuers know it (for `each`)."""
    return told(target, rules)


def seat_in(vehicle: Vehicle, index: int, group: Group) -> Member:
    """A pursuer as a member of a quarry's team, for which others count for nothing (for `each`)."""
    game, number = group
    return Member(vehicle, game.pursuer_limits[index], game.quarries[index] == number)


def planned_many(
    game: ManyGame, conditions: ManyConditions, previous: tuple[Plan, ...], planner: Planner
) -> tuple[Plan, ...]:
    """The next plans, one an evader: each for the pursuers whose quarry it is."""
    return each(planned_for, previous, Planning(game, conditions, planner))


class Parts(NamedTuple):
    """Everybody's plan (for `each`)."""

    quarries: tuple[int, ...]
    plans: tuple[Plan, ...]


def part_of(_pursuer: Vehicle, index: int, parts: Parts) -> Assignment:
    """A pursuer's part in the plan of its quarry (for `each`)."""
    return parts.plans[parts.quarries[index]].assignments[index]


class EvadersSide(NamedTuple):
    """What all evaders' decisions share."""

    game: ManyGame
    conditions: ManyConditions
    decide: EvaderStrategies


def flee(evader: Vehicle, number: int, side: EvadersSide) -> Decision:
    """An evader's decision; who has left the game stays where it is (for `each`)."""
    if not live(side.game.scores[number]):
        return silent(evader.velocity, evader.position)
    view = still_view(alone(side.game, number), conditions_alone(side.game, number, side.conditions))
    return evader_keeps_out(view, side.decide(view, number))


class Seen(NamedTuple):
    """What the evaders decided, and how far ahead that is looked (for `each_pair`)."""

    lookahead: float


def sighted_one(evader: Vehicle, decision: Decision, seen: Seen) -> Sighting:
    """An evader with its new heading (for `each_pair`)."""
    turned = Vehicle(evader.position, scale(decision.direction, decision.speed), evader.speed)
    return sighted(turned, decision.direction, seen.lookahead)


class PursuersSide(NamedTuple):
    """What all pursuers' decisions share."""

    game: ManyGame
    sightings: tuple[Sighting, ...]  # of the evaders, with their new headings
    conditions: ManyConditions
    decide: PursuerStrategy
    parts: tuple[Assignment, ...]  # of their plans, in the pursuers' order


def chase_one(own: Vehicle, index: int, side: PursuersSide) -> Decision:
    """Pursuer `index`'s decision against its quarry (for `each`)."""
    game = side.game
    number = game.quarries[index]
    conditions = conditions_alone(game, number, side.conditions)
    all_of_us = team_of(own, index, game.pursuers, conditions, side.parts[index])
    members = each(of_group, game.pursuers, Group(game, number))
    team = Team(
        all_of_us.mate,
        members,
        index,
        all_of_us.target,
        all_of_us.held,
        all_of_us.part,
        all_of_us.nose,
        all_of_us.wind,
    )
    limits = game.pursuer_limits[index]
    view = pursuer_view(own, limits, side.sightings[number], team, conditions.control, conditions.rules)
    return pursuer_keeps_out(view, side.decide(view))


def decide_many(
    game: ManyGame,
    conditions: ManyConditions,
    decide_evader: EvaderStrategies,
    decide_pursuer: PursuerStrategy,
    plans: tuple[Plan, ...],
) -> ManyDecisions:
    """Everybody's decision in still air, the evaders first; of an `aimed` game with quarries."""
    own = each(flee, game.evaders, EvadersSide(game, conditions, decide_evader))
    seen = each_pair(sighted_one, game.evaders, own, Seen(conditions.control.lookahead))
    parts = each(part_of, game.pursuers, Parts(game.quarries, plans))
    side = PursuersSide(game, seen, conditions, decide_pursuer, parts)
    return ManyDecisions(own, each(chase_one, game.pursuers, side))


class Flown(NamedTuple):
    """What evaders decided (for `each`)."""

    scores: tuple[Score, ...]
    decisions: tuple[Decision, ...]
    dt: float


def flown_on(evader: Vehicle, number: int, flown: Flown) -> Vehicle:
    """An evader after the step; who has left the game stays where it is (for `each`)."""
    if not live(flown.scores[number]):
        return evader
    return moved(evader, flown.decisions[number], flown.dt)


class Stepped(NamedTuple):
    """A game before and after a step (for `each`)."""

    before: ManyGame
    evaders: tuple[Vehicle, ...]
    pursuers: tuple[Vehicle, ...]
    conditions: ManyConditions


def scored(score: Score, number: int, step: Stepped) -> Score:
    """An evader's score after the step, judged against all pursuers (for `each`)."""
    before = step.before
    flown = Step(
        before.time,
        step.conditions.control.dt,
        before.evaders[number].position,
        step.evaders[number].position,
        positions(before.pursuers),
        positions(step.pursuers),
        before.evaders[number].speed,
        each(speed_of, before.pursuers, 0.0),
    )
    return judge_any(score, flown, step.conditions.rules, step.conditions.targets[number])


def moved_many(game: ManyGame, conditions: ManyConditions, decisions: ManyDecisions) -> ManyGame:
    """The game after one step of the control's `dt` [s] as decided: move by (7)–(8), judge each evader."""
    dt = conditions.control.dt
    evaders = each(flown_on, game.evaders, Flown(game.scores, decisions.evaders, dt))
    pursuers = each_pair(move_one, game.pursuers, decisions.pursuers, dt)
    scores = each(scored, game.scores, Stepped(game, evaders, pursuers, conditions))
    return ManyGame(
        game.time + dt, evaders, pursuers, game.evader_limits, game.pursuer_limits, scores, game.aims,
        game.quarries,
    )  # fmt: skip
