"""Plane games of several evaders or several targets: played, told, as one line an evader."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import msgspec

from onboard.core.game.many import (
    EvaderStrategies,
    ManyConditions,
    ManyGame,
    begin_many,
    decide_many,
    deserted,
    live,
    moved_many,
    over,
    planned_many,
    prepared,
    unplanned_many,
)
from onboard.core.game.planning import steps_between
from onboard.core.game.referee import GameResult, passage
from onboard.core.game.rules import NO_TARGET, Control, Target
from onboard.core.game.targets import NONE
from onboard.core.math.vectors import Vec
from onboard.core.strategy.team.planners import planner_for
from onboard.core.strategy.team.quarry import quarries_of
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario, targets_of
from sim_bridge.plane_game.setup import vehicles_of

COUNTED = ("captured", "arrived", "denied", "escaped")  # in the order in which they are told


def conditions_of(scenario: Scenario, dt: float | None = None) -> ManyConditions:
    """What a simulated game of the scenario is played under; `dt` [s] overrides its time step."""
    most = max(1, *(len(targets_of(spec)) for spec in scenario.evading))
    targets = []
    for spec in scenario.evading:
        own = [Target(True, place) for place in targets_of(spec)]
        targets.append((*own, *[NO_TARGET] * (most - len(own))))
    return ManyConditions(
        scenario.rules, tuple(targets), Control(scenario.parameters.dt if dt is None else dt)
    )


def game_of(scenario: Scenario) -> ManyGame:
    """The game before its first step."""
    team = 1 + len(scenario.pursuers)
    everybody = vehicles_of(scenario)
    return begin_many(
        (everybody[0], *everybody[team:]),
        everybody[1:team],
        tuple(spec.limits() for spec in scenario.evading),
        tuple(spec.limits() for spec in scenario.pursuers),
    )


def alone(scenario: Scenario, number: int) -> Scenario:
    """The game of one of the evaders, to the target that it goes for, against those who first have it.

    Where it is nobody's, against all pursuers.
    """
    replace = msgspec.structs.replace
    conditions = conditions_of(scenario)
    begun = prepared(game_of(scenario), conditions, True, quarries_of)
    spec, aim = scenario.evading[number], begun.aims[number]
    points = spec.targets if spec.target is None else (spec.target,)
    ids = scenario.pursuer_ids
    team = [k for k in range(len(ids)) if begun.quarries[k] == number] or range(len(ids))
    known = scenario.parameters.target_known and aim != NONE
    return replace(
        scenario,
        name=f"evader {scenario.evader_ids[number]}",
        description="",
        evader=replace(
            spec, id=scenario.evader_ids[number], targets=(), target=None if aim == NONE else points[aim]
        ),
        pursuers=tuple(replace(scenario.pursuers[k], id=ids[k]) for k in team),
        evaders=(),
        parameters=replace(scenario.parameters, target_known=known),
    )


def evaders_of(scenario: Scenario) -> EvaderStrategies:
    """Each evader's own strategy."""
    decide = [evader_strategy(spec.strategy) for spec in scenario.evading]
    return lambda view, number: decide[number](view)


class Played(NamedTuple):
    """A played game."""

    scenario: Scenario
    strategy: str  # of the pursuers
    conditions: ManyConditions
    frames: tuple[ManyGame, ...]  # every step, for pictures; else the last
    final: ManyGame  # every evader at the instant of its verdict

    @property
    def verdicts(self) -> list[str]:
        """How it ended for each evader."""
        return [score.verdict.name.lower() for score in self.final.scores]


def play(scenario: Scenario, strategy: str, dt: float | None = None, keep: bool = True) -> Played:
    """Play a plane game under a pursuers' strategy; `keep` records every step."""
    conditions = conditions_of(scenario, dt)
    flee, chase = evaders_of(scenario), pursuer_strategy(strategy)
    game = game_of(scenario)
    planner = planner_for(chase)
    plans, every, steps = unplanned_many(game), steps_between(conditions.control.dt), 0
    frames = []
    while not over(game):
        due = steps % every == 0 or deserted(game)
        before = prepared(game, conditions, due, quarries_of)
        if keep:
            frames.append(before)
        if due and planner is not None:
            plans = planned_many(before, conditions, plans, planner)
        decided = decide_many(before, conditions, flee, chase, plans)
        game = cut(before, moved_many(before, conditions, decided))
        steps += 1
    return Played(scenario, strategy, conditions, (*frames, game), game)


def cut(before: ManyGame, after: ManyGame) -> ManyGame:
    """The game after a step, evaders that left it within the step at the instant of their verdict."""
    whole = after.time - before.time
    evaders = list(after.evaders)
    for k, score in enumerate(after.scores):
        if live(before.scores[k]) and not live(score):
            share = min(1.0, (score.time - before.time) / whole)
            a, b = before.evaders[k].position, after.evaders[k].position
            place = Vec(a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, a.z + (b.z - a.z) * share)
            evaders[k] = after.evaders[k]._replace(position=place)
    return after._replace(evaders=tuple(evaders))


class EvaderResult(msgspec.Struct, frozen=True):
    """How a game ended for one evader."""

    id: int
    verdict: str
    time: float  # of the verdict [s]
    captor: int  # id of the pursuer, 0 = none
    target: int  # number of the target that it reached, counted from 1; 0 = none
    smallest_distance: float  # of any pursuer [m]
    time_within_safety_distance: float  # [s]
    final_position: tuple[float, float]  # (north, east) [m]


class Result(msgspec.Struct, frozen=True):
    """What `--json` prints of one game of several."""

    scenario: str
    strategy: str
    counts: dict[str, int]  # evaders by verdict
    time: float  # when the last evader left the game, or the horizon [s]
    evaders: list[EvaderResult]
    dt: float
    final_positions: dict[int, tuple[float, float]]  # of the pursuers, by id (north, east) [m]


def result(played: Played) -> Result:
    """The figures of a played game."""
    scenario, final = played.scenario, played.final
    told = [_evader(played, k) for k in range(len(final.evaders))]
    found = Counter(one.verdict for one in told)
    return Result(
        scenario.name,
        played.strategy,
        {word: found[word] for word in COUNTED},
        max(one.time for one in told),
        told,
        played.conditions.control.dt,
        {id: _flat(p.position) for id, p in zip(scenario.pursuer_ids, final.pursuers, strict=True)},
    )


def _evader(played: Played, number: int) -> EvaderResult:
    scenario, final = played.scenario, played.final
    score = final.scores[number]
    return EvaderResult(
        scenario.evader_ids[number],
        score.verdict.name.lower(),
        round(score.time, 6),
        scenario.pursuer_ids[score.captor] if score.captor >= 0 else 0,
        reached(played, number),
        round(score.smallest, 6),
        round(score.unsafe, 6),
        _flat(final.evaders[number].position),
    )


def reached(played: Played, number: int) -> int:
    """Which of its targets an evader has reached, counted from 1; 0 = none."""
    if played.final.scores[number].verdict != GameResult.ARRIVED:
        return 0
    place = played.final.evaders[number].position
    targets = played.conditions.targets[number]
    away = [
        passage(place, place, t.position, t.position, 0.0).smallest if t.exists else 1e300 for t in targets
    ]
    return 1 + min(range(len(away)), key=away.__getitem__)


def _flat(place: Vec) -> tuple[float, float]:
    return round(place.x, 6), round(place.y, 6)


def story(found: Result) -> str:
    """A game for people: a line for all, and one an evader."""
    counts = ", ".join(f"{count} {word}" for word, count in found.counts.items() if count)
    lines = [f"{found.scenario}, pursuers by {found.strategy}: of {len(found.evaders)} evaders {counts}"]
    for one in found.evaders:
        by = f" by {one.captor}" if one.captor else f" at target {one.target}" if one.target else ""
        lines.append(
            f"  evader {one.id:3d}: {one.verdict + by:22s} {one.time:7.2f} s,"
            f" nearest {one.smallest_distance:6.2f} m"
        )
    return "\n".join(lines)
