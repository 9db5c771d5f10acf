"""How often an encircled evader is captured: outcome 1 of 3.4.2, tried in plane games from random places.

The paper says that an evader without a free ray is captured. It is so in most games, not in all.
`sim-bridge campaign study encircled` prints the shares.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import NamedTuple

import numpy as np

from onboard.core.game.advance import Conditions, Game, begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.geometry.assessment import Goal, assess
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, ZERO, Vec, scale
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.runtime.progress import Tell, over, part, silent
from sim_bridge.campaign.compiled import campaign, starts_of

R = 2.0  # [m] capture
RHO = 4.0  # [m] the evader's safety distance, 2R
HORIZON = 100.0  # [s]
EVADER_SPEED = 5.0  # [m/s], as in Table 1
PURSUER_SPEED = 4.0
NEAR, FAR = 15.0, 120.0  # [m] from the evader at the start
TARGET = Vec(100.0, 0.0, 0.0)
MOST_TRIES = 1000  # draws for a game of the wanted kind


class Shares(NamedTuple):
    """How many games of a kind ended in capture."""

    pursuers: int
    ring: bool  # evenly spread over the circle, else anywhere
    target: bool
    encircled: bool  # at the start, at the safety distance ρ
    games: int
    captured: int


def _places(rng: np.random.Generator, pursuers: int, ring: bool) -> tuple[Vec, ...]:
    first = rng.uniform(-pi, pi)
    far = rng.uniform(NEAR, FAR, 1 if ring else pursuers)
    yaws = first + 2.0 * pi * np.arange(pursuers) / pursuers if ring else rng.uniform(-pi, pi, pursuers)
    return tuple(
        Vec(float(d * cos(yaw)), float(d * sin(yaw)), 0.0)
        for d, yaw in zip(np.broadcast_to(far, pursuers), yaws, strict=True)
    )


def draw_game(
    rng: np.random.Generator, pursuers: int, ring: bool, encircled: bool, target: Target
) -> Game | None:
    """A game whose evader is encircled at the start, or is not; None where no draw was of that kind."""
    free = VehicleLimits()
    evader = Vehicle(ZERO, scale(NORTH, EVADER_SPEED), EVADER_SPEED)
    for _ in range(MOST_TRIES):
        places = _places(rng, pursuers, ring)
        team = tuple(Vehicle(place, scale(NORTH, PURSUER_SPEED), PURSUER_SPEED) for place in places)
        seen = assess(evader, team, RHO, Goal(target.exists, target.position), True)
        if seen.encircled == encircled:
            return begin(evader, team, free, (free,) * pursuers)
    return None


def shares(
    games: int, seed: int, sizes: tuple[int, ...] = (5, 6), compiled: bool = True, tell: Tell = silent
) -> list[Shares]:
    """Games of every kind with each number of pursuers, played by the paper's strategies."""
    rng = np.random.default_rng(seed)
    found = []
    for number, pursuers in enumerate(sizes):
        tell(number / len(sizes), f"compiling for {pursuers} pursuers")
        play = campaign(EVADERS["paper"].decide, PURSUERS["paper"].decide, pursuers, compiled)
        kinds = ((False, False), (False, True), (True, True))
        for ring, encircled in over(kinds, part(tell, number, len(sizes)), f"{pursuers} pursuers"):
            for target in (NO_TARGET, Target(True, TARGET)):
                drawn = [draw_game(rng, pursuers, ring, encircled, target) for _ in range(games)]
                kept = [game for game in drawn if game is not None]
                if not kept:
                    continue
                rules = Rules(R, RHO, horizon=HORIZON, planar=True)
                ends = play(
                    starts_of(kept, [target.position] * len(kept)), Conditions(rules, target, Control())
                )
                captured = int(np.sum(ends.verdicts == GameResult.CAPTURED))
                found.append(Shares(pursuers, ring, target.exists, encircled, len(kept), captured))
    return found


def table(found: list[Shares]) -> str:
    """The shares as a table in Markdown."""
    lines = ["| pursuers | places | target | at the start | captured |", "|---|---|---|---|---|"]
    for s in found:
        share = 100.0 * s.captured / s.games
        begun = "encircled" if s.encircled else "not encircled"
        lines.append(
            f"| {s.pursuers} | {'ring' if s.ring else 'random'} | {'yes' if s.target else 'no'} |"
            f" {begun} | {s.captured} of {s.games} = {share:.0f} % |"
        )
    return "\n".join(lines)
