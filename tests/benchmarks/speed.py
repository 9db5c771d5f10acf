"""What programs cost now, beside earlier commits, in one run: games, a station, compiled games, agents.

Each state of the project, at the end HEAD, is unpacked into a folder and measured in processes of its own,
in turn and several times; the least cost of each counts. Games change from release to release, so a game
counts by the simulated second. `python -m tests.benchmarks.speed [--python INTERPRETER] [--rounds N]` writes
benchmarks/results/speed.md whole, in a quarter of an hour on a quiet machine.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic
from typing import NamedTuple

from tests.benchmarks.campaign_speed import unpacked
from tests.benchmarks.speed_work import GOALS, HEAD, Wanted, Work, work
from tests.support import benchmark_record

RELEASE, BEFORE = "c76e6d4", "3c9cbdc"  # version 0.1.0, and the last state before the work on speed
ENV = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
SCALES = {"µs": 1e6}  # of seconds
FEW = 3  # digits


class State(NamedTuple):
    """The project at one time, under one interpreter."""

    name: str
    tree: Path
    python: str


class Cost(NamedTuple):
    """The least of some processes, and what the script said."""

    value: float
    words: str


Found = dict[str, dict[str, Cost]]  # by row, by the state's name


def measure(state: State, script: str) -> dict[str, Cost]:
    """One process of its own. Raises CalledProcessError where it fails."""
    places = [str(state.tree), *{sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}]
    env = ENV | {"PYTHONPATH": os.pathsep.join(places)}
    command = [state.python, "-c", HEAD + script]
    done = subprocess.run(
        command, cwd=state.tree, env=env, check=True, stdout=subprocess.PIPE, text=True, timeout=900.0
    )
    rows, _, words = done.stdout.splitlines()[-1].partition("\t")
    return {row: Cost(value, words) for row, value in json.loads(rows).items()}


def turns(states: list[State], one: Work, rounds: int) -> Iterator[State]:
    """Who is measured, turn by turn."""
    for turn in range(min(one.times, rounds)):
        for state in states:
            old, other = state is not states[-1] and state.python == sys.executable, "," in state.name
            if (one.newest and old) or (other and not one.other):
                continue
            if one.once and (state.name == BEFORE or (turn and state.name == RELEASE)):
                continue
            yield state


def costs(states: list[State], only: str, rounds: int, pieces: list[Work]) -> Found:
    """The least cost of every row, for every state measured. Old ones may fail with today's libraries:
    they are left out. Raises what `measure` does where the newest fails."""
    found: Found = {}
    for one in pieces:
        if only and only not in one.script:
            continue
        for state in turns(states, one, rounds):
            begun = monotonic()
            try:
                rows = measure(state, one.script)
            except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as problem:
                if state.name == "now":
                    raise
                print(f"{state.name} failed, its cells stay empty: {str(problem)[-300:]}", flush=True)
                continue
            for row, cost in rows.items():
                seen = found.setdefault(row, {})
                seen[state.name] = min(cost, seen.get(state.name, cost))
                print(f"{row}, {state.name}: {cost.value:.4g} {cost.words}", flush=True)
            print(f"  ({monotonic() - begun:.0f} s)", flush=True)
    return found


def cell(value: float, unit: str) -> str:
    """A cost in its unit."""
    return f"{100.0 * value:.1f} %" if unit == "of a core" else f"{value * SCALES.get(unit, 1.0):.{FEW}g}"


def judged(row: str, each: dict[str, Cost]) -> str:
    """What is wanted of a row, and whether it is met."""
    wanted = GOALS.get(row, Wanted())
    now = each["now"].value if "now" in each else float("nan")
    said = []
    if wanted.most:
        said.append(f"{cell(wanted.most, wanted.unit)}: {'met' if now <= wanted.most else '**missed**'}")
    for least, name in ((wanted.times, "now"), (wanted.optimised, _other(each))):
        if least and name in each and RELEASE in each:
            times = each[RELEASE].value / each[name].value
            where = "" if name == "now" else " with PGO"
            said.append(f"{least:.2g}{where}: {'met' if times >= least else '**missed**'}")
    return "; ".join(said)


def _other(each: dict[str, Cost]) -> str:
    return next((name for name in each if name.startswith("now,")), "")


def page(names: list[str], found: Found) -> Iterator[str]:
    """The table, and what each state's game was."""
    yield "The least of some processes, in turn; in brackets how many times less than"
    yield f"{RELEASE} (0.1.0) and than {BEFORE}, before this work. Games and station: CPU-seconds a second of"
    yield "game or flight. Agents: real processes beside a simulated game of six; their answers from the"
    yield "position's datagram to the setpoint, stamped by the kernel: a round's median over that of a bare"
    yield "asyncio echo in the same round."
    yield ""
    yield "| what | unit | " + " | ".join(names) + " | wanted |"
    yield "|---|---|" + "---|" * (len(names) + 1)
    for row, each in found.items():
        unit = GOALS.get(row, Wanted()).unit
        yield f"| {row} | {unit} | {' | '.join(_cells(names, each, unit))} | {judged(row, each)} |"
    yield ""
    for row, each in found.items():
        words = [f"{name}: {cost.words}" for name, cost in each.items() if cost.words]
        if words:
            yield f"{row}: {'; '.join(words)}."
            yield ""
    yield f"{RELEASE} flew another game, with fewer rules, one log less a vehicle and no true tracks: its"
    yield f"figures say what a second of its game cost, not what the same work cost. {BEFORE} flies the same"
    yield "game as now but for the configuration at the head of each file of events, and for what changed on"
    yield "purpose since (CHANGELOG)."


def _cells(names: list[str], each: dict[str, Cost], unit: str) -> Iterator[str]:
    for name in names:
        if name not in each:
            yield "–"
            continue
        value = each[name].value
        ratios = [
            f"{each[old].value / value:.2f}" for old in (RELEASE, BEFORE) if old in each and old != name
        ]
        yield cell(value, unit) + (f" ({', '.join(ratios)})" if ratios and name not in (RELEASE,) else "")


def main() -> None:
    """Measure, print and write down."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", default="", help="another interpreter: a column more (built with PGO)")
    parser.add_argument("--only", default="", help="scripts that hold this word alone; writes no page")
    parser.add_argument("--rounds", type=int, default=9, help="no more processes of each than this")
    parser.add_argument("--short", action="store_true", help="HEAD alone, a second of each; writes no page")
    given = parser.parse_args()
    with TemporaryDirectory() as name:
        old = [] if given.short else [RELEASE, BEFORE]
        states = [State(c, unpacked(c, Path(name) / c), sys.executable) for c in old]
        now = unpacked("HEAD", Path(name) / "now")
        if given.python:
            states.append(State(f"now, {given.python}", now, given.python))
        states.append(State("now", now, sys.executable))
        found = costs(states, given.only, 1 if given.short else given.rounds, work(given.short))
    names = [state.name for state in states]
    lines = list(page(names, found))
    print("\n".join(lines))
    if not given.only and not given.short:
        command = "python -m tests.benchmarks.speed" + (f" --python {given.python}" if given.python else "")
        benchmark_record.write("speed.md", "What programs cost", command, lines)


if __name__ == "__main__":
    main()
