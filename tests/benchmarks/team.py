"""Who wins in space: teams against the paper's rules, the same seeds for every way.

    python -m tests.benchmarks.team --seeds 200 --jobs 2
    python -m tests.benchmarks.team --seeds 200 --fly 20

Aircraft, wind, gusts, sensor noise and delay as flown; the evader is the paper's. Resumable: each game leaves
a row in `--rows` with the fingerprint of the kernel that played it, and the page is made of the rows of
today's kernel. `--fly 20` flies that many seeds of each case besides, whole, with agents and messages, the
pursuers as a team, and computes each from the flight's states at t0. `--for` stops after as many seconds.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import combinations
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.core.strategy.team.closure import way_out
from onboard.game.scenario import Scenario
from onboard.pilot.predictor_choice import Predicting
from sim_bridge.campaign.fingerprint import fingerprint
from sim_bridge.campaign.machine import machine
from sim_bridge.campaign.spatial_campaign import Played, play_drawn
from sim_bridge.campaign.spatial_draw import draw
from sim_bridge.campaign.spatial_fixed import Sides
from sim_bridge.campaign.spatial_game import Chosen, Evasion
from sim_bridge.programs.scenario_band import situation_of
from tests.benchmarks.flown_computed import compute, fly
from tests.benchmarks.team_cases import CASES, Case, demand, game_of, near
from tests.benchmarks.team_page import flown_table, games_table, honesty, words
from tests.support.benchmark_record import write

WAYS = ("paper", "team")
SHARE = 20  # seeds of a case, then of the next: what is stopped early has as many of each
EVADING = tuple(EVADERS[name].decide for name in ("paper", "straight"))
PURSUING = tuple(PURSUERS[name].decide for name in WAYS)
Row = dict[str, Any]


class Job(NamedTuple):
    """A game to be played, or flown."""

    case: Case
    seed: int
    way: int
    flown: bool = False

    @property
    def key(self) -> tuple[str, int, str, bool]:
        """As its row has it."""
        return self.case.name, self.seed, WAYS[self.way], self.flown


def sides_of(count: int, way: int) -> Sides:
    """Both ways are in the same compiled kernel."""
    return Sides(EVADING, PURSUING, Chosen(0, (way,) * count))


def play(scenario: Scenario, way: int) -> Played:
    """One game computed."""
    sides = sides_of(len(scenario.pursuers), way)
    return play_drawn(draw(scenario, 0)._replace(sides=sides), Evasion.STRATEGY)


def apart(played: Played) -> float:
    """The least distance between two pursuers in a game [m]."""
    places = played.log[:, 1:, :3]
    pairs = combinations(range(places.shape[1]), 2)
    return float(min(np.linalg.norm(places[:, i] - places[:, j], axis=1).min() for i, j in pairs))


@cache
def sources() -> str:
    """Sixteen hexadecimal digits of everything that the kernel of these games contains."""
    return fingerprint(machine(EVADING, PURSUING, True))[:16]  # type: ignore[arg-type]


def row_of(job: Job) -> Row:
    """One game as a row."""
    began = time.process_time()
    scenario = game_of(job.case, job.seed)
    row = flight_of(scenario, job) if job.flown else game_row(scenario, job)
    return row | {"cpu": round(time.process_time() - began, 2), "sources": sources()}


def game_row(scenario: Scenario, job: Job) -> Row:
    """A computed game as a row."""
    band = way_out(situation_of(scenario, 0.0))
    played = play(scenario, job.way)
    return head(job) | {
        "verdict": played.verdict.name, "time": played.time, "smallest": played.smallest,
        "apart": apart(played), "separation": scenario.rules.separation, "closed": band.closed,
        "near": near(scenario),
    }  # fmt: skip


def flight_of(scenario: Scenario, job: Job) -> Row:
    """A flown game as a row, computed from its states at t₀ besides."""
    replace = msgspec.structs.replace
    team = tuple(replace(spec, strategy=WAYS[job.way]) for spec in scenario.pursuers)
    flight = replace(scenario.flight, prediction=Predicting.CONSTANT_VELOCITY)
    ready = replace(scenario, pursuers=team, flight=flight)
    f = fly(ready)
    c = compute(ready, 0, Evasion.STRATEGY, f, sides=sides_of(len(team), job.way))
    return head(job) | {
        "verdict": f.verdict.upper(), "time": f.time, "smallest": f.smallest, "apart": f.apart,
        "separation": scenario.rules.separation, "computed": c.verdict.name, "computed_time": c.time,
        "computed_smallest": c.smallest, "computed_apart": apart(c),
    }  # fmt: skip


def head(job: Job) -> Row:
    """Which game a row is of."""
    return {"case": job.case.name, "seed": job.seed, "way": WAYS[job.way], "flown": job.flown}


def jobs_of(cases: list[Case], seeds: int, flights: int) -> Iterator[Job]:
    """All games in order: of each case a share of the seeds, then the next share; the flights after them."""
    for first in range(1, seeds + 1, SHARE):
        for case in cases:
            for seed in range(first, min(first + SHARE, seeds + 1)):
                yield from (Job(case, seed, way) for way in range(len(WAYS)))
    for seed in range(1, flights + 1):
        yield from (Job(case, seed, len(WAYS) - 1, True) for case in cases)


def played(jobs: list[Job], workers: int) -> Iterator[Row]:
    """The rows of games, in order. Each number of pursuers is compiled before the workers are born."""
    if workers <= 1:
        yield from map(row_of, jobs)
        return
    for count in sorted({job.case.pursuers for job in jobs}):
        play(game_of(next(job.case for job in jobs if job.case.pursuers == count), 1), 0)
    with get_context("fork").Pool(workers) as pool:
        yield from pool.imap(row_of, jobs)


def read(path: Path) -> list[Row]:
    """The rows of today's kernel."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [row for row in map(json.loads, lines) if row.get("sources") == sources()]


def add(path: Path, rows: Iterable[Row], until: float) -> list[Row]:
    """Write rows down as they come, until an instant of the monotonic clock."""
    found = []
    with path.open("a", encoding="utf-8") as out:
        for row in rows:
            found.append(row)
            out.write(json.dumps(row) + "\n")
            out.flush()
            if time.monotonic() > until:
                break
    return found


def main() -> None:
    """Play what is missing and write the page."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(
        prog="python -m tests.benchmarks.team", description=__doc__, formatter_class=raw
    )
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--fly", type=int, default=0, help="seeds of each case that are flown besides")
    parser.add_argument("--jobs", type=int, default=1, help="games at a time")
    parser.add_argument("--for", dest="most", type=float, default=1e9, metavar="S", help="then stop playing")
    parser.add_argument("--cases", default=",".join(case.name for case in CASES))
    parser.add_argument("--rows", type=Path, default=Path(".bench-team.jsonl"))
    parser.add_argument("--page", default="team.md", help="in benchmarks/results; empty: none")
    given = parser.parse_args()
    rows = read(given.rows)
    have = {(r["case"], r["seed"], r["way"], r["flown"]) for r in rows}
    wanted = jobs_of([demand(name) for name in given.cases.split(",")], given.seeds, given.fly)
    missing = [job for job in wanted if job.key not in have]
    rows += add(given.rows, played(missing, given.jobs), time.monotonic() + given.most)
    games, flights = [[row for row in rows if row["flown"] is flown] for flown in (False, True)]
    lines = [*games_table(games), *honesty(games), *words(games, flights, given.seeds), *flown_table(flights)]
    print("\n".join(lines))
    if given.page:
        command = f"python -m tests.benchmarks.team --seeds {given.seeds}"
        command += f" --fly {given.fly}" if given.fly else ""
        write(given.page, "Teams in space", command, [*lines, "", f"Kernel `{sources()}`."])


if __name__ == "__main__":
    main()
