"""The gusts' filters against state spaces built from MIL-F-8785C's transfer functions. No statistics."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import solve_discrete_lyapunov
from scipy.spatial.transform import Rotation

from sim_bridge.vehicle.wind.dryden import GustAxes, GustNoise, GustState, gust_of, step_gust
from tests.oracle.dryden_8785c import FOOT, Array, Filter, lengths, spectrum

SIGMA = 3.0  # [m/s]
SPEED = 45.0  # [m/s]
DT = 0.02
HEIGHTS = (30.0, 164.0, 700.0, 1000.0, 1300.0, 1750.0, 2000.0, 5000.0)  # [ft]
NORTH = GustAxes(1.0, 0.0, 0.0, 0.0, 0.0)  # low: along the mean wind to the north


def outputs(state: GustState) -> Array:
    """u, v, w [m/s] of a state, read in the mean wind's axes."""
    return np.array(gust_of(state, SIGMA, NORTH))


def discrete(feet: float) -> tuple[Array, Array, Array]:
    """The product's step as matrices (A, B, C): it is linear in state and noise."""

    def step(state: Array, noise: Array) -> Array:
        return np.array(step_gust(GustState(*state), SPEED, feet * FOOT, DT, GustNoise(*noise)))

    none = np.zeros(5)
    a = np.array([step(one, none) for one in np.eye(5)]).T
    b = np.array([step(none, one) for one in np.eye(5)]).T
    c = np.array([outputs(GustState(*one)) for one in np.eye(5)]).T
    return a, b, c


@pytest.mark.parametrize("feet", HEIGHTS)
def test_every_covariance_is_that_of_the_published_filters(feet: float) -> None:
    """At no lag and at lags up to 20 s; the components are independent of each other."""
    a, b, c = discrete(feet)
    spread = solve_discrete_lyapunov(a, b @ b.T)
    filters = [Filter(name, feet, SPEED / FOOT, SIGMA / FOOT) for name in "uvw"]
    power = np.eye(5)
    for count in range(1001):
        if count in (0, 1, 5, 25, 100, 300, 1000):
            found = c @ power @ spread @ c.T
            expected = np.diag([f.covariance(count * DT) for f in filters]) * FOOT**2
            np.testing.assert_allclose(found, expected, atol=1e-5 * SIGMA**2)
        power = a @ power
    for f in filters:
        assert f.variance * FOOT**2 == pytest.approx(SIGMA**2)


@pytest.mark.parametrize("feet", [164.0, 1300.0, 5000.0])
@pytest.mark.parametrize("name", ["u", "v", "w"])
def test_the_spectra_are_the_standard_s(feet: float, name: str) -> None:
    """Of the step's own transfer function, well below where sampling folds them."""
    a, b, c = discrete(feet)
    omega = np.geomspace(0.01, 12.0, 25)
    row = c["uvw".index(name)]
    found = []
    for w in omega:
        response = row @ np.linalg.solve(np.exp(1j * w * DT) * np.eye(5) - a, b)
        found.append(float(np.sum(np.abs(response) ** 2)) * DT / np.pi)
    expected = spectrum(name, feet, SPEED / FOOT, SIGMA / FOOT, omega) * FOOT**2
    np.testing.assert_allclose(found, expected, rtol=0.03)
    np.testing.assert_allclose(
        Filter(name, feet, SPEED / FOOT, SIGMA / FOOT).density(omega) * FOOT**2, expected, rtol=1e-9
    )


@pytest.mark.parametrize("feet", [164.0, 5000.0])
@pytest.mark.parametrize("name", ["u", "v", "w"])
def test_the_published_spectra_have_the_variance_of_their_name(feet: float, name: str) -> None:
    """The oracle itself: ∫ Φ dω = σ²."""

    def density(omega: float) -> float:
        return float(spectrum(name, feet, 150.0, 10.0, np.array([omega]))[0])

    edges = [0.0, 0.1, 1.0, 10.0, 100.0, np.inf]
    total = sum(quad(density, low, high, limit=200)[0] for low, high in pairwise(edges))
    assert total == pytest.approx(100.0, rel=1e-6)


@pytest.mark.parametrize("feet", [600.0, 1000.0, 1250.0, 1500.0, 1750.0, 2000.0, 4000.0])
@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, 0.0), (90.0, 0.0), (130.0, 12.0)])
def test_the_blend_has_the_variance_of_both_axes_mixed(feet: float, yaw: float, pitch: float) -> None:
    """u, v, w independent, turned into the wind's axes and the body's, and interpolated over height."""
    blows = 40.0
    share = float(np.clip((feet - 1000.0) / 1000.0, 0.0, 1.0))
    mix = (1.0 - share) * Rotation.from_euler("z", blows, degrees=True).as_matrix()
    mix += share * Rotation.from_euler("ZY", [yaw, pitch], degrees=True).as_matrix()
    expected = SIGMA**2 * mix @ mix.T
    a, b, _ = discrete(feet)
    axes = GustAxes(
        float(np.cos(np.radians(blows))),
        float(np.sin(np.radians(blows))),
        float(np.radians(yaw)),
        float(np.radians(pitch)),
        feet * FOOT,
    )
    c = np.array([gust_of(GustState(*one), SIGMA, axes) for one in np.eye(5)]).T
    found = c @ solve_discrete_lyapunov(a, b @ b.T) @ c.T
    np.testing.assert_allclose(found, expected, atol=1e-6)
    if feet == 1500.0 and pitch == 0.0:  # half way the level rms is cos(θ/2) of the setting
        angle = np.radians(yaw - blows)
        assert np.sqrt(found[0, 0]) == pytest.approx(SIGMA * abs(np.cos(angle / 2.0)), rel=1e-6)


def test_the_scale_lengths_meet_where_the_models_do() -> None:
    below: Callable[[float], tuple[float, float]] = lengths
    assert below(1000.0) == pytest.approx(below(1000.001), rel=1e-5)
    assert below(2000.0) == pytest.approx(below(1999.999), rel=1e-5)
    assert below(1000.0) == pytest.approx((1000.0, 1000.0))
