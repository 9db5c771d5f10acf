"""The predictor of one track: filter, resample, choose, predict."""

from __future__ import annotations

from collections.abc import Iterator
from math import sqrt

from onboard.core.vectors import ZERO, Vec
from onboard.pilot.filter import Fate, FilterSettings, TrackFilter, Variance
from onboard.pilot.predictor.prediction import REFUSAL, Prediction, PredictorKind

FARTHEST = 600.0  # nothing is said about instants farther from the newest sample than this [s]


class TrackPredictor:
    """Predicts one target from its samples, for any instant.

    Never raises on bad samples and never answers NaN: `add` tells the fate of a sample, `predict`
    answers with a large stated error, or refuses by `usable`."""

    def __init__(self, seed: int = 0, settings: FilterSettings | None = None) -> None:
        self.filter = TrackFilter(settings)
        self.seed = seed

    def add(self, t: float, position: Vec, velocity: Vec | None, variance: Variance) -> Fate:
        """Take a sample of instant `t` [s] (see TrackFilter.add)."""
        return self.filter.add(t, position, velocity, variance)

    def predict(self, t: float) -> Prediction:
        """The target at instant `t` [s], before or after the newest sample."""
        if self.filter.empty or not abs(t - self.filter.newest) <= FARTHEST:
            return REFUSAL
        estimate = self.filter.estimate(t)
        if self.filter.count < 2 and not self.filter.velocity_known:
            blind = self.filter.settings.velocity_unknown * abs(t - self.filter.newest)
            sigma = sqrt(estimate.sigma * estimate.sigma + blind * blind)
            return Prediction(estimate.position, ZERO, sigma, PredictorKind.LAST_KNOWN, True)
        return Prediction(
            estimate.position, estimate.velocity, estimate.sigma, PredictorKind.CONSTANT_VELOCITY, True
        )

    @property
    def trainable(self) -> bool:
        """Whether there are enough points to train on."""
        return False

    def train(self) -> Iterator[None]:
        """Train in slices of about 1 ms: each `next` does one."""
        return iter(())
