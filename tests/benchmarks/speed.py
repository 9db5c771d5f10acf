"""What whole programs cost now, beside earlier commits, in one run: a game in one process, a station.

Each state of the project, at the end HEAD, is unpacked into a folder and measured in processes of its own,
in turn and several times; the least CPU time of each counts. Games change from release to release, so a
game counts by the simulated second. `python -m tests.benchmarks.speed [--python INTERPRETER] [--rounds N]`.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from tests.benchmarks.campaign_speed import unpacked
from tests.support import benchmark_record

RELEASE, BEFORE = "c76e6d4", "3c9cbdc"  # version 0.1.0, and the last state before the work on speed
ENV = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
HEAD = """
from pathlib import Path
from tempfile import TemporaryDirectory
"""
GAME = """
try:
    from onboard.pilot.predictor_choice import Predicting
except ImportError:
    from onboard.pilot.predicting import Predicting  # its place until 0.1.0
from tests.benchmarks.bench_fly_fast import play
with TemporaryDirectory() as folder:
    game = play(Predicting("{predicting}"), Path(folder))
print(game.cpu_s / game.virtual_s, game.outcome)
"""
STATION = """
from tests.benchmarks import bench_recorder
bench_recorder.SECONDS = 8.0
with TemporaryDirectory() as folder:
    cost = bench_recorder.measure(bench_recorder.Load({vehicles}, False), Path(folder))
assert cost.recorded == cost.messages
print(cost.picture + cost.recorder, cost.messages, "messages, all recorded")
"""
WORK = {
    "`fly --fast demo`, constant velocity": (GAME.format(predicting="constant-velocity"), 3),
    "`fly --fast demo`, networks that learn": (GAME.format(predicting="network"), 2),
    "picture and recorder, 200 vehicles at 20 Hz": (STATION.format(vehicles=200), 3),
    "picture and recorder, 250 vehicles at 20 Hz": (STATION.format(vehicles=250), 1),
}  # what it is: the script, and how often


class State(NamedTuple):
    """The project at one time, under one interpreter."""

    name: str
    tree: Path
    python: str


class Cost(NamedTuple):
    """CPU-seconds a second of game or flight, and what the script said of it."""

    value: float
    words: str


def measure(state: State, script: str) -> Cost:
    """One process of its own. Raises CalledProcessError where it fails."""
    places = [str(state.tree), *{sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}]
    env = ENV | {"PYTHONPATH": os.pathsep.join(places)}
    command = [state.python, "-c", HEAD + script]
    done = subprocess.run(
        command, cwd=state.tree, env=env, check=True, capture_output=True, text=True, timeout=600.0
    )
    value, _, words = done.stdout.splitlines()[-1].partition(" ")
    return Cost(float(value), words)


def costs(states: list[State], only: str, rounds: int) -> dict[str, list[Cost]]:
    """The least cost of each piece of work, for every state."""
    found: dict[str, list[Cost]] = {}
    for name, (script, times) in WORK.items():
        if only not in name:
            continue
        seen: list[list[Cost]] = [[] for _ in states]
        for _ in range(min(times, rounds)):
            for index, state in enumerate(states):
                seen[index].append(measure(state, script))
        found[name] = [min(each) for each in seen]
        told = ", ".join(f"{s.name} {c.value:.4f}" for s, c in zip(states, found[name], strict=True))
        print(f"{name}: {told}", flush=True)
    return found


def page(states: list[State], found: dict[str, list[Cost]]) -> Iterator[str]:
    """The table, and what each state's game was."""
    yield "CPU-seconds a second of game (of flight for the station): the least of some processes, in turn; in"
    yield f"brackets how many times faster than {RELEASE} (0.1.0) and than {BEFORE}, before this work."
    yield ""
    yield "| what | " + " | ".join(state.name for state in states) + " |"
    yield "|---|" + "---|" * len(states)
    for name, each in found.items():
        first, before = each[0].value, each[1].value
        cells = [f"{cost.value:.4f} ({first / cost.value:.2f}, {before / cost.value:.2f})" for cost in each]
        yield f"| {name} | " + " | ".join(cells) + " |"
    yield ""
    for name, each in found.items():
        words = (f"{state.name}: {cost.words}" for state, cost in zip(states, each, strict=True))
        yield f"{name}: {'; '.join(words)}."
        yield ""
    yield f"{RELEASE} flew another game, with fewer rules, one log less a vehicle and no true tracks: its"
    yield f"figures say what a second of its game cost, not what the same work cost. {BEFORE} flies the same"
    yield "game; but for the configuration at the head of each file of events, the bytes are the same."


def main() -> None:
    """Measure, print and write down."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", default="", help="another interpreter: a column more (built with PGO)")
    parser.add_argument("--only", default="", help="what holds this word alone; writes no page")
    parser.add_argument("--rounds", type=int, default=9, help="no more processes of each than this")
    given = parser.parse_args()
    with TemporaryDirectory() as name:
        trees = {commit: unpacked(commit, Path(name) / commit) for commit in (RELEASE, BEFORE)}
        states = [State(commit, tree, sys.executable) for commit, tree in trees.items()]
        now = unpacked("HEAD", Path(name) / "now")
        states.append(State("now", now, sys.executable))
        if given.python:
            states.append(State(f"now, {given.python}", now, given.python))
        lines = list(page(states, costs(states, given.only, given.rounds)))
    print("\n".join(lines))
    if not given.only:
        command = "python -m tests.benchmarks.speed" + (f" --python {given.python}" if given.python else "")
        benchmark_record.write("speed.md", "What whole programs cost", command, lines)


if __name__ == "__main__":
    main()
