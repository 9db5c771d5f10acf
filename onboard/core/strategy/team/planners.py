"""Which planner makes the plan that a strategy flies by.

All of them fly their parts by the table `TEAM`; they differ in what the team knows and is after.
"""

from __future__ import annotations

from onboard.core.game.advance import PursuerStrategy
from onboard.core.strategy.knowledge import fold
from onboard.core.strategy.semantic.model import Model
from onboard.core.strategy.team.flying import TEAM, pursuer_team
from onboard.core.strategy.team.planner import Planner, engaged, engaged_plainly, planner_of

_PLANNERS: dict[PursuerStrategy, Planner] = {}


def flown_by(planner: Planner) -> PursuerStrategy:
    """A strategy of its own whose pursuers fly by this planner's plan."""
    decide = fold(TEAM)
    _PLANNERS[decide] = planner
    return decide


def team_of(model: Model) -> PursuerStrategy:
    """The strategy of a team that knows this model."""
    return flown_by(planner_of(model))


def planner_for(decide: PursuerStrategy | None) -> Planner | None:
    """The planner that a strategy flies by; None of one that needs no plan, and of none."""
    return None if decide is None else _PLANNERS.get(decide)


_PLANNERS[pursuer_team] = engaged
pursuer_team_plain = flown_by(engaged_plainly)
