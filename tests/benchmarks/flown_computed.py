"""Whether a compiled spatial game is the flown one: the same seeds both ways, from the same states at t₀.

    python -m tests.benchmarks.flown_computed --seeds 100

A flight is whole, agents, MAVLink, sensor and bus, on virtual time; odd seeds fly with the strategy, even
ones straight. Its aircraft's states at t₀ are given to the compiled game, which draws the same gusts and
noise. Resumable: each seed leaves a row in `--rows`.
"""

from __future__ import annotations

import argparse
import json
import platform
from datetime import UTC, datetime
from math import isnan
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from onboard.game.scenario import Scenario
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.loop import run_virtual, virtual_clock
from sim_bridge.campaign.plane_in_wind import Flown
from sim_bridge.campaign.spatial_campaign import Played, play_drawn
from sim_bridge.campaign.spatial_draw import aboard_of, draw, drawn_scenario, spatial
from sim_bridge.campaign.spatial_game import Evasion
from sim_bridge.rehearsal import Options, Rehearsal
from sim_bridge.vehicle.autopilot.arduplane import ArduPlane
from sim_bridge.vehicle.flight.airframe import Plane
from sim_bridge.vehicle.flight.plane import PlaneState
from sim_bridge.vehicle.wind.estimate import Estimate

VERDICTS, ARRIVALS, CORRELATION = 0.95, 0.02, 0.95  # what is promised


class Began(NamedTuple):
    """One aircraft at t₀, and what its autopilot was told last."""

    plane: PlaneState
    bank: float  # [rad]
    height: float  # sought [m]
    airspeed: float  # [m/s]
    wind: Estimate  # its own


class Flight(NamedTuple):
    """A flown game."""

    verdict: str
    time: float  # [s]
    smallest: float  # [m]
    t0: float  # [s] since the beginning of the world
    began: tuple[Began, ...]


def ready_for(scenario: Scenario, seed: int, evasion: Evasion) -> Scenario:
    """A seed's scenario as it is flown: tracks go on at constant velocity, as in the compiled game."""
    replace = msgspec.structs.replace
    found = drawn_scenario(scenario, seed)
    if evasion is Evasion.STRAIGHT:
        found = replace(found, evader=replace(found.evader, strategy="straight"))
    return replace(found, flight=replace(found.flight, prediction=Predicting.CONSTANT_VELOCITY))


def fly(scenario: Scenario) -> Flight:
    """Fly a game whole."""
    began: list[Began] = []

    async def play() -> Flight:
        async with Rehearsal(scenario, virtual_clock(), Options()) as game:
            world = game.bridge.world
            move = world.step

            def step() -> None:
                move()
                if not began and game.master.t0_ns and world.wall_ns >= game.master.t0_ns:
                    began.extend(_begins(vehicle) for vehicle in world.vehicles.values())

            world.step = step  # type: ignore[method-assign]
            outcome = await game.until_ended()
            t0 = (game.master.t0_ns - (world.wall_ns - world.elapsed_ns)) / 1e9
            return Flight(outcome.verdict.value, outcome.time, outcome.smallest_distance, t0, tuple(began))

    return run_virtual(play())


def _begins(vehicle: Any) -> Began:
    airframe, autopilot = vehicle.airframe, vehicle.autopilot
    assert isinstance(airframe, Plane)
    assert isinstance(autopilot, ArduPlane)
    wind = autopilot.wind_filter.estimate
    return Began(airframe.state, autopilot._roll, -autopilot._altitude_z, autopilot._airspeed_target, wind)


def compute(scenario: Scenario, seed: int, evasion: Evasion, flight: Flight, compiled: bool = True) -> Played:
    """The compiled game of a seed, begun with the states of a flight at t₀."""
    d = draw(scenario, seed, flight.t0, compiled)
    players, crew = [], []
    for i, began in enumerate(flight.began):
        off = np.subtract(began.plane.position, d.players[i].plane.position)
        d.tracks.filters[i, (0, 5, 10)] += off
        d.tracks.waiting[:, i, :3] += off
        players.append(Flown(began.plane, d.players[i].gusts))
        told = aboard_of(began.plane, d.start, began.airspeed, i)
        altitude = told.altitude._replace(value=began.height)
        crew.append(told._replace(bank=began.bank, altitude=altitude, wind=began.wind))
    return play_drawn(d._replace(players=players, crew=crew), evasion, compiled)


class Row(NamedTuple):
    """One seed both ways."""

    seed: int
    way: str
    flown: str
    computed: str
    flown_s: float
    computed_s: float
    flown_m: float  # smallest distance
    computed_m: float


def row_of(scenario: Scenario, seed: int) -> Row:
    """Fly and compute a seed."""
    evasion = Evasion.STRATEGY if seed % 2 else Evasion.STRAIGHT
    f = fly(ready_for(scenario, seed, evasion))
    c = compute(scenario, seed, evasion, f)
    verdict = c.verdict.name.lower()
    return Row(seed, evasion.name.lower(), f.verdict, verdict, f.time, c.time, f.smallest, c.smallest)


def report(name: str, rows: list[Row]) -> str:
    """The rows as a Markdown page, with what they say together and every disagreement."""
    same = [r.flown == r.computed for r in rows]
    arrived = [r for r in rows if r.flown == r.computed == "arrived"]
    off = [abs(r.computed_s - r.flown_s) / r.flown_s for r in arrived]
    missed = [r for r in rows if "captured" not in (r.flown, r.computed)]
    correlation = float(np.corrcoef([r.flown_m for r in missed], [r.computed_m for r in missed])[0, 1])
    lines = [
        f"{len(rows)} seeds of `configs/scenarios/spatial/{name}.toml`, {len(arrived)} arrived both ways.\n",
        "| | found | promised |",
        "|---|---|---|",
        f"| same verdict | {sum(same)} of {len(rows)} | {VERDICTS:.0%} |",
        f"| arrival times apart, mean and most | {np.mean(off) if off else np.nan:.2%}, "
        f"{max(off, default=np.nan):.2%} | {ARRIVALS:.0%} |",
        f"| correlation of the smallest distances (of {len(missed)} without a capture) | {correlation:.3f} |"
        f" {CORRELATION} |",
        "",
        "| seed | evader | flown | computed | flown [s] | computed [s] | flown [m] | computed [m] |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for r in sorted(rows):
        mark = "" if r.flown == r.computed else " **differs**"
        lines.append(
            f"| {r.seed} | {r.way} | {r.flown} | {r.computed}{mark} | {r.flown_s:.2f} | {r.computed_s:.2f} |"
            f" {r.flown_m:.1f} | {r.computed_m:.1f} |"
        )
    return "\n".join(lines) + "\n"


def main() -> None:
    """Fly what is missing, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument(
        "--scenario", default="two", help="a file of configs/scenarios/spatial, without .toml"
    )
    parser.add_argument("--rows", type=Path, default=Path("runs/flown-computed"))
    parser.add_argument("--out", type=Path, default=Path("benchmarks/results/flown-computed.md"))
    options = parser.parse_args()
    options.rows.mkdir(parents=True, exist_ok=True)
    rows: list[Row] = []
    for seed in range(1, options.seeds + 1):
        path = options.rows / f"{options.scenario}-{seed}.json"
        if not path.exists():
            path.write_text(json.dumps(row_of(spatial(options.scenario), seed)), encoding="utf-8")
        rows.append(Row(*json.loads(path.read_text(encoding="utf-8"))))
        print(rows[-1], flush=True)
    made = f"{datetime.now(UTC):%Y-%m-%d} on {platform.machine()}, Python {platform.python_version()}"
    command = f"python -m tests.benchmarks.flown_computed --seeds {options.seeds}"
    page = f"# Flown and computed\n\n`{command}`, {made}.\n\n{report(options.scenario, rows)}"
    assert not any(isnan(r.flown_s) for r in rows)
    options.out.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
