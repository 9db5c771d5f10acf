"""Games with the aircraft as flown, one control step a call: those of `sim_bridge.campaign.spatial_play`.

Views, supervisor, autopilot, aircraft, gusts, sensor and filters are its functions, called in its order; a
step here begins where everybody decides. Kernel style, but for lists and arrays, which are changed in place.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import EvaderStrategy, Game, PursuerStrategy, judged
from onboard.core.game.referee import GameResult, Score
from onboard.core.game.views import EvaderView, PursuerView
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.features import Form, Turn, answer, evader_features, pursuer_features
from onboard.core.strategy.knowledge import Decision
from sim_bridge.campaign.ledger import known
from sim_bridge.campaign.spatial_game import (
    WIND_EVERY,
    Chosen,
    Deciding,
    Start,
    Ways,
    decide_all,
    decide_pursuers,
    evader_sees,
    in_air,
    standing,
)
from sim_bridge.campaign.spatial_lanes import InLanes
from sim_bridge.campaign.spatial_play import Motion, head
from sim_bridge.campaign.team_play import Messages, no_part, nothing_kept, nothing_said
from sim_bridge.campaign.tracks import Tracks
from sim_bridge.gym.exchange import Exchange
from sim_bridge.gym.simple import Run, idle_evader, idle_pursuer, note_end, reward
from sim_bridge.gym.starts import Here, Table, World, vec_of, write

Array = NDArray[np.float64]


class Skies(NamedTuple):
    """What the games fly in, beside their table."""

    starts: Any  # list of `Start`, one a game
    skies: Any  # list of `OneByOne`; in lanes: `InLanes` with one more axis, the games, in front
    before: Array  # (games, players, KNOWS): as the agents know everybody when they decide
    now: Array  # (games, players, KNOWS): as everybody is
    decided: Array  # (games, players, 8): see `decide_all`
    samples: NDArray[np.int64]  # (games,) of the aircraft, since the beginning of the world


class Chair(NamedTuple):
    """Who is asked, in place of the number of a strategy, and what it takes to answer.

    Everybody's is handed through all of a decision: of the game's arrays it holds its own rows alone, or the
    kernel compiles for a quarter of an hour.
    """

    learns: bool
    acts: Any  # its rows of `Exchange`
    sees: Any
    turn: Array  # (2,): axes of the observation
    form: Form
    evade: EvaderStrategy
    pursue: PursuerStrategy


class Seats(NamedTuple):
    """What chairs are made of (for `each`)."""

    here: Here
    exchange: Exchange
    evade: EvaderStrategy
    pursue: PursuerStrategy


class Craft(NamedTuple):
    """What a kernel is made of."""

    decide_evader: EvaderStrategy
    decide_pursuer: PursuerStrategy
    motion: Motion
    sky_at: Callable[[Any, int], Any]


def sky_in_list(skies: Any, game: int) -> Any:
    """The sky of a game, one by one."""
    return skies[game]


def sky_in_lanes(skies: InLanes, game: int) -> InLanes:
    """The sky of a game, in lanes."""
    seen = Tracks(skies.seen.waiting[game], skies.seen.filters[game], skies.seen.stamps[game])
    return InLanes(
        skies.air[game], skies.gusts[game], skies.sensor[game], skies.waiting[game], skies.crew[game], seen
    )


def ways_of(evader: Any, pursuer: Any, chair: Any, chairs: Any) -> Ways:
    """Everybody asked by a function of a view and a chair, and no plan for the team."""
    return Ways(evader, pursuer, Chosen(chair, chairs), Messages(nothing_kept, nothing_said, no_part))


def chair_of(_vehicle: Vehicle, index: int, seats: Seats) -> Chair:
    """The chair of pursuer `index` (for `each`)."""
    here, exchange, k = seats.here, seats.exchange, index + 1
    g = here.game
    return Chair(
        here.world.learns[k], exchange.pursuers_act[g, index], exchange.pursuers_see[g, index],
        here.table.turns[g, k], here.world.form, seats.evade, seats.pursue,
    )  # fmt: skip


def evaders_chair(seats: Seats) -> Chair:
    """The evader's."""
    here, exchange, g = seats.here, seats.exchange, seats.here.game
    return Chair(
        here.world.learns[0], exchange.evader_acts[g], exchange.evader_sees[g], here.table.turns[g, 0],
        here.world.form, seats.evade, seats.pursue,
    )  # fmt: skip


def ask(view: PursuerView, chair: Chair) -> Decision:
    """A pursuer's decision: its action, or its strategy's."""
    if not chair.learns:
        return chair.pursue(view)
    return answer(view.own, view.limits, chair.acts, Turn(chair.turn[0], chair.turn[1]), chair.form)


def ask_evader(view: EvaderView, chair: Chair) -> Decision:
    """The evader's decision: its action, or its strategy's."""
    if not chair.learns:
        return chair.evade(view)
    return answer(view.own, view.limits, chair.acts, Turn(chair.turn[0], chair.turn[1]), chair.form)


def look(view: PursuerView, chair: Chair) -> Decision:
    """Write what a pursuer sees where it would decide."""
    if chair.learns:
        keep_turn(pursuer_features(view, chair.form, chair.sees), chair.turn)
    return idle_pursuer(view)


def look_of_evader(view: EvaderView, chair: Chair) -> Decision:
    """Write what the evader sees where it would decide."""
    if chair.learns:
        keep_turn(evader_features(view, chair.form, chair.sees), chair.turn)
    return idle_evader(view)


def keep_turn(turn: Turn, row: Array) -> None:
    """Write the axes of an observation down."""
    row[0] = turn.x
    row[1] = turn.y


def standing_at(vehicle: Vehicle, index: int, here: Here) -> Vehicle:
    """Pursuer `index` where it was when the referee last looked (for `each`)."""
    return Vehicle(vec_of(here.table.places[here.game, index + 1]), vehicle.velocity, vehicle.speed)


def judged_before(here: Here, start: Start) -> Game:
    """The game as the referee saw it last."""
    t, g, first = here.table, here.game, start.game
    evader = Vehicle(vec_of(t.places[g, 0]), first.evader.velocity, first.evader.speed)
    score = Score(GameResult.RUNNING, t.clock[g, 0], -1, t.clock[g, 1], t.clock[g, 2])
    pursuers = each(standing_at, first.pursuers, here)
    return Game(t.clock[g, 0], evader, pursuers, first.evader_limits, first.pursuer_limits, score)


def judge_now(here: Here, start: Start, states: Array, exchange: Exchange) -> None:
    """What the referee says of the control step that ended, what that earned, and where everybody is."""
    t, g = here.table, here.game
    before = judged_before(here, start)
    evader = in_air(known(states, 0), ZERO, start.game.evader.speed)
    after = judged(before, evader, each(standing, start.game.pursuers, states), start.conditions)
    reward(before, after, here, exchange)
    exchange.verdicts[g] = after.score.verdict
    t.steps[g] += 1
    for i in range(states.shape[0]):
        write(t.places[g, i], Vec(states[i, 0], states[i, 1], states[i, 2]))
        write(t.velocities[g, i], Vec(states[i, 3] - states[i, 6], states[i, 4] - states[i, 7], states[i, 5]))
    t.clock[g, 0] = after.time
    t.clock[g, 1] = after.score.smallest
    t.clock[g, 2] = after.score.unsafe


def team_at(g: int, start: Start, skies: Skies, ways: Ways, sky: Any) -> Deciding:
    """Everybody in game `g` before a decision; the team has no plan."""
    return Deciding(start, skies.before[g], sky.seen, skies.samples[g], ways, skies.decided[g], 0)


def glide(here: Here, start: Start, skies: Skies, exchange: Exchange, craft: Craft, decided: bool) -> None:
    """Fly on until everybody decides again, or the game ends; `decided`: they have just done so."""
    g, motion = here.game, craft.motion
    sky, pace, now = craft.sky_at(skies.skies, g), start.pace, skies.now[g]
    watched = decided
    while True:
        sample = skies.samples[g]
        if not watched:
            motion.watch(sky, start, sample, now)
            if sample % pace.control == pace.decides:
                return
        watched = False
        if sample % WIND_EVERY == 0:
            motion.estimate(sky, start, now)
        if (sample + 1) % pace.control == pace.decides:
            head(motion, sky, now)
        skies.before[g][:] = now
        motion.move(sky, start, sample, now)
        skies.samples[g] += 1
        if (skies.samples[g] - pace.t0) % pace.control == 0:
            judge_now(here, start, now, exchange)
            if exchange.verdicts[g] != 0:
                return


def fly_all(table: Table, skies: Skies, shared: tuple[World, Exchange], run: Run, craft: Craft) -> None:
    """One control step of every game of the run; or, of games that begin, all until the first decision."""
    world, exchange = shared
    for g in range(run.first, run.last):
        here = Here(table, world, g)
        start = skies.starts[g]
        sky = craft.sky_at(skies.skies, g)
        seats = Seats(here, exchange, craft.decide_evader, craft.decide_pursuer)
        chair, chairs = evaders_chair(seats), each(chair_of, world.template.pursuers, seats)
        if run.begins:
            exchange.verdicts[g] = 0
            craft.motion.note(sky, skies.now[g])
            head(craft.motion, sky, skies.now[g])
            skies.before[g][:] = skies.now[g]
        elif exchange.verdicts[g] != 0:
            for i in range(exchange.rewards.shape[1]):
                exchange.rewards[g, i] = 0.0
            continue
        else:
            ways = ways_of(ask_evader, ask, chair, chairs)
            decide_all(team_at(g, start, skies, ways, sky), sky.crew, table.steps[g])
            craft.motion.order(sky)
        glide(here, start, skies, exchange, craft, not run.begins)
        team = team_at(g, start, skies, ways_of(look_of_evader, look, chair, chairs), sky)
        look_of_evader(evader_sees(team), chair)
        decide_pursuers(team)
        if exchange.verdicts[g] != 0:
            note_end(here, exchange)
