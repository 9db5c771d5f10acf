"""Many games of simple motion at once, one control step a call: actions in, observations and rewards out.

The game is that of `onboard.core.game.advance`: the same views, strategies, motion and referee, called here
one after another because some decisions come from outside. A mean wind carries everybody, and where the
scenario has a noisy sensor everybody is known by tracks, as in `sim_bridge.campaign.spatial_game`. Kernel
style, but for the arrays, which are changed in place.

The evader decides first and the pursuers see its new heading (2.2). An evader that does not learn has
therefore decided when the pursuers' observations are made; one that learns is seen with the velocity that it
has.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import (
    EvaderStrategy,
    Game,
    PursuerStrategy,
    decide_pursuers,
    judged,
    move_one,
    moved,
    team_of,
)
from onboard.core.game.referee import GameResult
from onboard.core.game.views import (
    EvaderView,
    PursuerView,
    Sighting,
    evader_view,
    heading_at,
    pursuer_view,
    sighted,
    with_limits,
)
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import NORTH, Vec, along, distance, norm, scale
from onboard.core.strategy.features import Turn, answer, evader_features, pursuer_features
from onboard.core.strategy.knowledge import Decision, RuleId
from onboard.core.strategy.team.plan_types import IDLE
from sim_bridge.campaign.flight_lanes import AT_WORDS, draw_seven
from sim_bridge.campaign.lanes import LANES, lane_normal
from sim_bridge.campaign.spatial_game import in_air
from sim_bridge.campaign.tracks import Tracks, hear, track_of
from sim_bridge.draws import uniform
from sim_bridge.gym.exchange import Exchange
from sim_bridge.gym.starts import Here, Table, World, loaded, restart, store, vec_of, wind_of, write

Array = NDArray[np.float64]


class Heard(NamedTuple):
    """What the tracks of a game say (for `each`)."""

    tracks: Tracks
    now: int
    world: World
    wind: Vec


def tracks_at(here: Here) -> Tracks:
    """The tracks of the game."""
    t, g = here.table, here.game
    return Tracks(t.waiting[g], t.filters[g], t.stamps[g])


def sense(here: Here, number: int) -> None:
    """Measurement `number` of everybody in the game: `tracks.measure`, the noise drawn eight at a time."""
    t, g, eye = here.table, here.game, here.world.eye
    words, noise, states = t.words, t.noise, t.states
    for i in range(states.shape[0]):
        words[i // LANES, i % LANES] = t.keys[g, i, 0]
        words[i // LANES, i % LANES + LANES] = t.keys[g, i, 1]
    for b in range(words.shape[0]):
        draw_seven(words, b, number)
        for i in range(6 * LANES):
            noise[b, i] = lane_normal(words[b, i + AT_WORDS + LANES])
    for i in range(states.shape[0]):
        b = i // LANES
        lane = i % LANES
        row = t.waiting[g, number % t.waiting.shape[1], i]
        for k in range(3):
            row[k] = states[i, k] + eye.sigma * noise[b, lane + k * LANES]
            row[k + 3] = states[i, k + 3] + eye.sigma_velocity * noise[b, lane + (k + 3) * LANES]
        row[6] = 0.0 if uniform(words[b, lane + AT_WORDS]) < eye.dropout else 1.0


def listen(here: Here) -> None:
    """What sensor and filters do before everybody decides. The first measurement is heard at once."""
    t, g, wind = here.table, here.game, wind_of(here)
    states = t.states
    sample = t.steps[g]
    for i in range(states.shape[0]):
        for axis in range(3):
            states[i, axis] = t.places[g, i, axis]
        states[i, 3] = t.velocities[g, i, 0] + wind.x
        states[i, 4] = t.velocities[g, i, 1] + wind.y
        states[i, 5] = t.velocities[g, i, 2] + wind.z
    eye, tracks, dt = here.world.eye, tracks_at(here), here.world.conditions.control.dt
    if sample % eye.period == 0:
        sense(here, sample // eye.period)
    if sample == 0:
        hear(tracks, eye, 0, dt)
    heard = sample - eye.delay
    if heard > 0 and heard % eye.period == 0:
        hear(tracks, eye, heard // eye.period, dt)


def spotted(vehicle: Vehicle, index: int, heard: Heard) -> Vehicle:
    """Pursuer `index` as its track has it (for `each`)."""
    world = heard.world
    track = track_of(heard.tracks, index + 1, heard.now, world.conditions.control.dt)
    return in_air(track, heard.wind, vehicle.speed)


def heard_at(here: Here) -> Heard:
    """What the tracks say now."""
    return Heard(tracks_at(here), here.table.steps[here.game], here.world, wind_of(here))


def others_by_tracks(game: Game, here: Here) -> tuple[Vehicle, ...]:
    """The pursuers as the evader sees them, by tracks."""
    return each(spotted, game.pursuers, heard_at(here))


def sighting_by_track(game: Game, here: Here, _ahead: Vec, _speed: float) -> Sighting:
    """The evader as the pursuers see it, by its track."""
    world = here.world
    track = track_of(tracks_at(here), 0, here.table.steps[here.game], world.conditions.control.dt)
    evader = in_air(track, wind_of(here), game.evader.speed)
    return sighted(evader, heading_at(evader), world.conditions.control.lookahead)


def deaf(_here: Here) -> None:
    """No sensor: everybody is seen where it is."""


def others_there(game: Game, _here: Here) -> tuple[Vehicle, ...]:
    """The pursuers where they are."""
    return game.pursuers


def sighting_there(game: Game, here: Here, ahead: Vec, speed: float) -> Sighting:
    """The evader where it is, about to fly `ahead` at `speed` [m/s]."""
    turned = Vehicle(game.evader.position, scale(ahead, speed), game.evader.speed)
    return sighted(turned, ahead, here.world.conditions.control.lookahead)


class Desk(NamedTuple):
    """Where observations are written, and who sees what (for `each`)."""

    here: Here
    exchange: Exchange
    sighting: Sighting
    pursuers: tuple[Vehicle, ...]


def look(vehicle: Vehicle, index: int, desk: Desk) -> float:
    """Write what pursuer `index` sees (for `each`)."""
    here = desk.here
    world, t, g = here.world, here.table, here.game
    if world.learns[index + 1]:
        conditions = world.conditions
        team = team_of(vehicle, index, desk.pursuers, conditions, IDLE)
        limits = world.template.pursuer_limits[index]
        view = pursuer_view(vehicle, limits, desk.sighting, team, conditions.control, conditions.rules)
        turn = pursuer_features(view, world.form, desk.exchange.pursuers_see[g, index])
        t.turns[g, index + 1, 0] = turn.x
        t.turns[g, index + 1, 1] = turn.y
    return 0.0


def look_all(game: Game, here: Here, exchange: Exchange, parts: Parts) -> None:
    """Let an evader that does not learn decide, and write what those who learn see."""
    t, g, world = here.table, here.game, here.world
    ahead = heading_at(game.evader)
    speed = game.evader.speed
    rules, target = world.conditions.rules, world.conditions.target
    others = parts.others(game, here)
    view = evader_view(game.evader, game.evader_limits, others, target, wind_of(here), rules)
    view = with_limits(view, game.pursuer_limits)
    if world.learns[0]:
        turn = evader_features(view, world.form, exchange.evader_sees[g])
        t.turns[g, 0, 0] = turn.x
        t.turns[g, 0, 1] = turn.y
        speed = norm(game.evader.velocity)
    else:
        decision = parts.decide_evader(view)
        ahead, speed = decision.direction, decision.speed
        write(t.decided[g], ahead)
        t.decided[g, 3] = speed
    if world.team_learns:
        seen = parts.sighting(game, here, ahead, speed)
        each(look, game.pursuers, Desk(here, exchange, seen, game.pursuers))


class Acting(NamedTuple):
    """Who acts, and what the others decided (for `each`)."""

    here: Here
    exchange: Exchange
    game: Game
    others: tuple[Decision, ...]


def turn_at(here: Here, index: int) -> Turn:
    """The axes of a player's observation."""
    row = here.table.turns[here.game, index]
    return Turn(row[0], row[1])


def act(vehicle: Vehicle, index: int, acting: Acting) -> Decision:
    """Pursuer `index`'s decision: its action, or what its strategy decided (for `each`)."""
    here = acting.here
    world = here.world
    if not world.learns[index + 1]:
        return acting.others[index]
    action = acting.exchange.pursuers_act[here.game, index]
    return answer(vehicle, world.template.pursuer_limits[index], action, turn_at(here, index + 1), world.form)


def idle(_vehicle: Vehicle, _index: int, _shared: float) -> Decision:
    """No decision (for `each`)."""
    return Decision(False, NORTH, 0.0, RuleId.NONE, NORTH, 0.0, 0.0)


def drifted(vehicle: Vehicle, _index: int, drift: Vec) -> Vehicle:
    """A vehicle that the wind carried (for `each`)."""
    return Vehicle(along(vehicle.position, drift, 1.0), vehicle.velocity, vehicle.speed)


def evader_decision(game: Game, here: Here, exchange: Exchange) -> Decision:
    """The evader's decision: its action, or what it decided when the others saw it."""
    t, g, world = here.table, here.game, here.world
    if world.learns[0]:
        return answer(game.evader, game.evader_limits, exchange.evader_acts[g], turn_at(here, 0), world.form)
    return Decision(True, vec_of(t.decided[g]), t.decided[g, 3], RuleId.CUSTOM, NORTH, 0.0, 0.0)


def played(game: Game, here: Here, exchange: Exchange, parts: Parts) -> Game:
    """The game after one control step under the actions."""
    world = here.world
    conditions = world.conditions
    own = evader_decision(game, here, exchange)
    others = each(idle, game.pursuers, 0.0)
    if world.team_plays:
        seen = parts.sighting(game, here, own.direction, own.speed)
        others = decide_pursuers(game, seen, conditions, parts.decide_pursuer)
    decisions = each(act, game.pursuers, Acting(here, exchange, game, others))
    dt = conditions.control.dt
    drift = scale(wind_of(here), dt)
    evader = drifted(moved(game.evader, own, dt), 0, drift)
    pursuers = each(drifted, each_pair(move_one, game.pursuers, decisions, dt), drift)
    return judged(game, evader, pursuers, conditions)


def reward(before: Game, after: Game, here: Here, exchange: Exchange) -> None:
    """Write what the step earned, and how the game stands."""
    g, world = here.game, here.world
    weights, target = world.rewards, world.conditions.target
    score = after.score
    caught = 0.0
    if score.verdict != GameResult.RUNNING:
        stopped = score.verdict == GameResult.CAPTURED or score.verdict == GameResult.DENIED
        caught = weights.outcome if stopped else -weights.outcome
    flown = score.time - before.time
    hunted = caught - weights.time * flown + weights.unsafe * (score.unsafe - before.score.unsafe)
    nearer = 0.0
    if target.exists:
        nearer = distance(before.evader.position, target.position) - distance(
            after.evader.position, target.position
        )
    exchange.rewards[g, 0] = weights.closing * nearer - hunted
    exchange.ends[g, 0] = score.time
    exchange.ends[g, 1] = score.captor
    exchange.ends[g, 2] = score.smallest
    exchange.ends[g, 3] = here.table.steps[g] + 1
    for k in range(len(after.pursuers)):
        gained = distance(before.pursuers[k].position, before.evader.position) - distance(
            after.pursuers[k].position, after.evader.position
        )
        exchange.rewards[g, k + 1] = hunted + weights.closing * gained


def note_end(here: Here, exchange: Exchange) -> None:
    """Keep a game's last observations."""
    g = here.game
    for k in range(exchange.evader_sees.shape[1]):
        exchange.evader_last[g, k] = exchange.evader_sees[g, k]
    for i in range(exchange.pursuers_see.shape[1]):
        for k in range(exchange.pursuers_see.shape[2]):
            exchange.pursuers_last[g, i, k] = exchange.pursuers_see[g, i, k]


def idle_evader(_view: EvaderView) -> Decision:
    """In place of a strategy where the evader learns."""
    return Decision(False, NORTH, 0.0, RuleId.NONE, NORTH, 0.0, 0.0)


def idle_pursuer(_view: PursuerView) -> Decision:
    """In place of a strategy where all pursuers learn."""
    return Decision(False, NORTH, 0.0, RuleId.NONE, NORTH, 0.0, 0.0)


class Run(NamedTuple):
    """Which games are meant, and what is done with them."""

    first: int
    last: int  # one behind
    stride: int  # added to the seed of a game that ended, which then begins anew; 0: it stands
    begins: bool  # all begin at their seeds' starts, and nobody acts


class Parts(NamedTuple):
    """What a kernel is made of: strategies, and how everybody is seen."""

    decide_evader: EvaderStrategy
    decide_pursuer: PursuerStrategy
    listen: Callable[[Here], None]
    others: Callable[[Game, Here], tuple[Vehicle, ...]]
    sighting: Callable[[Game, Here, Vec, float], Sighting]


def unfit(exchange: Exchange, world: World, run: Run) -> int:
    """Number of the first game with an action that is no number, −1 where all are."""
    for g in range(run.first, run.last):
        total = 0.0
        if world.learns[0]:
            for k in range(exchange.evader_acts.shape[1]):
                total += abs(exchange.evader_acts[g, k])
        for i in range(exchange.pursuers_act.shape[1]):
            if world.learns[i + 1]:
                for k in range(exchange.pursuers_act.shape[2]):
                    total += abs(exchange.pursuers_act[g, i, k])
        if not total < 1e30:
            return g
    return -1


def observe(here: Here, exchange: Exchange, stride: int, parts: Parts) -> None:
    """Write what everybody sees, and begin the next game where this one has ended."""
    t, g = here.table, here.game
    while True:
        game = loaded(here)
        parts.listen(here)
        look_all(game, here, exchange, parts)
        if t.steps[g] == 0 or exchange.verdicts[g] == 0:
            break
        note_end(here, exchange)
        if stride == 0:
            break
        t.seeds[g] += stride
        restart(here)


def step_all(table: Table, world: World, exchange: Exchange, run: Run, parts: Parts) -> None:
    """One control step of every game of the run, or the beginning of all of them."""
    for g in range(run.first, run.last):
        here = Here(table, world, g)
        if run.begins:
            exchange.verdicts[g] = 0
            restart(here)
        elif run.stride == 0 and table.steps[g] > 0 and exchange.verdicts[g] != 0:
            for i in range(exchange.rewards.shape[1]):
                exchange.rewards[g, i] = 0.0
            continue
        else:
            before = loaded(here)
            after = played(before, here, exchange, parts)
            reward(before, after, here, exchange)
            exchange.verdicts[g] = after.score.verdict
            table.steps[g] += 1
            store(after, here)
        observe(here, exchange, run.stride, parts)
