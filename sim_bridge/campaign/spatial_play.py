"""The spatial game played out: its clock, and how it has its vehicles moved.

`play` and `approach` are the same whether the vehicles are moved one by one, as here (`OneByOne`), or eight
at a time (`spatial_lanes`): what moves them is handed in (`Motion`). Kernel style but for lists and arrays,
which are changed in place.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from onboard.core.game.advance import begin, judged
from onboard.core.game.referee import GameResult
from onboard.core.math.each import each
from onboard.core.math.vectors import ZERO, Vec
from sim_bridge.campaign.envelope import UNMOVED, Envelope, widened
from sim_bridge.campaign.ledger import DECIDES, KNOWS, known, note, note_wind
from sim_bridge.campaign.plane_in_wind import Flown
from sim_bridge.campaign.spatial_game import (
    ABOARD_ROW,
    WIND_EVERY,
    Array,
    Deciding,
    SpatialPlay,
    Start,
    Ways,
    commanded_on,
    decide_all,
    in_air,
    load_aboard,
    moved_on,
    standing,
    store_aboard,
    weathered,
)
from sim_bridge.campaign.tracks import Tracks, watched
from sim_bridge.vehicle.flight.plane import Command, placed

LOGGED = 6  # numbers of a player in a row of a game's log


class Motion(NamedTuple):
    """How the vehicles of a game are moved; `sky` is whatever holds their states.

    `here` (players, 9) is what they know now, as `ledger` has it.
    """

    note: Callable[[Any, Array], None]  # write down `here`
    watch: Callable[[Any, Start, int, Array], None]  # sensor and track filters at a sample
    order: Callable[[Any], None]  # take the orders of the crew over
    course: Callable[[Any, int], float]  # of an aircraft [rad]
    estimate: Callable[[Any, Start, Array], None]  # another update of the estimates of the wind
    move: Callable[[Any, Start, int, Array], None]  # one sample as ordered
    carry: Callable[[Any, Start, int, Array], None]  # one sample on the commands of the approach
    put: Callable[[Any, Array, Array], None]  # aircraft and tracks from `here` to places (players, 3)
    widen: Callable[[Any, Start], None]  # how far they went
    reach: Callable[[Any], Envelope]


class OneByOne(NamedTuple):
    """Vehicles that are moved one by one, evader first."""

    players: list[Flown]
    level: list[Command]  # of the approach
    crew: Array  # rows of `ABOARD_ROW`
    seen: Tracks
    reach: list[Envelope]  # one, of all of them


class Desk(NamedTuple):
    """Room for what is known and decided: compiled games make no arrays."""

    here: Array  # (players, 9) now: see `ledger`
    before: Array  # (players, 9) a sample ago
    decided: Array  # (players, 6)


def desk_of(players: int) -> Desk:
    """The desk of a game."""
    return Desk(np.zeros((players, KNOWS)), np.zeros((players, KNOWS)), np.zeros((players, DECIDES)))


class Flying(NamedTuple):
    """Whatever holds the vehicles' states, and the desk of who flies them."""

    sky: Any
    desk: Desk


def approach(start: Start, motion: Motion, flying: Flying) -> None:
    """Fly on the start's heading until t₀ and be at the start's place then.

    What gusts make of an aircraft in that time is so what they make of it in flight before t₀, and neither
    tracks nor estimates of the wind are new.
    """
    sky, (here, places, _decided) = flying.sky, flying.desk
    motion.note(sky, here)
    keep(places, here)
    for sample in range(start.pace.t0):
        motion.watch(sky, start, sample, here)
        if sample % WIND_EVERY == 0:
            motion.estimate(sky, start, here)
        motion.carry(sky, start, sample, here)
    motion.put(sky, here, places)


def play(start: Start, ways: Ways, motion: Motion, flying: Flying, log: Array) -> SpatialPlay:
    """Play a game out from t₀.

    `log` (steps, players, 6): position [m; NED], flown and decided course [rad], rule; evader first.
    """
    first, pace = start.game, start.pace
    sky, (here, before, decided) = flying.sky, flying.desk
    # A score of its own: that of the start holds plain numbers, and a judged one a member of `GameResult`.
    game = begin(first.evader, first.pursuers, first.evader_limits, first.pursuer_limits)
    count = len(start.game.pursuers) + 1
    motion.note(sky, here)
    head(motion, sky, here)
    keep(before, here)
    talk = ways.messages.begin(game.pursuers, start.planning)
    steps = 0
    sample = pace.t0
    while game.score.verdict == GameResult.RUNNING:
        for _ in range(pace.control):
            motion.watch(sky, start, sample, here)
            if sample % pace.control == pace.decides:
                decide_all(Deciding(start, before, sky.seen, sample, ways, decided, talk), sky.crew, steps)
                motion.order(sky)
                for i in range(count):
                    log[steps, i, 0] = here[i, 0]
                    log[steps, i, 1] = here[i, 1]
                    log[steps, i, 2] = here[i, 2]
                    log[steps, i, 3] = motion.course(sky, i)
                    log[steps, i, 4] = decided[i, 0]
                    log[steps, i, 5] = decided[i, 1]
            if sample % WIND_EVERY == 0:
                motion.estimate(sky, start, here)
            if (sample + 1) % pace.control == pace.decides:
                head(motion, sky, here)
                keep(before, here)
            motion.move(sky, start, sample, here)
            sample += 1
        motion.widen(sky, start)
        game = judged(
            game,
            in_air(known(here, 0), ZERO, game.evader.speed),
            each(standing, game.pursuers, here),
            start.conditions,
        )
        steps += 1
    return SpatialPlay(game, steps, sample - pace.t0, motion.reach(sky))


def keep(before: Array, here: Array) -> None:
    """Copy what is known (a copy in one would count who refers to its array)."""
    for i in range(here.shape[0]):
        for k in range(here.shape[1]):
            before[i, k] = here[i, k]


def head(motion: Motion, sky: Any, here: Array) -> None:
    """Write down every aircraft's course through the air, by which the next decision knows its nose."""
    for i in range(here.shape[0]):
        here[i, 8] = motion.course(sky, i)


def note_each(sky: OneByOne, here: Array) -> None:
    """`Motion.note`, one by one."""
    for i in range(len(sky.players)):
        note(here, i, sky.players[i])
        note_wind(here, i, load_aboard(sky.crew, i, 0).wind)


def watch_each(sky: OneByOne, start: Start, sample: int, here: Array) -> None:
    """`Motion.watch`, one by one."""
    watched(sky.seen, start.eye, sample, here, start.fleet.evader.dt)


def order_each(_sky: OneByOne) -> None:
    """`Motion.order`, one by one: the crew itself flies."""


def course_of(sky: OneByOne, index: int) -> float:
    """`Motion.course`, one by one."""
    return sky.players[index].plane.course


def estimate_each(sky: OneByOne, start: Start, here: Array) -> None:
    """`Motion.estimate`, one by one."""
    for i in range(len(sky.players)):
        aboard = weathered(start, i, load_aboard(sky.crew, i, 0), sky.players[i])
        store_aboard(sky.crew, i, 0, aboard)
        note_wind(here, i, aboard.wind)


def move_each(sky: OneByOne, start: Start, sample: int, here: Array) -> None:
    """`Motion.move`, one by one."""
    for i in range(len(sky.players)):
        aboard = load_aboard(sky.crew, i, 0)
        sky.players[i] = commanded_on(start, i, aboard, sky.players[i], sample)
        note(here, i, sky.players[i])


def carry_each(sky: OneByOne, start: Start, sample: int, here: Array) -> None:
    """`Motion.carry`, one by one."""
    for i in range(len(sky.players)):
        sky.players[i] = moved_on(start, i, sky.players[i], sky.level[i], sample)
        note(here, i, sky.players[i])


def put_each(sky: OneByOne, here: Array, places: Array) -> None:
    """`Motion.put`, one by one."""
    for i in range(len(sky.players)):
        place = Vec(places[i, 0], places[i, 1], places[i, 2])
        for axis in range(3):
            off = places[i, axis] - here[i, axis]
            sky.seen.filters[i, 5 * axis] += off
            for slot in range(sky.seen.waiting.shape[0]):
                sky.seen.waiting[slot, i, axis] += off
        sky.players[i] = Flown(placed(sky.players[i].plane, place), sky.players[i].gusts)


def widen_each(sky: OneByOne, start: Start) -> None:
    """`Motion.widen`, one by one."""
    for i in range(len(sky.players)):
        model = start.fleet.pursuer if i else start.fleet.evader
        declared = start.policies[i].envelope.speed_max
        sky.reach[0] = widened(sky.reach[0], sky.players[i], model, declared)


def reach_of(sky: OneByOne) -> Envelope:
    """`Motion.reach`, one by one."""
    return sky.reach[0]


def moved_one_by_one() -> Motion:
    """The motion over `OneByOne`."""
    return Motion(
        note_each, watch_each, order_each, course_of, estimate_each, move_each, carry_each, put_each,
        widen_each, reach_of,
    )  # fmt: skip


def one_by_one(players: list[Flown], level: list[Command], crew: list[Any], seen: Tracks) -> OneByOne:
    """The sky of `moved_one_by_one`; `crew` of `Aboard`, `level` for an approach."""
    rows = np.zeros((len(players), ABOARD_ROW))
    for i, aboard in enumerate(crew):
        store_aboard(rows, i, 0, aboard)
    return OneByOne(list(players), list(level), rows, seen, [UNMOVED])
