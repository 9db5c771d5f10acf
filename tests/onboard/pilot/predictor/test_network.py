"""The two layers: analytic Jacobian, normal equations, Levenberg–Marquardt."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.pilot.predictor import network
from onboard.pilot.predictor.activation import Array, SParabola
from onboard.pilot.predictor.network import Batch, Weights

ACT = SParabola()
EPSILON = 0.05


def random_batch(rng: np.random.Generator, count: int = 20, inputs: int = 4, outputs: int = 3) -> Batch:
    mask = (rng.uniform(size=(count, outputs)) > 0.2).astype(float)
    return network.batch(rng.normal(size=(count, inputs)), rng.uniform(0.2, 0.8, (count, outputs)), mask)


def random_weights(rng: np.random.Generator, inputs: int = 4, neurons: int = 5, outputs: int = 3) -> Weights:
    return Weights(rng.normal(size=(inputs + 1, neurons)), rng.normal(size=(neurons + 1, outputs)))


def finite_differences(weights: Weights, data: Batch) -> Array:
    theta = np.concatenate([weights.first.ravel(), weights.second.ravel()])
    split = weights.first.size

    def outputs(parameters: Array) -> Array:
        moved = Weights(
            parameters[:split].reshape(weights.first.shape), parameters[split:].reshape(weights.second.shape)
        )
        out: Array = (network.output(ACT, moved, data.inputs, EPSILON) * data.mask).ravel()
        return out

    columns = []
    for k in range(len(theta)):
        h = np.zeros_like(theta)
        h[k] = 1e-6
        columns.append((outputs(theta + h) - outputs(theta - h)) / 2e-6)
    return np.stack(columns, axis=1)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000))
def test_the_analytic_jacobian_is_that_of_finite_differences(seed: int) -> None:
    rng = np.random.default_rng(seed)
    data, weights = random_batch(rng), random_weights(rng)
    exact = network.jacobian(ACT, weights, data, EPSILON)
    near = finite_differences(weights, data)
    assert np.abs(exact - near).max() <= 1e-5 * np.abs(exact).max()


def test_the_normal_equations_are_those_of_the_jacobian() -> None:
    rng = np.random.default_rng(1)
    data, weights = random_batch(rng), random_weights(rng)
    j = network.jacobian(ACT, weights, data, EPSILON)
    r = ((data.targets - network.output(ACT, weights, data.inputs, EPSILON)) * data.mask).ravel()
    eq = network.normal(ACT, weights, data, EPSILON)
    np.testing.assert_allclose(eq.matrix, j.T @ j, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(eq.gradient, j.T @ r, rtol=1e-10, atol=1e-12)
    assert eq.cost == pytest.approx(float(r @ r))
    assert network.cost(ACT, weights, data, EPSILON) == pytest.approx(eq.cost)


def finish(training: Generator[None, None, Weights]) -> tuple[Weights, int]:
    slices = 0
    while True:
        try:
            next(training)
        except StopIteration as end:
            return end.value, slices
        slices += 1


def test_training_learns_what_a_network_of_its_kind_says() -> None:
    rng = np.random.default_rng(2)
    teacher = random_weights(rng, 2, 3, 1)
    x = rng.normal(size=(300, 2))
    y = network.output(ACT, teacher, np.hstack([np.ones((300, 1)), x]), EPSILON)
    data = network.batch(x, y, np.ones_like(y))
    begun = network.start(ACT, data, 5, rng, EPSILON, 1e-3)
    before = network.cost(ACT, begun, data, EPSILON)
    learnt, slices = finish(network.train(ACT, begun, data, 40, EPSILON, 1e-6))
    after = network.cost(ACT, learnt, data, EPSILON)
    assert after < 0.05 * before
    assert after < 0.01 * float(((y - y.mean()) ** 2).sum())
    assert 10 < slices <= 120


def test_the_cost_never_rises() -> None:
    rng = np.random.default_rng(3)
    data = random_batch(rng, 60)
    weights = random_weights(rng)
    last = network.cost(ACT, weights, data, EPSILON)
    for _ in range(10):
        weights, _ = finish(network.train(ACT, weights, data, 1, EPSILON, 0.0))
        now = network.cost(ACT, weights, data, EPSILON)
        assert now <= last
        last = now


def test_masked_targets_are_not_learnt_from() -> None:
    rng = np.random.default_rng(4)
    x, y = rng.normal(size=(40, 3)), rng.uniform(0.2, 0.8, (40, 2))
    mask = np.ones_like(y)
    mask[30:] = 0.0
    wild = y.copy()
    wild[30:] = 1e6
    results = []
    for targets in (y, wild):
        data = network.batch(x, targets, mask)
        begun = network.start(ACT, data, 5, np.random.default_rng(5), EPSILON, 1e-3)
        results.append(finish(network.train(ACT, begun, data, 5, EPSILON, 0.1))[0])
    np.testing.assert_array_equal(results[0].first, results[1].first)
