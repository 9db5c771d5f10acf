"""What a pilot remembers from step to step: a predictor for each track, and how fast it has seen them fly."""

from __future__ import annotations

from collections.abc import Collection, Hashable

from onboard.core.math.vectors import ZERO, Vec, norm, sub
from onboard.pilot.predictor import Prediction, TrackPredictor, Trainer
from onboard.pilot.predictor.model import ModelSettings
from onboard.pilot.predictor.track import PredictorSettings
from onboard.pilot.predictor_choice import Predicting
from onboard.pilot.setup import TrackSample

FORGETTING = 1.0 / 60.0  # share of a remembered top speed that fades in a second
TRACKS_MAX = 256  # tracks remembered; more than any roster


SETTINGS = {
    Predicting.NETWORK: PredictorSettings(),
    Predicting.RIDGE: PredictorSettings(model=ModelSettings(networks=False)),
    Predicting.CONSTANT_VELOCITY: PredictorSettings(learns=False),
}


class Memory:
    """Tracks by id, their training, and the upper envelope of their airspeeds.

    `wanted`: the tracks that anybody will ask for; None takes whatever comes. What nobody asks for is
    neither filtered nor learnt."""

    def __init__(
        self, predicting: Predicting = Predicting.NETWORK, wanted: Collection[int] | None = None
    ) -> None:
        self.predicting = predicting
        self._wanted = None if wanted is None else frozenset(wanted)
        self.tracks: dict[Hashable, TrackPredictor] = {}  # by id
        self.trainer = Trainer()
        self._fastest: dict[int, tuple[float, float]] = {}  # id → (envelope [m/s], instant [s])

    def take(self, samples: tuple[TrackSample, ...]) -> None:
        """Give new measurements to their predictors."""
        for sample in samples:
            if self._wanted is not None and sample.id not in self._wanted:
                continue
            predictor = self.tracks.get(sample.id)
            if predictor is None:
                if len(self.tracks) >= TRACKS_MAX:
                    continue
                predictor = self.tracks[sample.id] = TrackPredictor(sample.id, SETTINGS[self.predicting])
            predictor.add(sample.t, sample.position, sample.velocity, sample.variance)

    def prepare(self, id: int) -> None:
        """Reckon now what the next prediction of a track needs."""
        predictor = self.tracks.get(id)
        if predictor is not None:
            predictor.prepare()

    def predict(self, id: int, t: float) -> Prediction | None:
        """A track at instant `t`; None where there is none that is usable."""
        predictor = self.tracks.get(id)
        if predictor is None:
            return None
        prediction = predictor.predict(t)
        return prediction if prediction.usable else None

    def top_speed(self, id: int, t: float, velocity: Vec, wind: Vec = ZERO) -> float:
        """Upper envelope of the filtered airspeed of a track with no declared maximum [m/s]."""
        speed = norm(sub(velocity, wind))
        envelope, then = self._fastest.get(id, (speed, t))
        faded = envelope * max(0.0, 1.0 - FORGETTING * max(0.0, t - then))
        best = max(speed, faded)
        self._fastest[id] = (best, t)
        return best

    def train(self, now: float, slices: int = 1, *, asked: bool = True, only: int | None = None) -> int:
        """Advance the predictors' training by at most `slices` of about 1 ms; returns how many were done.

        `asked`: predictions are asked for about now, and what the next one needs is reckoned, of all tracks
        or of the one that is asked for at each step."""
        done = self.trainer.advance(now, self.tracks, slices)
        if asked and only is not None:
            self.prepare(only)
        elif asked:
            for predictor in self.tracks.values():
                predictor.prepare()
        return done
