"""The forecast in plain floats beside the same sums in arrays, as `fit` learnt them."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.pilot.predictor import network, ridge
from onboard.pilot.predictor.activation import Array
from onboard.pilot.predictor.forecast import learnt, plain
from onboard.pilot.predictor.heading import windows
from onboard.pilot.predictor.model import REACH, SQUEEZE, Model, ModelSettings
from onboard.pilot.predictor.network import Weights
from onboard.pilot.predictor.path import _slopes
from onboard.pilot.predictor.prediction import PredictorKind

KINDS = (
    PredictorKind.RIDGE, PredictorKind.NETWORK, PredictorKind.CONSTANT_VELOCITY, PredictorKind.NETWORK,
    PredictorKind.RIDGE,
)  # fmt: skip
LAGS = (0, 2, 7)


def drawn(rng: np.random.Generator, axes: tuple[int, ...], points: int) -> Model:
    """A model of random numbers."""
    inputs, outputs = len(axes) * len(LAGS), 5 * len(axes)
    coefficients = rng.normal(size=(5, 3, points))
    coefficients[:, 1, -1] = 0.0
    return Model(
        points, coefficients, KINDS, (0,) * 5, rng.uniform(size=5), rng.uniform(size=5),
        Weights(rng.normal(size=(inputs + 1, 4)), rng.normal(size=(5, outputs))), LAGS, axes,
        rng.normal(size=inputs), rng.uniform(0.1, 2.0, inputs), rng.uniform(0.1, 2.0, (5, len(axes))),
        np.ones(5), rng.uniform(size=5),
    )  # fmt: skip


def in_arrays(model: Model, positions: Array, velocity: Array, settings: ModelSettings) -> Array:
    """Innovations (H, 3) by the functions that training uses."""
    recent = positions[-model.points :]
    last, newest = np.array([model.points - 1]), np.broadcast_to(velocity, recent.shape)
    view = windows(recent, newest, last, model.points)
    out = ridge.predict(model.coefficients, ridge.features(view.moves))[0]
    raw = view.moves[0][list(model.lags)][:, list(model.axes)].T.ravel()
    inputs = np.clip((raw - model.middle) / model.scale, -REACH, REACH)
    said = network.output(settings.activation, model.weights, np.array([[1.0, *inputs]]))[0]
    added = (said.reshape(5, -1) - 0.5) / SQUEEZE * model.spread * model.shrink[:, None]
    for i, kind in enumerate(KINDS):
        if kind is PredictorKind.NETWORK:
            out[i, list(model.axes)] += added[i]
        elif kind is PredictorKind.CONSTANT_VELOCITY:
            out[i] = 0.0
    return out


@pytest.mark.parametrize("axes", [(0, 1), (0, 1, 2)])
@pytest.mark.parametrize("still", [False, True], ids=["moving", "hovering"])
def test_floats_say_what_arrays_say(axes: tuple[int, ...], still: bool) -> None:
    rng, settings = np.random.default_rng(len(axes)), ModelSettings()
    for _ in range(50):
        points = int(rng.integers(9, 21))
        model = drawn(rng, axes, points)
        positions = rng.normal(0.0, 30.0, (points + 3, 3))
        if still:
            positions[:] = positions[0]
        velocity = rng.normal(0.0, 3.0, 3)
        said = learnt(plain(model, settings), positions.tolist(), velocity.tolist())
        wanted = in_arrays(model, positions, velocity, settings)
        np.testing.assert_allclose(said.innovation, wanted, rtol=1e-11, atol=1e-11)


def test_slopes_of_a_parabola_are_its_derivative() -> None:
    """Between the ends the parabola through three neighbours is the curve; the last is more careful."""
    ahead = (0, 1, 2, 5, 10, 20)
    moves = [(3.0 * t - 0.2 * t * t, 2.0 * t, 0.1 * t * t) for t in ahead]
    slopes = _slopes(ahead, moves, (3.0, 2.0, 0.0))
    wanted = [*((3.0 - 0.4 * t, 2.0, 0.2 * t) for t in ahead[:-1]), (-4.0, 2.0, 3.5)]
    np.testing.assert_allclose(slopes, wanted, atol=1e-12)
