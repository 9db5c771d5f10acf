"""Many games with the aircraft as flown, at once: the array interface over `flown`."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from onboard.config.strict import ConfigError
from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.strategy.team.planners import planner_for
from sim_bridge.campaign.compiled import in_arrays, register_strategies
from sim_bridge.campaign.ledger import DECIDES, KNOWS
from sim_bridge.campaign.spatial_draw import (
    Draw,
    Spread,
    compiled_kernel,
    draw,
    drawn_scenario,
    sky_of,
)
from sim_bridge.campaign.spatial_fixed import demand_spatial
from sim_bridge.campaign.spatial_lanes import InLanes, moved_in_lanes
from sim_bridge.campaign.spatial_play import moved_one_by_one
from sim_bridge.campaign.tracks import Tracks
from sim_bridge.gym.batch import BatchedGames, register_games, table_of, world_of
from sim_bridge.gym.exchange import Exchange
from sim_bridge.gym.flown import Craft, Skies, fly_all, sky_in_lanes, sky_in_list
from sim_bridge.gym.simple import Run, unfit
from sim_bridge.gym.starts import Table, World
from sim_bridge.gym.task import HEIGHT_SHARE, Task


class AircraftGames(BatchedGames):
    """As `BatchedGames`, flown: a step is a control step of the agents, and a game begins as in campaigns."""

    def __init__(
        self, task: Task, games: int, arrays: Exchange | None = None, workers: int = 1, compiled: bool = True
    ) -> None:
        """Raises ConfigError for a scenario that compiled games do not fly, ValueError as `BatchedGames`."""
        demand_spatial(task.scenario)
        if planner_for(task.pursuers) is not None:
            raise ConfigError(
                "pursuers: found 'team', expected a strategy without a plan, with motion 'aircraft'"
            )
        self._compiled = compiled
        self._skies: Skies | None = None
        super().__init__(task, games, arrays, workers, compiled)

    def _make(self, evader: EvaderStrategy, pursuers: PursuerStrategy, compiled: bool) -> tuple[Any, ...]:
        world = world_of(self.task)._replace(noisy=False, wind=0.0)
        return world, table_of(world, self.games), _kernels(evader, pursuers, compiled)

    def _run(self, stride: int, begins: bool) -> None:
        if begins:
            self._begin(range(self.games))
        self._fly(begins)
        if begins or stride == 0:
            return
        ended = np.flatnonzero(self.arrays.verdicts).tolist()
        if ended:
            self._follow(ended, stride)

    def _follow(self, ended: list[int], stride: int) -> None:
        """Begin the games anew that have ended; how they ended stays told."""
        verdicts = self.arrays.verdicts.copy()
        for g in ended:
            self._table.seeds[g] += stride
        self._begin(ended)
        for g in ended:
            self._part((g, g + 1), True)
            self.arrays.verdicts[g] = verdicts[g]

    def _begin(self, games: Any) -> None:
        spread = Spread(self.task.spread, HEIGHT_SHARE * self.task.spread)
        for g in games:
            scenario = drawn_scenario(self.task.scenario, int(self._table.seeds[g]), spread)
            self._put(g, draw(scenario, 0, compiled=self._compiled))

    def _put(self, g: int, drawn: Draw) -> None:
        """A drawn game in place of game `g`."""
        sky: Any = sky_of(drawn, self._compiled)
        if self._skies is None:
            self._skies = _room(drawn, sky, self.games, self._compiled)
        skies, start = self._skies, drawn.start
        skies.starts[g] = start
        if self._compiled:
            for one, many in zip(_leaves(sky), _leaves(skies.skies), strict=True):
                many[g] = one
        else:
            skies.skies[g] = sky
        skies.decided[g] = 0.0
        skies.samples[g] = start.pace.t0
        table, first = self._table, start.game
        for i, vehicle in enumerate((first.evader, *first.pursuers)):
            table.places[g, i] = vehicle.position
            table.velocities[g, i] = vehicle.velocity
        table.clock[g] = (0.0, first.score.smallest, 0.0)
        table.steps[g] = 0
        table.winds[g] = start.climate.reference[:2]

    def _fly(self, begins: bool) -> None:
        if self._pool is None:
            self._part((0, self.games), begins)
        else:
            list(self._pool.map(lambda part: self._part(part, begins), pairwise(self._edges)))

    def _part(self, part: tuple[int, int], begins: bool) -> None:
        shared = (self._world, self.arrays)
        # A game that ended is begun anew by `_run`, for its draw is made outside the kernel.
        self._kernels[0](self._table, self._skies, shared, Run(*part, 0, begins))


def _leaves(sky: InLanes) -> list[Any]:
    return [*sky[:5], *sky.seen]


def _room(drawn: Draw, sky: Any, games: int, compiled: bool) -> Skies:
    """Room for so many games like one."""
    players = len(drawn.players)
    starts: Any = [drawn.start] * games
    skies: Any = [sky] * games
    if compiled:
        from numba.typed import List

        starts = List()
        for _ in range(games):
            starts.append(drawn.start)
        parts: list[Any] = [np.repeat(one[None], games, axis=0) for one in _leaves(sky)]
        skies = InLanes._make([*parts[:5], Tracks._make(parts[5:])])
    before, now, decided = (np.zeros((games, players, width)) for width in (KNOWS, KNOWS, DECIDES))
    return Skies(starts, skies, before, now, decided, np.zeros(games, np.int64))


@cache
def _kernels(
    decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy, compiled: bool
) -> tuple[Callable[..., Any], ...]:
    """The step (and the beginning), and the check of actions."""
    motion, sky_at = (moved_in_lanes, sky_in_lanes) if compiled else (moved_one_by_one, sky_in_list)

    def flies(table: Table, skies: Skies, shared: tuple[World, Exchange], run: Run) -> None:
        fly_all(table, skies, shared, run, Craft(decide_evader, decide_pursuer, motion(), sky_at))

    if not compiled:
        return flies, unfit
    from sim_bridge.campaign.kernel_cache import kernel

    register_games()
    register_strategies(in_arrays((decide_evader, decide_pursuer)))
    return compiled_kernel(flies), kernel(unfit)
