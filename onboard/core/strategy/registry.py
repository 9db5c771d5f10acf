"""All strategies by name, each with the table it comes from."""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.game.views import EvaderView, PursuerView
from onboard.core.strategy import evasion, pursuit
from onboard.core.strategy.knowledge import Rule


class NamedPursuer(NamedTuple):
    """A pursuer's strategy and its knowledge base."""

    decide: PursuerStrategy
    table: tuple[Rule[PursuerView], ...]


class NamedEvader(NamedTuple):
    """An evader's strategy and its knowledge base."""

    decide: EvaderStrategy
    table: tuple[Rule[EvaderView], ...]


PURSUERS: dict[str, NamedPursuer] = {
    "paper": NamedPursuer(pursuit.pursuer, pursuit.PURSUER),
    "predictive": NamedPursuer(pursuit.pursuer_predictive, pursuit.PURSUER_PREDICTIVE),
    "earlier": NamedPursuer(pursuit.pursuer_earlier, pursuit.PURSUER_EARLIER),
    "pure-pursuit": NamedPursuer(pursuit.pursuer_pure, pursuit.PURE),
    "constant-bearing": NamedPursuer(pursuit.pursuer_bearing, pursuit.BEARING),
    "proportional-navigation": NamedPursuer(pursuit.pursuer_navigation, pursuit.NAVIGATION),
}

EVADERS: dict[str, NamedEvader] = {
    "paper": NamedEvader(evasion.evader, evasion.EVADER),
    "straight": NamedEvader(evasion.straight, evasion.STRAIGHT),
}

DEFAULT = "paper"
