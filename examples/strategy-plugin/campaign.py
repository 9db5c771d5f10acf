"""A strategy of one's own against the paper's, over many random games: `python campaign.py [GAMES]`.

An evader at 5 m/s wants to a target 150 m away; five pursuers at 4 m/s start anywhere within 40 to 120 m.
"""

from __future__ import annotations

import sys
from math import cos, pi, sin

import numpy as np
from apollonius_flank import FLANK

from onboard.core.game.advance import Conditions, begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign.compiled import campaign, starts_of

PURSUING = 5
TARGET = Target(True, Vec(0.0, 150.0, 0.0))
CONDITIONS = Conditions(Rules(R=2.0, rho=4.0, horizon=100.0, planar=True), TARGET, Control(dt=0.05))


def main(games: int, seed: int = 1) -> dict[str, dict[str, int]]:
    """Play the same starts under both strategies; how often each game ended how."""
    rng = np.random.default_rng(seed)
    drawn = []
    for _ in range(games):
        places = [(far * cos(yaw), far * sin(yaw)) for far, yaw in
                  zip(rng.uniform(40.0, 120.0, PURSUING), rng.uniform(-pi, pi, PURSUING), strict=True)]
        team = tuple(Vehicle(Vec(north, east, 0.0), ZERO, 4.0) for north, east in places)
        drawn.append(begin(Vehicle(ZERO, Vec(0.0, 5.0, 0.0), 5.0), team, FREE, (FREE,) * PURSUING))
    starts = starts_of(drawn, [TARGET.position] * games)
    found = {}
    for name, decide in (("paper", PURSUERS["paper"].decide), ("flank", FLANK.decide)):
        ends = campaign(EVADERS["paper"].decide, decide, PURSUING)(starts, CONDITIONS)
        counts = {result.name.lower(): int(np.sum(ends.verdicts == result)) for result in GameResult}
        found[name] = {result: count for result, count in counts.items() if count}
        print(f"{name:<6} {found[name]}, mean smallest distance {ends.smallest.mean():.1f} m")
    return found


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 400)
