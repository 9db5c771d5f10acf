"""What games of a campaign cost, beside the commit BEFORE in the same run: `make bench-campaign`.

Every figure is CPU time. Both versions play the same seeds turn by turn, between two yardsticks: a fixed loop
of Python and one compiled by numba, whose rates say how fast the machine was. The page is
benchmarks/results/campaign.md.
"""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import tarfile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, NamedTuple

import numpy as np
import typer

from tests.benchmarks import yardstick
from tests.support import benchmark_record
from tests.support.paths import ROOT

BEFORE = "82b7eea"  # kernels cached nowhere, aircraft one by one, reversals in Python
COMMAND = "make bench-campaign"
CHILD = "tests/benchmarks/campaign_games.py"
HORIZON = 400.0  # [s] of the games of five


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
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        archive.extractall(folder, filter="data")
    return folder


def versus(before: Path, kind: str, rounds: int, games: int) -> list[str]:
    """Rows of a kind of game by both versions."""
    players = [Player(tree, kind, 5, HORIZON) for tree in (before, ROOT)]
    for player in players:
        player.ready()
    (old, new), (python, compiled) = beside(players, rounds, games)
    for player in players:
        player.end()
    what = {"flown": "spatial, aircraft, wind, noise", "plane": "plane", "space": "space, simple motion"}[
        kind
    ]
    rows = []
    for name, s in ((BEFORE, old), ("now", new)):
        share = f"{100 * s.captured / s.games:.1f} / {100 * s.arrived / s.games:.1f} %"
        rows.append(
            f"| {what} | {name} | {s.games:.0f} | {s.rate:,.1f} | {1.0 / s.step_us:.3f} M |"
            f" {share} | {old.step_us / s.step_us:.2f} | {new.rate / old.rate if s is new else 1:.2f} |"
            f" {python:.1f} / {compiled:.0f} |"
        )
        print(rows[-1], flush=True)
    return rows


def growth(sizes: list[int]) -> list[str]:
    """Rows of flown games of 60 s by the number of pursuers."""
    rows = []
    for count in sizes:
        player = Player(ROOT, "flown", count, 60.0)
        player.ready()
        (s,), _yards = beside([player], 3, 4)
        player.end()
        rows.append(f"| {count} | {s.step_us:.1f} | {s.step_us / (count + 1):.2f} |")
        print(rows[-1], flush=True)
    return rows


def main(
    rounds: Annotated[int, typer.Option(help="Turns of each version.")] = 8,
    games: Annotated[int, typer.Option(help="Flown games a turn.")] = 25,
    sizes: Annotated[str, typer.Option(help="Numbers of pursuers for the growth.")] = "2,5,10,20,50",
    kinds: Annotated[str, typer.Option(help="Games to compare.")] = "flown,plane,space",
) -> None:
    """Measure and write benchmarks/results/campaign.md."""
    lines = [
        f"Both versions play the same seeds in turn, {rounds} turns; rates are medians over the turns,",
        "in CPU time of a core. Yardsticks: millions of rounds a CPU-second of a loop, in Python and numba.",
        "What flies has changed on purpose in between (estimated wind, teams), so that single games differ.",
        "",
        "| games | version | played | games a CPU-second | game steps a core-second | captured / arrived |"
        " a step: times faster | a game: times faster | yardsticks |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    with TemporaryDirectory() as folder:
        before = unpacked(BEFORE, Path(folder))
        for kind in kinds.split(","):
            lines += versus(before, kind, rounds, games if kind == "flown" else 4000)
    lines += ["", "How a flown game of 60 s grows:", ""]
    lines += ["| pursuers | µs a control step | µs a vehicle and control step |", "|---|---|---|"]
    lines += growth([int(size) for size in sizes.split(",")])
    benchmark_record.write("campaign.md", "What games of a campaign cost", COMMAND, lines)


if __name__ == "__main__":
    typer.run(main)
