"""What everybody who plays, judges or simulates a game must agree on."""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.geometry.zones import NO_ZONES, Zones
from onboard.core.math.vectors import ZERO, Vec


class Rules(NamedTuple):
    """The rules of one game, in the paper's symbols: the same for players, referee and simulations."""

    R: float  # capture radius of (6) [m]
    rho: float  # safety distance ρ of (4) [m]
    lambda_: float = 100.0  # λ of (21)–(22)
    beta: float = 1.0  # β of (22)
    epsilon_min: float = 1.0  # ε_min of (5): the target counts as reached within this [m]
    horizon: float = 100.0  # the game ends then: whoever is not captured has escaped, or was denied [s]
    separation: float = 0.0  # distance that pursuers keep from each other [m]; 0 = off (Figure 8b)
    planar: bool = False  # a game in the plane: heights count neither for decisions nor for the referee
    target_known: bool = False  # whether the pursuers know where the evader's target is
    zones: Zones = NO_ZONES  # that everybody keeps out of


def goal_disc(rules: Rules) -> float:
    """The radius about a target that must be held as a whole [m].

    It is 0 where who stands on the target captures everybody that comes within ε_min of it (ε_min ≤ R).
    """
    return 0.0 if rules.epsilon_min <= rules.R else rules.epsilon_min


class Target(NamedTuple):
    """The evader's target g. Apart from the rules: pursuers know it only where the rules say so."""

    exists: bool  # whether the evader has a target at all
    position: Vec  # [m; NED]


NO_TARGET = Target(False, ZERO)


class Control(NamedTuple):
    """How a player's decisions are paced."""

    dt: float = 0.05  # time between two decisions [s]
    lookahead: float = 1.0  # how far ahead rule 6's alternative (3.4.2) predicts the evader's place [s]
