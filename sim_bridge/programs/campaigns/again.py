"""One game of a campaign again: computed with its picture, or flown whole."""

from __future__ import annotations

import tempfile
from math import isnan
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.config.strict import ConfigError
from onboard.core.game.referee import GameResult
from onboard.core.strategy.registry import pursuer_named
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario
from onboard.runtime.run_folder import made
from sim_bridge.campaign.compiled import campaign, starts_of
from sim_bridge.plane_game.setup import conditions_of
from sim_bridge.plane_game.setup import game_of as begun
from sim_bridge.programs.campaigns import shards
from sim_bridge.programs.campaigns.plan import Cell, Plan, is_spatial
from sim_bridge.programs.campaigns.play import drawn, simple_games, spatial_game, spatial_row
from sim_bridge.programs.campaigns.rows import Row
from sim_bridge.programs.run_folder import toml_of


class Game(NamedTuple):
    """One game of a campaign."""

    plan: Plan
    cell: Cell
    seed: int
    kept: Row | None  # as its shard has it; None where that is missing


def game_of(folder: Path, text: str) -> Game:
    """The game `CELL:SEED` of a campaign's folder. Raises ConfigError."""
    plan = shards.read_plan(folder)
    first, colon, second = text.partition(":")
    cells, seeds = plan.cell_count, range(plan.first_seed, plan.first_seed + plan.games)
    right = bool(colon) and first.isdecimal() and second.isdecimal()
    if not right or int(first) >= cells or int(second) not in seeds:
        raise ConfigError(
            f"GAME: found {text!r}, expected CELL:SEED, a cell from 0 to {cells - 1} (see show) and a seed"
            f" from {seeds.start} to {seeds.stop - 1}"
        )
    number, seed = int(first), int(second)
    shard = next(s for s in plan.shards() if number in s.cells and seed in s.seeds)
    path = folder / shards.file_name(plan, shard)
    kept = shards.row_of(path, number, seed) if path.exists() and shards.sound(path, plan, shard) else None
    return Game(plan, plan.cell(number), seed, kept)


class Replayed(NamedTuple):
    """A game played again."""

    row: Row  # how it ended now
    pictures: list[Path]
    why_not: str  # why the evader was not captured; "" where it was, and of several evaders


def replay(game: Game, folder: Path) -> Replayed:
    """Play a game again and draw it. Raises ConfigError."""
    from sim_bridge.campaign.figures import draw_stages

    cell, seed = game.cell, game.seed
    if game.plan.flown:
        raise ConfigError("replay: found a campaign of flights, expected a computed one (see `fly`)")
    made(folder)
    name = f"{cell.label}-{cell.number}-{seed}".replace("/", "-")
    if is_spatial(cell.scenario):
        flown = spatial_game(game.plan, cell, seed)
        row = spatial_row(cell, seed, flown)
        pictures = draw_stages(drawn(cell, seed), flown, folder, name)
        return _explained(game, row, pictures, flown.log[:, :, :3])
    [row] = simple_games(cell, range(seed, seed + 1))
    scenario = drawn(cell, seed)
    if scenario.several:
        return Replayed(row, _several(scenario, row, folder, name), "")
    if scenario.planar:
        from sim_bridge.plane_game.figures import draw_game
        from sim_bridge.plane_game.program import play

        played = play(scenario, pursuer_named(scenario.pursuers[0].strategy))
        frames = [[g.evader.position, *(p.position for p in g.pursuers)] for g in played.frames]
        return _explained(game, row, draw_game(played, folder, name), np.array(frames))
    seen = _in_space(scenario, row)
    return _explained(game, row, draw_stages(scenario, seen, folder, name), seen.log)


def _explained(game: Game, row: Row, pictures: list[Path], places: NDArray[np.float64]) -> Replayed:
    """A game with the picture of why its evader was not captured, where it was not."""
    if row.verdict == GameResult.CAPTURED.name.lower() or len(places) < 2:
        return Replayed(row, pictures, "")
    from sim_bridge.campaign.why_not import ways_of, why_not

    scenario = drawn(game.cell, game.seed)
    aircraft = is_spatial(game.cell.scenario)
    step = 1.0 / scenario.flight.control_rate_hz if aircraft else conditions_of(scenario).control.dt
    path = pictures[0].with_name(f"{pictures[0].stem}-why-not.png")
    words = why_not(scenario, ways_of(scenario, places, step, aircraft), path)
    return Replayed(row, [*pictures, path], words)


def _several(scenario: Scenario, row: Row, folder: Path, name: str) -> list[Path]:
    """The picture of a game of several evaders."""
    if scenario.planar:
        from sim_bridge.plane_game.several import play
        from sim_bridge.plane_game.several_figures import draw_game

        return draw_game(play(scenario, scenario.pursuers[0].strategy), folder, name)
    from sim_bridge.campaign.figures import draw_stages
    from sim_bridge.programs.campaigns.several import ends_of

    dt = conditions_of(scenario).control.dt
    ends = ends_of([scenario], keep=int(row.time / dt) + 1)
    log = ends.trace[0][~np.isnan(ends.trace[0][:, 0, 0])]
    first, team = len(scenario.evading), len(scenario.pursuers)
    order = [0, *range(first, first + team), *range(1, first)]  # as the scenario has its vehicles
    verdict = GameResult[row.verdict.upper()]
    seen: Any = SimpleNamespace(log=log[:, order], verdict=verdict, time=row.time, smallest=row.smallest)
    return draw_stages(scenario, seen, folder, name)


def _in_space(scenario: Scenario, row: Row) -> Any:
    """A game of simple motion in space as its picture wants it: the paths, and how it ended."""
    conditions = conditions_of(scenario)
    starts = starts_of([begun(scenario)], [conditions.target.position])
    steps = int(row.time / conditions.control.dt) + 1
    decide = evader_strategy(scenario.evader.strategy), pursuer_strategy(scenario.pursuers[0].strategy)
    ends = campaign(*decide, len(scenario.pursuers), compiled=False)(starts, conditions, keep=steps)
    places = ends.trace[0]
    log = places[~np.isnan(places[:, 0, 0])]
    verdict = GameResult(int(ends.verdicts[0]))
    return SimpleNamespace(log=log, verdict=verdict, time=row.time, smallest=row.smallest)


def agrees(game: Game, row: Row) -> bool:
    """Whether a game played again is the one of its shard, number by number."""
    if game.kept is None:
        return True
    return all(a == b or (isinstance(a, float) and isnan(a)) for a, b in zip(game.kept, row, strict=True))


def scenario_file(game: Game) -> str:
    """The game as a scenario file for `fly`, its draw written out."""
    data = drawn(game.cell, game.seed).contents()
    return toml_of(data)


def fly(game: Game, runs: Path, report: bool) -> str:
    """Fly a game whole on virtual time, agents included; the story of it."""
    from sim_bridge.programs import fly as room

    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "scenario.toml"
        path.write_text(scenario_file(game), encoding="utf-8")
        return room.story(room.fly(path, room.Options(fast=True, runs=runs, report=report, quiet=True)))
