"""Plays games for `campaign_speed`, in a process of its own: a line in is a job, a line out its cost.

Runs by this version of the project and by earlier ones alike; says `ready` once everything is compiled.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from itertools import cycle, islice
from math import cos, pi, sin
from time import process_time

import msgspec
import numpy as np

from onboard.core.game.advance import Conditions
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.math.states import FREE
from onboard.core.math.vectors import ZERO
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.scenario import Scenario
from sim_bridge.campaign.compiled import Starts, campaign
from sim_bridge.campaign.spatial_campaign import play_seed
from sim_bridge.campaign.spatial_draw import spatial
from sim_bridge.campaign.spatial_game import Evasion

Cost = dict[str, float]
Job = Callable[[int, int], Cost]  # of the first seed and a count


def team_of(count: int, horizon: float) -> Scenario:
    """The scenario `five` with so many pursuers on a ring about the evader's way, and another horizon [s]."""
    five = spatial("five")
    replace = msgspec.structs.replace
    if count != 5:
        pursuers = []
        for k, spec in enumerate(islice(cycle(five.pursuers), count)):
            turn, far = 2.0 * pi * k / count, 6000.0 + 500.0 * (k % 3)
            place = (far * cos(turn), far * sin(turn), spec.position[2] + 40.0 * (k % 5))
            pursuers.append(replace(spec, id=None, position=place))
        five = replace(five, pursuers=tuple(pursuers))
    return replace(five, parameters=replace(five.parameters, horizon=horizon))


def flown(count: int, horizon: float) -> Job:
    """Spatial games with aircraft, wind, sensor and filters."""
    scenario = team_of(count, horizon)

    def play(first: int, games: int) -> Cost:
        begin = process_time()
        played = [play_seed(scenario, seed, Evasion.STRATEGY) for seed in range(first, first + games)]
        spent = process_time() - begin
        verdicts = [int(p.verdict) for p in played]
        return {
            "cpu_s": spent,
            "games": float(games),
            "steps": float(sum(len(p.log) for p in played)),
            "captured": float(verdicts.count(GameResult.CAPTURED)),
            "arrived": float(verdicts.count(GameResult.ARRIVED)),
        }

    return play


def simple(planar: bool, team: int) -> Job:
    """Games of simple motion against so many pursuers, in the plane or in space."""
    run = campaign(EVADERS["paper"].decide, PURSUERS["paper"].decide, team)
    rules = Rules(R=2.0, rho=4.0, horizon=40.0, planar=planar)
    conditions = Conditions(rules, Target(True, ZERO), Control())

    def play(first: int, games: int) -> Cost:
        rng = np.random.default_rng(first)
        ways = rng.standard_normal((games, team, 3))
        if planar:
            ways[:, :, 2] = 0.0
        ways *= rng.uniform(15.0, 120.0, (games, team, 1)) / np.linalg.norm(ways, axis=2, keepdims=True)
        places = np.concatenate([np.zeros((games, 1, 3)), ways], axis=1)
        speeds = np.tile([5.0] + [4.0] * team, (games, 1))
        velocities = np.zeros_like(places)
        velocities[:, :, 0] = speeds
        limits = np.tile(np.array(FREE, dtype=float), (games, team + 1, 1))
        targets = np.tile([300.0, 0.0, 0.0], (games, 1))
        begin = process_time()
        ends = run(Starts(places, velocities, speeds, limits, targets), conditions)
        spent = process_time() - begin
        verdicts = ends.verdicts.tolist()
        return {
            "cpu_s": spent,
            "games": float(games),
            "steps": float(ends.steps.sum()),
            "captured": float(verdicts.count(GameResult.CAPTURED)),
            "arrived": float(verdicts.count(GameResult.ARRIVED)),
        }

    return play


def main(kind: str, count: int, horizon: float) -> None:
    """Do jobs as they come; `kind` is flown, plane or space."""
    play = flown(count, horizon) if kind == "flown" else simple(kind == "plane", count)
    play(0, 2)
    print("ready", flush=True)
    for line in sys.stdin:
        first, games = json.loads(line)
        print(json.dumps(play(first, games)), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]))
