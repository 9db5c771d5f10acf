"""Thousands of games in one call: the array interface of the learning environments.

A game is its seed: game k of a reset with seed s has the seed `first_seed(s) + k`, and the one that follows
it in its place the seed `games` further on, in whichever order and on however many threads they are played.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from math import radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import EvaderStrategy, Game, PursuerStrategy
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.scenario import Scenario
from sim_bridge.campaign.flight_lanes import WORD_BLOCK
from sim_bridge.campaign.lanes import LANES, twins
from sim_bridge.campaign.spatial_draw import KERNELS
from sim_bridge.campaign.spatial_fixed import eye_of
from sim_bridge.campaign.tracks import WIDTH
from sim_bridge.gym import simple
from sim_bridge.gym.exchange import Exchange, demand_shapes, exchange
from sim_bridge.gym.simple import Parts, Run, idle_evader, idle_pursuer, step_all, unfit
from sim_bridge.gym.starts import Table, World
from sim_bridge.gym.task import HEIGHT_SHARE, Task, agents_of
from sim_bridge.plane_game.setup import conditions_of, game_of

ROOMS = ("sim_bridge.gym.starts", "sim_bridge.gym.simple", "sim_bridge.gym.flown")


def first_seed(seed: int) -> int:
    """The seed of a reset's first game, spread over 62 bits: seeds beside each other share no game."""
    return int(np.random.SeedSequence(seed).generate_state(1, np.uint64)[0] >> np.uint64(2))


class BatchedGames:
    """Many games of one task, stepped together.

    `arrays` are what a step reads and writes; write actions into them, or give arrays of your own to the
    constructor. Deterministic: seed and actions fix every number.
    """

    def __init__(
        self, task: Task, games: int, arrays: Exchange | None = None, workers: int = 1, compiled: bool = True
    ) -> None:
        """`workers`: threads of a step. `compiled=False` runs the same source interpreted, for a few games.

        Raises ValueError for arrays that do not fit.
        """
        if not 1 <= games <= 10_000_000 or not 1 <= workers <= 1024:
            found = f"found {games} with {workers} workers"
            raise ValueError(f"games: {found}, expected 1 to 10,000,000 with 1 to 1024")
        self.task = task
        self.games = games
        self.agents = agents_of(task.scenario)
        expected = exchange(games, len(self.agents) - 1, task.form)
        if arrays is not None:
            demand_shapes(arrays, expected)
        self.arrays = expected if arrays is None else arrays
        evader, pursuers = task.evader or idle_evader, task.pursuers or idle_pursuer
        if compiled:
            evader, pursuers = getattr(evader, "kernel", evader), getattr(pursuers, "kernel", pursuers)
        self._world, self._table, self._kernels = self._make(evader, pursuers, compiled)
        self._edges: list[int] = np.linspace(0, games, min(workers, games) + 1).astype(int).tolist()
        self._parts = [(self._apart(), *part) for part in pairwise(self._edges)]
        self._pool = ThreadPoolExecutor(workers) if workers > 1 else None
        self._begun = False

    def _make(
        self, evader: EvaderStrategy, pursuers: PursuerStrategy, compiled: bool
    ) -> tuple[World, Table, tuple[Callable[..., Any], ...]]:
        """What the games share, where they stand, and the kernels: the step, the check of actions."""
        world = world_of(self.task)
        return world, table_of(world, self.games), _kernels(evader, pursuers, world.noisy, compiled)

    @property
    def places(self) -> NDArray[np.float64]:
        """Where everybody is (games, players, 3) [m; NED], the evader first."""
        return self._table.places

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Velocities through the air (games, players, 3) [m/s; NED]."""
        return self._table.velocities

    @property
    def seeds(self) -> NDArray[np.int64]:
        """The games' seeds (games,)."""
        return self._table.seeds

    @property
    def winds(self) -> NDArray[np.float64]:
        """Each game's wind (games, 2): north and east [m/s], where the air moves to."""
        return self._table.winds

    @property
    def times(self) -> NDArray[np.float64]:
        """Since each game's start (games,) [s]."""
        return self._table.clock[:, 0]

    def reset(self, seed: int = 0, seeds: NDArray[np.int64] | None = None) -> Exchange:
        """Begin all games anew; `seeds` (games,) in place of those of `seed`."""
        if seeds is None:
            seeds = first_seed(seed) + np.arange(self.games, dtype=np.int64)
        if seeds.shape != (self.games,) or seeds.dtype.kind not in "iu":
            found = f"found {seeds.dtype} of shape {seeds.shape}"
            raise ValueError(f"seeds: {found}, expected integers of shape ({self.games},)")
        self._table.seeds[:] = seeds
        self._begun = True
        self._run(0, True)
        return self.arrays

    def step(self, again: bool = True) -> Exchange:
        """One control step of every game under the actions in `arrays`.

        A game that ends begins anew under its next seed where `again` says so; else it stands, with rewards
        of 0, until the next reset. Raises ValueError for an action that is no number: then nothing has moved.
        """
        if not self._begun:
            raise ValueError("step: found no game, expected reset() before the first step")
        bad = self._kernels[1](self.arrays, self._world, Run(0, self.games, 0, False))
        if bad >= 0:
            raise ValueError(f"actions: game {bad}: found a number that is not finite, expected −1 to 1")
        self._run(self.games if again else 0, False)
        return self.arrays

    def _run(self, stride: int, begins: bool) -> None:
        def play(part: tuple[Table, int, int]) -> None:
            table, first, last = part
            self._kernels[0](table, self._world, self.arrays, Run(first, last, stride, begins))

        if self._pool is None:
            play(self._parts[0])
        else:
            list(self._pool.map(play, self._parts))

    def _apart(self) -> Table:
        """The table with room of its own to draw in: threads share the rest."""
        states, words, noise = room(len(self.agents))
        return self._table._replace(states=states, words=words, noise=noise)


def world_of(task: Task) -> World:
    """What all games of a task share."""
    scenario = task.scenario
    conditions = conditions_of(scenario)
    learns = np.array([name in task.learners for name in agents_of(scenario)])
    sensor = scenario.flight.sensor
    noisy = sensor.sigma > 0.0 or sensor.sigma_velocity > 0.0 or sensor.delay_s > 0.0 or sensor.dropout > 0.0
    form: Any = task.form
    return World(
        _plain(game_of(scenario)),
        conditions,
        scenario.flight.wind.speed,
        eye_of(scenario, conditions.control.dt)._replace(keys=()),
        noisy,
        form._replace(axes=int(form.axes), steering=int(form.steering)),
        task.rewards,
        task.spread,
        0.0 if scenario.planar else HEIGHT_SHARE * task.spread,
        headings_of(scenario),
        np.array(scenario.ids),
        scenario.seed,
        learns,
        bool(learns[1:].any()),
        not bool(learns[1:].all()),
    )


def _plain(game: Game) -> Game:
    """A game without members of enumerations: a compiled call takes half a millisecond to look one up."""
    score: Any = game.score
    return game._replace(score=score._replace(verdict=0))


def headings_of(scenario: Scenario) -> NDArray[np.float64]:
    """Declared headings at the start [rad], NaN where none is."""
    declared = [v.heading_deg for v in scenario.vehicles]
    return np.array([np.nan if angle is None else radians(angle) for angle in declared])


def table_of(world: World, games: int) -> Table:
    """Room for so many games."""
    players = len(world.ids)
    slots = world.eye.delay // world.eye.period + 2 if world.noisy else 1
    tracked = games if world.noisy else 1
    return Table(
        np.zeros((games, players, 3)), np.zeros((games, players, 3)), np.zeros((games, 3)),
        np.zeros(games, np.int64), np.zeros(games, np.int64), np.zeros((games, 2)), np.zeros((games, 4)),
        np.zeros((games, players, 2)),
        np.zeros((tracked, players, 2), np.int64),
        np.zeros((tracked, slots, players, 7)),
        np.zeros((tracked, players, WIDTH)), np.full((tracked, players), -1.0), *room(players),
    )  # fmt: skip


def room(players: int) -> tuple[Any, ...]:
    """Where a thread draws a game's noise: `states`, `words` and `noise` of a table."""
    blocks = -(-players // LANES)
    return np.zeros((players, 6)), np.zeros((blocks, WORD_BLOCK), np.int64), np.zeros((blocks, 6 * LANES))


def register_games() -> None:
    """Register what games for learners are compiled of; idempotent."""
    from sim_bridge.campaign.compiled import register, register_strategies

    register((*KERNELS, "onboard.core.strategy.features", "onboard.core.strategy.policy", *ROOMS))
    register_strategies(twins())


@cache
def _kernels(
    decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy, noisy: bool, compiled: bool
) -> tuple[Callable[..., Any], ...]:
    """The step (and the beginning), and the check of actions."""
    listen = simple.listen if noisy else simple.deaf
    others = simple.others_by_tracks if noisy else simple.others_there
    sighting = simple.sighting_by_track if noisy else simple.sighting_there

    def steps(table: Table, world: World, arrays: Exchange, run: Run) -> None:
        step_all(table, world, arrays, run, Parts(decide_evader, decide_pursuer, listen, others, sighting))

    if not compiled:
        return steps, unfit
    from sim_bridge.campaign.compiled import register_strategies
    from sim_bridge.campaign.kernel_cache import kernel

    register_games()
    register_strategies((decide_evader, decide_pursuer))
    counted = bool({decide_evader, decide_pursuer} - _OWN)  # a plug-in may make lists
    return tuple(kernel(function, counted, "numpy") for function in (steps, unfit))


_OWN = frozenset((
    idle_evader, idle_pursuer,
    *(one.decide for one in EVADERS.values()), *(one.decide for one in PURSUERS.values()),
))  # fmt: skip
