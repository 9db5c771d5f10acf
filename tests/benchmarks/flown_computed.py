"""Whether a compiled spatial game is the flown one: the same seeds both ways, twice over.

    python -m tests.benchmarks.flown_computed --seeds 100

A flight is whole, agents, MAVLink, sensor and bus, on virtual time; odd seeds fly with the strategy, even
ones straight. It is computed twice, with the same gusts and noise: from its aircraft's states at t₀, and
from the scenario's places, as a campaign does it, where the flight should have been at t₀. Resumable: each
seed leaves a row in `--rows`; `--for` stops after as many seconds.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping
from datetime import UTC, datetime
from inspect import getclosurevars
from itertools import combinations
from math import degrees, hypot, inf
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from onboard.autopilot.arduplane import ArduPlaneEncoder
from onboard.core.guidance.plane import Reference, Said
from onboard.core.math.angles import wrap
from onboard.core.math.vectors import distance, sub, yaw_of
from onboard.game.scenario import Scenario
from onboard.game.staging import places_of, start_headings
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.loop import run_virtual, virtual_clock
from sim_bridge.campaign.aboard import Aboard
from sim_bridge.campaign.plane_in_wind import Flown
from sim_bridge.campaign.spatial_campaign import Played, play_drawn, play_seed
from sim_bridge.campaign.spatial_draw import Sides, draw, drawn_scenario, spatial
from sim_bridge.campaign.spatial_game import Evasion
from sim_bridge.rehearsal import Options, Rehearsal
from sim_bridge.vehicle.autopilot.arduplane import ArduPlane
from sim_bridge.vehicle.flight.airframe import Plane
from sim_bridge.vehicle.flight.plane import PlaneState
from sim_bridge.vehicle.motion import Motion
from sim_bridge.vehicle.wind.dryden import GustState
from tests.support import benchmark_record

VERDICTS, ARRIVALS, CORRELATION = 0.95, 0.02, 0.95  # what is promised


class Began(NamedTuple):
    """One aircraft at t₀, what its agent remembers, and what its autopilot was told last."""

    plane: PlaneState
    aboard: Aboard
    gusts: GustState  # that it meets


class Flight(NamedTuple):
    """A flown game."""

    verdict: str
    time: float  # [s]
    smallest: float  # [m]
    t0: float  # [s] since the beginning of the world
    began: tuple[Began, ...]
    apart: float  # [m] the least between two pursuers since t₀; inf with one


class Apart:
    """The least distance between two pursuers since t₀; its `step` is a `Bridge.watch`."""

    def __init__(self, master: Any, evader: int) -> None:
        self.least = inf
        self._master, self._evader = master, evader

    def step(self, wall_ns: int, motions: Mapping[int, Motion]) -> None:
        """Look at everybody's place at an instant."""
        if self._master.t0_ns and wall_ns >= self._master.t0_ns:
            places = [motion.position for id, motion in motions.items() if id != self._evader]
            self.least = min([self.least, *(distance(a, b) for a, b in combinations(places, 2))])


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
            field = getclosurevars(world._wind).nonlocals["field"]

            def step() -> None:
                move()
                if not began and game.master.t0_ns and world.wall_ns >= game.master.t0_ns:
                    later = (world.elapsed_ns - game.clock.monotonic_ns()) / 1e9
                    for n, (id, vehicle) in enumerate(world.vehicles.items()):
                        aboard = _aboard(vehicle, game.agents[id], scenario, later)
                        began.append(Began(vehicle.airframe.state, aboard, field._states[n]))

            world.step = step  # type: ignore[method-assign]
            near = Apart(game.master, scenario.ids[0])
            game.bridge.watch = near.step
            outcome = await game.until_ended()
            t0 = (game.master.t0_ns - (world.wall_ns - world.elapsed_ns)) / 1e9
            end = (outcome.verdict.value, outcome.time, outcome.smallest_distance)
            return Flight(*end, t0, tuple(began), near.least)

    return run_virtual(play())


def _aboard(vehicle: Any, agent: Any, scenario: Scenario, later: float) -> Aboard:
    """What agent and autopilot of a vehicle remember; `later` takes the agent's time to the world's [s]."""
    autopilot = vehicle.autopilot
    assert isinstance(vehicle.airframe, Plane)
    assert isinstance(autopilot, ArduPlane)
    encoder = agent.core.vehicle.adapter._encoder
    assert isinstance(encoder, ArduPlaneEncoder)
    last, reference = agent.core.flight._state, encoder._reference
    return Aboard(
        last.demand,
        last.stamp + later,
        Reference(reference.altitude - scenario.flight.origin.altitude_m, reference.at + later),
        Said(-autopilot._altitude_z, encoder._altitude._said.at + later),
        Said(autopilot._airspeed_target, encoder._speed._said.at + later),
        autopilot._roll,
        autopilot.wind_filter.estimate,
    )


def compute(
    scenario: Scenario,
    seed: int,
    evasion: Evasion,
    flight: Flight,
    compiled: bool = True,
    sides: Sides | None = None,
) -> Played:
    """The compiled game of a seed, begun with the states of a flight at t₀.

    By the scenario's strategies, or by `sides` of a kernel that holds them among others.
    """
    d = draw(scenario, seed, flight.t0, compiled)
    d = d if sides is None else d._replace(sides=sides)
    players, crew = [], []
    for i, began in enumerate(flight.began):
        off = np.subtract(began.plane.position, d.players[i].plane.position)
        d.tracks.filters[i, (0, 5, 10)] += off
        d.tracks.waiting[:, i, :3] += off
        players.append(Flown(began.plane, began.gusts))
        crew.append(began.aboard)
    return play_drawn(d._replace(players=players, crew=crew), evasion, compiled)


class Row(NamedTuple):
    """One seed flown, and computed from the flight's states at t₀ and from the scenario's places."""

    seed: int
    way: str
    flown: str
    states: str
    places: str
    flown_s: float
    states_s: float
    places_s: float
    flown_m: float  # smallest distance
    states_m: float
    places_m: float
    t0: float  # [s] since the beginning of the world
    away: tuple[float, ...]  # [m] from everybody's place at t₀, as seen from above
    turned: tuple[float, ...]  # [deg] everybody's nose from where it should point


def row_of(scenario: Scenario, seed: int) -> Row:
    """Fly a seed and compute it twice."""
    evasion = Evasion.STRATEGY if seed % 2 else Evasion.STRAIGHT
    ready = ready_for(scenario, seed, evasion)
    f = fly(ready)
    ends = (compute(scenario, seed, evasion, f), play_seed(scenario, seed, evasion, t0=f.t0))
    headings = [yaw_of(h) for h in start_headings(ready)]
    away = [sub(b.plane.position, p) for b, p in zip(f.began, places_of(ready), strict=True)]
    turned = [wrap(b.plane.yaw.angle - h) for b, h in zip(f.began, headings, strict=True)]
    return Row(
        seed, evasion.name.lower(), f.verdict, *(c.verdict.name.lower() for c in ends),
        f.time, *(c.time for c in ends), f.smallest, *(c.smallest for c in ends), f.t0,
        tuple(round(hypot(off.x, off.y), 2) for off in away), tuple(round(degrees(t), 2) for t in turned),
    )  # fmt: skip


class Pair(NamedTuple):
    """One game flown and computed."""

    row: Row
    verdict: str
    time: float
    smallest: float

    @property
    def same(self) -> bool:
        return self.row.flown == self.verdict


def pairs_of(rows: list[Row], which: str) -> list[Pair]:
    """The rows with what was computed from `which`: "states" or "places"."""
    return [Pair(r, *(getattr(r, which + end) for end in ("", "_s", "_m"))) for r in rows]


def found(pairs: list[Pair]) -> tuple[str, str, str]:
    """Equal verdicts, how far arrivals are apart, and the correlation of the smallest distances."""
    same = [p.same for p in pairs]
    arrived = [p for p in pairs if p.same and p.verdict == "arrived"]
    off = [abs(p.time - p.row.flown_s) / p.row.flown_s for p in arrived]
    missed = [p for p in pairs if "captured" not in (p.row.flown, p.verdict)]
    correlation = float(np.corrcoef([p.row.flown_m for p in missed], [p.smallest for p in missed])[0, 1])
    apart = f"{np.mean(off):.2%}, {np.max(off):.2%} ({len(off)})" if off else "none arrived both ways"
    return f"{sum(same)} of {len(same)}", apart, f"{correlation:.3f} ({len(missed)})"


def margin(pair: Pair, radius: float) -> str:
    """By how much a disagreement was one: what the game that was no capture lacked of it, or the times."""
    r = pair.row
    if "captured" in (r.flown, pair.verdict):
        lacks = (pair.smallest if r.flown == "captured" else r.flown_m) - radius
        return f"the other way the evader passed {lacks:.1f} m outside the radius of {radius:g} m"
    return f"they ended at {r.flown_s:.2f} and {pair.time:.2f} s"


def differences(rows: list[Row], radius: float) -> list[str]:
    """Every disagreement with its margin."""
    lines = []
    for which in ("states", "places"):
        for p in pairs_of(rows, which):
            if not p.same:
                away = ", ".join(f"{a:.0f}" for a in p.row.away)
                lines.append(
                    f"- seed {p.row.seed}, from the {which}: flown {p.row.flown}, computed {p.verdict}; "
                    f"{margin(p, radius)}. Away at t₀: {away} m."
                )
    return lines or ["None."]


def report(name: str, rows: list[Row], radius: float) -> str:
    """The rows as a Markdown page, with what they say together and every disagreement."""
    names = (
        "same verdict",
        "arrival times apart, mean and most (of)",
        "correlation of smallest distances (of)",
    )
    promised = (f"{VERDICTS:.0%}", f"{ARRIVALS:.0%}", f"{CORRELATION}")
    ways = (found(pairs_of(rows, "states")), found(pairs_of(rows, "places")))
    away, turned = [a for r in rows for a in r.away], [abs(t) for r in rows for t in r.turned]
    lines = [
        f"{len(rows)} seeds of `configs/scenarios/spatial/{name}.toml`, flown once and computed twice.\n",
        "| | from the states at t₀ | from the scenario's places | promised |",
        "|---|---|---|---|",
        *(f"| {a} | {b} | {c} | {d} |" for a, b, c, d in zip(names, *ways, promised, strict=True)),
        "",
        f"At t₀ the {len(away)} aircraft were {np.mean(away):.1f} m from their places in the mean, "
        f"{np.quantile(away, 0.95):.1f} m in 95 of 100 and {max(away):.1f} m at most; their noses "
        f"{np.mean(turned):.1f}°, {np.quantile(turned, 0.95):.1f}° and {max(turned):.1f}° off.\n",
        "Disagreements:\n",
        *differences(rows, radius),
        "",
        "| seed | evader | flown | from states | from places | flown [s] | states [s] | places [s] |"
        " flown [m] | states [m] | places [m] | t₀ [s] | away at t₀ [m] |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for r in sorted(rows):
        marks = ["" if r.flown == other else " **differs**" for other in (r.states, r.places)]
        away_all = ", ".join(f"{a:.1f}" for a in r.away)
        lines.append(
            f"| {r.seed} | {r.way} | {r.flown} | {r.states}{marks[0]} | {r.places}{marks[1]} |"
            f" {r.flown_s:.2f} | {r.states_s:.2f} | {r.places_s:.2f} |"
            f" {r.flown_m:.1f} | {r.states_m:.1f} | {r.places_m:.1f} | {r.t0:.0f} | {away_all} |"
        )
    return "\n".join(lines) + "\n"


def read(path: Path) -> Row:
    """A row as it was written."""
    return msgspec.json.decode(path.read_bytes(), type=Row)


def main() -> None:
    """Fly what is missing, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument(
        "--scenario", default="two", help="a file of configs/scenarios/spatial, without .toml"
    )
    parser.add_argument("--for", dest="most", type=float, default=1e9, metavar="S", help="then stop flying")
    parser.add_argument("--rows", type=Path, default=Path("runs/flown-computed"))
    parser.add_argument("--out", type=Path, default=Path("benchmarks/results/flown-computed.md"))
    options = parser.parse_args()
    options.rows.mkdir(parents=True, exist_ok=True)
    scenario, begun = spatial(options.scenario), time.monotonic()
    rows: list[Row] = []
    for seed in range(1, options.seeds + 1):
        path = options.rows / f"{options.scenario}-{seed}.json"
        if not path.exists():
            if time.monotonic() - begun > options.most:
                break
            path.write_bytes(msgspec.json.encode(row_of(scenario, seed)))
        rows.append(read(path))
        print(rows[-1], flush=True)
    made = f"{datetime.now(UTC):%Y-%m-%d} on {benchmark_record.machine()}"
    command = f"python -m tests.benchmarks.flown_computed --seeds {options.seeds}"
    short = "" if len(rows) == options.seeds else f" Of these seeds the first {len(rows)} have been flown."
    page = report(options.scenario, rows, scenario.parameters.R)
    options.out.write_text(f"# Flown and computed\n\n`{command}`, {made}.{short}\n\n{page}", encoding="utf-8")


if __name__ == "__main__":
    main()
