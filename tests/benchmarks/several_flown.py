"""Three evaders and ten pursuers, flown whole: how each evader ends, what it costs, how near vehicles come.

    python -m tests.benchmarks.several_flown --seeds 6

Seed 0 is the scenario `three-on-ten` as it is written; the others draw the pursuers' starts about theirs, as
a campaign does. Each is flown on virtual time as by `fly --fast` (agents, MAVLink, sensor and bus; nothing
is recorded), and computed in simple motion as by `campaign`. Resumable: each seed leaves a row in `--rows`;
`--for` stops after as many seconds.
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

NAME = "three-on-ten"
FILE = ROOT / "configs" / "scenarios" / "flight" / f"{NAME}.toml"
WORDS = [result.value for result in WORST[::-1]]  # verdicts, the best for the pursuers first


class Nearest:
    """Least distances since t₀; its `step` is a `Bridge.watch`."""

    def __init__(self, game: Rehearsal) -> None:
        self.pursuers = inf  # between two pursuers [m]
        self.gone = inf  # of a pursuer to an evader that is out and was left alone for a second [m]
        self._game = game
        self._out: dict[int, int] = {}  # evader → instant at which it was out [ns]

    def step(self, wall_ns: int, motions: Mapping[int, Motion]) -> None:
        """Look at everybody's place at an instant."""
        master = self._game.master
        if not master.t0_ns or wall_ns < master.t0_ns or self._game.outcome is not None:
            return
        ids = self._game.scenario.pursuer_ids
        places = [motions[id].position for id in ids]
        self.pursuers = min([self.pursuers, *(distance(a, b) for a, b in combinations(places, 2))])
        for end in master.out:
            since = self._out.setdefault(end.id, wall_ns)
            if wall_ns - since > 3_000_000_000:
                left = motions[end.id].position
                self.gone = min([self.gone, *(distance(left, place) for place in places)])


def scenario_of(seed: int) -> Scenario:
    """The scenario of a seed."""
    written = load(FILE, several=True)
    return written if seed == 0 else drawn_scenario(written, seed, spread_of(written))


def fly(seed: int) -> dict[str, Any]:
    """A row: the flight of a seed and the game computed from the same places."""
    scenario = scenario_of(seed)

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
    evaders = [
        (one.id, one.verdict, one.time, one.captor, one.smallest_distance) for one in summary.evaders
    ]
    return {
        "seed": seed, "verdict": summary.verdict, "time": summary.time, "evaders": evaders,
        "computed": [(one.verdict, one.time) for one in computed.evaders], "cpu_s": cpu_s,
        "virtual_s": virtual_s, "pursuers": nearest.pursuers,
        "gone": nearest.gone if nearest.gone < inf else -1.0,
        "safe": all(one.stage == "ended" for one in summary.vehicles),
    }  # fmt: skip


def page(rows: list[dict[str, Any]], command: str) -> None:
    """Write the page of all rows."""
    flown = Counter(end[1] for row in rows for end in row["evaders"])
    computed = Counter(end[0] for row in rows for end in row["computed"])
    alike = sum(
        end[1] == other[0]
        for row in rows
        for end, other in zip(row["evaders"], row["computed"], strict=True)
    )
    count = sum(flown.values())
    cpu = sum(row["cpu_s"] for row in rows) / len(rows)
    rate = sum(row["cpu_s"] for row in rows) / sum(row["virtual_s"] for row in rows)
    gone = min((row["gone"] for row in rows if row["gone"] >= 0.0), default=inf)
    left = "nobody left early" if gone == inf else f"{gone:.1f} m, from 3 s after it was out"
    apart = min(row["pursuers"] for row in rows)
    safe = "All" if all(row["safe"] for row in rows) else "Not all"
    lines = [
        f"{len(rows)} games of `{NAME}`: three evaders at 5 m/s with four targets, ten pursuers at 4 m/s by "
        f"their team's plan. Of {count} evaders",
        "",
        f"| | {' | '.join(WORDS)} |",
        f"|---|{'---|' * len(WORDS)}",
        f"| flown | {' | '.join(str(flown[word]) for word in WORDS)} |",
        f"| computed in simple motion | {' | '.join(str(computed[word]) for word in WORDS)} |",
        "",
        f"{alike} of {count} evaders end alike both ways. A flight has limits of turn and acceleration,",
        "delays, noise and a supervisor, of which a game in simple motion knows nothing: what turns on less",
        "than they take parts.",
        "",
        f"A flight of 13 agents takes {cpu:.0f} CPU-seconds, {rate:.2f} a second flown. {safe} agents ended",
        "in a mode that their autopilot holds. Nearest pursuers to one another:",
        f"{apart:.1f} m (separation 6 m); to an evader that was out: {left}.",
        "",
        "| seed | whole | evaders, flown | computed | pursuers apart [m] | CPU [s] |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        told = "; ".join(
            f"{id} {verdict}{f' by {captor}' if captor else ''} {at:.1f} s"
            for id, verdict, at, captor, _ in row["evaders"]
        )
        other = "; ".join(f"{verdict} {at:.1f} s" for verdict, at in row["computed"])
        seed = "as written" if row["seed"] == 0 else row["seed"]
        lines.append(
            f"| {seed} | {row['verdict']} | {told} | {other} | {row['pursuers']:.1f} | {row['cpu_s']:.0f} |"
        )
    benchmark_record.write("several-flown.md", "Several evaders, flown", command, lines)


def main() -> None:
    """Fly what is not flown yet, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=6, help="how many games, from 0")
    parser.add_argument("--rows", type=Path, default=Path("several-flown.jsonl"), help="rows so far")
    parser.add_argument("--for", dest="seconds", type=float, default=inf, help="stop after so long [s]")
    asked = parser.parse_args()
    kept = asked.rows.read_bytes().splitlines() if asked.rows.exists() else []
    rows = [msgspec.json.decode(line) for line in kept]
    began = time.monotonic()
    for seed in range(asked.seeds):
        if any(row["seed"] == seed for row in rows) or time.monotonic() - began > asked.seconds:
            continue
        rows.append(fly(seed))
        with asked.rows.open("ab") as file:
            file.write(msgspec.json.encode(rows[-1]) + b"\n")
        print(rows[-1], flush=True)
    rows = sorted((row for row in rows if row["seed"] < asked.seeds), key=lambda row: row["seed"])
    if len(rows) == asked.seeds:
        page(rows, f"python -m tests.benchmarks.several_flown --seeds {asked.seeds}")


if __name__ == "__main__":
    main()
