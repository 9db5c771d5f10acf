"""Games of several evaders: one evader plays as ever, two far apart as two games, who is captured is out."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import cos, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.game.advance import Conditions, Game, begin, decide_by_plan, moved_on
from onboard.core.game.many import (
    ManyConditions,
    ManyGame,
    begin_many,
    decide_many,
    deserted,
    moved_many,
    over,
    planned_many,
    prepared,
    unplanned_many,
)
from onboard.core.game.planning import planned, steps_between, unplanned
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.game.targets import NONE, chosen
from onboard.core.game.views import EvaderView, PursuerView
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, Vec, distance, scale
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.core.strategy.team.planner import engaged
from onboard.core.strategy.team.quarry import quarries_of

RULES = Rules(2.0, 4.0, horizon=40.0, planar=True, target_known=True)
CONTROL = Control(0.1)


def by(name: str) -> Callable[[EvaderView, int], Decision]:
    """All evaders by one strategy."""
    decide = EVADERS[name].decide
    return lambda view, _number: decide(view)


def vehicle(x: float, y: float, speed: float, down: float = 0.0) -> Vehicle:
    return Vehicle(Vec(x, y, down), scale(NORTH, speed), speed)


def target(x: float, y: float) -> Target:
    return Target(True, Vec(x, y, 0.0))


def game_of(evaders: list[Vehicle], pursuers: list[Vehicle]) -> ManyGame:
    return begin_many(tuple(evaders), tuple(pursuers), (FREE,) * len(evaders), (FREE,) * len(pursuers))


def conditions_of(*targets: tuple[Target, ...], rules: Rules = RULES) -> ManyConditions:
    return ManyConditions(rules, targets, CONTROL)


def played(game: ManyGame, conditions: ManyConditions, evader: str, pursuers: str) -> list[ManyGame]:
    """All instants of a game."""
    plans = unplanned_many(game)
    every = steps_between(conditions.control.dt)
    frames = [game]
    while not over(game):
        due = (len(frames) - 1) % every == 0 or deserted(game)
        game = prepared(game, conditions, due, quarries_of)
        if due and pursuers == "team":
            plans = planned_many(game, conditions, plans, engaged)
        decided = decide_many(game, conditions, by(evader), PURSUERS[pursuers].decide, plans)
        game = moved_many(game, conditions, decided)
        frames.append(game)
    return frames


def played_alone(game: Game, conditions: Conditions, evader: str, pursuers: str) -> list[Game]:
    """All instants of a game of one evader, by `advance`'s own functions."""
    plan, frames = unplanned(game), [game]
    while game.score.verdict == GameResult.RUNNING:
        if pursuers == "team" and (len(frames) - 1) % steps_between(conditions.control.dt) == 0:
            plan = planned(game, conditions, plan)
        ways = EVADERS[evader].decide, PURSUERS[pursuers].decide
        game = moved_on(game, conditions, decide_by_plan(game, conditions, *ways, plan.assignments))
        frames.append(game)
    return frames


places = st.tuples(st.floats(15.0, 90.0), st.floats(-pi, pi))


@settings(max_examples=15, deadline=None)
@given(
    team=st.lists(places, min_size=1, max_size=4),
    goal=st.none() | places,
    pursuers=st.sampled_from(["paper", "team", "goalkeeper", "abreast"]),
    separation=st.sampled_from([0.0, 5.0]),
    planar=st.booleans(),
)
def test_one_evader_with_one_target_plays_as_ever(
    team: list[tuple[float, float]],
    goal: tuple[float, float] | None,
    pursuers: str,
    separation: float,
    planar: bool,
) -> None:
    rules = RULES._replace(horizon=12.0, separation=separation, target_known=goal is not None, planar=planar)
    aim = NO_TARGET if goal is None else target(goal[0] * cos(goal[1]), goal[0] * sin(goal[1]))
    who = [
        vehicle(far * cos(yaw), far * sin(yaw), 4.0, 0.0 if planar else 5.0 * k)
        for k, (far, yaw) in enumerate(team)
    ]
    several = played(
        game_of([vehicle(0, 0, 5.0)], who), conditions_of((aim,), rules=rules), "paper", pursuers
    )
    first = begin(vehicle(0, 0, 5.0), tuple(who), FREE, (FREE,) * len(who))
    one = played_alone(first, Conditions(rules, aim, CONTROL), "paper", pursuers)
    assert len(several) == len(one)
    for mine, its in zip(several, one, strict=True):
        assert (mine.evaders, mine.pursuers, mine.scores) == ((its.evader,), its.pursuers, (its.score,))


@pytest.mark.parametrize("pursuers", ["paper", "team", "goalkeeper"])
def test_two_evaders_far_apart_play_as_two_games(pursuers: str) -> None:
    """Each flies straight at its target: one that looks for free rays heeds cones from however far."""
    here = [vehicle(30, 5, 4.0), vehicle(-20, 30, 4.0), vehicle(40, -30, 4.0)]
    there = [vehicle(9030, 15, 4.0), vehicle(8990, 40, 4.0), vehicle(9050, -20, 4.0)]
    goals = target(-70, 0), target(9080, 10)
    mixed = [member for pair in zip(here, there, strict=True) for member in pair]
    both = played(
        game_of([vehicle(0, 0, 5.0), vehicle(9000, 0, 5.0)], mixed),
        conditions_of((goals[0],), (goals[1],)), "straight", pursuers,
    )  # fmt: skip
    together = [frame for frame in both[1:] if all(score.verdict == 0 for score in frame.scores)]
    assert len(together) > 30
    assert {frame.quarries for frame in together} == {(0, 1, 0, 1, 0, 1)}
    ways = zip((here, there), (0.0, 9000.0), goals, strict=True)
    for number, (team, x, goal) in enumerate(ways):
        first = begin(vehicle(x, 0, 5.0), tuple(team), FREE, (FREE,) * 3)
        one = played_alone(first, Conditions(RULES, goal, CONTROL), "straight", pursuers)
        # A team plans at once where an evader leaves: from there on its plans come at other instants.
        last = min(len(one), len(together)) if pursuers == "team" else len(one)
        mine, its = both[last - 1], one[last - 1]
        assert mine.scores[number].verdict == its.score.verdict
        assert pursuers == "team" or its.score.verdict != GameResult.RUNNING
        assert mine.scores[number].time == pytest.approx(its.score.time, abs=1e-6)
        assert distance(mine.evaders[number].position, its.evader.position) < 1e-5
        for k, member in enumerate(its.pursuers):
            assert distance(mine.pursuers[2 * k + number].position, member.position) < 1e-5


def test_who_is_captured_is_out_and_its_pursuers_go_for_the_others() -> None:
    caught, far = vehicle(0, 0, 1.0), vehicle(300, 0, 1.0)
    game = game_of(
        [caught, far], [vehicle(8, 0, 4.0), vehicle(-8, 0, 4.0), vehicle(0, 9, 4.0), vehicle(240, 0, 4.0)]
    )
    frames = played(
        game, conditions_of((NO_TARGET,), (NO_TARGET,), rules=RULES._replace(horizon=90.0)), "paper", "paper"
    )
    first, second = frames[-1].scores
    assert (first.verdict, second.verdict) == (GameResult.CAPTURED, GameResult.CAPTURED)
    assert first.time < second.time
    out = next(k for k, frame in enumerate(frames) if frame.scores[0].verdict == GameResult.CAPTURED)
    still = {frame.evaders[0] for frame in frames[out:]}
    assert len(still) == 1
    assert {frame.scores[0] for frame in frames[out:]} == {first}
    assert set(frames[out].quarries) > {0}
    assert all(set(frame.quarries) == {1} for frame in frames[out + 1 :])
    before, after = frames[out], frames[-1]
    assert distance(after.pursuers[0].position, Vec(300, 0, 0)) < distance(
        before.pursuers[0].position, Vec(300, 0, 0)
    )


def test_every_pursuer_counts_in_every_evaders_judgement() -> None:
    """Who flies through another's quarry captures it."""
    passing = vehicle(40, 0, 8.0)
    game = game_of([vehicle(20, 0.5, 0.01), vehicle(0, 0, 0.01)], [vehicle(60, 0, 8.0), vehicle(15, 8, 0.02)])
    frames = played(game, conditions_of((NO_TARGET,), (NO_TARGET,)), "straight", "pure-pursuit")
    assert passing.speed == 8.0
    assert [score.captor for score in frames[-1].scores] == [0, 0]


def test_to_reach_any_of_several_targets_is_to_arrive_and_the_free_one_is_chosen() -> None:
    """A pursuer stands on the nearer target: the evader goes for the other, and keeps to it."""
    evader, guard = vehicle(0, 0, 5.0), vehicle(30, 0, 4.9)
    nearer, other = target(40, 0), target(0, -55)
    frames = played(game_of([evader], [guard]), conditions_of((nearer, other)), "paper", "paper")
    assert frames[-1].scores[0].verdict == GameResult.ARRIVED
    assert distance(frames[-1].evaders[0].position, other.position) < 2.0
    assert {frame.aims for frame in frames[1:]} == {(1,)}
    alone = played(game_of([evader], [guard]), conditions_of((nearer,)), "paper", "paper")
    assert alone[-1].scores[0].time > frames[-1].scores[0].time


def test_of_two_targets_as_far_the_one_it_flies_to_is_kept() -> None:
    """A pursuer crosses in front of both in turn: hysteresis, not a change at every step."""
    frames = played(
        game_of([vehicle(0, 0, 5.0)], [vehicle(60, 3, 3.0)]),
        conditions_of((target(80, 60), target(80, -60)), rules=RULES._replace(horizon=30.0)),
        "paper",
        "paper",
    )
    aims = [frame.aims[0] for frame in frames[1:]]
    changes = sum(a != b for a, b in pairwise(aims))
    assert changes <= 1
    assert frames[-1].scores[0].verdict == GameResult.ARRIVED


@pytest.mark.parametrize(
    ("guards", "verdict"),
    [([(50.0, 0.0), (0.0, 50.0)], GameResult.DENIED), ([(50.0, 0.0)], GameResult.ESCAPED)],
)
def test_denied_only_where_every_target_is_held(
    guards: list[tuple[float, float]], verdict: GameResult
) -> None:
    """Pursuers that stand on the targets, an evader that stands still: the horizon decides."""
    game = game_of([vehicle(0, 0, 1e-3)], [vehicle(x, y, 1e-3) for x, y in guards])
    goals = conditions_of((target(50, 0), target(0, 50)), rules=RULES._replace(horizon=1.0))
    frames = played(game, goals, "straight", "paper")
    assert frames[-1].scores[0].verdict == verdict


def test_a_target_is_left_for_a_clearly_sooner_one_only() -> None:
    """50 m, and 46 or 35 m the other way: 8 % less is not enough, 30 % is."""
    own, goal = vehicle(0, 0, 5.0), target(50, 0)
    for other, expected in ((target(-46, 0), (0, 1, 1)), (target(-35, 0), (1, 1, 1))):
        found = (chosen(own, FREE, (), (goal, other), True, before) for before in (0, 1, NONE))
        assert tuple(found) == expected
    assert chosen(own, FREE, (), (NO_TARGET, NO_TARGET), True, NONE) == NONE


def test_a_pursuer_knows_those_of_its_own_quarry_as_its_team() -> None:
    """Others stand in the tuple without speed and far away, and are still mates to keep away from."""
    pursuers = [vehicle(10, 0, 4.0), vehicle(12, 0, 4.0), vehicle(500, 0, 4.0)]
    game = game_of([vehicle(0, 30, 5.0), vehicle(500, 30, 5.0)], pursuers)._replace(quarries=(0, 1, 1))
    conditions = conditions_of((NO_TARGET,), (NO_TARGET,), rules=RULES._replace(separation=5.0))
    seen: list[PursuerView] = []

    def spy(view: PursuerView) -> Decision:
        seen.append(view)
        return PURSUERS["paper"].decide(view)

    decide_many(game, conditions, by("paper"), spy, unplanned_many(game))
    assert [[member.speed > 0.0 for member in view.members] for view in seen] == [
        [True, False, False], [False, True, True], [False, True, True],
    ]  # fmt: skip
    assert [view.evader.position.x for view in seen] == [0.0, 500.0, 500.0]
    assert seen[0].mate.position == pursuers[1].position
