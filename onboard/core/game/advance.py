"""A game as values, and the kernel `advance`: decide, move, judge.

The plane game, the compiled games and the bridge share it. The evader decides first; the
pursuers then see its new heading (2.2).
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import NamedTuple

from onboard.core.game.referee import Score, judge, opening
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import Vec, along, scale
from onboard.core.strategy.evasion import EvaderView
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.pursuit import PursuerView


class Params(NamedTuple):
    """The game's parameters, in the paper's symbols."""

    R: float  # capture radius (6) [m]
    rho: float  # safety distance ρ (4) [m]
    lambda_: float  # λ of (21)–(22)
    beta: float  # β of (22)
    epsilon: float  # ε_min of (5) [m]
    dt: float  # time step [s]
    horizon: float  # [s]
    separation: float  # between pursuers [m]; 0 = off
    planar: bool
    has_target: bool
    target: Vec  # g [m]
    lookahead: float = 1.0  # of rule 6's alternative, by constant velocity [s]


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


class Seat(NamedTuple):
    """One pursuer with what belongs to it."""

    own: Vehicle
    limits: VehicleLimits
    has_mate: bool
    mate: Vec  # place of the nearest team mate [m]


class Field(NamedTuple):
    """What all pursuers' decisions share."""

    evader: Vehicle  # with its new heading
    heading: Vec  # ê
    params: Params
    decide: Callable[[PursuerView], Decision]


EvaderStrategy = Callable[[EvaderView], Decision]
PursuerStrategy = Callable[[PursuerView], Decision]


def position_of(vehicle: Vehicle, _index: int, _shared: float) -> Vec:
    """Place of a vehicle (for `each`)."""
    return vehicle.position


def positions(vehicles: tuple[Vehicle, ...]) -> tuple[Vec, ...]:
    """Places of all vehicles [m]."""
    return each(position_of, vehicles, 0.0)


def begin(
    evader: Vehicle, pursuers: tuple[Vehicle, ...], evader_limits: VehicleLimits, pursuer_limits: tuple[VehicleLimits, ...]
) -> Game:
    """A game before its first step."""
    return Game(
        0.0, evader, pursuers, evader_limits, pursuer_limits, opening(evader.position, positions(pursuers))
    )


def evader_view(game: Game, params: Params) -> EvaderView:
    """The situation as the evader sees it."""
    return EvaderView(
        game.evader,
        game.evader_limits,
        game.pursuers,
        blocked_cones(game.evader, game.pursuers, params.rho),
        params.has_target,
        params.target,
        params.R,
        params.lambda_,
        params.beta,
        params.planar,
    )


def alone(own: Vehicle, limits: VehicleLimits, _shared: float) -> Seat:
    """A pursuer that need not look for team mates (for `each_pair`)."""
    return Seat(own, limits, False, own.position)


def beside_mates(seat: Seat, index: int, pursuers: tuple[Vehicle, ...]) -> Seat:
    """The pursuer with its nearest team mate (for `each`)."""
    has_mate = False
    mate = seat.mate
    nearest = 1e300
    for other in range(len(pursuers)):
        if other != index:
            place = pursuers[other].position
            x = place.x - seat.own.position.x
            y = place.y - seat.own.position.y
            z = place.z - seat.own.position.z
            square = x * x + y * y + z * z
            if square < nearest:
                nearest = square
                mate = place
                has_mate = True
    return Seat(seat.own, seat.limits, has_mate, mate)


def seats(game: Game, params: Params) -> tuple[Seat, ...]:
    """All pursuers; with their nearest team mates where a separation is kept."""
    plain = each_pair(alone, game.pursuers, game.pursuer_limits, 0.0)
    if params.separation > 0.0:
        return each(beside_mates, plain, game.pursuers)
    return plain


def pursuer_view(seat: Seat, evader: Vehicle, heading: Vec, params: Params) -> PursuerView:
    """The situation as a pursuer sees it; the evader already has its new heading."""
    return PursuerView(
        seat.own,
        seat.limits,
        evader,
        heading,
        seat.has_mate,
        seat.mate,
        params.separation,
        True,
        along(evader.position, heading, evader.speed * params.lookahead),
        params.lookahead,
        params.dt,
        params.planar,
    )


def decide_one(seat: Seat, _index: int, field: Field) -> Decision:
    """One pursuer's decision (for `each`)."""
    return field.decide(pursuer_view(seat, field.evader, field.heading, field.params))


def moved(vehicle: Vehicle, decision: Decision, dt: float) -> Vehicle:
    """Simple motion (7)–(8) along the decided direction for `dt` seconds."""
    velocity = scale(decision.direction, decision.speed)
    return Vehicle(along(vehicle.position, velocity, dt), velocity, vehicle.speed)


def move_one(vehicle: Vehicle, decision: Decision, dt: float) -> Vehicle:
    """A pursuer after the step (for `each_pair`)."""
    return moved(vehicle, decision, dt)


def decide(
    game: Game, params: Params, decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy
) -> Decisions:
    """Everybody's decision: the evader first."""
    own = decide_evader(evader_view(game, params))
    turned = Vehicle(game.evader.position, scale(own.direction, own.speed), game.evader.speed)
    field = Field(turned, own.direction, params, decide_pursuer)
    return Decisions(own, each(decide_one, seats(game, params), field))


def judged(before: Game, evader: Vehicle, pursuers: tuple[Vehicle, ...], params: Params) -> Game:
    """The game after a step in which everybody moved straight to their new places."""
    dt = params.dt
    score = judge(
        before.score,
        before.time,
        dt,
        before.evader.position,
        evader.position,
        positions(before.pursuers),
        positions(pursuers),
        params.R,
        params.rho,
        params.has_target,
        params.target,
        params.epsilon,
        params.horizon,
    )
    return Game(before.time + dt, evader, pursuers, before.evader_limits, before.pursuer_limits, score)


def advance(
    game: Game, params: Params, decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy
) -> Game:
    """One step of `params.dt` seconds: decide, move by (7)–(8), judge."""
    decisions = decide(game, params, decide_evader, decide_pursuer)
    evader = moved(game.evader, decisions.evader, params.dt)
    pursuers = each_pair(move_one, game.pursuers, decisions.pursuers, params.dt)
    return judged(game, evader, pursuers, params)


FREE = VehicleLimits(0.0, 1e9, -pi / 2, pi / 2, -pi, pi)
