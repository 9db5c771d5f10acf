"""The ridge kept up by rank-one changes beside NumPy's least squares of all windows at once."""

from __future__ import annotations

from math import pi, sin

import numpy as np
import pytest

from onboard.core.math.vectors import Vec
from onboard.pilot.predictor import TrackPredictor, Trainer
from onboard.pilot.predictor.activation import Array
from onboard.pilot.predictor.model import lessons
from onboard.pilot.predictor.running import BOUND, EXACT, change

VARIANCE = (1.0, 1.0, 1.0, -1.0, -1.0, -1.0)


def least_squares(rows: Array, facts: Array, load: Array) -> Array:
    """Of rows (k, F) and facts (k,) under a load (F,) on the diagonal, by an orthogonal factorisation."""
    whole = np.vstack([rows, np.diag(np.sqrt(load))])
    return np.asarray(np.linalg.lstsq(whole, np.concatenate([facts, np.zeros(len(load))]), rcond=None)[0])


def kept_up(rows: Array, load: Array, facts: Array, first: int) -> tuple[Array, Array]:
    """Coefficients of a window of `first` rows that has slid on to the last, and the window's own."""
    start = rows[:first]
    loaded = start.T @ start + np.diag(load)
    inverse: Array = np.asarray(np.linalg.inv(loaded), np.float64)[None]
    found: Array = np.asarray(np.linalg.solve(loaded, start.T @ facts[:first]), np.float64)[None]
    for k in range(first, len(rows)):
        assert change(inverse, found, (rows[k][None], facts[k : k + 1]), 1.0)
        assert change(inverse, found, (rows[k - first][None], facts[k - first : k - first + 1]), -1.0)
    return found[0], least_squares(rows[-first:], facts[-first:], load)


@pytest.mark.parametrize("seed", range(5))
def test_random_windows_give_what_least_squares_give(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, facts = rng.normal(0.0, 3.0, (150 + EXACT // 2, 20)), rng.normal(0.0, 1.0, 150 + EXACT // 2)
    mine, wanted = kept_up(rows, np.full(20, 0.1), facts, 150)
    assert np.abs(mine - wanted).max() < 1e-12 * np.abs(wanted).max()


@pytest.mark.parametrize("penalty", [3e-3, 1e-4, 1e-6])
def test_ill_conditioned_windows_stay_within_the_bound(penalty: float) -> None:
    """A smooth curve's moves are all but one another's sums: the normal matrix has a condition of 1e20."""
    t = np.arange(260.0)
    moves = 10.0 + np.sin(0.15 * t) + 0.3 * np.sin(0.07 * t + 1.0)
    rows = np.array([[*moves[k : k + 19], 1.0] for k in range(150 + EXACT // 2)])
    facts = moves[20 : 20 + len(rows)] - moves[19 : 19 + len(rows)]
    assert np.linalg.cond(rows[:150].T @ rows[:150]) > 1e15
    load = penalty * (rows[:150] ** 2).sum(axis=0)
    mine, wanted = kept_up(rows, load, facts, 150)
    assert np.abs(mine - wanted).max() < BOUND * np.abs(wanted).max()


def test_a_row_that_carries_the_solution_is_not_taken_away() -> None:
    """Without load, taking away one of just enough rows leaves nothing to solve: no number comes of it."""
    rows, facts = np.eye(3), np.array([1.0, 2.0, 3.0])
    inverse, found = np.eye(3)[None], facts[None].copy()
    assert not change(inverse, found, (rows[:1], facts[:1]), -1.0)
    np.testing.assert_array_equal(found[0], facts)
    np.testing.assert_array_equal(inverse[0], np.eye(3))


@pytest.mark.parametrize("late", [0.0, 0.2])
def test_in_flight_it_is_the_least_squares_of_the_windows_of_the_grid(late: float) -> None:
    """100 s of a noisy weave through the predictor, the window full after 40 s, some samples late."""
    rng, track, trainer = np.random.default_rng(1), TrackPredictor(1), Trainer()
    waiting: list[tuple[float, Vec]] = []
    compared = 0
    for k in range(1000):
        t = 0.1 * k
        side = 60.0 * sin(2.0 * pi * t / 8.0)
        off = rng.normal(0.0, 1.0, 3).tolist()
        sample = (t, Vec(35.0 * t - 0.7 * side + off[0], 35.0 * t + 0.7 * side + off[1], off[2]))
        if rng.uniform() < late and not waiting:
            waiting.append(sample)
            continue
        for when, place in (sample, *waiting):
            track.add(when, place, None, VARIANCE)
        waiting.clear()
        trainer.advance(t, {1: track}, 2)
        if k % 7 == 0 and track.model is not None and k > 150:
            track.refresh()
            compared += compare(track)
    assert compared > 80


def compare(track: TrackPredictor) -> int:
    """Coefficients of each speaking horizon and axis beside those of all windows at once."""
    model, settings = track.model, track.settings.model
    assert model is not None
    positions, velocities = track.grid.arrays()
    _, rows, wanted = lessons(positions, velocities, model.points, settings)
    speaking = [i for i in range(len(settings.horizons)) if model.coefficients[i].any()]
    for place, i in enumerate(speaking):
        count = len(positions) - settings.horizons[i] - model.points + 1
        for axis in range(3):
            load = track._ridge.load[place, axis]
            exact = least_squares(rows[axis, :count], wanted[:count, i, axis], load)
            assert np.abs(model.coefficients[i, axis] - exact).max() < BOUND * max(np.abs(exact).max(), 0.01)
    return len(speaking)
