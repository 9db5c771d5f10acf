"""The predictors that are compared, behind one Protocol."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from onboard.pilot.predictor.model import Model, ModelSettings, fit, forecast
from onboard.pilot.predictor.paper import PaperNetwork, PaperSettings
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
