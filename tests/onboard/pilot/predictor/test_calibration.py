"""Stated errors are widened until the wanted share of the facts lies within, and only then."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.pilot.predictor.calibration import LARGEST, Calibration


def inside(true_sigma: float, steps: int = 2000, seed: int = 1) -> tuple[float, float, float]:
    """Shares within one and two stated errors in the second half, and the factor at the end, where 1 m is
    stated and the truth scatters by `true_sigma` [m] along a line."""
    rng = np.random.default_rng(seed)
    one = Calibration((1,))
    found = []
    for k in range(steps):
        off = float(rng.normal(0.0, true_sigma))
        stated = float(one.factors()[0])
        if k > steps // 2:
            found.append((abs(off) <= stated, abs(off) <= 2.0 * stated))
        one.tell(k, np.zeros((1, 3)), np.ones(1))
        one.judge(k + 1, np.array([[off, 0.0, 0.0]]))
    shares = np.mean(found, axis=0)
    return float(shares[0]), float(shares[1]), float(one.factors()[0])


@pytest.mark.parametrize("true_sigma", [1.0, 1.5, 3.0])
def test_the_wanted_shares_lie_inside(true_sigma: float) -> None:
    one, two, factor = inside(true_sigma)
    assert 0.66 < one < 0.85
    assert two > 0.94
    assert 0.8 * true_sigma < factor < 1.6 * true_sigma


def test_luck_makes_nobody_sure_and_no_factor_grows_without_end() -> None:
    assert inside(0.1)[2] == 1.0
    assert inside(1000.0)[2] == pytest.approx(LARGEST)


def test_what_was_not_stated_is_not_judged() -> None:
    one = Calibration((1,))
    for k in range(50):
        one.tell(k, np.zeros((1, 3)), np.full(1, np.nan))
        one.judge(k + 1, np.full((1, 3), 1e6))
    assert one.factors()[0] == 1.0


def test_each_horizon_has_a_factor_of_its_own_and_a_restart_forgets() -> None:
    one = Calibration((1, 4))
    for k in range(200):
        one.judge(k, np.array([[5.0 * k, 0.0, 0.0]]))
        one.tell(k, np.array([[5.0 * (k + 1), 0.0, 0.0], [5.0 * k, 0.0, 0.0]]), np.ones(2))
    assert one.factors()[0] == 1.0
    assert one.factors()[1] > 2.0
    one.clear()
    np.testing.assert_array_equal(one.factors(), 1.0)
