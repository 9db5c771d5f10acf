"""All strategies by name, each with the table it comes from."""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.game.views import EvaderView, PursuerView
from onboard.core.strategy import choosing, evasion, evasive, pursuit
from onboard.core.strategy.knowledge import Rule
from onboard.core.strategy.own_air import in_own_air
from onboard.core.strategy.team import flying


class NamedPursuer(NamedTuple):
    """A pursuer's strategy and its knowledge base."""

    decide: PursuerStrategy
    table: tuple[Rule[PursuerView], ...]
    words: str  # what it does, in one line


class NamedEvader(NamedTuple):
    """An evader's strategy and its knowledge base."""

    decide: EvaderStrategy
    table: tuple[Rule[EvaderView], ...]
    words: str  # what it does, in one line


PARALLEL = NamedPursuer(
    pursuit.pursuer_parallel,
    pursuit.PURSUER_PARALLEL,
    "parallel pursuit: the line of sight keeps its direction",
)
PURSUERS: dict[str, NamedPursuer] = {
    "paper": NamedPursuer(
        pursuit.pursuer, pursuit.PURSUER, "rules 4 to 6 of 3.4.2: intercept, greatest approach, parallel"
    ),
    "predictive": NamedPursuer(
        pursuit.pursuer_predictive, pursuit.PURSUER_PREDICTIVE, "paper; rule 6 to where the evader will be"
    ),
    "earlier": NamedPursuer(
        pursuit.pursuer_earlier, pursuit.PURSUER_EARLIER, "the strategy of [37]: intercept, or straight at it"
    ),
    "choosing": NamedPursuer(
        choosing.pursuer_choosing,
        choosing.PURSUER_CHOOSING,
        "paper; in gusts it holds a meeting point (30) or finds a new one (31): figure 8b",
    ),
    "pure-pursuit": NamedPursuer(
        pursuit.pursuer_pure, pursuit.PURE, "for comparison: always straight at the evader"
    ),
    "parallel-pursuit": PARALLEL,
    "constant-bearing": PARALLEL._replace(words="the same by its older name"),
    "own-air": NamedPursuer(
        in_own_air(pursuit.pursuer_parallel),
        pursuit.PURSUER_PARALLEL,
        "parallel pursuit in the air around the vehicle: its gusts are taken out",
    ),
    "paper-own-air": NamedPursuer(
        in_own_air(pursuit.pursuer), pursuit.PURSUER, "paper in the air around the vehicle"
    ),
    "goalkeeper": NamedPursuer(
        pursuit.pursuer_keeper, pursuit.PURSUER_KEEPER, "one keeps a known target, the others chase"
    ),
    "blocking-line": NamedPursuer(
        pursuit.pursuer_line, pursuit.PURSUER_LINE, "goalkeeper; who is in time blocks beside it"
    ),
    "team": NamedPursuer(
        flying.pursuer_team, flying.TEAM, "its part of the team's plan: ring, goalkeeper, blocker, chase"
    ),
    "abreast": NamedPursuer(
        flying.pursuer_abreast, flying.ABREAST, "who come from one side fly as a wall: the answer to a dodge"
    ),
    "proportional-navigation": NamedPursuer(
        pursuit.pursuer_navigation,
        pursuit.NAVIGATION,
        "for comparison: turns 3 times as fast as the line of sight",
    ),
}

EVADERS: dict[str, NamedEvader] = {
    "paper": NamedEvader(
        evasion.evader, evasion.EVADER, "rules 1 to 3 of 3.4.1: free ray, or resultant force"
    ),
    "hysteresis": NamedEvader(
        evasive.hysteresis, evasive.HYSTERESIS, "paper; between free rays, a turn has its cost"
    ),
    "two-leg": NamedEvader(
        evasive.two_leg, evasive.TWO_LEG, "hysteresis; nothing free: a first leg after which a ray is safe"
    ),
    "dodge": NamedEvader(
        evasive.dodging, evasive.DODGING, "hysteresis; nothing free: early across the nearest line of sight"
    ),
    "evasive": NamedEvader(
        evasive.evasive, evasive.EVASIVE, "two-leg; else the best of some turns, played against the pursuers"
    ),
    "straight": NamedEvader(evasion.straight, evasion.STRAIGHT, "for comparison: straight to the target"),
}

DEFAULT = "paper"  # of evaders
DEFAULT_PURSUER = "parallel-pursuit"  # Table 1's scenarios and the paper's spatial games name `paper`


def evader_named(name: str) -> str:
    """The name of an evader's strategy; "" is the default's."""
    return name or DEFAULT


def pursuer_named(name: str) -> str:
    """The name of a pursuer's strategy; "" is the default's."""
    return name or DEFAULT_PURSUER
