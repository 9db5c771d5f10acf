"""Who goes for whom: the assignment of least time against everybody after the nearest evader.

    python -m tests.benchmarks.several

Three evaders and ten pursuers in the plane, simple motion, compiled, each start played both ways. Writes
benchmarks/results/several-evaders.md.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.many import ManyConditions, ManyGame, begin_many
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.math.each import each
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, Vec, distance, scale
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.core.strategy.team.plan_types import NOBODY, Member
from onboard.core.strategy.team.quarry import Assign, Quarry, quarries_of
from onboard.game.scenario import load
from onboard.runtime.resources import SCENARIOS, shipped_file
from sim_bridge.campaign.compiled import register_strategies
from sim_bridge.campaign.many import ManyEnds, Size, many_campaign, starts_of
from sim_bridge.campaign.spatial_campaign import mcnemar
from sim_bridge.campaign.spatial_draw import drawn_scenario
from sim_bridge.programs.campaigns.plan import spread_of
from sim_bridge.programs.campaigns.several import ends_of
from sim_bridge.programs.campaigns.until import wilson
from tests.support.benchmark_record import write

SIZE = Size(3, 10, 1)
PACE = 5.0  # [m/s] of the evaders
FIRST = 1001  # seed of the first start: the rule was chosen on those from 1 on
FIELD = 150.0  # [m] half of the square in which everybody starts
AWAY = (120.0, 250.0)  # [m] from an evader to its target
RULES = Rules(3.0, 6.0, epsilon_min=2.0, horizon=120.0, planar=True)


class Family(NamedTuple):
    """A kind of games."""

    words: str
    pursuers: str  # their strategy
    pace: float  # of the pursuers [m/s]
    targets: bool
    known: bool  # whether the pursuers know them


FAMILIES = (
    Family("slower (4 m/s), targets known, `team`", "team", 4.0, True, True),
    Family("slower (4 m/s), not known, `parallel-pursuit`", "parallel-pursuit", 4.0, True, False),
    Family("faster (5.5 m/s), not known, `parallel-pursuit`", "parallel-pursuit", 5.5, True, False),
    Family("slower (4 m/s), no targets, `parallel-pursuit`", "parallel-pursuit", 4.0, False, False),
)


def nearest_of(
    team: tuple[Member, ...],
    quarries: tuple[Quarry, ...],
    _previous: tuple[int, ...],
    _rules: Rules,
    _left: float,
) -> tuple[int, ...]:
    """Everybody after the nearest evader that is in the game."""
    return each(nearest, team, quarries)


def nearest(member: Member, _index: int, quarries: tuple[Quarry, ...]) -> int:
    """The evader nearest to a pursuer (for `each`)."""
    found = NOBODY
    least = 1e300
    for j in range(len(quarries)):
        if quarries[j].live:
            away = distance(member.vehicle.position, quarries[j].vehicle.position)
            if away < least:
                least = away
                found = j
    return found


WAYS: tuple[Assign, ...] = (nearest_of, quarries_of)


def start_of(family: Family, seed: int) -> tuple[ManyGame, tuple[tuple[Target, ...], ...]]:
    """A game's start: everybody anywhere in the square, but no pursuer within 2ρ of an evader."""
    rng = np.random.default_rng([19, seed])
    places = [Vec(*rng.uniform(-FIELD, FIELD, 2).tolist(), 0.0) for _ in range(SIZE.evaders)]
    targets = []
    for place in places:
        far, yaw = rng.uniform(*AWAY), rng.uniform(-np.pi, np.pi)
        goal = Vec(place.x + float(far * np.cos(yaw)), place.y + float(far * np.sin(yaw)), 0.0)
        targets.append((Target(True, goal) if family.targets else NO_TARGET,))
    team: list[Vec] = []
    while len(team) < SIZE.pursuers:
        place = Vec(*rng.uniform(-FIELD, FIELD, 2).tolist(), 0.0)
        if min(distance(place, other) for other in places) > 2.0 * RULES.rho:
            team.append(place)
    evaders = tuple(Vehicle(place, scale(NORTH, PACE), PACE) for place in places)
    pursuers = tuple(Vehicle(place, scale(NORTH, family.pace), family.pace) for place in team)
    limits = (FREE,) * SIZE.evaders, (FREE,) * SIZE.pursuers
    return begin_many(evaders, pursuers, *limits), tuple(targets)


def played(family: Family, games: int, assign: Assign) -> ManyEnds:
    """Games of a family under an assignment."""
    starts = [start_of(family, seed) for seed in range(FIRST, FIRST + games)]
    conditions = ManyConditions(RULES._replace(target_known=family.known), starts[0][1], Control(0.1))
    register_strategies((nearest,))
    flee, chase = EVADERS["paper"].decide, PURSUERS[family.pursuers].decide
    play = many_campaign((flee,) * SIZE.evaders, chase, SIZE, assign=assign)
    ends: ManyEnds = play(starts_of([g for g, _ in starts], [t for _, t in starts]), conditions)
    return ends


def share(found: NDArray[np.bool_]) -> str:
    """How many, as a share with Wilson's 95 % interval."""
    count, n = int(found.sum()), found.size
    low, high = wilson(count, n)
    return f"{100 * count / n:.1f} % ({100 * low:.1f}–{100 * high:.1f})"


def paired(old: NDArray[np.bool_], new: NDArray[np.bool_]) -> str:
    """How often only one of both, and McNemar's exact p."""
    only_new, only_old = int((new & ~old).sum()), int((old & ~new).sum())
    return f"{only_new} : {only_old}, p = {mcnemar(only_new, only_old):.1e}"


def row(family: Family, games: int) -> list[str]:
    """A family's lines: what is asked of evaders and of games, both ways, and the paired test."""
    old, new = (played(family, games, way).verdicts for way in WAYS)
    asked = {
        "evaders captured": [v == GameResult.CAPTURED for v in (old, new)],
        "games with all captured": [(v == GameResult.CAPTURED).all(axis=1) for v in (old, new)],
    }
    if family.targets:
        asked["evaders kept from their target"] = [v != GameResult.ARRIVED for v in (old, new)]
        asked["games in which nobody arrives"] = [(v != GameResult.ARRIVED).all(axis=1) for v in (old, new)]
    return [
        f"| {family.words if k == 0 else ''} | {what} | {share(a)} | {share(b)} | {paired(a, b)} |"
        for k, (what, (a, b)) in enumerate(asked.items())
    ]


def shipped(games: int) -> list[str]:
    """The lines of the shipped game of three on ten, from starts as a campaign draws them."""
    scenario = load(shipped_file(Path("three-on-ten"), SCENARIOS), several=True)
    spread = spread_of(scenario)
    verdicts = ends_of([drawn_scenario(scenario, seed, spread) for seed in range(1, games + 1)]).verdicts
    lines = [
        "",
        f"`sim-bridge campaign run three-on-ten --games {games}`, each evader:",
        "",
        "| evader | captured | arrived | denied | escaped |",
        "|---|---|---|---|---|",
    ]
    ended = (GameResult.CAPTURED, GameResult.ARRIVED, GameResult.DENIED, GameResult.ESCAPED)
    for k, id in enumerate(scenario.evader_ids):
        lines.append(f"| {id} | " + " | ".join(share(verdicts[:, k] == end) for end in ended) + " |")
    return lines


def main() -> None:
    """Play all and write the page."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--games", type=int, default=400, help="starts of each family")
    games = options.parse_args().games
    lines = [
        f"Three evaders at 5 m/s (`paper`) and ten pursuers in the plane, R = 3 m, {RULES.horizon:g} s,"
        f" simple motion; {games} starts a family, the same for both. 95 % intervals by Wilson; the last"
        " column counts what came about by the assignment only and by the nearest only, with McNemar's exact"
        " p. Evaders of one game are not independent: the rows of games are the proof."
        f" Seeds from {FIRST} on: the rule was chosen on those before.",
        "",
        "| pursuers | share of | everybody after the nearest | assignment of least time | new : old alone |",
        "|---|---|---|---|---|",
    ]
    for family in FAMILIES:
        told = row(family, games)
        lines += told
        print("\n".join(told), flush=True)
    lines += shipped(games)
    print("\n".join(lines[-4:]), flush=True)
    title, command = "Who goes for whom, of several evaders", "python -m tests.benchmarks.several"
    write("several-evaders.md", title, command, lines)


if __name__ == "__main__":
    main()
