"""`sim-bridge planar`: the paper's plane game, and Table 1."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.game.advance import (
    Conditions,
    Decisions,
    EvaderStrategy,
    Game,
    PursuerStrategy,
    decide,
    decide_by_plan,
    moved_on,
)
from onboard.core.game.planning import planning_by, steps_between, unplanned
from onboard.core.game.referee import GameResult
from onboard.core.math.vectors import Vec
from onboard.core.strategy.team.planners import planner_for
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario, load
from onboard.runtime.resources import configs
from sim_bridge.plane_game.setup import conditions_of, game_of

EARLIER = "earlier"
THIS_PAPER = "paper"
TABLE1_HORIZONS = (55.7, 120.4)  # [s] within which all 30 verdicts of Table 1 come out, at steps of 0.05 s


class Played(NamedTuple):
    """A played game."""

    scenario: Scenario
    strategy: str
    conditions: Conditions
    frames: tuple[Game, ...]  # every step, for pictures
    final: Game  # at the instant of the verdict

    @property
    def verdict(self) -> GameResult:
        """How it ended."""
        return self.final.score.verdict

    def decisions(self, index: int) -> Decisions:
        """Those taken at the instant of a frame, reckoned anew: a picture needs two of thousands."""
        decide_evader: EvaderStrategy = evader_strategy(self.scenario.evader.strategy)
        decide_pursuer: PursuerStrategy = pursuer_strategy(self.strategy)
        game = self.frames[index]
        planner = planner_for(decide_pursuer)
        if planner is None:
            return decide(game, self.conditions, decide_evader, decide_pursuer)
        parts = planning_by(planner)(game, self.conditions, unplanned(game)).assignments
        return decide_by_plan(game, self.conditions, decide_evader, decide_pursuer, parts)


class Result(msgspec.Struct, frozen=True):
    """What `--json` prints of one game."""

    scenario: str
    strategy: str
    verdict: str
    escapes: bool
    reaches: bool | None  # None without a target
    time: float  # of the verdict [s]
    captor: int  # number of the pursuer, 0 = none
    smallest_distance: float  # [m]
    time_within_safety_distance: float  # [s]
    dt: float
    final_positions: list[tuple[float, float]]  # evader, then pursuers (north, east) [m]
    expected_escapes: bool | None
    expected_reaches: bool | None


def play(scenario: Scenario, strategy: str, dt: float | None = None, keep: bool = True) -> Played:
    """Play a plane game under a pursuers' strategy; `keep` records every step."""
    conditions = conditions_of(scenario, dt)
    decide_evader: EvaderStrategy = evader_strategy(scenario.evader.strategy)
    decide_pursuer: PursuerStrategy = pursuer_strategy(strategy)
    game = game_of(scenario)
    frames = []
    before = game
    planner = planner_for(decide_pursuer)
    plan, every, steps = unplanned(game), steps_between(conditions.control.dt), 0
    while game.score.verdict == GameResult.RUNNING:
        if keep:
            frames.append(game)
        before = game
        if planner is not None and steps % every == 0:
            plan = planning_by(planner)(game, conditions, plan)
        decided = decide_by_plan(game, conditions, decide_evader, decide_pursuer, plan.assignments)
        game = moved_on(game, conditions, decided)
        steps += 1
    final = cut(before, game)
    if keep:
        frames.append(final)
    return Played(scenario, strategy, conditions, tuple(frames), final)


def cut(before: Game, after: Game) -> Game:
    """The game at the instant of its verdict, which may lie within the last step."""
    whole = after.time - before.time
    share = min(1.0, (after.score.time - before.time) / whole) if whole > 0.0 else 1.0

    def part(a: Vec, b: Vec) -> Vec:
        return Vec(a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, a.z + (b.z - a.z) * share)

    pairs = zip(before.pursuers, after.pursuers, strict=True)
    return after._replace(
        time=after.score.time,
        evader=after.evader._replace(position=part(before.evader.position, after.evader.position)),
        pursuers=tuple(b._replace(position=part(a.position, b.position)) for a, b in pairs),
    )


def result(played: Played) -> Result:
    """The figures of a played game."""
    score = played.final.score
    expect = played.scenario.expect
    vehicles = (played.final.evader, *played.final.pursuers)
    judged = expect is not None and played.strategy in (THIS_PAPER, EARLIER)
    wanted = None
    if expect is not None and judged:
        wanted = expect.escapes_earlier if played.strategy == EARLIER else expect.escapes
    return Result(
        played.scenario.name,
        played.strategy,
        score.verdict.name.lower(),
        score.verdict != GameResult.CAPTURED,
        score.verdict == GameResult.ARRIVED if played.conditions.target.exists else None,
        round(score.time, 6),
        score.captor + 1,
        round(score.smallest, 6),
        round(score.unsafe, 6),
        played.conditions.control.dt,
        [(round(v.position.x, 6), round(v.position.y, 6)) for v in vehicles],
        wanted,
        expect.reaches if expect is not None and played.strategy == THIS_PAPER else None,
    )


def table1() -> list[Path]:
    """The scenario files of Table 1's ten rows."""
    return sorted((configs() / "scenarios" / "table1").glob("row*.toml"))


def load_plane(paths: Iterable[Path]) -> list[Scenario]:
    """Load scenarios and demand that they are plane. Raises ConfigError."""
    scenarios = []
    for path in paths:
        scenario = load(path, several=True)
        if not scenario.planar:
            raise ConfigError(f"{path}: position: found three numbers, expected two (a plane game)")
        scenarios.append(scenario)
    return scenarios


def within_horizon(scenarios: list[Scenario], horizon: float | None) -> list[Scenario]:
    """The same scenarios with another horizon [s]; None: their own."""
    if horizon is None:
        return scenarios
    return [
        msgspec.structs.replace(s, parameters=msgspec.structs.replace(s.parameters, horizon=horizon))
        for s in scenarios
    ]


def verdict_line(agree: int, total: int, scenarios: Iterable[Scenario], whole_table: bool) -> str:
    """How many verdicts agree, and within which horizon: an evader that is still flying then has escaped."""
    horizons = sorted({scenario.parameters.horizon for scenario in scenarios})
    listed = ", ".join(f"{horizon:g}" for horizon in horizons)
    line = f"{agree} of {total} verdicts as in the paper, within a horizon of {listed} s"
    if whole_table:
        low, high = TABLE1_HORIZONS
        line += f" (30 of 30 hold from {low:g} to {high:g} s only: --horizon)"
    return line


def differs(results: Iterable[Result]) -> tuple[int, int]:
    """How many verdicts agree with the paper's, and how many there are.

    A row without a target counts its "–" as the verdict on the target, as the paper's table does.
    """
    agree = total = 0
    for r in results:
        if r.expected_escapes is not None:
            total += 1
            agree += r.escapes == r.expected_escapes
            if r.strategy == THIS_PAPER:
                total += 1
                agree += r.reaches == r.expected_reaches
    return agree, total


def table(results: list[Result]) -> str:
    """The table that people read: a line a scenario, all strategies beside each other."""
    by_name: dict[str, list[Result]] = {}
    for r in results:
        by_name.setdefault(r.scenario, []).append(r)
    rows = [("scenario", "escapes", "paper", "reaches", "paper", "how it went, by the pursuers' strategy")]
    for name, games in by_name.items():
        first = next((g for g in games if g.strategy == THIS_PAPER), games[0])
        rows.append(
            (
                name,
                "/".join(_word(g.escapes) for g in games),
                "/".join(_word(g.expected_escapes) for g in games),
                _word(first.reaches),
                _word(first.expected_reaches),
                ";  ".join(_story(g) for g in games),
            )
        )
    widths = [max(len(row[i]) for row in rows) for i in range(6)]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]
    lines.insert(1, "  ".join("-" * width for width in widths))
    return "\n".join(lines)


def _word(value: bool | None) -> str:
    return "–" if value is None else ("Yes" if value else "No")


def _story(game: Result) -> str:
    distance = f"nearest {game.smallest_distance:5.2f} m"
    return f"{game.strategy}: {game.verdict:8} {game.time:6.2f} s, {distance}"
