"""A team's plan in a game of simple motion: made at its own rate, known to everybody at once.

Kernel style. Aircraft games have delay and loss besides (`sim_bridge/campaign/team_play`).
"""

from __future__ import annotations

from collections.abc import Callable

from onboard.core.game.advance import Conditions, Game
from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.game.views import told
from onboard.core.math.each import each_pair
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Plan, Situation, nearest_staged
from onboard.core.strategy.team.planner import EVERY, Planner, engaged, no_plan


def steps_between(dt: float) -> int:
    """How many steps of `dt` [s] pass from one plan to the next."""
    return max(1, int(EVERY / dt + 0.5))


def seat(vehicle: Vehicle, limits: VehicleLimits, _shared: float) -> Member:
    """A pursuer as a member of the team (for `each_pair`)."""
    return Member(vehicle, limits, True)


def members(game: Game) -> tuple[Member, ...]:
    """All pursuers as the team."""
    return each_pair(seat, game.pursuers, game.pursuer_limits, 0.0)


def situation(game: Game, conditions: Conditions) -> Situation:
    """What the planner knows: everything, a step ago."""
    return situation_of(game, conditions, members(game))


def situation_of(game: Game, conditions: Conditions, team: tuple[Member, ...]) -> Situation:
    """What the planner of a team knows, which need not be all of the pursuers."""
    rules = conditions.rules
    return Situation(
        game.time, 0.0, game.evader, game.evader_limits, team, told(conditions.target, rules), ZERO,
        rules, Heights(-1e9, 1e9), Margin(conditions.control.dt, 0.0), game.evader.position,
        nearest_staged(rules), (NO_TARGET,),
    )  # fmt: skip


def with_targets(s: Situation, targets: tuple[Target, ...]) -> Situation:
    """The same situation of an evader that has several targets."""
    return Situation(
        s.now, s.t0, s.evader, s.evader_limits, s.team, s.target, s.wind, s.rules, s.heights, s.margin,
        s.expected, s.nearest, targets,
    )  # fmt: skip


def unplanned(game: Game) -> Plan:
    """The plan before the first."""
    return no_plan(members(game), game.time)


def planning_by(planner: Planner) -> Callable[[Game, Conditions, Plan], Plan]:
    """`planned` by another planner than the one of `team`."""

    def planned_so(game: Game, conditions: Conditions, previous: Plan) -> Plan:
        return planner(situation(game, conditions), previous)

    return planned_so


def planned(game: Game, conditions: Conditions, previous: Plan) -> Plan:
    """The team's next plan."""
    return engaged(situation(game, conditions), previous)
