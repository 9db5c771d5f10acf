"""Belief in a model follows what became of its predictions."""

from __future__ import annotations

import numpy as np

from onboard.pilot.predictor.trust import Trust

HORIZONS = (1, 5)
AHEAD = np.array([3.0, 0.0, 0.0])  # [m a step]
SIDE = np.array([0.0, 1.0, 0.0])


def follow(trust: Trust, drift: float, steps: int = 60, first: int = 0) -> None:
    """Predict a drift of SIDE at each step while the target really drifts by `drift` of it."""
    for k in range(first, first + steps):
        positions = np.array([j * (AHEAD + drift * SIDE) for j in range(k + 1)])
        trust.judge(k, positions[-30:])
        trust.tell(k, positions[-1], AHEAD, np.tile(SIDE, (2, 1)))


def test_belief_begins_full() -> None:
    np.testing.assert_allclose(Trust(HORIZONS).shares(), 1.0)


def test_a_model_that_is_right_keeps_it_and_one_that_is_wrong_loses_it() -> None:
    right, half, wrong, mirrored = (Trust(HORIZONS) for _ in range(4))
    follow(right, 1.0)
    follow(half, 0.5)
    follow(wrong, 0.0)
    follow(mirrored, -1.0)
    np.testing.assert_allclose(right.shares(), 1.0)
    assert (np.abs(np.array(half.shares()) - 0.5) < 0.15).all()
    assert (np.array(wrong.shares()) < 0.25).all()
    assert (np.array(mirrored.shares()) == 0.0).all()


def test_belief_comes_back() -> None:
    trust = Trust(HORIZONS)
    follow(trust, 0.0)
    low = np.array(trust.shares())
    for k in range(60, 160):
        position = k * (AHEAD + SIDE)
        trust.judge(k, position[None])
        trust.tell(k, position, AHEAD, np.tile(SIDE, (2, 1)))
    assert (np.array(trust.shares()) > low + 0.5).all()


def test_points_that_were_skipped_are_judged_too() -> None:
    trust = Trust((1,))
    trust.tell(0, np.zeros(3), AHEAD, SIDE[None])
    positions = np.array([k * (AHEAD - SIDE) for k in range(4)])
    trust.judge(3, positions)  # points 1 to 3 at once: point 1 is the one horizon 1 waited for
    assert trust.shares()[0] < 1.0


def test_clear_forgets() -> None:
    trust = Trust(HORIZONS)
    follow(trust, -1.0)
    trust.clear()
    np.testing.assert_allclose(trust.shares(), 1.0)
