"""What a team's goals are worth: the same games with its knowledge model and without.

    python -m tests.benchmarks.knowledge --games 1000 --seeds 40

Plane: five pursuers against the paper's evader as in `team_plane` (5 m/s, R = 2 m, ρ = 4 m, 300 s). Random
and staged: its games. Mixed: pursuers of 1.5 to 4.9 m/s. Lost: random games in which one of the five,
drawn, is lost within the first minute. Rings, one lost: its rings, within 20 s. Two targets: another one 60
to 200 m away; the team without a model is told which of them the evader goes for. Space: the cases of
`team`, flown by the compiled kernel; each game leaves a row in `--rows`, so that what was stopped goes on.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import Conditions
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Target
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.registry import EVADERS
from onboard.game.plugins import pursuer_strategy
from onboard.game.team_knowledge import planner
from sim_bridge.campaign.compiled import starts_of
from sim_bridge.campaign.fingerprint import fingerprint
from sim_bridge.campaign.machine import machine
from sim_bridge.campaign.spatial_campaign import mcnemar, play_drawn, share
from sim_bridge.campaign.spatial_draw import draw
from sim_bridge.campaign.spatial_fixed import Sides
from sim_bridge.campaign.spatial_game import Chosen, Evasion
from tests.benchmarks import team_plane as plane
from tests.benchmarks.knowledge_play import Ended, Trials, player
from tests.benchmarks.team_cases import CASES, game_of
from tests.support.benchmark_record import write

WAYS = ("team:plain", "team")
KEPT = (GameResult.CAPTURED, GameResult.DENIED)
SLOW, FAST = 1.5, 4.9  # [m/s] of mixed teams
LOST_BY, RING_LOST_BY = 60.0, 20.0  # [s]
HOW_TO_READ = """Without and with the model; `better`, `worse`: games that end better with it, and worse, \
of the same start. p by McNemar's exact test. Captured, or denied at the horizon, is what pursuers want; \
denied means that every target is held then. The rules were chosen on other draws of the families with a \
lost pursuer or two targets."""
Row = dict[str, Any]


def trials_of(drawn: plane.Drawn, seed: int, lost_by: float = 0.0, two: bool = False) -> Trials:
    """Drawn games as trials; with `lost_by` one pursuer of each is lost until then [s]."""
    rng = np.random.default_rng(seed)
    n = len(drawn.games)
    lost = np.full((n, plane.TEAM), np.inf)
    if lost_by > 0.0:
        lost[np.arange(n), rng.integers(0, plane.TEAM, n)] = rng.uniform(0.0, lost_by, n)
    targets = np.full((n, 2, 3), np.nan)
    targets[:, 0] = drawn.targets
    if two:
        targets[:, 1] = [plane._around(rng, 60.0, 200.0) for _ in range(n)]
    return Trials(starts_of(drawn.games, drawn.targets), targets, lost)


def mixed(count: int) -> plane.Drawn:
    """Random games of teams whose members differ much in speed."""
    rng = np.random.default_rng(21)
    games, targets = [], list[Vec]()
    for _ in range(count):
        places = [plane._around(rng, plane.NEAR, plane.FAR) for _ in range(plane.TEAM)]
        games.append(plane._game(places, [float(v) for v in rng.uniform(SLOW, FAST, plane.TEAM)]))
        targets.append(plane._around(rng, 60.0, 200.0))
    return plane.Drawn(games, targets)


FAMILIES: dict[str, Callable[[int], Trials]] = {
    "random": lambda n: trials_of(plane.random_games(n), 1),
    "rings": lambda n: trials_of(plane.rings(n // 2), 2),
    "staged": lambda n: trials_of(plane.staged(plane.random_games(n)), 3),
    "mixed speeds": lambda n: trials_of(mixed(n), 4),
    "one lost": lambda n: trials_of(plane.random_games(n, 31), 45, LOST_BY),
    "rings, one lost": lambda n: trials_of(plane.rings(n // 2, 32), 46, RING_LOST_BY),
    "two targets": lambda n: trials_of(plane.random_games(n, 33), 47, two=True),
    "two targets, one lost": lambda n: trials_of(plane.random_games(n, 34), 48, LOST_BY, two=True),
    "staged, two targets": lambda n: trials_of(plane.staged(plane.random_games(n, 35)), 49, two=True),
}


def verdicts(trials: Trials, way: str) -> NDArray[np.int64]:
    """How each game ends when the pursuers fly one way."""
    n = len(trials.lost)
    ends = Ended(np.zeros(n, np.int64), np.zeros(n))
    conditions = Conditions(plane.RULES, Target(True, ZERO), Control(plane.STEP))
    play = player((EVADERS["paper"].decide, pursuer_strategy(way)), planner(way), plane.TEAM)
    play(trials, conditions, ends)
    return ends.verdicts


class Pair(NamedTuple):
    """How the same games end without the model and with it."""

    name: str
    plain: NDArray[np.int64]
    team: NDArray[np.int64]

    def row(self) -> str:
        """As a line of the table."""
        n = len(self.plain)
        cells = [self.name, str(n)]
        for results, good in (((GameResult.CAPTURED,), True), ((GameResult.ARRIVED,), False), (KEPT, True)):
            a, b = np.isin(self.plain, results), np.isin(self.team, results)
            better, worse = int(np.sum(b & ~a)), int(np.sum(a & ~b))
            better, worse = (better, worse) if good else (worse, better)
            cells += [share(int(a.sum()), n), share(int(b.sum()), n),
                      f"{better}, {worse}; {mcnemar(better, worse):.1e}"]  # fmt: skip
        return f"| {' | '.join(cells)} |"


def table(pairs: list[Pair]) -> list[str]:
    """All families."""
    heads = ["captured", "arrived", "captured or denied"]
    each = " | ".join(f"{head}: without | with | better, worse; p" for head in heads)
    return [f"| family | games | {each} |", "|" + "---|" * 11, *(pair.row() for pair in pairs)]


@cache
def kernel_of(way: str) -> str:
    """Sixteen digits of what the spatial kernel of a way contains."""
    found = machine((EVADERS["paper"].decide, EVADERS["straight"].decide), (pursuer_strategy(way),), True)
    return fingerprint(found)[:16]  # type: ignore[arg-type]


def space(seeds: int, rows: Path, until: float) -> list[Pair]:
    """The spatial cases, as far as they were played; both ways of as many seeds."""
    lines = rows.read_text(encoding="utf-8").splitlines() if rows.exists() else []
    kernels = {way: kernel_of(way) for way in WAYS}
    have = {(r["case"], r["seed"], r["way"]): r for r in map(json.loads, lines)
            if r["sources"] == kernels.get(r["way"])}  # fmt: skip
    evaders = EVADERS["paper"].decide, EVADERS["straight"].decide
    wanted = ((c, w, s) for c in sorted(CASES, key=lambda c: c.pursuers) for w in WAYS
              for s in range(1, seeds + 1))  # fmt: skip
    with rows.open("a", encoding="utf-8") as out:
        for case, way, seed in wanted:
            if (case.name, seed, way) in have or time.monotonic() > until:
                continue
            scenario = game_of(case, seed)
            sides = Sides(evaders, (pursuer_strategy(way),), Chosen(0, (0,) * len(scenario.pursuers)))
            played = play_drawn(draw(scenario, 0)._replace(sides=sides), Evasion.STRATEGY)
            row: Row = {"case": case.name, "seed": seed, "way": way, "verdict": int(played.verdict),
                        "time": played.time, "sources": kernels[way]}  # fmt: skip
            have[case.name, seed, way] = row
            out.write(json.dumps(row) + "\n")
    found = []
    for case in CASES:
        both = [s for s in range(1, seeds + 1) if all((case.name, s, way) in have for way in WAYS)]
        ends = [np.array([have[case.name, s, way]["verdict"] for s in both], np.int64) for way in WAYS]
        if both:
            found.append(Pair(case.words, *ends))
    return found


def main() -> None:
    """Play and write the page."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.benchmarks.knowledge", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("--games", type=int, default=1000, help="of each plane family")
    parser.add_argument("--seeds", type=int, default=40, help="of each case in space; 0: none")
    parser.add_argument("--for", dest="most", type=float, default=1e9, metavar="S", help="then stop in space")
    parser.add_argument("--rows", type=Path, default=Path(".bench-knowledge.jsonl"))
    parser.add_argument("--page", default="knowledge.md", help="in benchmarks/results; empty: none")
    given = parser.parse_args()
    until = time.monotonic() + given.most
    lines = ["## On the plane", ""]
    pairs = [Pair(name, *(verdicts(trials, way) for way in WAYS))
             for name, trials in ((name, make(given.games)) for name, make in FAMILIES.items())]  # fmt: skip
    lines += table(pairs)
    if given.seeds > 0 and (found := space(given.seeds, given.rows, until)):
        lines += ["", "## In space", "", *table(found)]
    words = (__doc__ or "").split("\n\n", 2)[2].strip().replace("\n", " ")
    lines += ["", words, "", HOW_TO_READ]
    print("\n".join(lines))
    if given.page:
        command = f"python -m tests.benchmarks.knowledge --games {given.games} --seeds {given.seeds}"
        write(given.page, "What a team's goals are worth", command, lines)


if __name__ == "__main__":
    main()
