"""The core compiled: the same source, registered with numba, played at millions of steps a second.

The core itself knows nothing of numba. `register()` marks every kernel of the given modules as
compilable (`register_jitable`), functions found in closures included, and gives `each` its
compiled form: a tuple written out in full for the length at hand. `campaign()` plays many games
of one size, in the plane or in space, from arrays of starts.

Compiling takes some ten seconds a number of pursuers; what is compiled is kept on disk (`kernel_cache`).
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from types import FunctionType, ModuleType
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

from onboard.core.game.advance import (
    Conditions,
    EvaderStrategy,
    Game,
    PursuerStrategy,
    advance,
    begin,
    decide_by_plan,
    moved_on,
)
from onboard.core.game.planning import planning_by, steps_between, unplanned
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Target
from onboard.core.math import each as each_module
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import Vec
from onboard.core.strategy.team.plan_types import Plan
from onboard.core.strategy.team.planners import planner_for
from sim_bridge.campaign.each_compiled import compile_each
from sim_bridge.campaign.kernel_cache import kept, kernel
from sim_bridge.campaign.reached import reached

KERNELS = (
    "onboard.core.math.vectors",
    "onboard.core.math.angles",
    "onboard.core.geometry.apollonius",
    "onboard.core.geometry.cones",
    "onboard.core.geometry.rims",
    "onboard.core.geometry.edges",
    "onboard.core.geometry.free_ray",
    "onboard.core.geometry.zones",
    "onboard.core.geometry.zone_rays",
    "onboard.core.geometry.zone_ways",
    "onboard.core.game.views",
    "onboard.core.geometry.lead",
    "onboard.core.math.angles",
    "onboard.core.strategy.denial",
    "onboard.core.strategy.evasion",
    "onboard.core.strategy.own_air",
    "onboard.core.strategy.keep_out",
    "onboard.core.strategy.foresight",
    "onboard.core.strategy.evasive",
    "onboard.core.strategy.pursuit",
    "onboard.core.strategy.features",
    "onboard.core.strategy.policy",
    "onboard.core.strategy.choosing",
    "onboard.core.strategy.semantic.graph",
    "onboard.core.strategy.semantic.goals",
    "onboard.core.strategy.semantic.relations",
    "onboard.core.strategy.team.assignment",
    "onboard.core.strategy.team.closure",
    "onboard.core.strategy.team.flying",
    "onboard.core.strategy.team.abreast",
    "onboard.core.strategy.team.guarding",
    "onboard.core.strategy.team.parts",
    "onboard.core.strategy.team.plan_types",
    "onboard.core.strategy.team.planner",
    "onboard.core.strategy.team.ring",
    "onboard.core.strategy.team.staging",
    "onboard.core.strategy.team.timed",
    "onboard.core.game.referee",
    "onboard.core.game.advance",
    "onboard.core.game.planning",
)

# Everything is inlined, or else the many small functions would pass whole games by value; but
# these are called from many places and would swell the code.
OUT_OF_LINE = frozenset(
    {"free_ray_limited", "by_pairs", "nearest_allowed", "allow", "restart", "listen", "foreseen", "hunted"}
    | {"two_legs", "chase"}
    | {"assigned", "engaged", "way_out_at", "least_gap"}
    | {"one_of_many", "way_round", "free_ray_beside", "first_entered", "blocked", "entry", "way_out_of"}
    | {"sector_of", "face_of", "level_met", "first_met", "_spread"}
    | {"blow", "fly_ordered", "fly_commanded", "measure", "hear"}
)

OURS = ("onboard.core", "onboard.pilot", "sim_bridge")  # where kernels are registered by their modules

Array = NDArray[np.float64]
T = TypeVar("T", bound=tuple[Callable[..., Any], ...])

_registered: set[int] = set()


def register(modules: Iterable[str] = KERNELS) -> None:
    """Register every function of the modules with numba; idempotent."""
    compile_each()
    for name in modules:
        for function in _functions(importlib.import_module(name)):
            _register(function)


def _functions(module: ModuleType) -> list[FunctionType]:
    return [value for value in vars(module).values() if isinstance(value, FunctionType)]


def _register(function: FunctionType) -> None:
    if id(function) in _registered or function.__module__ == each_module.__name__:
        return
    if not function.__module__.startswith(OURS):
        return
    _registered.add(id(function))
    _register_parts(function)
    register_jitable(forceinline=function.__name__ not in OUT_OF_LINE, no_cfunc_wrapper=True)(function)


def _register_parts(function: FunctionType) -> None:
    for cell in function.__closure__ or ():
        if isinstance(cell.cell_contents, FunctionType):
            _register(cell.cell_contents)


def in_arrays(strategies: T) -> T:
    """Strategies as compiled code takes them: of a trained one the kernel whose weights are an array."""
    found: Any = tuple(getattr(strategy, "kernel", strategy) for strategy in strategies)
    same: T = found
    return same


def register_strategies(functions: Iterable[Callable[..., Any]]) -> None:
    """Register functions of any module, plug-ins' too, with those of their closures; idempotent."""
    for function in functions:
        if isinstance(function, FunctionType) and id(function) not in _registered:
            _registered.add(id(function))
            _register_parts(function)
            register_strategies(reached(function, OURS))
            register_jitable(forceinline=True, no_cfunc_wrapper=True)(function)


class Starts(NamedTuple):
    """Where many games of one size begin. Player 0 is the evader; NED [m], [m/s]."""

    positions: Array  # (games, players, 3)
    velocities: Array  # (games, players, 3)
    speeds: Array  # (games, players)
    limits: Array  # (games, players, 6), in the order of `VehicleLimits`
    targets: Array  # (games, 3), unused where the conditions say that there is no target


class Ends(NamedTuple):
    """How they ended."""

    verdicts: NDArray[np.int64]  # (games,) of `GameResult`
    times: Array  # (games,) of the verdict [s]
    captors: NDArray[np.int64]  # (games,) index of the pursuer, −1 = none
    smallest: Array  # (games,) smallest distance [m]
    unsafe: Array  # (games,) time within the safety distance [s]
    steps: NDArray[np.int64]  # (games,) played
    trace: Array  # (games, kept + 1, players, 3) places at the start and after every step, NaN after the end


def starts_of(games: Sequence[Game], targets: Sequence[Vec]) -> Starts:
    """The starts of games made elsewhere (from `onboard.core.game.advance.begin`), one target each."""
    teams = [(game.evader, *game.pursuers) for game in games]
    limits = [(game.evader_limits, *game.pursuer_limits) for game in games]
    return Starts(
        np.array([[v.position for v in team] for team in teams], dtype=float),
        np.array([[v.velocity for v in team] for team in teams], dtype=float),
        np.array([[v.speed for v in team] for team in teams], dtype=float),
        np.array(limits, dtype=float),
        np.array(targets, dtype=float),
    )


class _Table(NamedTuple):
    """The starts and the game that is being built from them."""

    starts: Starts
    game: int


def _vehicle(player: int, _index: int, table: _Table) -> Vehicle:
    """A player of the game at its start (for `each`)."""
    p = table.starts.positions[table.game, player]
    v = table.starts.velocities[table.game, player]
    return Vehicle(
        Vec(float(p[0]), float(p[1]), float(p[2])),
        Vec(float(v[0]), float(v[1]), float(v[2])),
        float(table.starts.speeds[table.game, player]),
    )


def _limits(player: int, _index: int, table: _Table) -> VehicleLimits:
    """What that player may do (for `each`)."""
    a = table.starts.limits[table.game, player]
    return VehicleLimits(
        float(a[0]), float(a[1]), float(a[2]), float(a[3]), float(a[4]), float(a[5]), float(a[6])
    )


def _begin(table: _Table, pursuers: tuple[int, ...]) -> Game:
    """The game before its first step."""
    return begin(
        _vehicle(0, 0, table),
        each(_vehicle, pursuers, table),
        _limits(0, 0, table),
        each(_limits, pursuers, table),
    )


def _aimed(conditions: Conditions, target: Array) -> Conditions:
    """The conditions with a game's own target."""
    place = Vec(float(target[0]), float(target[1]), float(target[2]))
    return Conditions(conditions.rules, Target(conditions.target.exists, place), conditions.control)


def _note(game: Game, places: Array) -> None:
    """Write everybody's place down, (players, 3)."""
    places[0, 0] = game.evader.position.x
    places[0, 1] = game.evader.position.y
    places[0, 2] = game.evader.position.z
    for k in range(len(game.pursuers)):
        place = game.pursuers[k].position
        places[k + 1, 0] = place.x
        places[k + 1, 1] = place.y
        places[k + 1, 2] = place.z


def _blank(starts: Starts, keep: int) -> Ends:
    """Ends to be filled, with room for everybody's places over the first `keep` steps."""
    games, players = starts.speeds.shape
    rows = keep + 1 if keep > 0 else 0
    return Ends(
        np.zeros(games, np.int64), np.zeros(games), np.zeros(games, np.int64), np.zeros(games),
        np.zeros(games), np.zeros(games, np.int64), np.full((games, rows, players, 3), np.nan),
    )  # fmt: skip


def _as_fast(now: Vehicle, start: Vehicle, _shared: float) -> Vehicle:
    """A pursuer with the speed that it started with (for `each_pair`)."""
    return Vehicle(now.position, now.velocity, start.speed)


Campaign = Callable[..., Ends]


@cache
def _player(
    decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy, pursuers: int, compiled: bool
) -> Callable[[Starts, Conditions, Ends, int, int], None]:
    """Plays games first…last − 1 of the starts into the ends."""
    team = tuple(range(1, pursuers + 1))
    planner = planner_for(decide_pursuer)
    if planner is not None:
        pair = decide_evader, decide_pursuer
        return _planning_player(pair, planning_by(planner), team, compiled)

    def play(starts: Starts, conditions: Conditions, ends: Ends, first: int, last: int) -> None:
        kept = ends.trace.shape[1]
        for number in range(first, last):
            mine = _aimed(conditions, starts.targets[number])
            start = _begin(_Table(starts, number), team)
            game = start
            steps = 0
            if kept > 0:
                _note(game, ends.trace[number, 0])
            while game.score.verdict == GameResult.RUNNING:
                now = advance(game, mine, decide_evader, decide_pursuer)
                # Limits and speeds never change: taken from the start, they stay out of the compiled loop.
                game = Game(
                    now.time,
                    Vehicle(now.evader.position, now.evader.velocity, start.evader.speed),
                    each_pair(_as_fast, now.pursuers, start.pursuers, 0.0),
                    start.evader_limits,
                    start.pursuer_limits,
                    now.score,
                )
                steps += 1
                if steps < kept:
                    _note(game, ends.trace[number, steps])
            _close(ends, number, game, steps)

    return _ready(play, (decide_evader, decide_pursuer), compiled)


def _planning_player(
    pair: tuple[EvaderStrategy, PursuerStrategy],
    planned: Callable[[Game, Conditions, Plan], Plan],
    team: tuple[int, ...],
    compiled: bool,
) -> Callable[[Starts, Conditions, Ends, int, int], None]:
    """`_player` for pursuers that fly by a plan."""
    decide_evader, decide_pursuer = pair

    def play(starts: Starts, conditions: Conditions, ends: Ends, first: int, last: int) -> None:
        kept = ends.trace.shape[1]
        every = steps_between(conditions.control.dt)
        for number in range(first, last):
            mine = _aimed(conditions, starts.targets[number])
            start = _begin(_Table(starts, number), team)
            game = start
            plan = unplanned(game)
            steps = 0
            if kept > 0:
                _note(game, ends.trace[number, 0])
            while game.score.verdict == GameResult.RUNNING:
                if steps % every == 0:
                    plan = planned(game, mine, plan)
                decided = decide_by_plan(game, mine, decide_evader, decide_pursuer, plan.assignments)
                now = moved_on(game, mine, decided)
                game = Game(
                    now.time, now.evader, now.pursuers, start.evader_limits, start.pursuer_limits, now.score
                )
                steps += 1
                if steps < kept:
                    _note(game, ends.trace[number, steps])
            _close(ends, number, game, steps)

    return _ready(play, (*pair, planned), compiled)


def _close(ends: Ends, number: int, game: Game, steps: int) -> None:
    """Write down how a game ended."""
    ends.verdicts[number] = game.score.verdict
    ends.times[number] = game.score.time
    ends.captors[number] = game.score.captor
    ends.smallest[number] = game.score.smallest
    ends.unsafe[number] = game.score.unsafe
    ends.steps[number] = steps


def _ready(
    play: Callable[..., None], strategies: tuple[Callable[..., Any], ...], compiled: bool
) -> Callable[..., None]:
    """The kernel of a play, or the play itself."""
    if not compiled:
        return play
    register((*KERNELS, __name__))
    register_strategies(strategies)
    return kernel(play, True, "numpy")


def campaign(
    decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy, pursuers: int, compiled: bool = True
) -> Callable[..., Ends]:
    """The play of many games of one size under two strategies in kernel style.

    Returns `play(starts, conditions, workers=1, keep=0) -> Ends`: the games go to that many threads (compiled
    code holds no interpreter lock), and `keep` records everybody's places over the first so many
    steps. The games differ in their starts, speeds, limits and targets; the rest of the conditions,
    `planar` too, is common to a call. Compiles at the first call; `compiled=False` runs the same
    functions interpreted. Raises ValueError where the arrays' shapes disagree.
    """

    def play(starts: Starts, conditions: Conditions, workers: int = 1, keep: int = 0) -> Ends:
        games, players = starts.positions.shape[0], pursuers + 1
        shapes = ((players, 3), (players, 3), (players,), (players, len(VehicleLimits._fields)), (3,))
        for name, array, shape in zip(Starts._fields, starts, shapes, strict=True):
            if array.shape != (games, *shape):
                raise ValueError(f"{name}: shape {array.shape}, expected {(games, *shape)}")
        starts = Starts(*(np.ascontiguousarray(array, dtype=np.float64) for array in starts))
        ends = _blank(starts, keep)
        pair = in_arrays((decide_evader, decide_pursuer)) if compiled else (decide_evader, decide_pursuer)
        run = _player(*pair, pursuers, compiled)
        if workers <= 1 or games < 2 * workers:
            run(starts, conditions, ends, 0, games)
            return ends
        # Small parts, because games differ in length; each writes into rows of its own.
        edges = np.linspace(0, games, 8 * workers + 1).astype(int).tolist()
        with ThreadPoolExecutor(workers) as pool:
            parts = pairwise(edges)
            list(pool.map(lambda part: run(starts, conditions, ends, *part), parts))
        return ends

    return play


def needs_no_compiling(
    decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy, starts: Starts, conditions: Conditions
) -> bool:
    """Whether games of these strategies were compiled before: in this process, or on disk."""
    pair = in_arrays((decide_evader, decide_pursuer))
    run = _player(*pair, starts.speeds.shape[1] - 1, True)
    return kept(run, starts, conditions, _blank(starts, 1), 0, 1)
