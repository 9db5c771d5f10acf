"""What prevents capture in the end game: the same closed rings with and without the supervisor's separation.

    python -m tests.benchmarks.end_game --seeds 60

Rings of five as in `tests.benchmarks.team`, random phase, pursuers by the team's strategy. Each cause is
taken away alone: gusts, the sensor's noise, the supervisor's separation. The picture shows the first game
that the separation decides, or else the first: the courses that the two nearest pursuers wanted and flew.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import msgspec
import numpy as np

from onboard.core.game.referee import GameResult
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game import palette
from onboard.game.scenario import Scenario
from sim_bridge.campaign.spatial_campaign import Played, play_drawn, share
from sim_bridge.campaign.spatial_draw import draw
from sim_bridge.campaign.spatial_fixed import Sides
from sim_bridge.campaign.spatial_game import Chosen, Evasion
from tests.benchmarks.team import WAYS, apart
from tests.benchmarks.team_cases import demand, game_of
from tests.support.benchmark_record import write
from tests.support.paths import ROOT

replace = msgspec.structs.replace
WORDS = """
Closed rings of five aircraft at 2 km, random phase, the paper's evader, the pursuers by their team's plan.
Each row takes one cause away, the same seeds; without the supervisor's separation (100 m) pursuers meet.

![Courses wanted and flown](../../docs/pictures/end-game.png)

The picture is the first game that the separation decides, if any: who come to the evader together give way.
"""
TAKEN = ("nothing", "gusts", "sensor noise", "separation")


def without(scenario: Scenario, taken: str) -> Scenario:
    """The scenario without gusts or without the sensor's noise."""
    flight = scenario.flight
    if taken == "gusts":
        return replace(scenario, flight=replace(flight, wind=replace(flight.wind, gust_sigma=0.0)))
    if taken == "sensor noise":
        return replace(
            scenario, flight=replace(flight, sensor=replace(flight.sensor, sigma=0.0, sigma_velocity=0.0))
        )
    return scenario


def play(scenario: Scenario, apart_at: float | None) -> Played:
    """One game; `apart_at` [m] in place of the supervisor's separation."""
    d = draw(scenario, 0)
    start = d.start
    if apart_at is not None:
        start = start._replace(policies=tuple(p._replace(separation=apart_at) for p in start.policies))
    evaders = (EVADERS["paper"].decide, EVADERS["straight"].decide)
    sides = Sides(
        evaders, tuple(PURSUERS[name].decide for name in WAYS), Chosen(0, (1,) * len(scenario.pursuers))
    )
    return play_drawn(d._replace(start=start, sides=sides), Evasion.STRATEGY)


def caught(played: Played) -> bool:
    """Whether the evader was captured."""
    return played.verdict == GameResult.CAPTURED


def picture(played: Played, file: Path) -> None:
    """Courses wanted and flown of the two pursuers that come nearest, with the evader's."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    log = played.log
    away = np.linalg.norm(log[:, 1:, :3] - log[:, :1, :3], axis=2)
    end = int(np.argmin(away.min(axis=1))) + 20
    two = np.argsort(away[:end].min(axis=0))[:2]
    time = 0.05 * np.arange(end)
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.5), layout="constrained")
    left.plot(log[:end, 0, 1], log[:end, 0, 0], color=palette.vehicle(1, True).light, label="evader 1")
    for k in two:
        color = palette.vehicle(int(k) + 2, False).light
        left.plot(log[:end, k + 1, 1], log[:end, k + 1, 0], color=color, label=f"pursuer {k + 2}")
        for column, style, word in ((3, "-", "flown"), (4, "--", "wanted")):
            course = np.degrees(np.unwrap(log[:end, k + 1, column]))
            right.plot(time, course, style, color=color, label=f"pursuer {k + 2}, {word}")
    left.set(xlabel="east [m]", ylabel="north [m]", aspect="equal", title=f"nearest {played.smallest:.0f} m")
    right.set(xlabel="time [s]", ylabel="course [deg]", title="courses of the two nearest pursuers")
    for axes in (left, right):
        axes.legend(fontsize=7)
        axes.grid(alpha=0.3)
    figure.savefig(file, dpi=120)
    plt.close(figure)


def main() -> None:
    """Play, print, write the page and the picture."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--seeds", type=int, default=60)
    given = parser.parse_args()
    case = demand("ring-5")
    lines = [
        "| taken away | captured (95 %) | misses at [m] | two pursuers at the nearest [m] |",
        "|---|---|---|---|",
    ]
    games: dict[str, list[Played]] = {}
    for taken in TAKEN:
        at = 0.0 if taken == "separation" else None
        games[taken] = [play(without(game_of(case, s), taken), at) for s in range(1, given.seeds + 1)]
        missed = sorted(round(g.smallest) for g in games[taken] if not caught(g))
        lines.append(
            f"| {taken} | {share(sum(map(caught, games[taken])), given.seeds)} |"
            f" {', '.join(map(str, missed)) or 'none'} | {min(map(apart, games[taken])):.0f} |"
        )
        print(lines[-1], flush=True)
    pairs = list(zip(games["nothing"], games["separation"], strict=True))
    shown = next((a for a, b in pairs if caught(b) and not caught(a)), pairs[0][0])
    picture(shown, ROOT / "docs" / "pictures" / "end-game.png")
    write(
        "end-game.md",
        "What prevents capture",
        f"python -m tests.benchmarks.end_game --seeds {given.seeds}",
        [*lines, *WORDS.rstrip().splitlines()],
    )


if __name__ == "__main__":
    main()
