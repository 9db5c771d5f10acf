"""Capture, safety distance and arrival are judged over the whole step."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.game.referee import GameResult, Score, Step, judge, opening, passage
from onboard.core.game.rules import Rules, Target
from onboard.core.math.vectors import TINY, ZERO, Vec
from tests.support.random_situations import points

FRESH = Score(GameResult.RUNNING, 0.0, -1, 1e300, 0.0)


def step(e0, e1, before, after, R=2.0, rho=4.0, target=None, start=0.0, dt=1.0, horizon=100.0, score=FRESH):
    goal = ZERO if target is None else target
    rules = Rules(R, rho, horizon=horizon)
    return judge(score, Step(start, dt, e0, e1, before, after), rules, Target(target is not None, goal))


@settings(max_examples=500, deadline=None)
@given(points(), points(), points(), points(), st.floats(0.1, 200.0))
def test_passage_against_dense_sampling(a0, a1, b0, b1, radius):
    seen = passage(a0, a1, b0, b1, radius)
    share = np.linspace(0.0, 1.0, 4001)[:, None]
    gap = np.array(a0) - np.array(b0) + share * (np.array(a1) - a0 - np.array(b1) + b0)
    far = np.sqrt((gap**2).sum(axis=1))
    # A squared distance is a sum of terms that cancel, together at most (2L)², where L bounds the lengths.
    # Eight roundings of ε/2 each leave it off by 16 ε L², and the samples by as much. Who moves by less than
    # TINY is taken to rest.
    longest = sqrt(float((gap[0] ** 2).sum())) + sqrt(float((gap[-1] ** 2).sum()))
    rounding = 32.0 * np.finfo(float).eps * longest**2
    assert seen.smallest <= sqrt(far.min() ** 2 + rounding) + TINY
    assert seen.smallest >= far.min() - 1.0  # samples lie at most half a metre apart
    assert seen.enters == (seen.smallest <= radius) or abs(seen.smallest - radius) < 1e-6
    if seen.enters and far[0] > radius:
        index = min(int(seen.entry * 4000), 4000)
        assert far[: max(index - 1, 0)].min(initial=1e9) > radius - 1e-6
        at_entry = np.array(a0) - np.array(b0) + seen.entry * (np.array(a1) - a0 - np.array(b1) + b0)
        assert sqrt(float((at_entry**2).sum())) == pytest.approx(radius, rel=1e-6, abs=1e-5)


def test_a_capture_between_the_ends_of_a_step_counts():
    score = step(ZERO, Vec(10.0, 0.0, 0.0), (Vec(5.0, 10.0, 0.0),), (Vec(5.0, -10.0, 0.0),))
    assert score.verdict == GameResult.CAPTURED
    assert 0.3 < score.time < 0.5
    assert score.smallest == pytest.approx(2.0)


def test_an_arrival_between_the_ends_of_a_step_counts():
    far = (Vec(99.0, 0.0, 0.0),)
    score = step(Vec(-10.0, 0.5, 0.0), Vec(10.0, 0.5, 0.0), far, far, target=ZERO)
    assert score.verdict == GameResult.ARRIVED
    assert score.time == pytest.approx((10.0 - sqrt(0.75)) / 20.0)


@pytest.mark.parametrize(("place", "verdict"), [(4.0, GameResult.CAPTURED), (9.0, GameResult.ARRIVED)])
def test_whatever_comes_first_in_a_step_decides(place, verdict):
    guard = (Vec(place, 0.0, 0.0),)
    score = step(ZERO, Vec(20.0, 0.0, 0.0), guard, guard, R=0.5, target=Vec(7.0, 0.0, 0.0))
    assert score.verdict == verdict


def test_the_first_captor_of_a_step_is_named():
    team = (Vec(15.0, 0.0, 0.0), Vec(10.0, 0.0, 0.0))
    assert step(ZERO, Vec(20.0, 0.0, 0.0), team, team).captor == 1


def test_the_safety_distance_is_watched_over_the_whole_step():
    guard = (Vec(5.0, 3.0, 0.0),)
    assert step(ZERO, Vec(10.0, 0.0, 0.0), guard, guard).unsafe == 1.0
    assert step(ZERO, Vec(10.0, 0.0, 0.0), (Vec(5.0, 4.1, 0.0),), (Vec(5.0, 4.1, 0.0),)).unsafe == 0.0


def test_at_the_horizon_the_evader_has_escaped_and_later_captures_do_not_count():
    guard = (Vec(8.0, 0.0, 0.0),)
    score = step(ZERO, Vec(10.0, 0.0, 0.0), guard, guard, R=0.5, start=99.6, horizon=100.0)
    assert (score.verdict, score.time) == (GameResult.ESCAPED, 100.0)


@pytest.mark.parametrize(("place", "speed", "result"), [
    (9.0, 4.0, GameResult.DENIED),  # 30/5 s to the target for the evader; 21/4 s for the pursuer
    (5.9, 4.0, GameResult.ESCAPED),  # 24.1/4 s: too late by 0.03 s
    (6.1, 4.0, GameResult.DENIED),
    (-20.0, 0.0, GameResult.ESCAPED),  # no speed declared: distances count
    (1.0, 0.0, GameResult.DENIED),
])  # fmt: skip
def test_a_target_that_a_pursuer_holds_at_the_horizon_is_denied(place, speed, result):
    guard = (Vec(place, 50.0, 0.0), Vec(-400.0, 0.0, 0.0))
    goal = Vec(30.0, 50.0, 0.0)
    e = Vec(0.0, 50.0, 0.0)
    still = Step(99.5, 1.0, e, e, guard, guard, 5.0, (speed, speed))
    rules = Rules(0.5, 1.0, epsilon_min=0.5, horizon=100.0)
    assert judge(FRESH, still, rules, Target(True, goal)).verdict == result
    assert judge(FRESH, still, rules, Target(False, goal)).verdict == GameResult.ESCAPED


@pytest.mark.parametrize(("line", "result"), [
    (50.0, GameResult.DENIED),  # every point of the edge, from 50 m on, is nearer to the guard
    (30.0, GameResult.DENIED),
    (20.0, GameResult.ESCAPED),  # the nearest point of the edge is nearer to the evader
])  # fmt: skip
def test_a_target_that_is_a_region_is_held_as_a_whole(line, result):
    """A border: the edge of a disc of 200 km, north of it; evader and guard, 50 m apart, are as fast."""
    far = 200_000.0
    e, guard = ZERO, (Vec(50.0, 0.0, 0.0),)
    still = Step(99.5, 1.0, e, e, guard, guard, 5.0, (5.0,))
    rules = Rules(1.0, 2.0, epsilon_min=far, horizon=100.0)
    score = judge(opening(e, guard), still, rules, Target(True, Vec(line + far, 0.0, 0.0)))
    assert score.verdict == result


def test_a_verdict_stands():
    done = Score(GameResult.ARRIVED, 3.0, -1, 7.0, 0.0)
    guard = (ZERO,)
    assert step(ZERO, ZERO, guard, guard, score=done) == done


def test_the_opening_knows_the_smallest_distance():
    assert opening(ZERO, (Vec(3.0, 4.0, 0.0), Vec(9.0, 0.0, 0.0))).smallest == pytest.approx(5.0)


def test_players_in_one_place_at_the_start_are_captured_at_once():
    score = step(ZERO, Vec(10.0, 0.0, 0.0), (ZERO,), (ZERO,))
    assert (score.verdict, score.time) == (GameResult.CAPTURED, 0.0)
