"""What `tests.benchmarks.speed` measures: scripts for processes of their own, and what is wanted of each row.

A script runs in the tree of one state of the project, prints one line that is a JSON object of rows and costs
(less is better), and words after it. Names moved since 0.1.0: a script tries today's first.
"""

from __future__ import annotations

from typing import NamedTuple

HEAD = """
import asyncio, importlib.util, json, sys, time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

def tell(rows, words=""):
    print(json.dumps(rows), words, sep="\\t", flush=True)
"""
GAME = """
try:
    from onboard.pilot.predictor_choice import Predicting
except ImportError:
    from onboard.pilot.predicting import Predicting
from tests.benchmarks.bench_fly_fast import play
with TemporaryDirectory() as folder:
    game = play(Predicting("{predicting}"), Path(folder))
tell({{"{row}": game.cpu_s / game.virtual_s}}, game.outcome)
"""
STATION = """
from tests.benchmarks import bench_recorder
chase = bench_recorder.chase  # of its own state
keep = {every}  # one message of so many
vehicles, seconds = {vehicles}, {seconds}

def fewer(*given, **named):
    seen = {{}}
    for item in chase(*given, **named):
        seen[item[0]] = seen.get(item[0], -1) + 1
        if seen[item[0]] % keep == 0:
            yield item

bench_recorder.SECONDS, bench_recorder.chase = seconds, fewer
with TemporaryDirectory() as folder:
    cost = bench_recorder.measure(bench_recorder.Load(vehicles, False), Path(folder))
assert cost.recorded == cost.messages
tell({{"{row}": cost.picture + cost.recorder}}, f"{{cost.messages}} messages, all recorded")
"""
CORE = """
try:
    from onboard.core.game.advance import Conditions, begin
    from onboard.core.game.rules import Control, Rules, Target
    from onboard.core.math.states import FREE, Vehicle
    from onboard.core.math.vectors import NORTH, ZERO, Vec, scale, unit
    from onboard.core.strategy.evasion import evader
    from onboard.core.strategy.pursuit import pursuer
    from sim_bridge.campaign.compiled import campaign, starts_of
    GOAL = Vec(300.0, 0.0, 0.0)
    given = Conditions(Rules(R=2.0, rho=4.0), Target(True, GOAL), Control())
except ImportError:
    from tests.benchmarks.bench_core import *
    GOAL = TARGET
    given = Params(2.0, 4.0, 100.0, 1.0, 1.0, 0.05, 100.0, 0.0, False, True, GOAL)
import numpy as np

def starts(games, pursuers):
    rng, made = np.random.default_rng(pursuers), []
    for _ in range(games):
        team = []
        for _ in range(pursuers):
            way = unit(Vec(*map(float, rng.standard_normal(3))), NORTH)
            team.append(Vehicle(scale(way, float(rng.uniform(20.0, 200.0))), scale(way, -4.0), 4.0))
        made.append(begin(Vehicle(ZERO, scale(NORTH, 5.0), 5.0), tuple(team), FREE, (FREE,) * pursuers))
    return starts_of(made, [GOAL] * games)

n = {pursuers}
play = campaign(evader, pursuer, n)
play(starts(2, n), given)
started = time.process_time()  # with all imports
at = starts(max(6, 600 // n), n)
ends, best = play(at, given), float("inf")
for _ in range(7):
    begun = time.process_time()
    play(at, given)
    best = min(best, time.process_time() - begun)
steps = int(ends.steps.sum())
rows = {{"{row}": best / steps}}
if n == 5:
    rows["start of compiled play, kernels on disk"] = started
tell(rows, f"{{steps}} steps")
"""
AGENT = """
import os
place = TemporaryDirectory()
if {plain}:  # agents find no uvloop
    Path(place.name, "uvloop.py").write_text("raise ImportError")
    os.environ["PYTHONPATH"] = os.pathsep.join((place.name, os.environ["PYTHONPATH"]))
from tests.benchmarks import bench_agent
bench_agent.LOOK_S = {seconds}
rows, loop = {{}}, ", asyncio's own loop" if {plain} else ""
for one in bench_agent.resources():
    rows[f"share of a core at 20 Hz, {{one.role}}{{loop}}"] = one.core
    rows[f"memory of an agent [MB], {{one.role}}{{loop}}"] = one.memory_later_mb
tell(rows)
"""
ANSWER = """
from tests.benchmarks import bench_agent
bench_agent.ROUND_S, bench_agent.STAGED_S = {seconds}, 6.0

async def rounds():
    found = {{}}
    with TemporaryDirectory() as folder:
        for kind in bench_agent.KINDS:
            if kind == "mavsdk" and importlib.util.find_spec("mavsdk") is None:
                continue
            for _ in range(3):  # on a busy machine it may start too late for the staging
                try:
                    found[kind] = median(await bench_agent.latency(kind, Path(folder))) / 1e3
                    break
                except TimeoutError as late:
                    print(late, file=sys.stderr)
    return found

found = asyncio.run(rounds())
rows = {{"a bare echo's answer [s]": found["echo"] / 1e6}}
for kind, took in found.items():
    if kind != "echo":
        rows[f"position to setpoint, times the echo: {{kind}}"] = took / found["echo"]
tell(rows)
"""


class Work(NamedTuple):
    """A piece of work."""

    script: str
    times: int  # processes of each state; the least of each row counts
    once: bool = False  # the oldest state is measured once, the one before this work not at all: they compile
    newest: bool = False  # of the newest state alone: what the others cannot
    other: bool = True  # under another interpreter as well


class Wanted(NamedTuple):
    """What is wanted of a row."""

    times: float = 0.0  # so many times less than 0.1.0; 0: nothing
    optimised: float = 0.0  # the same under an interpreter built with PGO
    most: float = 0.0  # the cost itself at most; 0: nothing
    unit: str = "CPU-s a second"


ECHO = "position to setpoint, times the echo: "
GOALS = {
    "`fly --fast demo`, constant velocity": Wanted(1.7, 2.2),
    "`fly --fast demo`, networks that learn": Wanted(1.7, 2.2),
    "picture and recorder, 200 vehicles at 20 Hz": Wanted(26.0 / 16.0, unit="of a core"),
    "picture and recorder, 1000 vehicles at 5 Hz": Wanted(unit="of a core"),
    "compiled core, 5 pursuers, a game step": Wanted(1.5, unit="µs"),
    "compiled core, 20 pursuers, a game step": Wanted(2.0, unit="µs"),
    "compiled core, 50 pursuers, a game step": Wanted(2.0, unit="µs"),
    "start of compiled play, kernels on disk": Wanted(most=1.0, unit="CPU-s"),
    ECHO + "agent": Wanted(most=2.0, unit="times"),
    ECHO + "agent, ahead": Wanted(most=2.0, unit="times"),
    ECHO + "agent, signed": Wanted(most=2.3, unit="times"),
    ECHO + "agent, signed, ahead": Wanted(most=2.3, unit="times"),
    ECHO + "mavsdk": Wanted(unit="times"),
    "a bare echo's answer [s]": Wanted(unit="µs"),
    "share of a core at 20 Hz, pursuer": Wanted(most=0.045, unit="of a core"),
    "share of a core at 20 Hz, evader": Wanted(unit="of a core"),
    "memory of an agent [MB], pursuer": Wanted(most=65.0, unit="MB"),
    "memory of an agent [MB], evader": Wanted(unit="MB"),
}
GOALS |= {f"{row}, asyncio's own loop": GOALS[row] for row in list(GOALS)[-4:]}


def work(short: bool = False) -> list[Work]:
    """All of it; `short`: a second or so of each, to see that it works."""
    flight, look = (1.0, 1.0) if short else (8.0, 10.0)
    found = [
        Work(GAME.format(predicting=kind, row=row), 3)
        for kind, row in (
            ("constant-velocity", "`fly --fast demo`, constant velocity"),
            ("network", "`fly --fast demo`, networks that learn"),
        )
    ]
    found[1] = found[1]._replace(times=2)
    few = "picture and recorder, 200 vehicles at 20 Hz"
    many = "picture and recorder, 1000 vehicles at 5 Hz"
    found.append(Work(STATION.format(vehicles=200, every=1, seconds=flight, row=few), 2))
    found.append(
        Work(STATION.format(vehicles=1000, every=4, seconds=flight, row=many), 1, newest=True, other=False)
    )
    for pursuers in (5, 20, 50):
        row = f"compiled core, {pursuers} pursuers, a game step"
        found.append(Work(CORE.format(pursuers=pursuers, row=row), 2, once=True, other=False))
    found.append(Work(ANSWER.format(seconds=look / 2.0), 2, once=True, other=False))
    found.append(Work(AGENT.format(seconds=look, plain=False), 1, once=True, other=False))
    found.append(Work(AGENT.format(seconds=look, plain=True), 1, newest=True, other=False))
    return found
