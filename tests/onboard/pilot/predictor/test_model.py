"""The predictor that flies, on a grid: ridge base, ladder, choice."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.pilot.predictor import ridge
from onboard.pilot.predictor.activation import Array
from onboard.pilot.predictor.forecast import forecast
from onboard.pilot.predictor.heading import windows
from onboard.pilot.predictor.model import Heard, Model, ModelSettings, fit, refresh
from onboard.pilot.predictor.prediction import PredictorKind

SETTINGS = ModelSettings()
STEADY = PredictorKind.CONSTANT_VELOCITY


def trained(positions: Array, settings: ModelSettings = SETTINGS, seed: int = 0) -> Model | None:
    training = fit(positions, steps(positions), settings, np.random.default_rng(seed))
    while True:
        try:
            next(training)
        except StopIteration as end:
            model: Model | None = end.value
            return model


def steps(positions: Array) -> Array:
    return np.vstack([positions[1:2] - positions[:1], np.diff(positions, axis=0)])


def weave(count: int = 300, climb: float = 0.0, noise: float = 0.0, seed: int = 0) -> Array:
    t = 0.2 * np.arange(count)
    heading = 0.4 + 0.6 * np.sin(2 * np.pi * t / 8.0)
    rise = climb * np.sin(2 * np.pi * t / 11.0)
    velocity = 3.0 * np.stack([np.cos(heading), np.sin(heading), rise], axis=1)
    out: Array = np.cumsum(velocity, axis=0) + np.random.default_rng(seed).normal(0.0, noise, (count, 3))
    return out


def ratios(model: Model, positions: Array, truth: Array) -> Array:
    """Mean error over that of constant velocity, by horizon, from origin 200 on."""
    moves = steps(positions)
    mine, steady = [], []
    for k in range(200, 280):
        said = forecast(model, positions[: k + 1], moves[k], SETTINGS)
        for i, h in enumerate(SETTINGS.horizons):
            mine.append(np.linalg.norm(positions[k] + h * said.velocities[i] - truth[k + h]))
            steady.append(np.linalg.norm(positions[k] + h * moves[k] - truth[k + h]))
    out: Array = np.reshape(mine, (80, -1)).mean(axis=0) / np.reshape(steady, (80, -1)).mean(axis=0)
    return out


@pytest.mark.parametrize("climb", [0.0, 0.3])
def test_a_weave_is_foreseen_in_the_plane_and_in_space(climb: float) -> None:
    truth = weave(climb=climb)
    model = trained(truth[:200])
    assert model is not None
    assert STEADY not in model.kinds
    assert PredictorKind.NETWORK in model.kinds
    assert model.axes == ((0, 1, 2) if climb else (0, 1))
    assert ratios(model, truth, truth).max() < 0.1


def test_noise_is_borne() -> None:
    truth = weave()
    seen = weave(noise=0.15)
    model = trained(seen[:200])
    assert model is not None
    assert ratios(model, seen, truth).max() < 0.9
    assert ratios(model, seen, truth)[-1] < 0.4


def test_what_is_learnt_on_one_course_holds_on_any_other() -> None:
    truth = weave()
    turned = np.stack([-truth[:, 1], truth[:, 0], truth[:, 2]], axis=1)
    model = trained(truth[:200])
    assert model is not None
    np.testing.assert_allclose(ratios(model, turned, turned), ratios(model, truth, truth), rtol=1e-6)


def test_the_ladder_goes_from_constant_velocity_to_network_to_ridge() -> None:
    truth = weave()
    assert trained(truth[:7]) is None
    young = trained(truth[:25])
    assert young is not None
    assert not young.coefficients.any()
    assert PredictorKind.RIDGE not in young.kinds
    grown = trained(truth[:40])
    assert grown is not None
    assert grown.coefficients.any()
    assert grown.kinds[-1] is STEADY  # nothing was held out at 20 steps yet


def test_a_straight_flight_in_noise_keeps_constant_velocity_or_does_no_harm() -> None:
    rng = np.random.default_rng(0)
    truth = np.arange(300)[:, None] * np.array([3.0, 1.0, 0.0])
    moves = np.tile([3.0, 1.0, 0.0], (300, 1))
    seen = truth + rng.normal(0.0, 0.5, (300, 3))
    training = fit(seen[:200], moves[:200], SETTINGS, rng)  # the true velocity: it cannot be beaten
    model = None
    while model is None:
        try:
            next(training)
        except StopIteration as end:
            model = end.value
    said = forecast(model, seen[:201], moves[200], SETTINGS)
    assert np.abs(said.velocities[2:] - moves[200]).max() < 0.3


@pytest.mark.parametrize("kind", ["still", "straight", "jump", "huge"])
def test_degenerate_tracks_give_finite_answers(kind: str) -> None:
    k = np.arange(200)[:, None]
    tracks = {
        "still": np.zeros((200, 3)),
        "straight": k * np.array([3.0, 0.0, 0.0]),
        "jump": np.where(k < 100, 0.0, 5000.0) + k * np.array([1.0, 2.0, 0.0]),
        "huge": 1e9 * np.sin(k) * np.ones(3),
    }
    positions = tracks[kind].astype(float)
    model = trained(positions)
    assert model is not None
    said = forecast(model, positions, steps(positions)[-1], SETTINGS)
    assert np.isfinite(said.velocities).all()
    assert not np.isnan(said.sigma).any()
    if kind == "still":
        assert np.abs(said.velocities).max() == 0.0


def test_ridge_by_axis_is_the_ridge_over_mirrored_copies() -> None:
    rng = np.random.default_rng(6)
    moves = rng.normal(size=(60, 4, 3))
    targets = rng.normal(size=(60, 1, 3))
    by_axis = ridge.fit(ridge.features(moves), targets, [60], (0.01,))[0]
    mirror = np.array([1.0, -1.0, 1.0])
    rows = np.concatenate([moves, moves * mirror])
    wanted = np.concatenate([targets[:, 0], targets[:, 0] * mirror])
    lateral = np.hstack([rows[:, :, 1], rows[:, :, 0], np.ones((120, 1))])  # from all moves
    gram = lateral.T @ lateral
    solution = np.linalg.solve(gram + 0.01 * np.diag(np.diag(gram)), lateral.T @ wanted[:, 1])
    np.testing.assert_allclose(solution[:4], by_axis[0, 1, :4], rtol=1e-9)
    np.testing.assert_allclose(solution[4:], 0.0, atol=1e-12)


def test_windows_lie_in_the_frame_of_their_heading() -> None:
    positions = np.arange(10)[:, None] * np.array([0.0, 2.0, -1.0])  # east and up
    view = windows(positions, steps(positions), np.array([6]), 5)
    np.testing.assert_allclose(view.moves[0], np.tile([2.0, 0.0, -1.0], (4, 1)), atol=1e-12)


def test_the_ridge_is_kept_up_between_trainings() -> None:
    truth = weave()
    model = trained(truth[:200])
    assert model is not None
    later = refresh(truth[:210][-200:], steps(truth[:210])[-200:], model, SETTINGS)
    assert not np.array_equal(later.coefficients, model.coefficients)
    assert later.kinds == model.kinds
    assert ratios(later, truth, truth).max() < 0.1


def test_the_same_seed_gives_the_same_bytes() -> None:
    a, b, c = (trained(weave(noise=0.1)[:100], seed=seed) for seed in (1, 1, 2))
    assert a is not None
    assert b is not None
    assert c is not None
    assert a.weights.first.tobytes() == b.weights.first.tobytes()
    assert a.coefficients.tobytes() == b.coefficients.tobytes()
    assert a.weights.first.tobytes() != c.weights.first.tobytes()


def test_a_manoeuvre_filter_is_believed_as_far_as_it_was_right() -> None:
    """It is asked where nothing is to be learnt: turns of random rate in noise. Right, it is believed; wrong
    by a mirror, it is not; silent, nothing changes."""
    rng = np.random.default_rng(4)
    heading = np.cumsum(np.repeat(rng.uniform(-0.15, 0.15, 30), 10))
    truth = np.cumsum(3.0 * np.stack([np.cos(heading), np.sin(heading), 0.0 * heading], axis=1), axis=0)
    seen = truth + rng.normal(0.0, 0.15, truth.shape) * np.array([1.0, 1.0, 0.0])
    horizons = np.array(SETTINGS.horizons)
    ends = np.minimum(np.arange(200)[:, None] + horizons, 199)
    right = truth[ends][..., :2]
    drift = right - seen[:200, None, :2] - horizons[:, None] * steps(seen)[:200, None, :2]
    models = {}
    for name, places in (("right", right), ("wrong", right - 2.0 * drift), ("silent", None)):
        heard = None if places is None else Heard(places, seen[:200])
        training = fit(seen[:200], steps(seen)[:200], SETTINGS, np.random.default_rng(0), heard)
        while True:
            try:
                next(training)
            except StopIteration as end:
                models[name] = end.value
                break
    assert (models["right"].turning[:4] > 0.8).all()
    assert (models["wrong"].turning < 0.2).all()
    assert not models["silent"].turning.any()
    future = truth[250 + horizons][:, :2]
    said = forecast(models["right"], seen[:251], steps(seen)[250], SETTINGS, None, future)
    reached = seen[250, :2] + horizons[:, None] * said.velocities[:, :2]
    plain = seen[250, :2] + horizons[:, None] * steps(seen)[250, :2]
    off, steady = (np.linalg.norm(one - future, axis=1) for one in (reached, plain))
    assert (off[:4] < 0.5 * steady[:4]).all()
