"""The predictor of one track: filter, resample, learn, predict."""

from __future__ import annotations

from collections.abc import Generator
from itertools import pairwise
from math import hypot, nan, sqrt
from typing import NamedTuple

import numpy as np

from onboard.core.math.vectors import ZERO, Vec, norm
from onboard.pilot.kalman import Variance
from onboard.pilot.predictor import model as flying
from onboard.pilot.predictor.calibration import Calibration
from onboard.pilot.predictor.forecast import Plain, answer, learnt, plain
from onboard.pilot.predictor.grid import Grid
from onboard.pilot.predictor.manoeuvre import ManoeuvreFilter
from onboard.pilot.predictor.model import Heard, Model, ModelSettings
from onboard.pilot.predictor.need import Need
from onboard.pilot.predictor.path import Path, at, path, sound
from onboard.pilot.predictor.prediction import REFUSAL, Prediction, PredictorKind
from onboard.pilot.predictor.running import RunningRidge
from onboard.pilot.predictor.trust import Trust
from onboard.pilot.track_filter import Fate, FilterSettings, TrackFilter

Places = list[tuple[float, float]]

FARTHEST = 600.0  # nothing is said about instants farther from the newest sample than this [s]


class PredictorSettings(NamedTuple):
    """Settings of a track's predictor."""

    filter: FilterSettings = FilterSettings()
    model: ModelSettings = ModelSettings()
    step: float = 0.2  # of the grid [s]
    window: int = 200  # points of the grid that are kept
    gap: float = 2.0  # a longer silence makes the grid begin anew [s]
    learns: bool = True  # off: the filter alone, carried on at constant velocity


class TrackPredictor:
    """Predicts one target from its samples, for any instant.

    Never raises on bad samples and never answers NaN: `add` tells the fate of a sample, `predict`
    answers with a large stated error, or refuses by `usable`. The same samples, trainings and seed
    give the same answers."""

    def __init__(self, seed: int = 0, settings: PredictorSettings | None = None) -> None:
        self.settings = PredictorSettings() if settings is None else settings
        self.filter = TrackFilter(self.settings.filter)
        self.grid = Grid(self.settings.step, self.settings.window, self.settings.gap)
        self.model: Model | None = None
        self.trust = Trust(self.settings.model.horizons)
        self.calibration = Calibration(self.settings.model.horizons)
        self.need = Need(self.settings.model.horizons, self.settings.model.ladder)
        self.trainings = 0
        self.manoeuvre = ManoeuvreFilter()
        self._turned: dict[int, Places] = {}  # grid point → places (H, 2) [m] expected by `manoeuvre`
        self._plain: Plain | None = None  # the model
        self._ridge = RunningRidge(self.settings.model)
        self._seed = seed
        self._life = 0  # counts restarts: a training that began before one is thrown away
        self._fitted = -1  # grid points at the last fit of the ridge
        self._path: Path | None = None
        self._fresh = False  # whether _path is of the newest sample and model

    def add(self, t: float, position: Vec, velocity: Vec | None, variance: Variance) -> Fate:
        """Take a sample of instant `t` [s] (see TrackFilter.add)."""
        fate = self.filter.add(t, position, velocity, variance)
        if not self.settings.learns:
            return fate
        if fate in (Fate.TAKEN, Fate.RESTARTED):
            self.manoeuvre.add(t, position, velocity, variance)
        if fate is Fate.TAKEN:
            self.grid.extend(self.filter)
        elif fate is Fate.LATE:
            self.grid.revise(self.filter, t)
        elif fate is Fate.RESTARTED:
            self._turned.clear()
            self.grid.clear()
            self.grid.extend(self.filter)
            self.trust.clear()
            self.calibration.clear()
            self.need.clear()
            self.model = self._plain = None
            self._life += 1
        else:
            return fate
        self._note()
        self._fresh = False
        return fate

    def _note(self) -> None:
        """Keep what the manoeuvre filter expects from the newest grid point on, once a point."""
        newest = self.grid.last
        if newest in self._turned or not len(self.grid):
            return
        self._turned[newest] = self._expected(newest * self.settings.step)
        while len(self._turned) > self.settings.window:
            del self._turned[next(iter(self._turned))]

    def _expected(self, since: float) -> Places:
        """Places (H, 2) [m] that the manoeuvre filter expects at the horizons after `since` [s]."""
        begun = since - self.manoeuvre.newest
        step = self.settings.step
        return self.manoeuvre.places([h * step + begun for h in self.settings.model.horizons])

    def _heard(self) -> Heard:
        """What the manoeuvre filter expected at the grid's points, NaN where nothing was noted."""
        silent = [(nan, nan)] * len(self.settings.model.horizons)
        first = self.grid.last - len(self.grid) + 1
        points = range(first, self.grid.last + 1)
        return Heard(np.array([self._turned.get(point, silent) for point in points]), self.grid.measured())

    def predict(self, t: float) -> Prediction:
        """The target at instant `t` [s], before or after the newest sample."""
        if self.filter.empty or not abs(t - self.filter.newest) <= FARTHEST:
            return REFUSAL
        estimate = self.filter.estimate(t)
        if self.filter.count < 2 and not self.filter.velocity_known:
            blind = self.filter.settings.velocity_unknown * abs(t - self.filter.newest)
            sigma = sqrt(estimate.sigma * estimate.sigma + blind * blind)
            return Prediction(estimate.position, ZERO, sigma, PredictorKind.LAST_KNOWN, True)
        line = self._line() if t > self.filter.newest else None
        if line is not None:
            return at(line, t, estimate.sigma)
        kind = PredictorKind.CONSTANT_VELOCITY
        return Prediction(estimate.position, estimate.velocity, estimate.sigma, kind, True)

    def prepare(self) -> None:
        """Reckon now what the next prediction needs, so that no control step waits for it."""
        if self.model is not None and not self.filter.empty:
            self._line()

    @property
    def longest(self) -> float:
        """The longest horizon [s]; beyond it constant velocity goes on."""
        return max(self.settings.model.horizons) * self.settings.step

    @property
    def trainable(self) -> bool:
        """Whether there are enough points to train on, and the model asks for it: see Need."""
        count = len(self.grid)
        return count >= self.settings.model.ladder[0] and self.need.asks(count, self.settings.window)

    def train(self) -> Generator[None, None, None]:
        """Train on the grid in slices of about 1 ms: each `next` does one; the last puts the model to use."""
        life = self._life
        count, points, newest = self.grid.added, len(self.grid), self.grid.last
        self.trainings += 1
        rng = np.random.default_rng([self._seed, self.trainings])
        trained = yield from flying.fit(*self.grid.arrays(), self.settings.model, rng, self._heard())
        if trained is not None and life == self._life:
            self.model, self._plain = trained, plain(trained, self.settings.model)
            self._ridge.clear()
            self.need.trained(points, newest)
            self._fitted = count
            self._fresh = False

    @property
    def ready(self) -> bool:
        """Whether the path of the newest sample and model is at hand, so that a prediction computes none."""
        return self._fresh and self._path is not None

    @property
    def stale(self) -> bool:
        """Whether grid points came since the ridge was last fitted."""
        return self.model is not None and self.grid.added != self._fitted

    def refresh(self) -> None:
        """Keep the ridge up with the grid, and judge the last predictions: far less than 1 ms."""
        if self.model is None or self._plain is None:
            return
        self.model = model = self._ridge.follow(self.grid, self.model)
        self._plain = plain = self._plain._replace(ridge=model.coefficients.tolist())
        self._fitted = self.grid.added
        self._fresh = False
        newest = self.grid.last
        rows = self.grid.tail(max(model.points, 1))
        self.trust.judge(newest, rows)
        self.need.hear(self.calibration.judge(newest, rows))
        if len(rows) < model.points:
            return
        step, horizons = self.settings.step, self.settings.model.horizons
        here, velocity = rows[-1][:3], [v * step for v in rows[-1][3:6]]
        own = learnt(plain, rows, velocity)
        alone = answer(plain, own, here, velocity, horizons)
        innovation = [[x - v for x, v in zip(mean, velocity, strict=True)] for mean in alone.velocities]
        self.trust.tell(newest, here, velocity, innovation)
        beside = (self.trust.shares(), self._turned.get(newest))
        said = answer(plain, own, here, velocity, horizons, beside)
        ends = [
            [p + h * v for p, v in zip(here, mean, strict=True)]
            for mean, h in zip(said.velocities, horizons, strict=True)
        ]
        start = self.filter.estimate(newest * step).sigma
        self.calibration.tell(newest, ends, [hypot(start, sigma) for sigma in said.sigma])

    def _line(self) -> Path | None:
        """The path from the newest sample on; None where the model cannot speak."""
        if not self._fresh:
            self._path = self._forecast()
            self._fresh = True
        return self._path

    def _forecast(self) -> Path | None:
        model, step, newest = self._plain, self.settings.step, self.filter.newest
        places = None if model is None else self.grid.window(self.filter, model.points)
        if model is None or places is None:
            return None
        here = self.filter.estimate(newest)
        horizons = self.settings.model.horizons
        velocity = [v * step for v in here.velocity]
        beside = (self.trust.shares(), self._expected(newest))
        said = answer(model, learnt(model, places, velocity), places[-1], velocity, horizons, beside)
        own = here.sigma * here.sigma
        errors = zip(self.calibration.factors(), said.sigma, strict=True)
        said = said._replace(
            sigma=[sqrt(max(f * f * (own + sigma * sigma) - own, 0.0)) for f, sigma in errors]
        )
        line = path(here, said, horizons, step)
        moves = (((a - x) ** 2 + (b - y) ** 2 + (c - z) ** 2) for (a, b, c), (x, y, z) in pairwise(places))
        return line if sound(line, max(sqrt(max(moves)) / step, norm(here.velocity))) else None
