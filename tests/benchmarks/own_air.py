"""What taking gusts out of the own way is worth: the same closed rings with and without.

    python -m tests.benchmarks.own_air --seeds 100 --teams 5 --ways paper paper-own-air

Pursuers at 40 m/s evenly on a ring of 2 km about the paper's evader at 50 m/s, its phase drawn by the seed,
noses on the heading of parallel pursuit; aircraft, gusts, wind, sensor and supervisors as in `spatial/six`.
Ways go in pairs; how near two pursuers ever came is told beside the separation that they keep.
"""

from __future__ import annotations

import argparse
from itertools import combinations
from math import cos, degrees, pi, sin
from pathlib import Path

import msgspec
import numpy as np

from onboard.core.game.referee import GameResult
from onboard.core.geometry.lead import lead
from onboard.core.math.vectors import Vec, yaw_of
from onboard.game.scenario import Scenario
from sim_bridge.campaign.spatial_campaign import Played, mcnemar, play_seed, share
from sim_bridge.campaign.spatial_draw import drawn_wind, spatial
from sim_bridge.campaign.spatial_game import Evasion
from tests.support import benchmark_record

RADIUS, HEIGHT = 2000.0, 1500.0  # [m]
PAPER = ("paper", "paper-own-air")


def ring(pursuers: int, seed: int, strategy: str) -> Scenario:
    """A closed ring of random phase."""
    replace, base = msgspec.structs.replace, spatial("six")
    phase = np.random.default_rng([77, seed, pursuers]).uniform(-pi, pi)
    team = []
    for k in range(pursuers):
        bearing = phase + 2.0 * pi * k / pursuers
        place = Vec(RADIUS * cos(bearing), RADIUS * sin(bearing), -HEIGHT)
        nose = yaw_of(lead(place, 40.0, Vec(0.0, 0.0, -HEIGHT), Vec(50.0, 0.0, 0.0)))
        team.append(
            replace(base.pursuers[0], position=(place.x, place.y, HEIGHT), heading_deg=degrees(nose),
                    strategy=strategy, id=None)
        )  # fmt: skip
    world = seed + 1
    wind = replace(base.flight.wind, from_deg=drawn_wind(world))
    flight = replace(base.flight, wind=wind)
    return replace(base, seed=world, pursuers=tuple(team), flight=flight)


def apart(game: Played) -> float:
    """How near any two pursuers came [m], at control steps."""
    places = game.log[:, 1:, :3]
    pairs = combinations(range(places.shape[1]), 2)
    return float(min(np.linalg.norm(places[:, i] - places[:, j], axis=1).min() for i, j in pairs))


def table(seeds: int, pursuers: int, ways: tuple[str, ...]) -> list[str]:
    """A line a way; every second one is compared with the one before."""
    separation = spatial("six").parameters.separation
    lines = [
        f"| {pursuers} pursuers | captured (95 %) | arrived | by this alone | by the one before alone | p |"
        f" two nearer than {separation:g} m | nearest two [m] |",
        "|---|---|---|---|---|---|---|---|",
    ]
    before: list[bool] = []
    for number, way in enumerate(ways):
        games = [play_seed(ring(pursuers, seed, way), 0, Evasion.STRATEGY) for seed in range(seeds)]
        captured = [game.verdict == GameResult.CAPTURED for game in games]
        arrived = sum(game.verdict == GameResult.ARRIVED for game in games)
        near = [apart(game) for game in games]
        pair = "| | | "
        if number % 2:
            won = sum(a and not b for a, b in zip(captured, before, strict=True))
            lost = sum(b and not a for a, b in zip(captured, before, strict=True))
            pair = f"| {won} | {lost} | {mcnemar(won, lost):.2g} "
        before = captured
        lines.append(
            f"| {way} | {share(sum(captured), seeds)} | {arrived} {pair}|"
            f" {sum(far < separation for far in near)} | {min(near):.0f} |"
        )
    return lines


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.own_air", description=__doc__)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--teams", type=int, nargs="+", default=[4, 5, 6])
    parser.add_argument("--ways", nargs="+", default=[*PAPER, "parallel-pursuit", "own-air"])
    parser.add_argument("--out", type=Path, default=Path("benchmarks/results/own-air.md"))
    given = parser.parse_args()
    teams = " ".join(map(str, given.teams))
    command = f"python -m tests.benchmarks.own_air --seeds {given.seeds} --teams {teams} --ways "
    text = ["# Gusts taken out of the own way\n"]
    text.append(f"`{command}{' '.join(given.ways)}` on {benchmark_record.machine()}, "
                f"NumPy {np.__version__}.\n")  # fmt: skip
    text.append(str(__doc__).split("\n\n", 2)[2].strip().replace("\n", " ") + "\n")
    for pursuers in given.teams:
        text += [*table(given.seeds, pursuers, tuple(given.ways)), ""]
        given.out.write_text("\n".join(text), encoding="utf-8")
    print(f"written: {given.out}")


if __name__ == "__main__":
    main()
