"""What games of a campaign cost, beside the commit BEFORE in the same run: `make bench-campaign`.

Every figure is CPU time. Both versions play the same seeds turn by turn, between two yardsticks: a fixed loop
of Python and one compiled by numba, whose rates say how fast the machine was. The page is
benchmarks/results/campaign.md.
"""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, NamedTuple

import numpy as np
import typer
from scipy.stats import binomtest, chi2_contingency, fisher_exact

from tests.benchmarks import yardstick
from tests.support import benchmark_record
from tests.support.paths import ROOT

BEFORE = "82b7eea"  # kernels cached nowhere, aircraft one by one, reversals in Python
COMMAND = "make bench-campaign"  # with options: `python -m tests.benchmarks.campaign_speed` and these
CHILD = "tests/benchmarks/campaign_games.py"
HORIZON = 400.0  # [s] of the flown games of five
SIMPLE = 4000  # games of simple motion a turn
NOTES = """
What it says, and what not:

- By a profile (perf, five pursuers) a flown game's time goes: supervisor 21 % (it looks ahead along the ways
  past a mate, as 82b7eea did not), aircraft 20 %, gusts 16 %, views and strategies 15 %, scalar sines and
  arctangents 11 %, Python around the kernel 8 %, sensor and filters 7 %, free rays 2 %. References to arrays
  are no longer counted. Decisions are still one vehicle at a time, and of eight lanes six are used.
- Games of simple motion with five pursuers spend most of a step on square roots and divisions: those of cones
  are had at once by vector instructions, those of meeting points and the referee one by one, behind branches.
  In space free rays are searched one cone after another (free-rays.md). Lanes over games: lanes-over-games.md
- Aircraft fly at 100 Hz; 40 Hz would be another grid of gusts than that of a flight, and is not offered.
""".strip().splitlines()


class Player:
    """A process that plays games by one version of the project."""

    def __init__(self, tree: Path, kind: str, count: int, horizon: float) -> None:
        """`tree`: where the version lies."""
        self.name = kind
        environment = {**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
        self._process = subprocess.Popen(
            [sys.executable, str(ROOT / CHILD), kind, str(count), str(horizon)],
            cwd=tree, env=environment, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        )  # fmt: skip

    def ready(self) -> None:
        """Wait until everything is compiled."""
        if self._line() != "ready":
            raise SystemExit(f"{self.name}: the games could not be played")

    def play(self, first: int, games: int) -> dict[str, float]:
        """The cost of games from a seed on."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps([first, games]) + "\n")
        self._process.stdin.flush()
        found: dict[str, float] = json.loads(self._line())
        return found

    def end(self) -> None:
        """No more games."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()

    def _line(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline().strip()


class Sum(NamedTuple):
    """What a version played in all rounds."""

    games: float
    steps: float
    captured: float
    arrived: float
    rate: float  # games a CPU-second, the median of the rounds
    step_us: float  # CPU microseconds a control step (a game step), the median


def beside(players: list[Player], rounds: int, games: int) -> tuple[list[Sum], tuple[float, float]]:
    """Rounds in turn; the sums of each player, and the medians of the yardsticks."""
    costs: list[list[dict[str, float]]] = [[] for _ in players]
    yards = []
    for number in range(rounds):
        yards.append(yardstick.rates())
        for player, cost in zip(players, costs, strict=True):
            cost.append(player.play(1 + number * games, games))
    sums = []
    for cost in costs:
        total = {key: sum(c[key] for c in cost) for key in cost[0]}
        rate = float(np.median([c["games"] / c["cpu_s"] for c in cost]))
        step = float(np.median([1e6 * c["cpu_s"] / c["steps"] for c in cost]))
        sums.append(Sum(total["games"], total["steps"], total["captured"], total["arrived"], rate, step))
    python, compiled = (float(np.median([y[k] for y in yards])) for k in (0, 1))
    return sums, (python, compiled)


def unpacked(commit: str, folder: Path) -> Path:
    """The project as of a commit, in a folder."""
    data = subprocess.run(["git", "archive", commit], cwd=ROOT, check=True, capture_output=True).stdout
    folder.mkdir(exist_ok=True)
    subprocess.run(["tar", "--extract", "--directory", str(folder)], input=data, check=True)
    return folder


KINDS = {"flown": "spatial, aircraft, wind, noise", "plane": "plane", "space": "space, simple motion"}


def share(count: float, games: float) -> str:
    """A share with its 95 % interval (Wilson)."""
    low, high = binomtest(round(count), round(games)).proportion_ci(method="wilson")
    return f"{100 * count / games:.1f} ({100 * low:.1f}–{100 * high:.1f})"


def alike(one: Sum, other: Sum) -> str:
    """The p-value of captured, arrived and neither in two samples (χ²; Fisher's for two kinds of end)."""
    table = np.array([[s.captured, s.arrived, s.games - s.captured - s.arrived] for s in (one, other)])
    table = table[:, table.any(axis=0)]
    if table.shape[1] == 1:
        return "1 (all end alike)"
    if table.shape[1] == 2:
        return f"{fisher_exact(table.astype(int)).pvalue:.2f}"
    return f"{chi2_contingency(table).pvalue:.2f}"


class Versus(NamedTuple):
    """Both versions beside each other."""

    rows: list[str]
    rate: float  # games a CPU-second, now


def versus(before: Path, kind: str, rounds: int, games: int) -> Versus:
    """Rows of a kind of game by both versions."""
    players = [Player(tree, kind, 5, HORIZON) for tree in (before, ROOT)]
    for player in players:
        player.ready()
    (old, new), (python, compiled) = beside(players, rounds, games)
    for player in players:
        player.end()
    rows = []
    for name, s in ((BEFORE, old), ("now", new)):
        rows.append(
            f"| {KINDS[kind]} | {name} | {s.games:.0f} | {s.rate:,.1f} | {1.0 / s.step_us:.3f} M |"
            f" {share(s.captured, s.games)} | {share(s.arrived, s.games)} | {alike(old, new)} |"
            f" {old.step_us / s.step_us:.2f} | {s.rate / old.rate:.2f} | {python:.1f} / {compiled:.0f} |"
        )
        print(rows[-1], flush=True)
    return Versus(rows, new.rate)


def whole(numbers: str) -> list[int]:
    """The numbers of a list with commas."""
    return [int(number) for number in numbers.split(",") if number]


def growth(kind: str, sizes: list[int], horizon: float) -> list[str]:
    """Rows of a kind of game by the number of pursuers."""
    rows = []
    for count in sizes:
        player = Player(ROOT, kind, count, horizon)
        player.ready()
        (s,), _yards = beside([player], 3, 4 if kind == "flown" else max(10, 2000 // count))
        player.end()
        each = s.step_us / (count + 1)
        rows.append(f"| {KINDS[kind]} | {count} | {s.rate:,.1f} | {s.step_us:.2f} | {each:.2f} |")
        print(rows[-1], flush=True)
    return rows


def cpu_of_children() -> float:
    """CPU time of all processes that have ended so far [s]."""
    spent = os.times()
    return spent.children_user + spent.children_system


def told_command(options: list[str]) -> str:
    """The command as it was given."""
    return shlex.join(["python", "-m", "tests.benchmarks.campaign_speed", *options]) if options else COMMAND


def paper_plan(games: float) -> str:
    """What 10⁹ games cost at so many games a CPU-second."""
    hours = 1e9 / games / 3600.0
    return f"{hours:,.0f} core-hours: {hours / 1000.0:,.0f} h on 1,000 cores"


def main(
    rounds: Annotated[int, typer.Option(help="Turns of each version.")] = 8,
    games: Annotated[int, typer.Option(help="Flown games a turn.")] = 25,
    sizes: Annotated[str, typer.Option(help="Numbers of pursuers for the growth.")] = "2,5,10,20,50",
    flown: Annotated[str, typer.Option(help="The same of flown games; each is compiled once.")] = "2,5,10",
    kinds: Annotated[str, typer.Option(help="Games to compare.")] = "flown,plane,space",
    short: Annotated[bool, typer.Option("--short", help="Few games, told and not written.")] = False,
) -> None:
    """Measure and write benchmarks/results/campaign.md."""
    if short:
        rounds, games, sizes, flown = 2, 4, "2,5", "5"
    plan = ""
    lines = [
        f"Both versions play the same seeds in turn, {rounds} turns; rates are medians over the turns, in CPU"
        " time of a core.",
        "Yardsticks: millions of rounds a CPU-second of a loop, in Python and numba.",
        "What flies has changed on purpose in between (estimated wind, teams), so that single games differ:",
        "shares in % with their 95 % intervals, p of a test that both end alike.",
        "",
        "| games | version | played | games a CPU-second | game steps a core-second | captured | arrived |"
        " p | a step: times faster | a game: times faster | yardsticks |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    with TemporaryDirectory() as folder:
        before = unpacked(BEFORE, Path(folder))
        for kind in kinds.split(","):
            found = versus(before, kind, rounds, games if kind == "flown" else SIMPLE)
            lines += found.rows
            if kind == "flown":
                plan = paper_plan(found.rate)
    lines += ["", "How games grow, by this version (of 60 s with aircraft; in simple motion of 40 s):", ""]
    lines += [
        "| games | pursuers | games a CPU-second | µs a step | µs a vehicle and step |",
        "|---|---|---|---|---|",
    ]
    lines += growth("space", whole(sizes), HORIZON) + growth("flown", whole(flown), 60.0)
    if plan:
        lines += ["", f"On paper, 10⁹ flown games of five pursuers at this rate: {plan}."]
    lines += ["", *NOTES]
    lines[0] += f" All of it took {cpu_of_children():.0f} CPU-seconds, compiling included."
    if short:
        print("\n".join(lines))
        return
    benchmark_record.write("campaign.md", "What games of a campaign cost", told_command(sys.argv[1:]), lines)


if __name__ == "__main__":
    typer.run(main)
