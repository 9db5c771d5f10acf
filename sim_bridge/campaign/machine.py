"""The spatial game for strategies at hand: several of each side in one kernel."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from onboard.config.strict import ConfigError
from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.team.planner import Planner
from onboard.core.strategy.team.planners import planner_for
from sim_bridge.campaign.spatial_game import Array, Chosen, SpatialPlay, Start, Ways, planned_by
from sim_bridge.campaign.spatial_lanes import moved_in_lanes
from sim_bridge.campaign.spatial_play import Flying, approach, moved_one_by_one, play
from sim_bridge.campaign.team_play import SILENT, Messages

FEW = 2  # strategies of a side that are worth a copy for each of its players


def among(strategies: tuple[Callable[[Any], Decision], ...]) -> Callable[[Any, int], Decision]:
    """Strategies of one side as one function, of a view and the number of the strategy that decides."""
    if len(strategies) > FEW:
        strategies = tuple(map(_apart, strategies))
    decide = _last(strategies[-1])
    for number in range(len(strategies) - 2, -1, -1):
        decide = _either(number, strategies[number], decide)
    return decide


def _apart(strategy: Callable[[Any], Decision]) -> Callable[[Any], Decision]:
    """Out of line: many strategies in a kernel are compiled one by one, and once for all pursuers."""

    def one_of_many(view: Any) -> Decision:
        return strategy(view)

    return one_of_many


def _last(strategy: Callable[[Any], Decision]) -> Callable[[Any, int], Decision]:
    def only(view: Any, _number: int) -> Decision:
        return strategy(view)

    return only


def _either(
    mine: int, strategy: Callable[[Any], Decision], rest: Callable[[Any, int], Decision]
) -> Callable[[Any, int], Decision]:
    def either(view: Any, number: int) -> Decision:
        if number == mine:
            return strategy(view)
        return rest(view, number)

    return either


def only_planner(pursuers: tuple[PursuerStrategy, ...]) -> Planner | None:
    """The planner of those of a kernel's strategies that fly by a plan; None where none does.

    Raises ConfigError where they fly by the plans of several: a kernel has one planner.
    """
    found = {planner for decide in pursuers if (planner := planner_for(decide)) is not None}
    if len(found) > 1:
        raise ConfigError(f"pursuers: found strategies of {len(found)} planners, expected one in a game")
    return next(iter(found), None)


@cache
def machine(
    evaders: tuple[EvaderStrategy, ...], pursuers: tuple[PursuerStrategy, ...], in_lanes: bool
) -> Callable[..., SpatialPlay]:
    """The game of these strategies: `play` of a start, `Chosen`, who flies (`Flying`) and a log.

    One compiled kernel holds all of them, so that a matrix of strategies is compiled once. `in_lanes`: the
    sky is `InLanes`, for a kernel that is compiled, else `OneByOne`.
    """
    evade, pursue = among(evaders), among(pursuers)
    planner = only_planner(pursuers)
    messages = SILENT if planner is None else planned_by(planner)
    begin, exchange, part = messages
    motion = moved_in_lanes if in_lanes else moved_one_by_one

    def played(start: Start, chosen: Chosen, flying: Flying, log: Array) -> SpatialPlay:
        ways = Ways(evade, pursue, chosen, Messages(begin, exchange, part))
        return play(start, ways, motion(), flying, log)

    return played


def approach_in_lanes(start: Start, flying: Flying) -> None:
    """`approach` for a kernel that is compiled."""
    approach(start, moved_in_lanes(), flying)
