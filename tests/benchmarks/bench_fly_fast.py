"""How fast a whole game of six vehicles plays in one process, and where the time goes.

Promises, on one core: ten times real time with tracks at constant velocity, four times with the
predictors that learn. CPU time of this process, so that what else runs on the machine counts little.
`python -m tests.benchmarks.bench_fly_fast`, or with pytest.
"""

from __future__ import annotations

import cProfile
import pstats
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import NamedTuple

import msgspec

from onboard.game.scenario import load
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.resources import configs
from sim_bridge.rehearsal import Options, Rehearsal
from tests.benchmarks import yardstick
from tests.support import benchmark_record

PROMISES = {Predicting.CONSTANT_VELOCITY: 10.0, Predicting.NETWORK: 4.0}
RUNS = 3


class Played(NamedTuple):
    """One game."""

    virtual_s: float
    cpu_s: float
    outcome: str

    @property
    def ratio(self) -> float:
        """Times real time on one core."""
        return self.virtual_s / self.cpu_s


def play(predicting: Predicting, folder: Path) -> Played:
    """The demo, with everything that `fly --fast` records."""
    scenario = load(configs() / "scenarios" / "flight" / "demo.toml")
    flight = msgspec.structs.replace(scenario.flight, prediction=predicting)
    scenario = msgspec.structs.replace(scenario, flight=flight)
    assert len(scenario.vehicles) == 6

    async def game() -> Played:
        clock = virtual_clock()
        async with Rehearsal(scenario, clock, Options(folder=folder)) as rehearsal:
            outcome = await rehearsal.until_ended()
            await rehearsal.land_agents()
            ended = f"{outcome.verdict.value} after {outcome.time:.1f} s"
            return Played(clock.monotonic_ns() / 1e9, 0.0, ended)

    begun = process_time()
    played = run_virtual(game())
    return played._replace(cpu_s=process_time() - begun)


def fastest(predicting: Predicting) -> Played:
    """The best of a few games: they are the same, so what differs is the machine."""
    games = []
    for _ in range(RUNS):
        with TemporaryDirectory() as folder:
            games.append(play(predicting, Path(folder)))
    return min(games, key=lambda game: game.cpu_s)


def shares(predicting: Predicting) -> dict[str, float]:
    """Where the time of one game goes: the share of each room."""
    profile = cProfile.Profile(process_time)
    with TemporaryDirectory() as folder:
        profile.enable()
        play(predicting, Path(folder))
        profile.disable()
    seconds = benchmark_record.rooms(pstats.Stats(profile))
    whole = sum(seconds.values())
    return {room: part / whole for room, part in seconds.items()}


def report() -> dict[Predicting, Played]:
    """Measure, print and write down."""
    played = {predicting: fastest(predicting) for predicting in Predicting}
    lines = [
        "Six vehicles, five on one (`configs/scenarios/flight/demo.toml`), with logs and recording, in one",
        f"process on virtual time; CPU time of the process, the best of {RUNS}.",
        "",
        "| tracks by | played [s] | CPU [s] | times real time | promised | outcome |",
        "|---|---|---|---|---|---|",
    ]
    for predicting, game in played.items():
        promise = f"{PROMISES[predicting]:g}" if predicting in PROMISES else "–"
        lines.append(
            f"| {predicting.value} | {game.virtual_s:.1f} | {game.cpu_s:.2f} | {game.ratio:.1f} | {promise} "
            f"| {game.outcome} |"
        )
    parts = {predicting: shares(predicting) for predicting in PROMISES}
    known = set().union(*parts.values())
    most = {name: max(part.get(name, 0.0) for part in parts.values()) for name in known}
    names = sorted(most, key=lambda name: -most[name])
    lines += ["", "Where the time goes: shares under cProfile, which favours few and large functions.", ""]
    lines += ["| room | " + " | ".join(p.value for p in parts) + " |", "|---|" + "---|" * len(parts)]
    for name in names:
        if most[name] >= 0.005:
            row = " | ".join(f"{100 * part.get(name, 0.0):.1f} %" for part in parts.values())
            lines.append(f"| {name} | {row} |")
    print("\n".join(lines))
    command = "python -m tests.benchmarks.bench_fly_fast"
    benchmark_record.write("fly-fast.md", "Play in one process", command, lines)
    return played


def test_six_vehicles_play_faster_than_real_time() -> None:
    played = report()
    for predicting, game in played.items():
        yardstick.cost(f"a second of fly --fast, {predicting.value}", 1.0 / game.ratio)
    for predicting, promise in PROMISES.items():
        assert played[predicting].ratio >= promise, predicting


if __name__ == "__main__":
    report()
