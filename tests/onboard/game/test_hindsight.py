"""Why not captured: the moment is checked by planning again from it, by brute force over headings."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from onboard.core.game.advance import Conditions, advance, begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.hindsight import Ways, in_words, missed, way_out

RULES = Rules(R=2.0, rho=4.0, horizon=90.0, planar=True)
DT = 0.1
ALL = np.linspace(-pi, pi, 1441)


def flown(seed: int) -> Ways:
    """A plane game that ends without capture, as the core plays it."""
    rng = np.random.default_rng(seed)
    yaws, far = rng.uniform(-pi, pi, 4), rng.uniform(25.0, 70.0, 4)
    team = tuple(
        Vehicle(Vec(d * cos(a), d * sin(a), 0.0), Vec(4.0, 0.0, 0.0), 4.0)
        for a, d in zip(yaws, far, strict=True)
    )
    game = begin(Vehicle(ZERO, Vec(5.0, 0.0, 0.0), 5.0), team, FREE, (FREE,) * 4)
    conditions = Conditions(RULES, Target(True, Vec(150.0, 0.0, 0.0)), Control(DT))
    games = [game]
    while game.score.verdict == GameResult.RUNNING:
        game = advance(game, conditions, EVADERS["paper"].decide, PURSUERS["paper"].decide)
        games.append(game)
    assert game.score.verdict != GameResult.CAPTURED
    return Ways(
        np.array([g.time for g in games]),
        np.array([g.evader.position for g in games]),
        np.array([[g.pursuers[k].position for g in games] for k in range(4)]),
        np.full(4, 4.0), 5.0, RULES.R, True,
    )  # fmt: skip


def nearest(ways: Ways, pursuer: int, t: float, yaws: np.ndarray) -> float:
    """The smallest distance to the way that was flown of who leaves at t on a heading and keeps it."""
    place = [np.interp(t, ways.t, ways.pursuers[pursuer, :, axis]) for axis in range(2)]
    later = np.linspace(t, ways.t[-1], 900)
    e = [np.interp(later, ways.t, ways.evader[:, axis]) for axis in range(2)]
    gone = 4.0 * (later - t)
    x = place[0] + np.cos(yaws)[:, None] * gone - e[0]
    y = place[1] + np.sin(yaws)[:, None] * gone - e[1]
    return float(np.hypot(x, y).min())


@pytest.mark.parametrize("seed", [3, 4, 5])
def test_before_the_moment_a_plan_wins_and_after_it_none_does(seed: int) -> None:
    ways = flown(seed)
    found = missed(ways)
    assert found.who >= 0
    assert found.t < found.when <= ways.t[-1]
    before, after = found.t - 0.3, found.t + 0.3
    assert nearest(ways, found.who, before, ALL) <= RULES.R + 0.15
    for pursuer in range(4):
        assert nearest(ways, pursuer, after, ALL) > RULES.R


@pytest.mark.parametrize("seed", [3, 4, 5])
def test_the_way_out_is_safe_whatever_anybody_flies(seed: int) -> None:
    ways = flown(seed)
    found = missed(ways)
    later = np.linspace(0.0, 400.0, 801)
    yaws = np.linspace(-pi, pi, 360, endpoint=False)
    for j in range(0, len(ways.t), 60):
        safe = np.ones(len(yaws), bool)
        for k in range(4):
            r = ways.pursuers[k, j] - ways.evader[j]
            x = 5.0 * later * np.cos(yaws)[:, None] - r[0]
            y = 5.0 * later * np.sin(yaws)[:, None] - r[1]
            safe &= (np.hypot(x, y) - 4.0 * later > RULES.R).all(axis=1)
        longest = max(len(run) for run in "".join("x." [not one] for one in [*safe, *safe]).split("."))
        assert longest * 2.0 * pi / 360 == pytest.approx(way_out(ways, j), abs=0.1)
        if ways.t[j] > found.open_since:
            assert safe.any()


def test_reach_only_shrinks() -> None:
    found = missed(flown(3))
    most = found.spare.max(axis=1)
    assert np.all(np.diff(most) < 0.15 * 4.0 * DT)


def test_it_is_told_who_and_when() -> None:
    told = in_words(missed(flown(3)), (2, 3, 4, 5))
    assert "could still have met the evader" in told
    assert "nothing could have forced a capture" in told
