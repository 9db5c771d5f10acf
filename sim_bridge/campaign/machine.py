"""The spatial game for strategies at hand: several of each side in one kernel."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.team.flying import pursuer_team
from onboard.core.strategy.team.planner import engaged
from sim_bridge.campaign.spatial_game import Array, Chosen, SpatialPlay, Start, Ways
from sim_bridge.campaign.spatial_lanes import InLanes, moved_in_lanes
from sim_bridge.campaign.spatial_play import approach, moved_one_by_one, play
from sim_bridge.campaign.team_play import stand_by

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


@cache
def machine(
    evaders: tuple[EvaderStrategy, ...], pursuers: tuple[PursuerStrategy, ...], in_lanes: bool
) -> Callable[..., SpatialPlay]:
    """The game of these strategies: `play` of a start, `Chosen`, a sky and a log.

    One compiled kernel holds all of them, so that a matrix of strategies is compiled once. `in_lanes`: the
    sky is `InLanes`, for a kernel that is compiled, else `OneByOne`.
    """
    evade, pursue = among(evaders), among(pursuers)
    planner = engaged if pursuer_team in pursuers else stand_by
    motion = moved_in_lanes if in_lanes else moved_one_by_one

    def played(start: Start, chosen: Chosen, sky: Any, log: Array) -> SpatialPlay:
        return play(start, Ways(evade, pursue, chosen, planner), motion(), sky, log)

    return played


def approach_in_lanes(start: Start, sky: InLanes) -> None:
    """`approach` for a kernel that is compiled."""
    approach(start, moved_in_lanes(), sky)
