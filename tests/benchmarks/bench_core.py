"""What the core costs: interpreted beside NumPy, compiled beside a plain hand-written kernel.

All figures are CPU time, all promises ratios within one run. The table of the compiled game goes
to benchmarks/results/core.md.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from math import cos, pi, sin
from time import process_time
from typing import Any, NamedTuple

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from onboard.core.game.advance import Conditions, begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.game.views import EvaderView, Nearest, PursuerView
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec, scale, unit
from onboard.core.strategy.evasion import evader
from onboard.core.strategy.knowledge import RuleId
from onboard.core.strategy.pursuit import pursuer
from sim_bridge.campaign.compiled import Starts, campaign, starts_of
from tests.benchmarks import numpy_core, plain_kernel, yardstick
from tests.benchmarks.yardstick import Yard
from tests.support import benchmark_record

COMMAND = "make bench"
TARGET = Vec(300.0, 0.0, 0.0)
RULES = Rules(R=2.0, rho=4.0)
SIZES = tuple(int(n) for n in os.environ.get("APOLLONIUS_BENCH_PURSUERS", "2,5,10,20,50").split(","))


class Pair(NamedTuple):
    """Two ways of doing the same."""

    ours: float  # CPU seconds a call
    theirs: float

    @property
    def ratio(self) -> float:
        """How many times faster ours is."""
        return self.theirs / self.ours


def beside(ours: Callable[[], object], theirs: Callable[[], object], number: int, rounds: int = 9) -> Pair:
    """CPU seconds a call of both, interleaved, the best of the rounds."""
    costs: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        for call, cost in zip((ours, theirs), costs, strict=True):
            start = process_time()
            for _ in range(number):
                call()
            cost.append((process_time() - start) / number)
    return Pair(min(costs[0]), min(costs[1]))


def around(tilt: float, count: int = 5, far: float = 60.0) -> tuple[Vehicle, ...]:
    """Pursuers on a ring about north, tilted away from it by so much [rad]."""
    found = []
    for k in range(count):
        turn = 2.0 * pi * k / count + 0.1
        place = Vec(cos(tilt), sin(tilt) * cos(turn), sin(tilt) * sin(turn))
        found.append(Vehicle(scale(place, far + 3.0 * k), scale(place, -4.0), 4.0))
    return tuple(found)


# Ahead of the goal: five cones of 57° about axes 35° off it all cover it, and their edges cross each other.
FREE_GOAL = around(2.4)
ALL_IN_THE_WAY = around(0.6)
# γ = 0.96: five cones close every ray, and every candidate is tried in vain.
ENCLOSED = tuple(
    Vehicle(Vec(*place), ZERO, 4.8)
    for place in ((60.0, 0, 1), (-55.0, 2, 0), (0, 62.0, 3), (1, -30.0, 52), (2, -31.0, -54))
)


def evader_decides(team: tuple[Vehicle, ...]) -> Any:
    own = Vehicle(ZERO, scale(NORTH, 5.0), 5.0)
    cones = blocked_cones(own, team, 4.0)
    return evader(EvaderView(own, FREE, team, cones, Target(True, TARGET), RULES, (0.0,) * len(team)))


@pytest.mark.parametrize(
    ("name", "team", "rule"),
    [
        ("goal free", FREE_GOAL, RuleId.FREE_RAY_TO_TARGET),
        ("all five cones in the way", ALL_IN_THE_WAY, RuleId.FREE_RAY_TO_TARGET),
        ("nothing free", ENCLOSED, RuleId.RESULTANT_FORCE_TO_TARGET),
    ],
)
def test_evader_beside_numpy(
    name: str, team: tuple[Vehicle, ...], rule: RuleId, benchmark: BenchmarkFixture
) -> None:
    e, g = np.zeros(3), np.array(TARGET)
    p, v_p = np.array([v.position for v in team]), np.array([v.speed for v in team])

    def theirs() -> Any:
        return numpy_core.evader(e, 5.0, p, v_p, g, 2.0, 4.0, 100.0, 1.0)

    decision = evader_decides(team)
    assert decision.rule == rule
    np.testing.assert_allclose(decision.direction, theirs(), atol=1e-9)
    if team is ALL_IN_THE_WAY:
        cones = blocked_cones(Vehicle(ZERO, ZERO, 5.0), team, 4.0)
        assert all(cone.axis.x > cone.cos for cone in cones)  # the goal lies north
    found = beside(lambda: evader_decides(team), theirs, 200)
    mine, numpys = found.ours * 1e6, found.theirs * 1e6
    print(f"\nevader, {name}: {mine:.1f} µs, NumPy {numpys:.1f} µs, × {found.ratio:.2f}")
    benchmark.extra_info.update(numpy_us=found.theirs * 1e6, ratio=found.ratio)
    benchmark(evader_decides, team)
    yardstick.cost(f"evader's decision, {name}", found.ours)
    assert found.ratio >= 1.0


@pytest.mark.parametrize("bearing", [0.3, 1.2, 2.5])
def test_pursuer_beside_numpy(bearing: float, benchmark: BenchmarkFixture) -> None:
    place = Vec(60.0 * cos(bearing), 60.0 * sin(bearing), 5.0)
    own, quarry = Vehicle(place, ZERO, 4.0), Vehicle(ZERO, scale(NORTH, 5.0), 5.0)
    e, heading, p = np.zeros(3), np.array(NORTH), np.array(place)

    view = PursuerView(own, FREE, quarry, NORTH, False, ZERO, Nearest(False, ZERO), Control(), RULES)

    def ours() -> Any:
        return pursuer(view)

    decision = ours()
    rules = {0.3: RuleId.INTERCEPT, 1.2: RuleId.CLOSEST_APPROACH, 2.5: RuleId.PARALLEL}
    assert decision.rule == rules[bearing]
    theirs = numpy_core.pursuer(e, heading, 5.0, p, 4.0)
    lean = numpy_core.pursuer_lean(e, heading, 5.0, p, 4.0)
    for way in (decision.direction, lean):
        np.testing.assert_allclose(way, theirs.direction, atol=1e-9)
    np.testing.assert_allclose(decision.aim, theirs.point, atol=1e-9)
    assert (decision.time, decision.miss) == (pytest.approx(theirs.time), pytest.approx(theirs.miss))
    found = beside(ours, lambda: numpy_core.pursuer(e, heading, 5.0, p, 4.0), 500)
    spare = beside(ours, lambda: numpy_core.pursuer_lean(e, heading, 5.0, p, 4.0), 500)
    mine, numpys, least = found.ours * 1e6, found.theirs * 1e6, spare.theirs * 1e6
    print(f"\npursuer, {decision.rule.name}: {mine:.2f} µs, NumPy {numpys:.2f} µs (× {found.ratio:.2f}), "
          f"its direction alone in the leanest NumPy {least:.2f} µs")  # fmt: skip
    benchmark.extra_info.update(numpy_us=found.theirs * 1e6, ratio=found.ratio, lean_us=spare.theirs * 1e6)
    benchmark(ours)
    yardstick.cost(f"pursuer's decision, {decision.rule.name}", found.ours)
    assert found.ratio >= 5.0  # promised; intercept and parallel flight miss it (decisions.md)


def starts(games: int, pursuers: int) -> Starts:
    """Random games in space: pursuers 20 to 200 m around the evader."""
    rng = np.random.default_rng(pursuers)
    made = []
    for _ in range(games):
        team = []
        for _ in range(pursuers):
            way = unit(Vec(*map(float, rng.standard_normal(3))), NORTH)
            team.append(Vehicle(scale(way, float(rng.uniform(20.0, 200.0))), scale(way, -4.0), 4.0))
        made.append(begin(Vehicle(ZERO, scale(NORTH, 5.0), 5.0), tuple(team), FREE, (FREE,) * pursuers))
    return starts_of(made, [TARGET] * games)


def compiled_row(pursuers: int) -> tuple[float, float, float]:
    """Game steps a CPU-second, compiled and of the plain kernel; share of games that end alike."""
    conditions = Conditions(RULES, Target(True, TARGET), Control())
    play = campaign(evader, pursuer, pursuers)
    at = starts(max(6, 600 // pursuers), pursuers)
    play(starts(2, pursuers), conditions)  # compiles

    def plain() -> list[Any]:
        return [
            plain_kernel.play(place[0].copy(), 5.0, place[1:].copy(), speeds[1:], target,
                              2.0, 4.0, 100.0, 1.0, 1.0, 0.05, 100.0)
            for place, speeds, target in zip(at.positions, at.speeds, at.targets, strict=True)
        ]  # fmt: skip

    ends, theirs = play(at, conditions), plain()
    # The plain kernel knows no target that is kept: for it the evader has escaped.
    verdicts = np.where(ends.verdicts == GameResult.DENIED, GameResult.ESCAPED, ends.verdicts)
    same = float(np.mean([a == b[0] and v == b[1] for a, v, b in
                          zip(ends.steps, verdicts, theirs, strict=True)]))  # fmt: skip
    found = beside(lambda: play(at, conditions), plain, 1, rounds=5)
    return float(ends.steps.sum()) / found.ours, sum(r[0] for r in theirs) / found.theirs, same


def test_compiled_play_beside_a_plain_kernel() -> None:
    rows = [
        "| pursuers | compiled core | plain kernel | ratio | games that end alike |",
        "|---|---|---|---|---|",
    ]
    ratios = {}
    for pursuers in SIZES:
        ours, theirs, same = compiled_row(pursuers)
        ratios[pursuers] = ours / theirs
        speeds = f"{ours / 1e3:,.0f} k | {theirs / 1e3:,.0f} k | {ours / theirs:.2f}"
        rows.append(f"| {pursuers} | {speeds} | {same:.0%} |")
        print(rows[-1])
        yardstick.cost(f"compiled game step, {pursuers} pursuers", 1.0 / ours, Yard.COMPILED)
        assert same >= 0.9
    about = "Spatial game, simple motion, one evader; game steps (all decisions, moves and the referee) "
    about += "a CPU-second, one thread."
    if SIZES == (2, 5, 10, 20, 50):
        title = "The compiled core beside a plain hand-written kernel"
        benchmark_record.write("core.md", title, COMMAND, [about, "", *rows])
    assert ratios[5] >= 0.7
