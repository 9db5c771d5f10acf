"""Pursuers on the plane, the same games for all of them: who captures, who denies, what staging gives.

    python -m tests.benchmarks.team_plane --games 1000 --rings 500 --staged 1000

Five pursuers against the paper's evader at 5 m/s, R = 2 m, ρ = 4 m, 300 s in steps of 0.1 s. Nobody begins
nearer to the evader than 10ρ. Random: pursuers of 3 to 4.5 m/s 40 to 120 m away, anywhere around it. Ring:
five of 4 m/s evenly around it. Staged: the random games, with 60 s before the evader moves (it stands until
then) in which the pursuers fly to the slots of the team's plan.
"""

from __future__ import annotations

import argparse
from math import cos, pi, sin
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import Conditions, Game, begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.geometry.apollonius import in_time
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec, along, distance, scale, sub, unit
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Situation
from onboard.core.strategy.team.planner import no_plan, plan
from sim_bridge.campaign.compiled import campaign, starts_of
from sim_bridge.campaign.spatial_campaign import mcnemar, share
from tests.support import benchmark_record

RULES = Rules(2.0, 4.0, horizon=300.0, planar=True, target_known=True)
STEP = 0.1  # [s]
TEAM = 5
EVADER = Vehicle(ZERO, scale(NORTH, 5.0), 5.0)
NEAR, FAR = 10.0 * RULES.rho, 120.0  # [m] from the evader
STAGING = 60.0  # [s]
WAYS = ("paper", "parallel-pursuit", "goalkeeper", "team")


class Drawn(NamedTuple):
    """Games before their first step, and their targets."""

    games: list[Game]
    targets: list[Vec]


def _around(rng: np.random.Generator, low: float, high: float) -> Vec:
    bearing, far = rng.uniform(-pi, pi), rng.uniform(low, high)
    return Vec(float(far * cos(bearing)), float(far * sin(bearing)), 0.0)


def _game(places: list[Vec], speeds: list[float]) -> Game:
    pairs = zip(places, speeds, strict=True)
    team = tuple(Vehicle(p, scale(unit(sub(ZERO, p), NORTH), v), v) for p, v in pairs)
    return begin(EVADER, team, FREE, (FREE,) * len(team))


def random_games(count: int, seed: int = 1) -> Drawn:
    """Pursuers anywhere around the evader, targets 60 to 200 m away."""
    rng = np.random.default_rng(seed)
    games, targets = [], []
    for _ in range(count):
        places = [_around(rng, NEAR, FAR) for _ in range(TEAM)]
        games.append(_game(places, [float(v) for v in rng.uniform(3.0, 4.5, TEAM)]))
        targets.append(_around(rng, 60.0, 200.0))
    return Drawn(games, targets)


def rings(count: int, seed: int = 2) -> Drawn:
    """Even rings of pursuers at γ = 0.8."""
    rng = np.random.default_rng(seed)
    games, targets = [], []
    for _ in range(count):
        first, far = rng.uniform(-pi, pi), rng.uniform(NEAR, FAR)
        bearings = [first + 2.0 * pi * k / TEAM for k in range(TEAM)]
        games.append(_game([Vec(far * cos(b), far * sin(b), 0.0) for b in bearings], [4.0] * TEAM))
        targets.append(_around(rng, 60.0, 200.0))
    return Drawn(games, targets)


def staged(drawn: Drawn) -> Drawn:
    """The same games after a staging of 60 s, in which the evader stands."""
    games = []
    for game, target in zip(drawn.games, drawn.targets, strict=True):
        members = tuple(Member(p, FREE, True) for p in game.pursuers)
        situation = Situation(
            0.0, STAGING, EVADER, FREE, members, Target(True, target), ZERO, RULES, Heights(), Margin(),
            ZERO, NEAR,
        )  # fmt: skip
        found = plan(situation, no_plan(members, 0.0))
        places = []
        for own, part in zip(game.pursuers, found.assignments, strict=True):
            aim = Vec(part.aim.x, part.aim.y, 0.0)
            reach = min(distance(aim, own.position), own.speed * STAGING)
            places.append(along(own.position, unit(sub(aim, own.position), NORTH), reach))
        games.append(_game(places, [p.speed for p in game.pursuers]))
    return Drawn(games, drawn.targets)


def nearest(drawn: Drawn) -> float:
    """Smallest distance of any pursuer to the evader at t₀ [m]."""
    return min(distance(p.position, g.evader.position) for g in drawn.games for p in g.pursuers)


def verdicts(drawn: Drawn, way: str) -> NDArray[np.int64]:
    """How each game ends when the pursuers fly one way."""
    play = campaign(EVADERS["paper"].decide, PURSUERS[way].decide, TEAM)
    conditions = Conditions(RULES, Target(True, ZERO), Control(STEP))
    return play(starts_of(drawn.games, drawn.targets), conditions).verdicts


def table(drawn: Drawn, ways: tuple[str, ...]) -> list[str]:
    """A line a way, with the games that it and the first way decide otherwise."""
    lines = [
        "| pursuers | captured (95 %) | arrived (95 %) | denied | escaped | captured, not by the first way |"
        " by the first way alone | arrives against the first way alone | against this one alone | p |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    first: NDArray[np.int64] | None = None
    for way in ways:
        ends = verdicts(drawn, way)
        first = ends if first is None else first
        count = {result: int(np.sum(ends == result)) for result in GameResult}
        mine, theirs = ends == GameResult.CAPTURED, first == GameResult.CAPTURED
        here, there = ends == GameResult.ARRIVED, first == GameResult.ARRIVED
        saved, lost = int(np.sum(there & ~here)), int(np.sum(here & ~there))
        n = len(ends)
        lines.append(
            f"| {way} | {share(count[GameResult.CAPTURED], n)} | {share(count[GameResult.ARRIVED], n)} |"
            f" {count[GameResult.DENIED]} | {count[GameResult.ESCAPED]} | {int(np.sum(mine & ~theirs))} |"
            f" {int(np.sum(theirs & ~mine))} | {saved} | {lost} | {mcnemar(saved, lost):.1e} |"
        )
    return lines


def page(games: int, ring_games: int, staged_games: int) -> str:
    """The whole result."""
    drawn = random_games(games)
    some = staged(random_games(staged_games))
    first = [
        any(in_time(t, p.position, p.speed, ZERO, EVADER.speed) for p in g.pursuers)
        for g, t in zip(drawn.games, drawn.targets, strict=True)
    ]
    made = f"{benchmark_record.machine()}, NumPy {np.__version__}"
    command = f"python -m tests.benchmarks.team_plane --games {games} --rings {ring_games}"
    command += f" --staged {staged_games}"
    words = __doc__.split("\n\n", 2)[2].strip().replace("\n", " ")
    return "\n".join(
        [
            "# Pursuers on the plane\n",
            f"`{command}` on {made}.\n",
            words + "\n",
            f"## Random, {games} games\n",
            f"In {np.mean(first):.1%} of them somebody can be at the target before the evader at t₀.\n",
            *table(drawn, WAYS),
            f"\n## Rings, {ring_games} games\n",
            *table(rings(ring_games), WAYS),
            f"\n## Staged for {STAGING:g} s, {staged_games} games\n",
            f"The nearest pursuer at t₀ is {nearest(some):.1f} m away; 10ρ are {NEAR:g} m.\n",
            *table(some, WAYS),
            "",
        ]
    )


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.team_plane", description=__doc__)
    parser.add_argument("--games", type=int, default=1000)
    parser.add_argument("--rings", type=int, default=500)
    parser.add_argument("--staged", type=int, default=1000)
    parser.add_argument("--out", type=Path, default=Path("benchmarks/results/team-plane.md"))
    given = parser.parse_args()
    given.out.write_text(page(given.games, given.rings, given.staged), encoding="utf-8")
    print(f"written: {given.out}")


if __name__ == "__main__":
    main()
