"""Figure 8b's choice between (30) and (31) in pursuit: the same spatial games with and without it.

    python -m tests.benchmarks.choice_in_pursuit --seeds 40

writes benchmarks/results/choice-in-pursuit.md.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np
from scipy.stats import wilcoxon

from onboard.core.game.referee import GameResult
from onboard.core.strategy.knowledge import RuleId
from onboard.game.scenario import Scenario
from sim_bridge.campaign.spatial_campaign import Played, mcnemar, play_seed, share
from sim_bridge.campaign.spatial_draw import spatial
from sim_bridge.campaign.spatial_game import Evasion
from tests.support import benchmark_record

RESULT = Path("benchmarks/results/choice-in-pursuit.md")
WAYS = ("paper", "choosing")


class Row(NamedTuple):
    """One game."""

    captured: bool
    arrived: bool
    smallest: float  # [m]
    turned: float  # by which a pursuer's decided course turns [deg/s], mean over pursuers and time
    corrected: float  # share of the pursuers' decisions that are (30)


def row_of(played: Played, dt: float) -> Row:
    """What a game says of the choice."""
    courses = np.unwrap(played.log[:, 1:, 4], axis=0)
    turned = float(np.mean(np.abs(np.diff(courses, axis=0)))) / dt
    return Row(
        played.verdict == GameResult.CAPTURED,
        played.verdict == GameResult.ARRIVED,
        played.smallest,
        float(np.degrees(turned)),
        float(np.mean(played.log[:, 1:, 5] == RuleId.POINT_BY_POINT)),
    )


def flown_by(scenario: Scenario, way: str) -> Scenario:
    """The scenario with pursuers that follow the named strategy."""
    pursuers = tuple(msgspec.structs.replace(p, strategy=way) for p in scenario.pursuers)
    return msgspec.structs.replace(scenario, pursuers=pursuers)


def games_of(name: str, seeds: int) -> dict[str, list[Row]]:
    """Both ways over the same seeds."""
    found: dict[str, list[Row]] = {}
    for way in WAYS:
        scenario = flown_by(spatial(name), way)
        dt = 1.0 / scenario.flight.control_rate_hz
        found[way] = [row_of(play_seed(scenario, seed, Evasion.STRATEGY), dt) for seed in range(seeds)]
    return found


def table_of(name: str, games: dict[str, list[Row]]) -> list[str]:
    """Rows of a Markdown table."""
    return [
        f"| {name} | {way} | {share(sum(g.captured for g in rows), len(rows))} |"
        f" {share(sum(g.arrived for g in rows), len(rows))} |"
        f" {np.median([g.smallest for g in rows]):.1f} | {np.mean([g.turned for g in rows]):.2f} |"
        f" {100 * np.mean([g.corrected for g in rows]):.1f} % |"
        for way, rows in games.items()
    ]


def paired(name: str, games: dict[str, list[Row]]) -> str:
    """The pairs' differences, in words."""
    pairs = list(zip(games["paper"], games["choosing"], strict=True))
    nearer = np.array([b.smallest - a.smallest for a, b in pairs])
    calmer = np.array([b.turned - a.turned for a, b in pairs])
    gained = sum(b.captured and not a.captured for a, b in pairs)
    lost = sum(a.captured and not b.captured for a, b in pairs)
    held = sum(a.arrived and not b.arrived for a, b in pairs)
    let = sum(b.arrived and not a.arrived for a, b in pairs)
    return (
        f"{name}: captures gained {gained}, lost {lost} (McNemar p = {mcnemar(gained, lost):.2f}); arrivals"
        f" prevented {held}, let pass {let} (p = {mcnemar(held, let):.2f}); smallest distance"
        f" {np.median(nearer):+.1f} m in the median pair (Wilcoxon p = {wilcoxon(nearer).pvalue:.2f});"
        f" decided course turns by {np.median(calmer):+.2f} °/s (p = {wilcoxon(calmer).pvalue:.1e})."
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--scenarios", nargs="+", default=["six"])
    options = parser.parse_args()
    lines = [
        "# (30) and (31) in pursuit",
        "",
        f"{benchmark_record.machine()};"
        f" `python -m tests.benchmarks.choice_in_pursuit --seeds {options.seeds}`; compiled spatial games,"
        " the evader by the strategy of 3.4.1, pairs of the same seeds.",
        "",
        "| scenario | pursuers | captured | arrived | median smallest distance [m] |"
        " decided course turns [°/s] | decisions by (30) |",
        "|---|---|---|---|---|---|---|",
    ]
    games = {name: games_of(name, options.seeds) for name in options.scenarios}
    for name in options.scenarios:
        lines += table_of(name, games[name])
    for name in options.scenarios:
        lines += ["", paired(name, games[name])]
    RESULT.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
