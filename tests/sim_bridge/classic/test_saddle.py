"""Optimal play of each classical problem is a saddle: it reaches the value, and no deviation helps."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin

import numpy as np
import pytest

from onboard.core.math.vectors import Vec
from sim_bridge.classic.play import Evader, Pursuers, Scene, ours, theirs
from sim_bridge.classic.problem import Problem, drawn, play
from sim_bridge.classic.problems import PROBLEMS, played_by_bench, start_of

TOLERANCE = {"s": 0.35, "m": 0.6, "": 0.0}  # of what steps of 0.05 s and a capture radius that is not 0 cost
WIDER = {"two-cars": 2.6, "target-attacker-defender": 1.2}  # [m] a grid's 0.06 radii; a radius of 1 m
FEINT = 3.0  # [s]
DEVIATIONS: list[tuple[float, float]] = [(0.5, 1e9), (-0.5, 1e9), (1.2, FEINT), (-1.2, FEINT)]


def turned(v: Vec, angle: float) -> Vec:
    return Vec(v.x * cos(angle) - v.y * sin(angle), v.x * sin(angle) + v.y * cos(angle), v.z)


def evader_aside(problem: Problem, angle: float, until: float) -> Evader:
    def fly(scene: Scene) -> Vec:
        wish = problem.evader(scene)
        return turned(wish, angle) if scene.game.time < until else wish

    return fly


def pursuers_aside(problem: Problem, angle: float, until: float) -> Pursuers:
    def fly(scene: Scene) -> tuple[Vec, ...]:
        wishes = problem.pursuers(scene)
        return tuple(turned(w, angle) for w in wishes) if scene.game.time < until else wishes

    return fly


def starts(problem: Problem) -> list[Scene]:
    """The file's start and one more, of the other winner where there is one near."""
    first = start_of(problem)
    rng, first_won = np.random.default_rng(3), problem.won(first, problem.value(first))
    others = [drawn(problem, first, rng) for _ in range(8)]
    changed = [one for one in others if problem.won(one, problem.value(one)) != first_won]
    return [first, (changed or others)[0]]


@pytest.mark.parametrize("name", PROBLEMS)
def test_optimal_play_reaches_the_value_and_no_deviation_helps(name: str) -> None:
    problem = PROBLEMS[name]
    off = WIDER.get(name, TOLERANCE[problem.unit])
    for number, start in enumerate(starts(problem)):
        value = problem.value(start)
        best = play(problem, start, problem.evader, problem.pursuers).end
        assert best.payoff == pytest.approx(problem.expected(value), abs=off)
        assert best.won == problem.won(start, value)
        for angle, until in DEVIATIONS[2 * number :]:
            worse = play(problem, start, evader_aside(problem, angle, until), problem.pursuers).end
            assert problem.pursuers_want * (worse.payoff - best.payoff) >= -off, ("evader", angle, until)
            worse = play(problem, start, problem.evader, pursuers_aside(problem, angle, until)).end
            assert problem.pursuers_want * (worse.payoff - best.payoff) <= off, ("pursuers", angle, until)


@pytest.mark.parametrize(
    ("name", "side", "strategy", "falls_short"),
    [
        ("convex-target", "pursuers", "pure-pursuit", True),
        ("convex-target", "pursuers", "parallel-pursuit", False),
        ("convex-target", "evader", "paper", True),
        ("lion-and-man", "pursuers", "pure-pursuit", True),
        ("capture-the-flag", "pursuers", "parallel-pursuit", True),
    ],
)
def test_ours_against_optimal_play(name: str, side: str, strategy: str, falls_short: bool) -> None:
    """Who chases from behind gives ground that parallel pursuit keeps; none of ours knows of the way back."""
    problem = PROBLEMS[name]
    start = start_of(problem)
    sides: Callable[[], tuple[Evader, Pursuers]] = (
        (lambda: (problem.evader, ours(strategy)()))
        if side == "pursuers"
        else (lambda: (theirs(strategy)(), problem.pursuers))
    )
    gap = play(problem, start, *sides()).end.payoff - problem.expected(problem.value(start))
    lost = -problem.pursuers_want * gap if side == "pursuers" else problem.pursuers_want * gap
    assert (lost > TOLERANCE[problem.unit] + 0.5) == falls_short


def test_who_takes_part_in_the_bench_plays_a_form_that_its_games_have() -> None:
    assert played_by_bench() == (
        "classic/two-cutters", "classic/convex-target", "classic/border-defence", "classic/lion-and-man",
    )  # fmt: skip
    for one in PROBLEMS.values():
        assert bool(one.left_out) == (f"classic/{one.name}" not in played_by_bench())
        assert min(map(len, (one.why, one.reference, one.rule))) > 10
