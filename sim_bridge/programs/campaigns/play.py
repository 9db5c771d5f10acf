"""Plays the games of a shard: aircraft in their wind or simple motion, compiled, or whole flights."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache
from typing import Any, NamedTuple

from onboard.config.strict import ConfigError
from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.game.referee import GameResult
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario
from onboard.runtime.progress import Tell, silent
from sim_bridge.campaign.compiled import campaign, starts_of
from sim_bridge.campaign.matrix import matrix
from sim_bridge.campaign.spatial_campaign import Played, play_drawn
from sim_bridge.campaign.spatial_draw import draw, drawn_scenario
from sim_bridge.campaign.spatial_fixed import Sides
from sim_bridge.campaign.spatial_game import Chosen
from sim_bridge.plane_game.setup import conditions_of, game_of
from sim_bridge.programs.campaigns import several
from sim_bridge.programs.campaigns.plan import Cell, Plan, Shard, is_spatial, spread_of
from sim_bridge.programs.campaigns.playing import compiled_or_not
from sim_bridge.programs.campaigns.rows import EvaderRow, Row

PAIRS = 6  # of strategies up to which each has the fastest kernel, its own; beyond, compiling takes longer
GOLDEN = 0.618033988749895  # its multiples modulo 1 lie apart, however many there are


def rows(plan: Plan, shard: Shard, tell: Tell = silent) -> Iterator[Row]:
    """All games of a shard, cell by cell. Raises ConfigError."""
    found: dict[int, list[Row]] = {}
    for place, number in enumerate(turned(shard)):
        tell(place / len(shard.cells), f"cell {number}")
        found[number] = list(_games(plan, plan.cell(number), shard.seeds))
    for number in shard.cells:
        yield from found[number]


def turned(shard: Shard) -> list[int]:
    """The cells in the order in which they are played: each shard begins elsewhere, every second one with the
    last cells, so that workers who begin together do not all wait for the same kernels."""
    cells = list(shard.cells)
    first = round(len(cells) * (shard.number // 2 * GOLDEN % 1.0)) % len(cells)
    order = cells[first:] + cells[:first]
    return order[::-1] if shard.number % 2 else order


def _games(plan: Plan, cell: Cell, seeds: range) -> Iterable[Row]:
    """The games of a cell."""
    if plan.flown:
        return (_flown(cell, seed) for seed in seeds)
    if is_spatial(cell.scenario):
        return (spatial_row(cell, seed, spatial_game(plan, cell, seed)) for seed in seeds)
    return simple_games(cell, seeds, _shared_by(plan))


def drawn(cell: Cell, seed: int) -> Scenario:
    """The scenario of a game: the cell's, with what the seed draws."""
    return drawn_scenario(cell.scenario, seed, spread_of(cell.scenario))


# ---------------------------------------------------------------- aircraft in wind


def spatial_game(plan: Plan, cell: Cell, seed: int) -> Played:
    """One game of aircraft in their wind, with its paths."""
    sides = _sides(cell, _shared_by(plan))
    one = draw(cell.scenario, seed)._replace(sides=sides)
    return play_drawn(one, sides.chosen.evader)


def spatial_row(cell: Cell, seed: int, played: Played) -> Row:
    """How a game of aircraft ended."""
    score = played.play.game.score
    return Row(cell.number, seed, played.verdict.name.lower(), played.time, played.smallest,
               int(score.captor) + 1, float(score.unsafe), played.reversals)  # fmt: skip


class _Shared(NamedTuple):
    """The strategies of the house that a campaign's one kernel holds."""

    evaders: tuple[str, ...]
    pursuers: tuple[str, ...]


ALONE = _Shared((), ())


def _shared_by(plan: Plan) -> _Shared:
    """Those of a plan."""
    return _shared(tuple((pair.evader, pair.pursuers) for pair in plan.pairs))


@cache
def _shared(pairs: tuple[tuple[str, str], ...]) -> _Shared:
    """Those of all pairs that are the core's own; a plug-in has a kernel for itself."""
    return _Shared(
        tuple(sorted({evader for evader, _pursuers in pairs} & set(EVADERS))),
        tuple(sorted({pursuers for _evader, pursuers in pairs} & set(PURSUERS))),
    )


def _sides(cell: Cell, shared: _Shared) -> Sides:
    """The strategies of a cell's kernel, and who flies by which."""
    scenario = cell.scenario
    names = [spec.strategy for spec in scenario.pursuers]
    evaders, pursuers = shared
    if scenario.evader.strategy not in evaders:
        evaders = (scenario.evader.strategy,)
    if not set(names) <= set(pursuers):
        pursuers = tuple(sorted(set(names)))
    chosen = Chosen(evaders.index(scenario.evader.strategy), tuple(pursuers.index(name) for name in names))
    return Sides(
        tuple(evader_strategy(name) for name in evaders),
        tuple(pursuer_strategy(name) for name in pursuers),
        chosen,
    )


# ---------------------------------------------------------------- simple motion


def simple_games(cell: Cell, seeds: range, shared: _Shared = ALONE) -> list[Row]:
    """Games of simple motion, all in one call of the kernel; of many strategies all share one."""
    games = [drawn(cell, seed) for seed in seeds]
    if cell.scenario.several:
        return several.games_of(cell.number, games, seeds)
    conditions = conditions_of(games[0])
    starts = starts_of([game_of(one) for one in games], [conditions.target.position] * len(games))
    pair = cell.scenario.evader.strategy, cell.scenario.pursuers[0].strategy
    together = len(shared.evaders) * len(shared.pursuers) > PAIRS
    if together and pair[0] in shared.evaders and pair[1] in shared.pursuers:
        numbers = shared.evaders.index(pair[0]), shared.pursuers.index(pair[1])
        ends = _together(shared, len(games[0].pursuers))(starts, conditions, *numbers)
    else:
        ends = _simple(*pair, len(games[0].pursuers))(starts, conditions)
    return [
        Row(cell.number, seed, GameResult(int(ends.verdicts[k])).name.lower(), float(ends.times[k]),
            float(ends.smallest[k]), int(ends.captors[k]) + 1, float(ends.unsafe[k]), -1)
        for k, seed in enumerate(seeds)
    ]  # fmt: skip


@cache
def _together(shared: _Shared, count: int) -> Callable[..., Any]:
    """The play of many games by any two of the strategies, compiled once for all."""
    sides = tuple(map(evader_strategy, shared.evaders)), tuple(map(pursuer_strategy, shared.pursuers))
    return matrix(*sides, count)


@cache
def _simple(evader: str, pursuers: str, count: int) -> Callable[..., Any]:
    """The play of many games, compiled; interpreted where a plug-in does not compile."""
    flee: EvaderStrategy = evader_strategy(evader)
    chase: PursuerStrategy = pursuer_strategy(pursuers)
    return compiled_or_not((evader,), pursuers, lambda kernel: campaign(flee, chase, count, kernel))


# ---------------------------------------------------------------- flights


def _flown(cell: Cell, seed: int) -> Row:
    """One game flown whole on virtual time: agents, MAVLink, sensor and bus; nothing is recorded."""
    from onboard.runtime.loop import run_virtual, virtual_clock
    from sim_bridge.rehearsal import Rehearsal
    from sim_bridge.world.summary import Summary

    scenario = drawn(cell, seed)

    async def whole() -> Summary:
        async with Rehearsal(scenario, virtual_clock()) as game:
            await game.until_ended()
            await game.land_agents()
            return game.summary()

    summary = run_virtual(whole())
    if summary.verdict == "none":
        raise ConfigError(f"{cell.label}, seed {seed}: found no outcome of the flight, expected a verdict")
    def captor(id: int) -> int:
        return scenario.pursuer_ids.index(id) + 1 if id in scenario.pursuer_ids else 0

    def metres(smallest: float | None) -> float:
        return float("nan") if smallest is None else smallest

    each = tuple(
        EvaderRow(one.verdict, one.time, metres(one.smallest_distance), captor(one.captor), float("nan"))
        for one in summary.evaders
    )
    return Row(cell.number, seed, summary.verdict, summary.time, metres(summary.smallest_distance),
               captor(summary.captor), float("nan"), -1, each)  # fmt: skip
