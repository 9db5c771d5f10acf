"""Every evader against every pursuers' strategy: captured and arrived, with Wilson's 95 % intervals.

`make bench-matrix`: in the plane encircled and open starts of five, in space closed rings of five aircraft of
random phase at 2 km in wind, with gusts and noise. One start serves every pair. A part that was played stays
in `--parts`; `--only` plays one kind. Writes benchmarks/results/matrix.md.
"""

from __future__ import annotations

import argparse
import json
from math import atan2, cos, degrees, pi, sin
from pathlib import Path

import msgspec
import numpy as np
from scipy.stats import binomtest

from onboard.core.game.advance import Conditions
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.geometry.lead import lead
from onboard.core.math.vectors import Vec
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.scenario import Scenario
from sim_bridge.campaign import encircled
from sim_bridge.campaign.compiled import campaign, starts_of
from sim_bridge.campaign.plane_in_wind import drawn_wind
from sim_bridge.campaign.spatial_draw import draw, kernel_of, sky_of, spatial
from sim_bridge.campaign.spatial_game import Chosen
from tests.support import benchmark_record
from tests.support.paths import RESULTS

COUNT = 5
EVADING = ("paper", "dodge", "evasive")
PURSUING = ("paper", "parallel-pursuit", "own-air")
KINDS = ("plane, encircled", "plane, open", "space, ring of 2 km")
PLANE = Rules(encircled.R, encircled.RHO, horizon=300.0, planar=True)
Ends = dict[str, list[int]]  # verdicts by "evader pursuers"


def in_the_plane(kind: str, games: int) -> Ends:
    """Games of the plane, all pairs from the same starts."""
    rng = np.random.default_rng(5)
    target = Target(True, encircled.TARGET)
    drawn = [encircled.draw_game(rng, COUNT, False, kind.endswith("encircled"), target) for _ in range(games)]
    starts = starts_of([game for game in drawn if game is not None], [encircled.TARGET] * games)
    conditions = Conditions(PLANE, target, Control(0.1))
    found = {}
    for p in PURSUING:
        for e in EVADING:
            ends = campaign(EVADERS[e].decide, PURSUERS[p].decide, COUNT)(starts, conditions)
            found[f"{e} {p}"] = [int(v) for v in ends.verdicts]
    return found


def ring(seed: int) -> Scenario:
    """A closed ring of random phase about the evader of `spatial/five`, noses on parallel pursuit."""
    base = spatial("five")
    replace = msgspec.structs.replace
    phase = float(np.random.default_rng([7, seed]).uniform(0.0, 2.0 * pi))
    pursuers = []
    for k in range(COUNT):
        a = phase + 2.0 * pi * k / COUNT
        place = Vec(2000.0 * cos(a), 2000.0 * sin(a), -1500.0)
        nose = lead(place, 40.0, Vec(0.0, 0.0, -1500.0), Vec(50.0, 0.0, 0.0))
        told = degrees(atan2(nose.y, nose.x))
        spec = base.pursuers[0]
        pursuers.append(replace(spec, position=(place.x, place.y, 1500.0), heading_deg=told))
    wind = replace(base.flight.wind, from_deg=drawn_wind(1000 + seed))
    flight = replace(base.flight, wind=wind)
    return replace(base, pursuers=tuple(pursuers), seed=1000 + seed, flight=flight)


def in_space(_kind: str, games: int) -> Ends:
    """Games of aircraft, all pairs from the same starts; one kernel for all of them."""
    evaders = tuple(EVADERS[name].decide for name in EVADING)
    play = kernel_of(evaders, tuple(PURSUERS[name].decide for name in PURSUING), True)
    found: Ends = {f"{e} {p}": [] for p in PURSUING for e in EVADING}
    for seed in range(1, games + 1):
        scenario = ring(seed)
        for j, p in enumerate(PURSUING):
            for i, e in enumerate(EVADING):
                d = draw(scenario, 0)
                log = np.zeros((d.steps, COUNT + 1, 5))
                end = play(d.start, Chosen(i, (j,) * COUNT), sky_of(d, True), log)
                found[f"{e} {p}"].append(int(end.game.score.verdict))
    return found


def share(verdicts: list[int], verdict: GameResult) -> str:
    """`85 % (79–90)`."""
    count = sum(v == verdict for v in verdicts)
    low, high = binomtest(count, len(verdicts)).proportion_ci(method="wilson")
    return f"{100 * count / len(verdicts):.0f} % ({100 * low:.0f}–{100 * high:.0f})"


def table(kind: str, ends: Ends) -> list[str]:
    """One kind as Markdown: captured / arrived."""
    games = len(next(iter(ends.values())))
    pursuing = list(dict.fromkeys(pair.split()[1] for pair in ends))
    evading = list(dict.fromkeys(pair.split()[0] for pair in ends))
    lines = [f"\n## {kind}: {games} games a pair, captured / arrived\n"]
    lines.append(f"| evader | {' | '.join(pursuing)} |")
    lines.append("|---" * (1 + len(pursuing)) + "|")
    for e in evading:
        cells = [
            f"{share(ends[f'{e} {p}'], GameResult.CAPTURED)} / {share(ends[f'{e} {p}'], GameResult.ARRIVED)}"
            for p in pursuing
        ]
        lines.append(f"| {e} | {' | '.join(cells)} |")
    return lines


def main() -> None:
    """Play what is missing, write the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.matrix", description=__doc__)
    parser.add_argument("--plane", type=int, default=300, help="games a pair in the plane")
    parser.add_argument("--space", type=int, default=60, help="games a pair of aircraft")
    parser.add_argument("--parts", type=Path, default=Path(".matrix"))
    parser.add_argument("--only", type=int, choices=range(len(KINDS)), help="number of the one kind to play")
    given = parser.parse_args()
    given.parts.mkdir(parents=True, exist_ok=True)
    lines = []
    for number, kind in enumerate(KINDS):
        games = given.space if kind.startswith("space") else given.plane
        path = given.parts / f"{number}-{games}.json"
        if not path.exists() and given.only in (None, number):
            ends = (in_space if kind.startswith("space") else in_the_plane)(kind, games)
            path.write_text(json.dumps(ends), encoding="utf-8")
        if path.exists():
            lines += table(kind, json.loads(path.read_text(encoding="utf-8")))
    command = f"python -m tests.benchmarks.matrix --plane {given.plane} --space {given.space}"
    head = ["# Evaders against pursuers", "", f"`{command}` on {benchmark_record.machine()}."]
    head.append(f"Five pursuers; Wilson's 95 % intervals. γ = 0.8; plane: horizon {PLANE.horizon:g} s.")
    (RESULTS / "matrix.md").write_text("\n".join(head + lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
