"""A game as values, and the kernel `advance`: decide, move, judge.

The plane game, the compiled games and the bridge share it. The evader decides first; the
pursuers then see its new heading (2.2).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from onboard.core.game.referee import Score, Step, judge, opening
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.game.views import (
    EvaderView,
    Held,
    Nearest,
    PursuerView,
    Sighting,
    Team,
    evader_view,
    nearest_mate,
    pursuer_view,
    sighted,
    told,
    with_limits,
)
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, along, scale
from onboard.core.strategy.keep_out import evader_keeps_out, pursuer_keeps_out
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.team.plan_types import IDLE, Assignment


class Conditions(NamedTuple):
    """What a simulated game is played under."""

    rules: Rules
    target: Target
    control: Control  # its `dt` is the time step of the game


class Game(NamedTuple):
    """A game at one instant."""

    time: float  # since the start [s]
    evader: Vehicle
    pursuers: tuple[Vehicle, ...]
    evader_limits: VehicleLimits
    pursuer_limits: tuple[VehicleLimits, ...]
    score: Score


class Decisions(NamedTuple):
    """What everybody decided in a step."""

    evader: Decision
    pursuers: tuple[Decision, ...]


EvaderStrategy = Callable[[EvaderView], Decision]
PursuerStrategy = Callable[[PursuerView], Decision]


class Field(NamedTuple):
    """What all pursuers' decisions share."""

    game: Game
    sighting: Sighting  # of the evader, with its new heading
    conditions: Conditions
    decide: PursuerStrategy
    parts: tuple[Assignment, ...]  # of the team's plan, in the pursuers' order


def unassigned(_vehicle: Vehicle, _index: int, _shared: float) -> Assignment:
    """The part of a pursuer without a plan (for `each`)."""
    return IDLE


def position_of(vehicle: Vehicle, _index: int, _shared: float) -> Vec:
    """Place of a vehicle (for `each`)."""
    return vehicle.position


def positions(vehicles: tuple[Vehicle, ...]) -> tuple[Vec, ...]:
    """Places of all vehicles [m]."""
    return each(position_of, vehicles, 0.0)


def speed_of(vehicle: Vehicle, _index: int, _shared: float) -> float:
    """Speed that the game reckons with [m/s] (for `each`)."""
    return vehicle.speed


def begin(
    evader: Vehicle,
    pursuers: tuple[Vehicle, ...],
    evader_limits: VehicleLimits,
    pursuer_limits: tuple[VehicleLimits, ...],
) -> Game:
    """A game before its first step."""
    return Game(
        0.0, evader, pursuers, evader_limits, pursuer_limits, opening(evader.position, positions(pursuers))
    )


def team_of(
    own: Vehicle, index: int, pursuers: tuple[Vehicle, ...], conditions: Conditions, part: Assignment
) -> Team:
    """What pursuer `index` knows of its side; its nearest mate only where a separation is kept."""
    rules = conditions.rules
    mate = Nearest(False, own.position)
    if rules.separation > 0.0:
        mate = nearest_mate(own.position, positions(pursuers), index)
    held = Held(False, False, mate.position, 0.0)
    return Team(mate, pursuers, index, told(conditions.target, rules), held, part, ZERO, ZERO)


def view_of_one(own: Vehicle, index: int, field: Field) -> PursuerView:
    """The situation as pursuer `index` sees it (for `each`)."""
    game, conditions = field.game, field.conditions
    team = team_of(own, index, game.pursuers, conditions, field.parts[index])
    limits = game.pursuer_limits[index]
    return pursuer_view(own, limits, field.sighting, team, conditions.control, conditions.rules)


def decide_one(own: Vehicle, index: int, field: Field) -> Decision:
    """Pursuer `index`'s decision (for `each`)."""
    view = view_of_one(own, index, field)
    return pursuer_keeps_out(view, field.decide(view))


def decide_pursuers(
    game: Game, sighting: Sighting, conditions: Conditions, decide: PursuerStrategy
) -> tuple[Decision, ...]:
    """All pursuers' decisions against the evader as they see it, without a plan."""
    parts = each(unassigned, game.pursuers, 0.0)
    return each(decide_one, game.pursuers, Field(game, sighting, conditions, decide, parts))


def moved(vehicle: Vehicle, decision: Decision, dt: float) -> Vehicle:
    """Simple motion (7)–(8) along the decided direction for `dt` seconds."""
    velocity = scale(decision.direction, decision.speed)
    return Vehicle(along(vehicle.position, velocity, dt), velocity, vehicle.speed)


def move_one(vehicle: Vehicle, decision: Decision, dt: float) -> Vehicle:
    """A pursuer after the step (for `each_pair`)."""
    return moved(vehicle, decision, dt)


def still_view(game: Game, conditions: Conditions) -> EvaderView:
    """The situation as the evader sees it in still air."""
    view = evader_view(
        game.evader, game.evader_limits, game.pursuers, conditions.target, ZERO, conditions.rules
    )
    return with_limits(view, game.pursuer_limits)


def decide(
    game: Game, conditions: Conditions, decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy
) -> Decisions:
    """Everybody's decision in still air: the evader first. Pursuers without a plan."""
    return decide_by_plan(
        game, conditions, decide_evader, decide_pursuer, each(unassigned, game.pursuers, 0.0)
    )


def decide_by_plan(
    game: Game,
    conditions: Conditions,
    decide_evader: EvaderStrategy,
    decide_pursuer: PursuerStrategy,
    parts: tuple[Assignment, ...],
) -> Decisions:
    """Everybody's decision in still air, each pursuer's by its part of the team's plan."""
    view = still_view(game, conditions)
    own = evader_keeps_out(view, decide_evader(view))
    turned = Vehicle(game.evader.position, scale(own.direction, own.speed), game.evader.speed)
    seen = sighted(turned, own.direction, conditions.control.lookahead)
    field = Field(game, seen, conditions, decide_pursuer, parts)
    return Decisions(own, each(decide_one, game.pursuers, field))


def judged(before: Game, evader: Vehicle, pursuers: tuple[Vehicle, ...], conditions: Conditions) -> Game:
    """The game after a step in which everybody moved straight to their new places."""
    dt = conditions.control.dt
    step = Step(
        before.time,
        dt,
        before.evader.position,
        evader.position,
        positions(before.pursuers),
        positions(pursuers),
        before.evader.speed,
        each(speed_of, before.pursuers, 0.0),
    )
    score = judge(before.score, step, conditions.rules, conditions.target)
    return Game(before.time + dt, evader, pursuers, before.evader_limits, before.pursuer_limits, score)


def moved_on(game: Game, conditions: Conditions, decisions: Decisions) -> Game:
    """The game after one step of the control's `dt` [s] as decided: move by (7)–(8), judge."""
    evader = moved(game.evader, decisions.evader, conditions.control.dt)
    pursuers = each_pair(move_one, game.pursuers, decisions.pursuers, conditions.control.dt)
    return judged(game, evader, pursuers, conditions)


def advance(
    game: Game, conditions: Conditions, decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy
) -> Game:
    """One step of the control's `dt` [s]: decide, move by (7)–(8), judge."""
    return moved_on(game, conditions, decide(game, conditions, decide_evader, decide_pursuer))
