"""Every evader against every pursuers' strategy: captured and arrived, with Wilson's 95 % intervals.

`make bench-matrix`: in the plane encircled and open starts of five, in space closed rings of five aircraft of
random phase at 2 km in wind, with gusts and noise; the pursuers know the target. One start serves every pair.
A pair that was played stays in `--parts`; `--only` plays one kind, `--most` so many pairs more. Writes
benchmarks/results/matrix.md.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
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
from sim_bridge.campaign.spatial_draw import draw, kernel_of, log_of, sky_of, spatial
from sim_bridge.campaign.spatial_game import Chosen
from tests.support import benchmark_record

COUNT = 5
EVADING = ("paper", "dodge", "evasive")
PURSUING = ("team", "goalkeeper", "parallel-pursuit", "paper", "own-air", "blocking-line")
PAIRS = [(e, p) for p in PURSUING for e in EVADING]
KINDS = ("plane, encircled", "plane, open", "space, ring of 2 km")
PLANE = Rules(encircled.R, encircled.RHO, horizon=300.0, planar=True, target_known=True)
Pair = tuple[str, str]  # evader, pursuers
Ends = dict[Pair, list[int]]  # verdicts


def in_the_plane(kind: str, games: int, pairs: list[Pair]) -> Iterator[tuple[Pair, list[int]]]:
    """Games of the plane, all pairs from the same starts."""
    rng = np.random.default_rng(5)
    target = Target(True, encircled.TARGET)
    drawn = [encircled.draw_game(rng, COUNT, False, kind.endswith("encircled"), target) for _ in range(games)]
    starts = starts_of([game for game in drawn if game is not None], [encircled.TARGET] * games)
    conditions = Conditions(PLANE, target, Control(0.1))
    for e, p in pairs:
        ends = campaign(EVADERS[e].decide, PURSUERS[p].decide, COUNT)(starts, conditions)
        yield (e, p), [int(v) for v in ends.verdicts]


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
    known = replace(base.parameters, target_known=True)
    return replace(base, pursuers=tuple(pursuers), seed=1000 + seed, flight=flight, parameters=known)


def in_space(_kind: str, games: int, pairs: list[Pair]) -> Iterator[tuple[Pair, list[int]]]:
    """Games of aircraft, all pairs from the same starts; one kernel for those that are asked for."""
    evading, pursuing = (list(dict.fromkeys(names)) for names in zip(*pairs, strict=True))
    evaders = tuple(EVADERS[name].decide for name in evading)
    play = kernel_of(evaders, tuple(PURSUERS[name].decide for name in pursuing), True)
    for e, p in pairs:
        verdicts = []
        for seed in range(1, games + 1):
            d = draw(ring(seed), 0)
            chosen = Chosen(evading.index(e), (pursuing.index(p),) * COUNT)
            verdicts.append(int(play(d.start, chosen, sky_of(d, True), log_of(d)).game.score.verdict))
        yield (e, p), verdicts


def share(verdicts: list[int], verdict: GameResult) -> str:
    """`85 % (79–90)`."""
    count = sum(v == verdict for v in verdicts)
    low, high = binomtest(count, len(verdicts)).proportion_ci(method="wilson")
    return f"{100 * count / len(verdicts):.0f} % ({100 * low:.0f}–{100 * high:.0f})"


def table(kind: str, ends: Ends) -> list[str]:
    """One kind as Markdown: captured / arrived."""
    games = sorted({len(verdicts) for verdicts in ends.values()})
    pursuing = [p for p in PURSUING if any(pair[1] == p for pair in ends)]
    lines = [f"\n## {kind}: {' or '.join(map(str, games))} games a pair, captured / arrived\n"]
    lines.append(f"| evader | {' | '.join(pursuing)} |")
    lines.append("|---" * (1 + len(pursuing)) + "|")
    for e in EVADING:
        cells = []
        for p in pursuing:
            seen = ends.get((e, p))
            both = [share(seen, v) for v in (GameResult.CAPTURED, GameResult.ARRIVED)] if seen else ["–"]
            cells.append(" / ".join(both))
        lines.append(f"| {e} | {' | '.join(cells)} |")
    missing = [f"{p} against {e}" for p in PURSUING for e in EVADING if (e, p) not in ends]
    if missing:
        lines.append(f"\nNot played here: {', '.join(missing)}.")
    return lines


def main() -> None:
    """Play what is missing, write the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.matrix", description=__doc__)
    parser.add_argument("--plane", type=int, default=300, help="games a pair in the plane")
    parser.add_argument("--space", type=int, default=60, help="games a pair of aircraft")
    parser.add_argument("--parts", type=Path, default=Path(".matrix"))
    parser.add_argument("--only", type=int, choices=range(len(KINDS)), help="number of the one kind to play")
    parser.add_argument("--most", type=int, default=len(PAIRS), help="pairs of a kind that are played now")
    given = parser.parse_args()
    given.parts.mkdir(parents=True, exist_ok=True)
    lines = []
    for number, kind in enumerate(KINDS):
        games = given.space if kind.startswith("space") else given.plane
        paths = {(e, p): given.parts / f"{number}-{games}-{e}-{p}.json" for e, p in PAIRS}
        missing = [pair for pair in PAIRS if not paths[pair].exists()][: given.most]
        if missing and given.only in (None, number):
            play = in_space if kind.startswith("space") else in_the_plane
            for pair, verdicts in play(kind, games, missing):
                paths[pair].write_text(json.dumps(verdicts), encoding="utf-8")
        ends = {pair: json.loads(path.read_text("utf-8")) for pair, path in paths.items() if path.exists()}
        lines += table(kind, ends)
    command = f"python -m tests.benchmarks.matrix --plane {given.plane} --space {given.space}"
    head = f"Five pursuers; Wilson's 95 % intervals. γ = 0.8; plane: horizon {PLANE.horizon:g} s."
    benchmark_record.write("matrix.md", "Evaders against pursuers", command, [head, *lines])
    print("\n".join(lines))


if __name__ == "__main__":
    main()
