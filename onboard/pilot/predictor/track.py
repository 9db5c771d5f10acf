"""The predictor of one track: filter, resample, learn, predict."""

from __future__ import annotations

from collections.abc import Generator
from math import sqrt
from typing import NamedTuple

import numpy as np

from onboard.core.math.vectors import ZERO, Vec, norm
from onboard.pilot.kalman import Variance
from onboard.pilot.predictor import model as flying
from onboard.pilot.predictor.activation import Array
from onboard.pilot.predictor.calibration import Calibration
from onboard.pilot.predictor.forecast import answer, forecast, learnt
from onboard.pilot.predictor.grid import Grid
from onboard.pilot.predictor.manoeuvre import ManoeuvreFilter
from onboard.pilot.predictor.model import Heard, Model, ModelSettings
from onboard.pilot.predictor.path import Path, at, path, sound
from onboard.pilot.predictor.prediction import REFUSAL, Prediction, PredictorKind
from onboard.pilot.predictor.trust import Trust
from onboard.pilot.track_filter import Fate, FilterSettings, TrackFilter

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
        self.trainings = 0
        self.manoeuvre = ManoeuvreFilter()
        self._turned: dict[int, Array] = {}  # grid point → places (H, 2) [m] expected by `manoeuvre`
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
            self.model = None
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

    def _expected(self, since: float) -> Array:
        """Places (H, 2) [m] that the manoeuvre filter expects at the horizons after `since` [s]."""
        begun = since - self.manoeuvre.newest
        step = self.settings.step
        return self.manoeuvre.places([h * step + begun for h in self.settings.model.horizons])

    def _heard(self) -> Heard:
        """What the manoeuvre filter expected at the grid's points, NaN where nothing was noted."""
        silent = np.full((len(self.settings.model.horizons), 2), np.nan)
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
        """Whether there are enough points to train on."""
        return len(self.grid) >= self.settings.model.ladder[0]

    def train(self) -> Generator[None, None, None]:
        """Train on the grid in slices of about 1 ms: each `next` does one; the last puts the model to use."""
        life = self._life
        count = self.grid.added
        self.trainings += 1
        rng = np.random.default_rng([self._seed, self.trainings])
        trained = yield from flying.fit(*self.grid.arrays(), self.settings.model, rng, self._heard())
        if trained is not None and life == self._life:
            self.model = trained
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
        """Fit the ridge anew to the grid, and judge the last predictions: a slice of less than 1 ms."""
        if self.model is None:
            return
        positions, velocities = self.grid.arrays()
        self.model = flying.refresh(positions, velocities, self.model, self.settings.model)
        self._fitted = self.grid.added
        self._fresh = False
        self.trust.judge(self.grid.last, positions)
        self.calibration.judge(self.grid.last, positions)
        if len(positions) >= self.model.points:
            settings, here, velocity = self.settings.model, positions[-1], velocities[-1]
            own = learnt(self.model, positions, velocity, settings)
            alone = answer(self.model, own, here, velocity, settings)
            self.trust.tell(self.grid.last, here, velocity, alone.velocities - velocity)
            beside = (self.trust.shares(), self._turned.get(self.grid.last))
            said = answer(self.model, own, here, velocity, settings, beside)
            ends = positions[-1] + said.velocities * np.array(self.settings.model.horizons)[:, None]
            start = self.filter.estimate(self.grid.last * self.settings.step).sigma
            self.calibration.tell(self.grid.last, ends, np.hypot(start, said.sigma))

    def _line(self) -> Path | None:
        """The path from the newest sample on; None where the model cannot speak."""
        if not self._fresh:
            self._path = self._forecast()
            self._fresh = True
        return self._path

    def _forecast(self) -> Path | None:
        model, step, newest = self.model, self.settings.step, self.filter.newest
        places = None if model is None else self.grid.window(self.filter, model.points)
        if model is None or places is None:
            return None
        here = self.filter.estimate(newest)
        with np.errstate(over="ignore", invalid="ignore"):
            velocity = np.array(here.velocity) * step
            said = forecast(
                model, places, velocity, self.settings.model, self.trust.shares(), self._expected(newest)
            )
        whole = self.calibration.factors() * np.hypot(here.sigma, said.sigma)
        said = said._replace(sigma=np.sqrt(whole * whole - here.sigma * here.sigma))
        horizons = self.settings.model.horizons
        line = path(here, said, horizons, step)
        moves = np.diff(places, axis=0)
        fastest = float(np.sqrt((moves * moves).sum(axis=1)).max()) / step
        return line if sound(line, max(fastest, norm(here.velocity))) else None
