"""The predictors that are compared, behind one Protocol."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from onboard.pilot.predictor.forecast import forecast
from onboard.pilot.predictor.model import Model, ModelSettings, fit, refresh
from onboard.pilot.predictor.paper import PaperNetwork, PaperSettings
from onboard.pilot.predictor.trust import Trust
from tests.benchmarks.predictor.families import Array

HORIZONS = (1, 5, 10, 20)  # [steps]
SETTINGS = ModelSettings()
ROWS = [SETTINGS.horizons.index(h) for h in HORIZONS]


class Method(Protocol):
    """A predictor on a grid."""

    def fit(self, positions: Array, velocities: Array, seed: int) -> None:
        """Learn from positions (n, 3) [m] and velocities (n, 3) [m a step]."""
        ...

    def predict(self, positions: Array, velocity: Array) -> Array:
        """Places (H, 3) at HORIZONS from the positions so far and the velocity now [m a step]."""
        ...


class ConstantVelocity:
    """The last displacement goes on."""

    def fit(self, positions: Array, velocities: Array, seed: int) -> None:
        """Nothing to learn."""

    def predict(self, positions: Array, velocity: Array) -> Array:
        out: Array = positions[-1] + np.array(HORIZONS)[:, None] * velocity
        return out


class Flying:
    """The predictor that flies, or its ridge base alone."""

    def __init__(self, networks: bool = True) -> None:
        self.settings = SETTINGS._replace(networks=networks)
        self.model: Model | None = None

    def fit(self, positions: Array, velocities: Array, seed: int) -> None:
        training = fit(positions, velocities, self.settings, np.random.default_rng(seed))
        while True:
            try:
                next(training)
            except StopIteration as end:
                self.model = end.value
                return

    def predict(self, positions: Array, velocity: Array) -> Array:
        if self.model is None:
            return ConstantVelocity().predict(positions, velocity)
        said = forecast(self.model, positions, velocity, self.settings)
        out: Array = positions[-1] + said.velocities[ROWS] * np.array(HORIZONS)[:, None]
        return out


class Online:
    """The predictor as it flies: the last 200 points, the ridge fitted at every step, the network every 20,
    and belief that follows what became of the last predictions."""

    def fit(self, positions: Array, velocities: Array, seed: int) -> None:
        self.seed, self.count, self.window = seed, 0, len(positions)
        self.trust = Trust(SETTINGS.horizons)
        self.inner = Flying()
        early = len(positions) - 40  # belief begins with the last predictions of the training set
        self.inner.fit(positions[:early], velocities[:early], seed)
        for k in range(early, len(positions)):
            self._step(positions[: k + 1], velocities[: k + 1])

    def predict(self, positions: Array, velocity: Array) -> Array:
        velocities = np.vstack([positions[1:2] - positions[:1], np.diff(positions, axis=0)])
        self._step(positions[-self.window :], velocities[-self.window :])
        model = self.inner.model
        assert model is not None
        said = forecast(model, positions, velocity, SETTINGS, self.trust.shares())
        out: Array = positions[-1] + said.velocities[ROWS] * np.array(HORIZONS)[:, None]
        return out

    def _step(self, positions: Array, velocities: Array) -> None:
        self.count += 1
        model = self.inner.model
        assert model is not None
        if self.count % 20 == 0:
            self.inner.fit(positions, velocities, self.seed + self.count)
            model = self.inner.model
            assert model is not None
        else:
            model = self.inner.model = refresh(positions, velocities, model, SETTINGS)
        self.trust.judge(self.count, positions)
        said = forecast(model, positions, velocities[-1], SETTINGS)
        self.trust.tell(self.count, positions[-1], velocities[-1], said.velocities - velocities[-1])


class Paper:
    """The paper's networks, one a coordinate, sign corrected, rolled out."""

    def __init__(self, epochs: int = 1000) -> None:
        self.settings = PaperSettings(epochs=epochs)

    def fit(self, positions: Array, velocities: Array, seed: int) -> None:
        axes = 3 if np.ptp(positions[:, 2]) > 1e-9 else 2
        self.networks = [PaperNetwork(np.random.default_rng([seed, a]), self.settings) for a in range(axes)]
        for axis, network in enumerate(self.networks):
            network.fit(positions[:, axis])

    def predict(self, positions: Array, velocity: Array) -> Array:
        out = np.repeat(positions[-1:], len(HORIZONS), axis=0)
        for axis, network in enumerate(self.networks):
            with np.errstate(over="ignore", invalid="ignore"):
                out[:, axis] = network.roll(positions[-5:, axis], HORIZONS[-1])[np.array(HORIZONS) - 1]
        return out
