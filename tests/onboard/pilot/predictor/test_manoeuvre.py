"""The manoeuvre filter, against circles, straight lines and an integrator that shares no code with it."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from onboard.core.math.vectors import Vec
from onboard.pilot.predictor import manoeuvre
from onboard.pilot.predictor.manoeuvre import STRAIGHT, TURNING, ManoeuvreFilter

VARIANCE = (1.0, 1.0, 1.0, -1.0, -1.0, -1.0)
AHEAD = np.array([0.5, 1.0, 2.0, 4.0])
SPEED, RATE = 30.0, 0.3


def circle(t: float) -> Vec:
    """A turn to the right at RATE, begun northwards."""
    radius = SPEED / RATE
    return Vec(radius * sin(RATE * t), radius * (1.0 - cos(RATE * t)), -100.0)


def straight(t: float) -> Vec:
    return Vec(SPEED * t * cos(1.0), SPEED * t * sin(1.0), -100.0)


def follow(filter: ManoeuvreFilter, places: list[tuple[float, Vec]], sigma: float = 1.0) -> None:
    rng = np.random.default_rng(1)
    for t, place in places:
        noisy = Vec(*(np.array(place) + rng.normal(0.0, sigma, 3)).tolist())
        filter.add(t, noisy, None, VARIANCE)


def test_a_circle_goes_on_as_a_circle_and_a_line_as_a_line() -> None:
    times = [k * 0.1 for k in range(200)]
    for path, model in ((circle, TURNING), (straight, STRAIGHT)):
        filter = ManoeuvreFilter()
        follow(filter, [(t, path(t)) for t in times])
        truth = np.array([path(times[-1] + ahead)[:2] for ahead in AHEAD])
        off = np.linalg.norm(filter.places(AHEAD) - truth, axis=1)
        drift = 0.5 * SPEED * RATE * AHEAD**2  # of who flies straight on out of this circle
        assert (off < 2.0 + 0.3 * drift).all(), off
        assert filter.shares[model] > 0.5


def test_a_measured_velocity_is_used() -> None:
    filter = ManoeuvreFilter()
    variance = (1.0, 1.0, 1.0, 0.01, 0.01, 0.01)
    for k in range(3):
        t = 0.1 * k
        filter.add(t, straight(t), Vec(SPEED * cos(1.0), SPEED * sin(1.0), 0.0), variance)
    np.testing.assert_allclose(filter.places([1.0]), [straight(1.2)[:2]], atol=1.0)


@pytest.mark.parametrize("rate", [-0.7, -1e-9, 0.0, 0.2])
def test_the_turn_is_that_of_its_differential_equation(rate: float) -> None:
    begin = [10.0, -20.0, 12.0, 5.0, rate]

    def slope(_: float, x: list[float]) -> list[float]:
        return [x[2], x[3], -x[4] * x[3], x[4] * x[2], 0.0]

    exact = solve_ivp(slope, (0.0, 2.5), begin, rtol=1e-10, atol=1e-10).y[:, -1]
    np.testing.assert_allclose(manoeuvre.turned(begin, 2.5), exact, atol=1e-4)
    for i in range(5):
        step = np.eye(5)[i] * 1e-4
        higher = np.array(manoeuvre.turned((np.array(begin) + step).tolist(), 2.5))
        lower = np.array(manoeuvre.turned((np.array(begin) - step).tolist(), 2.5))
        np.testing.assert_allclose(manoeuvre.turning(begin, 2.5)[:, i], (higher - lower) / 2e-4, atol=2e-3)


def test_a_silence_begins_anew_and_an_old_sample_changes_nothing() -> None:
    filter = ManoeuvreFilter()
    follow(filter, [(k * 0.1, circle(k * 0.1)) for k in range(100)])
    before = filter.places(AHEAD)
    filter.add(5.0, Vec(1e4, 1e4, 0.0), None, VARIANCE)
    np.testing.assert_array_equal(filter.places(AHEAD), before)
    filter.add(60.0, Vec(500.0, 500.0, 0.0), None, VARIANCE)
    np.testing.assert_allclose(filter.places(AHEAD), 500.0)


def test_whatever_comes_the_answer_is_finite_and_the_shares_are_shares() -> None:
    rng = np.random.default_rng(3)
    filter, t = ManoeuvreFilter(), 0.0
    for _ in range(3000):
        t += float(rng.choice([1e-6, 0.01, 0.1, 1.9]))
        place = Vec(*(rng.normal(0.0, 10.0 ** rng.uniform(-3, 8), 3)).tolist())
        variance = (10.0 ** rng.uniform(-12, 8),) * 3 + (-1.0,) * 3
        filter.add(t, place, None, variance)
        assert np.isfinite(filter.places(AHEAD)).all()
        assert filter.shares.sum() == pytest.approx(1.0)
        assert filter.shares.min() > 0.0


def test_a_turn_through_half_a_circle_is_not_lost_at_the_wrap_of_headings() -> None:
    filter = ManoeuvreFilter()
    times = [k * 0.1 for k in range(round(2.0 * pi / RATE / 0.1) + 20)]
    follow(filter, [(t, circle(t)) for t in times], 0.3)
    truth = np.array(circle(times[-1] + 1.0)[:2])
    assert np.linalg.norm(filter.places(np.array([1.0]))[0] - truth) < 2.0
