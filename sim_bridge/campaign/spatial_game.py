"""The spatial game of 4.4 with the aircraft as flown, in its wind: one kernel, interpreted or compiled.

It is the game that `fly --fast` plays, without its messages: the aircraft, gusts and sensor by the same
functions and the same random numbers, the tracks filtered as onboard, everybody's decision through the
supervisor and the autopilot, all of it at the instants of a flight (`Pace`). Capture, arrival and the
safety distance are judged on ground positions.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import Conditions, Game, positions
from onboard.core.game.rules import NO_TARGET
from onboard.core.game.views import (
    EvaderView,
    Nearest,
    PursuerView,
    Team,
    evader_view,
    heading_at,
    nearest_mate,
    pursuer_view,
    sighted,
    told,
    with_limits,
)
from onboard.core.math.each import each
from onboard.core.math.states import Mate, Vehicle
from onboard.core.math.vectors import Vec, scale
from onboard.core.safety.policy import Policy
from onboard.core.strategy.keep_out import evader_keeps_out, pursuer_keeps_out
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.team.plan_types import Assignment, Plan, Situation
from onboard.core.strategy.team.planner import no_plan
from sim_bridge.campaign.aboard import NOBODY, Aboard, Autopilot, Instant, aware, commanded, ordered
from sim_bridge.campaign.envelope import Envelope
from sim_bridge.campaign.lanes import packing
from sim_bridge.campaign.ledger import held_by, known, known_nose, known_wind, write_down
from sim_bridge.campaign.plane_in_wind import Climate, Flown, blown, fly, gust_at, gust_tick, wind_at
from sim_bridge.campaign.team_play import SILENT, Messages, Planning, Talk, arrived, opened, posted, seat
from sim_bridge.campaign.tracks import Eye, Tracks, track_of
from sim_bridge.draws import Key
from sim_bridge.vehicle.flight.plane import Command, PlaneModel, nose_yaw, true_airspeed
from sim_bridge.vehicle.wind.dryden import gust_noise
from sim_bridge.vehicle.wind.estimate import ARDUPILOT, Errors, Sensed, estimated

Array = NDArray[np.float64]
ABOARD = packing(Aboard, 1)
load_aboard, store_aboard = ABOARD.load, ABOARD.store
ABOARD_ROW = ABOARD.width  # numbers of a row of the crew
WIND_EVERY = 10  # samples between two updates of an estimate of the wind: `EVERY` of it


class Evasion(IntEnum):
    """How the evader flies."""

    STRATEGY = 0  # by the scenario's strategy
    STRAIGHT = 1  # straight at its target, whoever is in the way


class Chosen(NamedTuple):
    """Who flies by which strategy: numbers into the tuples that a kernel was made of (`machine`)."""

    evader: int
    pursuers: tuple[int, ...]


class Ways(NamedTuple):
    """The strategies of a kernel, each side's as one function of a view and a number; who flies by which."""

    evader: Callable[[EvaderView, int], Decision]
    pursuer: Callable[[PursuerView, int], Decision]
    chosen: Chosen
    messages: Messages = SILENT  # of the pursuers' team


class Fleet(NamedTuple):
    """The aircraft models: one for the evader, one for all pursuers."""

    evader: PlaneModel
    pursuer: PlaneModel


class Pace(NamedTuple):
    """When what happens, in samples of the aircraft, as measured in flight.

    Samples are counted from the beginning of the world. A position is told with the sample after its own,
    and what is decided on it flies from there on.
    """

    t0: int  # the game begins
    control: int  # between two decisions
    decides: int  # remainder at which everybody decides


class SpatialPlay(NamedTuple):
    """How a game ended."""

    game: Game
    steps: int  # control steps
    samples: int  # of each aircraft
    envelope: Envelope


class Start(NamedTuple):
    """A game before its first step, and what it is played under."""

    game: Game
    conditions: Conditions
    fleet: Fleet
    climate: Climate
    eye: Eye
    pace: Pace
    policies: tuple[Policy, ...]  # of the supervisors, evader first
    autopilots: tuple[Autopilot, ...]
    gusts: tuple[Key, ...]  # of everybody's random numbers
    errors: tuple[Errors, ...]  # of everybody's estimate of the wind
    planning: Planning


class Deciding(NamedTuple):
    """The pursuers when they decide (for `each`)."""

    start: Start
    states: Array  # (players, 9), as their agents know it: see `ledger`
    seen: Tracks
    now: int  # sample
    ways: Ways
    decided: Array  # as `decide_all` has it
    talk: Any  # what `Messages.begin` gave


def in_air(vehicle: Vehicle, wind: Vec, speed: float) -> Vehicle:
    """A vehicle over ground as one in moving air."""
    v = vehicle.velocity
    return Vehicle(vehicle.position, Vec(v.x - wind.x, v.y - wind.y, v.z - wind.z), speed)


class Watch(NamedTuple):
    """What the evader sees the pursuers by (for `each`)."""

    seen: Tracks
    now: int
    wind: Vec  # at the evader [m/s]
    dt: float  # [s] of a sample


def opponent(vehicle: Vehicle, index: int, watch: Watch) -> Vehicle:
    """Pursuer `index` as the evader sees it (for `each`)."""
    return in_air(track_of(watch.seen, index + 1, watch.now, watch.dt), watch.wind, vehicle.speed)


def mate_of(_vehicle: Vehicle, index: int, states: Array) -> Mate:
    """Pursuer `index` as its team mates know it (for `each`)."""
    here = known(states, index + 1)
    return Mate(index + 2, here.position, here.velocity, 0.0)


def member_of(vehicle: Vehicle, index: int, deciding: Deciding) -> Vehicle:
    """Pursuer `index` in the air as its team mates know it (for `each`)."""
    here = known(deciding.states, index + 1)
    return in_air(here, wind_at(deciding.start.climate, here.position), vehicle.speed)


class Side(NamedTuple):
    """The pursuers when they decide, and where their mates know them (for `each`)."""

    team: Deciding
    members: tuple[Vehicle, ...]  # in the air
    spotted: Vehicle  # the evader's track, over ground


def decide_pursuers(team: Deciding) -> tuple[Decision, ...]:
    """All pursuers' decisions."""
    start = team.start
    pursuers = start.game.pursuers
    spotted = track_of(team.seen, 0, team.now, start.fleet.evader.dt)
    return each(decide_pursuer, pursuers, Side(team, each(member_of, pursuers, team), spotted))


def decide_pursuer(vehicle: Vehicle, index: int, side: Side) -> Decision:
    """Pursuer `index`'s decision (for `each`)."""
    team, members = side.team, side.members
    start = team.start
    game = start.game
    rules, control = start.conditions.rules, start.conditions.control
    own = known(team.states, index + 1)
    wind = known_wind(team.states, index + 1)
    spotted = in_air(side.spotted, wind, game.evader.speed)
    sighting = sighted(spotted, heading_at(spotted), control.lookahead)
    mate = Nearest(False, own.position)
    if rules.separation > 0.0:
        mate = nearest_mate(own.position, positions(members), index)
    me = in_air(own, wind, vehicle.speed)
    held = held_by(team.decided, index + 1, control.dt, wind)
    part = team.ways.messages.part(team.talk, index)
    nose = known_nose(team.states, index + 1, vehicle.speed)
    mine = Team(mate, members, index, told(start.conditions.target, rules), held, part, nose, wind)
    view = pursuer_view(me, game.pursuer_limits[index], sighting, mine, control, rules)
    decision: Decision = team.ways.pursuer(view, team.ways.chosen.pursuers[index])
    return pursuer_keeps_out(view, decision)


def order(
    start: Start, mates: tuple[Mate, ...], decision: Decision, states: Array, place: tuple[int, int],
    aboard: Aboard,
) -> Aboard:  # fmt: skip
    """What becomes of the decision of a player; `place` is its number and the sample."""
    index, now = place
    own = known(states, index)
    at = Instant(
        now * start.fleet.evader.dt,
        own.position,
        own.velocity,
        known_wind(states, index),
        index + 1,
    )
    return ordered(aboard, scale(decision.direction, decision.speed), at, start.policies[index], mates)


def nobody(_vehicle: Vehicle, _index: int, _shared: float) -> Mate:
    """A mate that does not count (for `each`)."""
    return NOBODY


def situation(team: Deciding) -> Situation:
    """What the planner knows, by the wind of the first pursuer. The game has begun: t₀ is past."""
    start = team.start
    game, conditions, planning = start.game, start.conditions, start.planning
    dt = start.fleet.evader.dt
    wind = known_wind(team.states, 1)
    evader = in_air(track_of(team.seen, 0, team.now, dt), wind, game.evader.speed)
    members = each(seat, each(member_of, game.pursuers, team), planning)
    target = told(conditions.target, conditions.rules)
    return Situation(
        (team.now - start.pace.t0) * dt, 0.0, evader, planning.limits[0], members, target, wind,
        conditions.rules, planning.heights, planning.margin, evader.position, planning.nearest,
        (NO_TARGET,),
    )  # fmt: skip


def part_heard(talk: Talk, index: int) -> Assignment:
    """`Messages.part` of a team that plans."""
    return talk.parts[index]


def planned_by(planner: Callable[[Situation, Plan], Plan]) -> Messages:
    """The messages of a team that plans."""

    def talk_of(pursuers: tuple[Vehicle, ...], planning: Planning) -> Talk:
        return opened(no_plan(each(seat, pursuers, planning), 0.0))

    def exchanged(team: Deciding, step: int) -> None:
        planning = team.start.planning
        if step % planning.every == 0:
            posted(team.talk, planning, planner(situation(team), team.talk.made[0]), step)
        arrived(team.talk, planning, step)

    return Messages(talk_of, exchanged, part_heard)


def evader_sees(team: Deciding) -> EvaderView:
    """The situation as the evader sees it."""
    start, states = team.start, team.states
    game, conditions = start.game, start.conditions
    wind = known_wind(states, 0)
    others = each(opponent, game.pursuers, Watch(team.seen, team.now, wind, start.fleet.evader.dt))
    me = in_air(known(states, 0), wind, game.evader.speed)
    view = evader_view(me, game.evader_limits, others, conditions.target, wind, conditions.rules)
    return with_limits(view, game.pursuer_limits)


def decide_all(team: Deciding, crew: Array, step: int) -> None:
    """Everybody's decision into `crew`, evader first, and into the team's `decided`: see `ledger`."""
    start, ways, states, now = team.start, team.ways, team.states, team.now
    game, decided = start.game, team.decided
    ways.messages.exchange(team, step)
    view = evader_sees(team)
    decision = evader_keeps_out(view, ways.evader(view, ways.chosen.evader))
    alone = each(nobody, game.pursuers, 0.0)  # nobody is the evader's mate
    store_aboard(crew, 0, 0, order(start, alone, decision, states, (0, now), load_aboard(crew, 0, 0)))
    write_down(decided, 0, decision)
    decisions = decide_pursuers(team)
    mates = each(mate_of, game.pursuers, states)
    for i in range(len(decisions)):
        aboard = order(start, mates, decisions[i], states, (i + 1, now), load_aboard(crew, i + 1, 0))
        store_aboard(crew, i + 1, 0, aboard)
        write_down(decided, i + 1, decisions[i])


def weathered(start: Start, index: int, aboard: Aboard, flown: Flown) -> Aboard:
    """The autopilot of aircraft `index` with one more update of its estimate of the wind."""
    model = start.fleet.pursuer if index else start.fleet.evader
    plane, climate = flown.plane, start.climate
    speed = true_airspeed(plane, wind_at(climate, plane.position), gust_at(climate, flown, model))
    sensed = Sensed(plane.velocity, speed, nose_yaw(plane, model))
    return aware(aboard, estimated(aboard.wind, ARDUPILOT, start.errors[index], sensed))


def moved_on(start: Start, index: int, flown: Flown, command: Command, sample: int) -> Flown:
    """One sample of aircraft `index`, with the gusts' grid."""
    model = start.fleet.pursuer if index else start.fleet.evader
    tick = gust_tick(sample)
    if tick >= 0:
        flown = blown(flown, model, start.climate, gust_noise(start.gusts[index], tick))
    return fly(flown, model, command, start.climate)


def commanded_on(start: Start, index: int, aboard: Aboard, flown: Flown, sample: int) -> Flown:
    """One sample of aircraft `index` as its autopilot flies it."""
    model = start.fleet.pursuer if index else start.fleet.evader
    down = wind_at(start.climate, flown.plane.position).z
    told = commanded(aboard, flown.plane, model, start.autopilots[index], down)
    return moved_on(start, index, flown, told, sample)


def standing(vehicle: Vehicle, index: int, states: Array) -> Vehicle:
    """Pursuer `index` where it is (for `each`)."""
    here = known(states, index + 1)
    return Vehicle(here.position, here.velocity, vehicle.speed)
