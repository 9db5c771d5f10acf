"""Pairs of pursuers abreast against evaders that dodge: parallel pursuit and `abreast`, the same seeds.

    python -m tests.benchmarks.abreast --games 60

Eight aircraft in space as four pairs at 2 km, 145 m apart in each, noses on parallel pursuit; wind, gusts and
noise. In one kind the ring has a random phase, in the other a pair is on the line to the target. Games that
were played stay in `--rows`. Writes benchmarks/results/abreast.md.
"""

from __future__ import annotations

import argparse
import json
from math import atan2, cos, degrees, pi, sin
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from onboard.core.game.referee import GameResult
from onboard.core.geometry.lead import lead
from onboard.core.math.vectors import Vec
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.scenario import Scenario
from sim_bridge.campaign.plane_in_wind import drawn_wind
from sim_bridge.campaign.spatial_campaign import mcnemar, play_drawn, share
from sim_bridge.campaign.spatial_draw import Sides, draw, spatial
from sim_bridge.campaign.spatial_game import Chosen
from tests.benchmarks.team import apart
from tests.support.benchmark_record import write

PAIRS, FAR, BESIDE = 4, 2000.0, 145.0  # number; [m]
EVADING = ("paper", "dodge", "evasive")
PURSUING = ("parallel-pursuit", "abreast")
KINDS = {"front": "a pair before the target", "phase": "random phase"}
Row = dict[str, Any]
replace = msgspec.structs.replace


def game_of(kind: str, seed: int) -> Scenario:
    """The game of a seed."""
    base = spatial("five")
    phase = 0.0 if kind == "front" else float(np.random.default_rng([7, seed]).uniform(0.0, 2.0 * pi))
    pursuers = []
    for k in range(2 * PAIRS):
        a, off = phase + 2.0 * pi * (k // 2) / PAIRS, BESIDE * (k % 2 - 0.5)
        place = Vec(FAR * cos(a) - off * sin(a), FAR * sin(a) + off * cos(a), -1500.0)
        nose = lead(place, 40.0, Vec(0.0, 0.0, -1500.0), Vec(50.0, 0.0, 0.0))
        told = degrees(atan2(nose.y, nose.x))
        pursuers.append(replace(base.pursuers[0], position=(place.x, place.y, 1500.0), heading_deg=told))
    flight = replace(base.flight, wind=replace(base.flight.wind, from_deg=drawn_wind(1000 + seed)))
    return replace(base, pursuers=tuple(pursuers), seed=1000 + seed, flight=flight)


def row_of(kind: str, seed: int, evader: int, pursuers: int) -> Row:
    """One game."""
    evaders = tuple(EVADERS[name].decide for name in EVADING)
    chosen = Chosen(evader, (pursuers,) * (2 * PAIRS))
    sides = Sides(evaders, tuple(PURSUERS[name].decide for name in PURSUING), chosen)
    played = play_drawn(draw(game_of(kind, seed), 0)._replace(sides=sides), evader)
    return {
        "kind": kind, "seed": seed, "evader": EVADING[evader], "pursuers": PURSUING[pursuers],
        "verdict": played.verdict.name, "apart": apart(played),
    }  # fmt: skip


def table(rows: list[Row]) -> list[str]:
    """The page's lines."""
    lines = ["| start | evader | games | parallel pursuit: captured (95 %) | arrived |"]
    lines[0] += " abreast: captured (95 %) | arrived | only abreast, only parallel pursuit captured; p |"
    lines.append("|---|---|---|---|---|---|---|---|")
    for kind, words in KINDS.items():
        for evader in EVADING:
            ours = [r for r in rows if r["kind"] == kind and r["evader"] == evader]
            old, new = ({r["seed"]: r["verdict"] for r in ours if r["pursuers"] == p} for p in PURSUING)
            seeds = sorted(set(old) & set(new))
            if not seeds:
                continue
            n, caught = len(seeds), GameResult.CAPTURED.name
            won = sum(new[s] == caught != old[s] for s in seeds)
            lost = sum(old[s] == caught != new[s] for s in seeds)
            cells = []
            for side in (old, new):
                cells.append(share(sum(side[s] == caught for s in seeds), n))
                cells.append(str(sum(side[s] == GameResult.ARRIVED.name for s in seeds)))
            paired = f"{won}, {lost}; {mcnemar(won, lost):.1e}"
            lines.append(f"| {words} | {evader} | {n} | {' | '.join(cells)} | {paired} |")
    close = [r["apart"] for r in rows]
    lines += ["", f"Least distance between two pursuers in all games: {min(close):.0f} m; nearer than the"]
    lines[-1] += f" separation of 100 m in {sum(d < 100.0 for d in close)} of {len(close)} games."
    return lines


def main() -> None:
    """Play what is missing and write the page."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--games", type=int, default=60)
    parser.add_argument("--rows", type=Path, default=Path(".bench-abreast.jsonl"))
    given = parser.parse_args()
    rows = [json.loads(line) for line in given.rows.read_text().splitlines()] if given.rows.exists() else []
    have = {(r["kind"], r["seed"], r["evader"], r["pursuers"]) for r in rows}
    with given.rows.open("a") as out:
        for kind in KINDS:
            for seed in range(1, given.games + 1):
                for i, evader in enumerate(EVADING):
                    for j, pursuers in enumerate(PURSUING):
                        if (kind, seed, evader, pursuers) not in have:
                            rows.append(row_of(kind, seed, i, j))
                            print(json.dumps(rows[-1]), file=out, flush=True)
    lines = table(rows)
    print("\n".join(lines))
    command = f"python -m tests.benchmarks.abreast --games {given.games}"
    write("abreast.md", "Pairs abreast against evaders that dodge", command, lines)


if __name__ == "__main__":
    main()
