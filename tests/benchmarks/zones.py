"""Zones: how near anybody comes to one in many games, and what the way round costs.

    python -m tests.benchmarks.zones --games 1000

Games of `flight/two-obstacles` in the plane, compiled: a seed draws the pursuers' starts, outside the zones.
Everybody's place is kept after every step, with its clearance (the distance from a zone's farthest wall), and
the straight ways between them are tried against the zones. The same games without zones stand beside.
"""

from __future__ import annotations

import argparse
from collections import Counter
from math import inf
from time import process_time
from typing import Any

import msgspec
import numpy as np

from onboard.core.game.referee import GameResult
from onboard.core.geometry.zones import entry
from onboard.core.math.vectors import Vec
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario, load
from onboard.runtime.resources import configs
from sim_bridge.campaign.compiled import campaign, starts_of
from sim_bridge.campaign.spatial_draw import drawn_scenario
from sim_bridge.plane_game.setup import conditions_of, game_of
from sim_bridge.programs.campaigns.plan import spread_of
from tests.support import benchmark_record

PART = 50  # games whose places are kept at a time
PAIRS = (("paper", "parallel-pursuit"), ("paper", "paper"))


def clearances(scenario: Scenario, places: Any) -> Any:
    """The clearance [m] of places (…, 3) from the nearest zone, by the farthest wall of each."""
    least = np.full(places.shape[:-1], inf)
    zones = scenario.rules.zones
    for area in zones.areas:
        walls = np.array(zones.walls[area.first : area.first + area.sides])
        off = places[..., :2] @ walls[:, 2:4].T - walls[:, 4]
        least = np.minimum(least, off.max(axis=-1))
    return least


def entered(scenario: Scenario, path: Any) -> bool:
    """Whether a path (steps, 3) enters a zone on the straight ways between its places."""
    zones = scenario.rules.zones
    near = clearances(scenario, path) < 5.0  # no step is longer
    for step in np.flatnonzero(near[:-1] | near[1:]):
        a, b = Vec(*path[step].tolist()), Vec(*path[step + 1].tolist())
        if any(entry(zones, area, 0.0, a, b, True) <= 1.0 for area in zones.areas):
            return True
    return False


def played(
    base: Scenario, games: int, pair: tuple[str, str], keep: bool
) -> tuple[Counter[str], float, int, float]:
    """The verdicts, the least clearance [m], how many players entered a zone, and CPU-seconds a game."""
    verdicts: Counter[str] = Counter()
    least, entries, cpu = inf, 0, 0.0
    play = campaign(evader_strategy(pair[0]), pursuer_strategy(pair[1]), len(base.pursuers))
    conditions = conditions_of(base)
    steps = int(base.parameters.horizon / base.parameters.dt) + 2 if keep else 0
    for first in range(1, games + 1, PART):
        seeds = range(first, min(first + PART, games + 1))
        drawn = [game_of(drawn_scenario(base, seed, spread_of(base))) for seed in seeds]
        starts = starts_of(drawn, [conditions.target.position] * len(drawn))
        if first == 1:
            play(starts, conditions, keep=1)  # compiled
        before = process_time()
        ends = play(starts, conditions, keep=steps)
        cpu += process_time() - before
        verdicts.update(GameResult(int(one)).name.lower() for one in ends.verdicts)
        if not keep:
            continue
        for game in range(len(drawn)):
            trace = ends.trace[game, : ends.steps[game] + 1]
            least = min(least, float(np.nanmin(clearances(base, trace))))
            entries += sum(entered(base, trace[:, player]) for player in range(trace.shape[1]))
    return verdicts, least, entries, cpu / games


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.zones", description=__doc__)
    parser.add_argument("--games", type=int, default=1000)
    given = parser.parse_args()
    base = load(configs() / "scenarios" / "flight" / "two-obstacles.toml")
    bare = msgspec.structs.replace(base, zones=())
    lines = [
        *str(__doc__).split("\n\n", 2)[2].strip().splitlines(),
        "",
        "| evader | pursuers | games | arrived | captured | else | entries of a zone | least clearance [m] |"
        " without zones: arrived | captured | ms a game with zones, without |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for pair in PAIRS:
        seen, least, entries, cpu = played(base, given.games, pair, True)
        free, _least, _entries, quick = played(bare, given.games, pair, False)
        left = given.games - seen["arrived"] - seen["captured"]
        lines.append(
            f"| {pair[0]} | {pair[1]} | {given.games} | {seen['arrived']} | {seen['captured']} | {left} |"
            f" {entries} | {least:.2f} | {free['arrived']} | {free['captured']} |"
            f" {1e3 * cpu:.1f}, {1e3 * quick:.2f} |"
        )
        print(lines[-1], flush=True)
    command = f"python -m tests.benchmarks.zones --games {given.games}"
    benchmark_record.write("zones.md", "Zones: nobody enters one", command, lines)


if __name__ == "__main__":
    main()
