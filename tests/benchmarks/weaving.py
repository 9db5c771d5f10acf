"""Why pursuers weave and rules change: strategy, sensor, or the vehicle's limits, each switched off in turn.

`python -m tests.benchmarks.weaving [SCENARIO]` plays a plane scenario (the demo) as the paper has it, in
steps and simple motion, and flown on virtual time. Of each way it tells, a vehicle and second: how often the
rule changed, how often the decided course turned back (by more than 2 degrees a decision), and how far it
turned. In the plane every decision counts, flown those that are reported, ten a second.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterable
from math import atan2
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from msgspec.structs import replace

import gcs
from onboard.agent.config import EnvelopeConfig
from onboard.core.strategy.knowledge import Decision
from onboard.game.scenario import Scenario, load
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.resources import configs
from onboard.wire.bus.messages import Role
from sim_bridge.plane_game.program import play
from sim_bridge.rehearsal import Options, Rehearsal

TURNED = np.radians(2.0)  # less is no turn
FREE: dict[str, Any] = {"acceleration": 1000.0, "turn_rate_deg": 3600.0}  # a vehicle that turns at once


class Restless(NamedTuple):
    """How restless one side's decisions were, a vehicle and second."""

    rules: float  # changes of the rule [1/s]
    reversals: float  # of the decided course [1/s]
    turned: float  # by the decided course [deg/s]


def restless(courses: np.ndarray, rules: np.ndarray, seconds: float) -> Restless:
    """Of one vehicle: its decided courses [rad] and the rules by which it decided."""
    turns = np.angle(np.exp(1j * np.diff(courses)))
    real = turns[np.abs(turns) > TURNED]
    back = int(np.sum(np.sign(real[1:]) != np.sign(real[:-1])))
    changes = int(np.sum(rules[1:] != rules[:-1]))
    return Restless(changes / seconds, back / seconds, float(np.degrees(np.abs(turns).sum())) / seconds)


def mean(found: Iterable[Restless]) -> Restless:
    """The mean of several vehicles."""
    return Restless(*np.mean(list(found), axis=0).tolist())


def in_the_plane(scenario: Scenario, dt: float) -> tuple[Restless, Restless, float]:
    """Evader, pursuers, time: the strategies alone, in simple motion with steps of `dt` [s]."""
    played = play(scenario, "paper", dt)
    taken = [played.decisions(index) for index in range(len(played.frames) - 1)]
    seconds = played.final.time

    def of(decisions: list[Decision]) -> Restless:
        courses = np.array([atan2(d.direction.y, d.direction.x) for d in decisions])
        return restless(courses, np.array([d.rule.name for d in decisions]), seconds)

    pursuers = [of([each.pursuers[i] for each in taken]) for i in range(len(scenario.pursuers))]
    return of([each.evader for each in taken]), mean(pursuers), seconds


def flown(scenario: Scenario, *, limits: bool = True) -> tuple[Restless, Restless, float]:
    """Evader, pursuers, time: a whole game with agents; without `limits` no agent shapes what it decides."""
    told = {} if limits else {id: {"envelope": EnvelopeConfig(acceleration=0.0)} for id in scenario.ids}

    async def fly(folder: Path) -> None:
        async with Rehearsal(scenario, virtual_clock(), Options(folder=folder, configure=told)) as game:
            await game.until_ended()

    with tempfile.TemporaryDirectory() as name:
        run_virtual(fly(Path(name)))
        run = gcs.load(name)
    assert run.outcome is not None
    found: dict[Role, list[Restless]] = {Role.EVADER: [], Role.PURSUER: []}
    for id, role in run.roles.items():
        part = run.decisions.of(id)
        part = part.at((part["t_s"] >= 0.0) & (part["t_s"] <= run.outcome.time))
        courses = np.arctan2(part["air_v_east_m_s"], part["air_v_north_m_s"])
        found[role].append(restless(courses, part["rule"], run.outcome.time))
    return mean(found[Role.EVADER]), mean(found[Role.PURSUER]), run.outcome.time


def ways(scenario: Scenario) -> Iterable[tuple[str, tuple[Restless, Restless, float]]]:
    """Every way to play, with what came of it."""
    flight = replace(scenario.flight, prediction=Predicting.CONSTANT_VELOCITY)
    scenario = replace(scenario, flight=flight)
    sensor = replace(flight.sensor, sigma=0.0, sigma_velocity=0.0, delay_s=0.0, dropout=0.0)
    perfect = replace(scenario, flight=replace(flight, sensor=sensor))

    def free(given: Scenario) -> Scenario:
        team = tuple(replace(v, **FREE) for v in given.pursuers)
        return replace(given, evader=replace(given.evader, **FREE), pursuers=team)

    for dt in (0.1, 0.05, 0.01):
        yield f"strategies alone, step {dt:g} s", in_the_plane(scenario, dt)
    yield "flown", flown(scenario)
    yield "flown, perfect sensor", flown(perfect)
    yield "flown, no limits of turn and acceleration", flown(free(scenario), limits=False)
    yield "flown, neither", flown(free(perfect), limits=False)


def main(path: Path) -> None:
    """Print the table, a line as each way is played."""
    print("| way | ended [s] | evader: rules, reversals [1/s], turned [deg/s] | pursuers: the same |")
    print("|---|---|---|---|")
    for name, (evader, pursuers, seconds) in ways(load(path)):
        sides = (f"{r.rules:.2f}, {r.reversals:.2f}, {r.turned:.0f}" for r in (evader, pursuers))
        print(f"| {name} | {seconds:.1f} | {' | '.join(sides)} |", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else configs() / "scenarios" / "flight" / "demo.toml")
