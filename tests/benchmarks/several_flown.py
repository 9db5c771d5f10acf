"""Several evaders, flown whole: how each one ends, what it costs, how near vehicles come.

    python -m tests.benchmarks.several_flown --seeds 5 --small 10

Games of `three-on-ten` and of `two-on-three`. Seed 0 is the scenario as it is written; the others draw the
pursuers' starts about theirs, as a campaign does. Each is flown on virtual time as by `fly --fast` (agents,
MAVLink, sensor and bus; nothing is recorded), and computed in simple motion as by `campaign`. Resumable: each
game leaves a row in `--rows`; `--for` stops after as many seconds, and the page is of the rows there are.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Mapping
from itertools import combinations
from math import inf
from pathlib import Path
from typing import Any

import msgspec

from onboard.core.math.vectors import distance
from onboard.game.scenario import Scenario, load
from onboard.game.trials import WORST
from onboard.runtime.loop import run_virtual, virtual_clock
from sim_bridge.campaign.spatial_draw import drawn_scenario
from sim_bridge.programs.campaigns.plan import spread_of
from sim_bridge.programs.campaigns.several import games_of
from sim_bridge.rehearsal import Options, Rehearsal
from sim_bridge.vehicle.motion import Motion
from sim_bridge.world.summary import Summary
from tests.support import benchmark_record
from tests.support.paths import ROOT

LARGE, SMALL = "three-on-ten", "two-on-three"
WORDS = [result.value for result in WORST[::-1]]  # verdicts, the best for the pursuers first
SETTLED_NS = 3_000_000_000  # for so long an evader that is out may still be flown away from

Row = dict[str, Any]


class Nearest:
    """Least distances since t₀; its `step` is a `Bridge.watch`."""

    def __init__(self, game: Rehearsal) -> None:
        self.pursuers = inf  # between two pursuers [m]
        self.gone = inf  # of a pursuer to an evader that has been out for a while [m]
        self._game = game
        self._out: dict[int, int] = {}  # evader → instant at which it was out [ns]

    def step(self, wall_ns: int, motions: Mapping[int, Motion]) -> None:
        """Look at everybody's place at an instant."""
        master = self._game.master
        if not master.t0_ns or wall_ns < master.t0_ns or self._game.outcome is not None:
            return
        places = [motions[id].position for id in self._game.scenario.pursuer_ids]
        self.pursuers = min([self.pursuers, *(distance(a, b) for a, b in combinations(places, 2))])
        for end in master.out:
            if wall_ns - self._out.setdefault(end.id, wall_ns) > SETTLED_NS:
                left = motions[end.id].position
                self.gone = min([self.gone, *(distance(left, place) for place in places)])


def scenario_of(name: str, seed: int) -> Scenario:
    """The scenario of a game."""
    written = load(ROOT / "configs" / "scenarios" / "flight" / f"{name}.toml", several=True)
    return written if seed == 0 else drawn_scenario(written, seed, spread_of(written))


def fly(name: str, seed: int) -> Row:
    """A row: the flight of a game, and the game computed from the same places."""
    scenario = scenario_of(name, seed)

    async def whole() -> tuple[Summary, Nearest, float]:
        clock = virtual_clock()
        async with Rehearsal(scenario, clock, Options(seed=seed)) as game:
            nearest = Nearest(game)
            game.bridge.watch = nearest.step
            await game.until_ended()
            await game.land_agents()
            return game.summary(), nearest, clock.monotonic_ns() / 1e9

    began = time.process_time()
    summary, nearest, virtual_s = run_virtual(whole())
    cpu_s = time.process_time() - began
    (computed,) = games_of(0, [scenario], range(seed, seed + 1))
    return {
        "name": name, "seed": seed, "verdict": summary.verdict, "time": summary.time,
        "evaders": [(one.id, one.verdict, one.time, one.captor) for one in summary.evaders],
        "computed": [(one.verdict, one.time) for one in computed.evaders],
        "cpu_s": cpu_s, "virtual_s": virtual_s, "pursuers": nearest.pursuers,
        "gone": nearest.gone if nearest.gone < inf else -1.0,
        "safe": all(one.stage == "ended" for one in summary.vehicles),
    }  # fmt: skip


def part(name: str, rows: list[Row]) -> list[str]:
    """The page's part of one scenario."""
    scenario = scenario_of(name, 0)
    flown = Counter(end[1] for row in rows for end in row["evaders"])
    computed = Counter(end[0] for row in rows for end in row["computed"])
    pairs = [pair for row in rows for pair in zip(row["evaders"], row["computed"], strict=True)]
    alike = sum(end[1] == other[0] for end, other in pairs)
    cpu = sum(row["cpu_s"] for row in rows)
    rate = cpu / sum(row["virtual_s"] for row in rows)
    gone = min((row["gone"] for row in rows if row["gone"] >= 0.0), default=inf)
    left = "" if gone == inf else f", and from an evader that was out (3 s and more ago) {gone:.1f} m"
    apart = min(row["pursuers"] for row in rows)
    keep = scenario.parameters.separation
    safe = "All" if all(row["safe"] for row in rows) else "Not all"
    lines = [
        f"## {name}: {len(scenario.evading)} evaders, {len(scenario.pursuers)} pursuers",
        "",
        f"| {len(rows)} games, {len(pairs)} evaders | {' | '.join(WORDS)} |",
        f"|---|{'---|' * len(WORDS)}",
        f"| flown | {' | '.join(str(flown[word]) for word in WORDS)} |",
        f"| computed in simple motion | {' | '.join(str(computed[word]) for word in WORDS)} |",
        "",
        f"{alike} of {len(pairs)} evaders end alike both ways.",
        f"A flight takes {cpu / len(rows):.0f} CPU-seconds, {rate:.2f} for each second that",
        f"{len(scenario.vehicles)} agents fly. {safe} agents ended in a mode that their autopilot holds.",
        f"Pursuers were {apart:.1f} m apart at the least (separation {keep:g} m){left}.",
        "",
        "| seed | whole | evaders, flown | computed | pursuers apart [m] | CPU [s] |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        told = "; ".join(
            f"{id} {verdict}{f' by {captor}' if captor else ''} {at:.1f} s"
            for id, verdict, at, captor in row["evaders"]
        )
        other = "; ".join(f"{verdict} {at:.1f} s" for verdict, at in row["computed"])
        seed = "as written" if row["seed"] == 0 else row["seed"]
        lines.append(
            f"| {seed} | {row['verdict']} | {told} | {other} | {row['pursuers']:.1f} | {row['cpu_s']:.0f} |"
        )
    return [*lines, ""]


def page(rows: list[Row]) -> None:
    """Write the page of all rows."""
    counts = {name: [row for row in rows if row["name"] == name] for name in (LARGE, SMALL)}
    lines = [line for name, some in counts.items() if some for line in part(name, some)]
    lines += [
        "A flight has limits of turn and acceleration, delays, noise and a supervisor, of which a game in",
        "simple motion knows nothing: games that turn on less than these take end in other words.",
    ]
    asked = f"--seeds {len(counts[LARGE])} --small {len(counts[SMALL])}"
    command = f"python -m tests.benchmarks.several_flown {asked}"
    benchmark_record.write("several-flown.md", "Several evaders, flown", command, lines)


def main() -> None:
    """Fly what is not flown yet, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help=f"how many games of {LARGE}, from seed 0")
    parser.add_argument("--small", type=int, default=10, help=f"how many games of {SMALL}, from seed 0")
    parser.add_argument("--rows", type=Path, default=Path("several-flown.jsonl"), help="rows so far")
    parser.add_argument("--for", dest="seconds", type=float, default=inf, help="stop after so long [s]")
    asked = parser.parse_args()
    kept = asked.rows.read_bytes().splitlines() if asked.rows.exists() else []
    rows: list[Row] = [msgspec.json.decode(line) for line in kept]
    began = time.monotonic()
    wanted = [(LARGE, seed) for seed in range(asked.seeds)] + [(SMALL, seed) for seed in range(asked.small)]
    for name, seed in wanted:
        done = any((row["name"], row["seed"]) == (name, seed) for row in rows)
        if done or time.monotonic() - began > asked.seconds:
            continue
        rows.append(fly(name, seed))
        with asked.rows.open("ab") as file:
            file.write(msgspec.json.encode(rows[-1]) + b"\n")
        print(rows[-1], flush=True)
    page(sorted(rows, key=lambda row: row["seed"]))


if __name__ == "__main__":
    main()
