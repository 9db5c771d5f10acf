"""Games with a sensor that is late and loses measurements: what carrying tracks forward is worth.

Five pursuers at 40 m/s in simple motion (7)–(8); an evader at 50 m/s that runs for a target by the paper's
rules from the true state and turns at 60 deg/s at most. The pursuers see it through a 10 Hz sensor with
3 m of noise, 0.5 s late, with 30 % of the measurements lost, and decide at 20 Hz by the paper's rules from
one track: carried forward to now by the predictor, at constant velocity, or not at all.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np

from onboard.core.game.advance import Conditions, begin, decide_pursuers, moved, still_view
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.game.views import sighted
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec, along, angle_between, distance, dot, scale, unit
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.pilot.predictor import TrackPredictor, Trainer

DT, SECONDS, DELAY, LOST, RATE, SIGMA = 0.05, 40.0, 0.5, 0.3, 10.0, 3.0
TURN = pi / 3.0  # [rad/s]
SAFE = 4.0  # distance that the evader keeps by rule 1 [m]
SEEDS = range(50)
WEAVING = range(20)
NOISE = (SIGMA**2, SIGMA**2, SIGMA**2, -1.0, -1.0, -1.0)


class Waiting(NamedTuple):
    """A measurement on its way."""

    arrival: float
    t: float
    place: Vec


Carry = Callable[[TrackPredictor, float], tuple[Vec, Vec]]


def by_predictor(track: TrackPredictor, now: float) -> tuple[Vec, Vec]:
    """Place and velocity now, as the predictor says."""
    said = track.predict(now)
    return said.position, said.velocity


def at_constant_velocity(track: TrackPredictor, now: float) -> tuple[Vec, Vec]:
    """Place and velocity now, the filter carried forward."""
    said = track.filter.estimate(now)
    return said.position, said.velocity


def last_known(track: TrackPredictor, _now: float) -> tuple[Vec, Vec]:
    """Place and velocity at the newest measurement."""
    said = track.filter.estimate(track.filter.newest)
    return said.position, said.velocity


WAYS: dict[str, Carry] = {
    "predictor": by_predictor,
    "constant velocity": at_constant_velocity,
    "last known": last_known,
}


class Played(NamedTuple):
    """What came of a game."""

    smallest: float  # distance of any pursuer [m]
    error: float  # mean distance of the carried track from the evader, after 10 s [m]


def play(seed: int, carry: Carry, weaving: bool) -> Played:
    """One game of a minute; `weaving` puts a weave of 8 s on the evader's decision."""
    rng = np.random.default_rng([seed, 5])
    bearings, ranges = rng.uniform(-pi, pi, 6), rng.uniform(400.0, 900.0, 5)
    places = [Vec(r * cos(b), r * sin(b), 0.0) for r, b in zip(ranges, bearings[:5], strict=True)]
    target = Vec(3500.0 * cos(bearings[5]), 3500.0 * sin(bearings[5]), 0.0)
    rules = Rules(0.01, SAFE, epsilon_min=0.01, horizon=SECONDS, planar=True)
    conditions = Conditions(rules, Target(True, target), Control(DT))
    evader = Vehicle(ZERO, scale(unit(target, NORTH), 50.0), 50.0)
    game = begin(evader, tuple(Vehicle(p, ZERO, 40.0) for p in places), FREE, (FREE,) * 5)
    flee, chase = evader_strategy(""), pursuer_strategy("")
    track, trainer = TrackPredictor(seed), Trainer()
    under_way: deque[Waiting] = deque()
    smallest, errors = float("inf"), []
    for k in range(round(SECONDS / DT)):
        now = k * DT
        if k % round(1.0 / RATE / DT) == 0:
            noise = rng.normal(0.0, SIGMA, 3).tolist()
            if rng.random() >= LOST:
                under_way.append(Waiting(now + DELAY, now, along(game.evader.position, Vec(*noise), 1.0)))
        while under_way and under_way[0].arrival <= now + 1e-9:
            seen = under_way.popleft()
            track.add(seen.t, seen.place, None, NOISE)
        if carry is by_predictor:
            trainer.advance(now, {1: track}, 1)
        wanted = flee(still_view(game, conditions)).direction
        if weaving:
            swing = 0.7 * sin(2.0 * pi * now / 8.0)
            c, s = cos(swing), sin(swing)
            wanted = Vec(wanted.x * c - wanted.y * s, wanted.x * s + wanted.y * c, 0.0)
        ahead = turned_by(unit(game.evader.velocity, NORTH), wanted, TURN * DT)
        runner = Vehicle(game.evader.position, scale(ahead, 50.0), 50.0)
        pursuers = game.pursuers
        if not track.filter.empty:
            place, velocity = carry(track, now)
            place, velocity = place._replace(z=0.0), velocity._replace(z=0.0)  # a plane game
            heading = unit(velocity, NORTH)
            believed = Vehicle(place, scale(heading, 50.0), 50.0)
            sighting = sighted(believed, heading, conditions.control.lookahead)
            wanted_of = decide_pursuers(game, sighting, conditions, chase)
            pursuers = tuple(moved(p, d, DT) for p, d in zip(game.pursuers, wanted_of, strict=True))
            if now > 10.0:
                errors.append(distance(place, game.evader.position))
        game = game._replace(
            time=now + DT,
            pursuers=pursuers,
            evader=runner._replace(position=along(runner.position, runner.velocity, DT)),
        )
        smallest = min(smallest, *(distance(p.position, game.evader.position) for p in pursuers))
    return Played(smallest, float(np.mean(errors)))


def turned_by(u: Vec, wanted: Vec, most: float) -> Vec:
    """The unit vector u (level) turned towards `wanted` by at most `most` [rad]."""
    angle = min(angle_between(u, unit(wanted, u)), most)
    side = 1.0 if u.x * wanted.y - u.y * wanted.x >= 0.0 else -1.0
    c, s = cos(angle), side * sin(angle)
    turned = Vec(u.x * c - u.y * s, u.x * s + u.y * c, 0.0)
    return unit(turned, u) if dot(turned, turned) > 0.0 else u


class Statistics(NamedTuple):
    """Over the seeds."""

    mean: float  # smallest distance [m]
    median: float
    lower: float  # quartiles
    upper: float
    error: float  # of the carried track [m]
    nearer: float  # share of the seeds with a smaller distance than with the last known place


def games(weaving: bool, seeds: range, say: Callable[[str], None]) -> dict[str, Statistics]:
    """All ways over the seeds."""
    played: dict[str, list[Played]] = {name: [] for name in WAYS}
    for seed in seeds:
        if seed % 10 == 0:
            say(f"delayed games, {'weaving' if weaving else 'plain'}: seed {seed}")
        for name, carry in WAYS.items():
            played[name].append(play(seed, carry, weaving))
    base = np.array([one.smallest for one in played["last known"]])
    out = {}
    for name, results in played.items():
        d = np.array([one.smallest for one in results])
        lower, median, upper = np.percentile(d, [25, 50, 75])
        error = float(np.mean([one.error for one in results]))
        nearer = float((d < base).mean())
        out[name] = Statistics(float(d.mean()), float(median), float(lower), float(upper), error, nearer)
    return out
