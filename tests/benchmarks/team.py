"""Who wins in space: teams against the paper's rules, the same seeds for every way.

    python -m tests.benchmarks.team --seeds 200

Aircraft, wind, gusts, sensor noise and delay as flown; the evader is the paper's. Resumable: each game leaves
a row in `--rows`, and the page is made of the rows that there are. `--fly 20` flies that many seeds of
each case besides, whole, with agents and messages.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from onboard.core.game.referee import GameResult
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.core.strategy.team.closure import way_out
from onboard.game.scenario import Scenario
from sim_bridge.campaign.spatial_campaign import Played, mcnemar, play_drawn, share
from sim_bridge.campaign.spatial_draw import Sides, draw
from sim_bridge.campaign.spatial_game import Chosen, Evasion
from sim_bridge.programs.scenario_band import situation_of
from tests.benchmarks.team_cases import CASES, Case, demand, game_of, near
from tests.support.benchmark_record import write

WAYS = ("paper", "team")
Row = dict[str, Any]


def play(scenario: Scenario, way: int) -> Played:
    """One game; both ways are in the same compiled kernel."""
    count = len(scenario.pursuers)
    evaders = (EVADERS["paper"].decide, EVADERS["straight"].decide)
    sides = Sides(evaders, tuple(PURSUERS[name].decide for name in WAYS), Chosen(0, (way,) * count))
    return play_drawn(draw(scenario, 0)._replace(sides=sides), Evasion.STRATEGY)


def apart(played: Played) -> float:
    """The least distance between two pursuers in a game [m]."""
    places = played.log[:, 1:, :3]
    count = places.shape[1]
    pairs = [(i, j) for i in range(count) for j in range(i)]
    return float(min(np.linalg.norm(places[:, i] - places[:, j], axis=1).min() for i, j in pairs))


def row_of(case: Case, seed: int, way: int) -> Row:
    """One game as a row."""
    scenario = game_of(case, seed)
    band = way_out(situation_of(scenario, 0.0))
    played = play(scenario, way)
    return {
        "case": case.name, "seed": seed, "way": WAYS[way], "verdict": played.verdict.name,
        "time": played.time, "smallest": played.smallest, "apart": apart(played), "closed": band.closed,
        "gap": band.gap, "near": near(scenario),
    }  # fmt: skip


def table(rows: list[Row]) -> list[str]:
    """The page's lines."""
    lines = [
        "| case | games | paper: captured (95 %) | arrived | team: captured (95 %) | arrived (95 %) |"
        " only team, only paper captured; p | closed at t0 |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        ours = [row for row in rows if row["case"] == case.name]
        mine = {way: {row["seed"]: row for row in ours if row["way"] == way} for way in WAYS}
        seeds = sorted(set(mine["paper"]) & set(mine["team"]))
        if not seeds:
            continue
        old, new = [[mine[way][seed] for seed in seeds] for way in WAYS]
        caught = [[r["verdict"] == GameResult.CAPTURED.name for r in side] for side in (old, new)]
        came = [sum(r["verdict"] == GameResult.ARRIVED.name for r in side) for side in (old, new)]
        won = sum(b and not a for a, b in zip(*caught, strict=True))
        lost = sum(a and not b for a, b in zip(*caught, strict=True))
        n = len(seeds)
        lines.append(
            f"| {case.words} | {n} | {share(sum(caught[0]), n)} | {came[0]} | {share(sum(caught[1]), n)} |"
            f" {share(came[1], n)} | {won}, {lost}; {mcnemar(won, lost):.1e} |"
            f" {sum(r['closed'] for r in new)} |"
        )
    return lines


def honesty(rows: list[Row]) -> list[str]:
    """What must never be."""
    close = [r["apart"] for r in rows if r["way"] == "team"]
    near_by = sum(r["near"] for r in rows if not r["case"].startswith("shipped"))
    return [
        "",
        f"Rings and staged starts with a pursuer nearer than 1.5 km at t0: {near_by}. Least distance"
        f" between two pursuers of a team in all its games: {min(close):.0f} m; nearer than 25 m in"
        f" {sum(d < 25.0 for d in close)} of {len(close)} games.",
    ]


def main() -> None:
    """Play what is missing and write the page."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--cases", default=",".join(case.name for case in CASES))
    parser.add_argument("--rows", type=Path, default=Path(".bench-team.jsonl"))
    parser.add_argument("--page", default="team.md", help="in benchmarks/results; empty: none")
    given = parser.parse_args()
    rows = [json.loads(line) for line in given.rows.read_text().splitlines()] if given.rows.exists() else []
    have = {(r["case"], r["seed"], r["way"]) for r in rows}
    with given.rows.open("a") as out:
        for case in map(demand, given.cases.split(",")):
            for seed in range(1, given.seeds + 1):
                for way in range(len(WAYS)):
                    if (case.name, seed, WAYS[way]) not in have:
                        rows.append(row_of(case, seed, way))
                        out.write(json.dumps(rows[-1]) + "\n")
                        out.flush()
    lines = [*table(rows), *honesty(rows)]
    print("\n".join(lines))
    if given.page:
        write(given.page, "Teams in space", f"python -m tests.benchmarks.team --seeds {given.seeds}", lines)


if __name__ == "__main__":
    main()
