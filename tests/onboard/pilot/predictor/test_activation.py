"""The s-parabola's mathematics: (23)–(28)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.pilot.predictor.activation import SParabola, smooth_root, smooth_root_slope

numbers = st.floats(-1e3, 1e3)
shapes = st.builds(SParabola, st.sampled_from([0.25, 0.05, 1.0]), st.sampled_from([-0.5, 0.0, 0.3]))


@settings(max_examples=200, deadline=None)
@given(shapes, numbers)
def test_the_inverse_undoes_the_value_on_both_branches(f: SParabola, s: float) -> None:
    back = f.inverse(f.value(np.array(s)))
    assert abs(float(back) - s) <= 1e-12 * max(1.0, abs(s))


@settings(max_examples=200, deadline=None)
@given(shapes, numbers)
def test_the_value_undoes_the_inverse(f: SParabola, y: float) -> None:
    assert abs(float(f.value(f.inverse(np.array(y)))) - y) <= 1e-12 * max(1.0, abs(y))


@settings(max_examples=100, deadline=None)
@given(shapes, st.floats(0.0, 1e3))
def test_the_upper_branch_alone_has_its_own_inverse(f: SParabola, s: float) -> None:
    assert abs(float(f.upper_inverse(f.upper(np.array(s)))) - s) <= 1e-12 * max(1.0, s)
    assert float(f.upper(np.array(-s))) == f.beta


def test_it_is_odd_about_beta_and_passes_through_it() -> None:
    f = SParabola(0.05, 0.3)
    s = np.linspace(-4.0, 4.0, 81)
    np.testing.assert_allclose(f.value(s) - f.beta, -(f.value(-s) - f.beta), atol=1e-15)
    assert float(f.value(np.array(0.0))) == f.beta
    np.testing.assert_allclose(f.value(s[s > 0]), 0.3 + np.sqrt(0.1 * s[s > 0]))
    np.testing.assert_allclose(f.value(s[s < 0]), 0.3 - np.sqrt(-0.1 * s[s < 0]))


@pytest.mark.parametrize("s", [-3.0, -0.2, 0.2, 3.0])
def test_the_derivatives_are_those_of_the_value(s: float) -> None:
    f, h, at = SParabola(), 1e-6, np.array(s)
    assert float(f.slope(at)) == pytest.approx(float(f.value(at + h) - f.value(at - h)) / (2 * h), rel=1e-6)
    bend = float(f.slope(at + h) - f.slope(at - h)) / (2 * h)
    assert float(f.curvature(at)) == pytest.approx(bend, rel=1e-6)
    # As printed, with x in place of 2x, it would be twice this.
    assert abs(bend) == pytest.approx(0.5 * f.p / (abs(s) * np.sqrt(2 * f.p * abs(s))), rel=1e-6)


def test_the_slope_is_infinite_at_the_joint_and_the_upper_branch_is_flat_below_it() -> None:
    f = SParabola()
    assert float(f.slope(np.array(0.0))) == np.inf
    assert float(f.upper_slope(np.array(-1.0))) == 0.0
    assert float(f.upper_slope(np.array(2.0))) == float(f.slope(np.array(2.0)))


def test_the_smoothed_root_for_training_approaches_the_activation() -> None:
    f, epsilon = SParabola(0.25, 0.0), 0.05
    s = np.linspace(-3.0, 3.0, 61)
    gap = np.abs(np.sqrt(2 * f.p) * smooth_root(s, epsilon) - f.value(s))
    assert gap.max() < 0.1
    assert gap[np.abs(s) > 0.5].max() < 0.002
    h = 1e-6
    slope = (smooth_root(s + h, epsilon) - smooth_root(s - h, epsilon)) / (2 * h)
    np.testing.assert_allclose(smooth_root_slope(s, epsilon), slope, rtol=1e-6)
    assert float(smooth_root_slope(np.array(0.0), epsilon)) == pytest.approx(epsilon**-0.5)


def test_the_printed_inverse_mirrors_a_target_of_the_other_branch() -> None:
    f = SParabola()
    wanted = np.array(0.4)  # above β: s must be positive
    assert float(f.value(f.inverse(wanted))) == pytest.approx(0.4)
    mirrored = f.value(f.inverse_printed(wanted, np.array(-0.1)))
    assert float(mirrored) == pytest.approx(2 * f.beta - 0.4)
