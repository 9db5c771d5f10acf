"""The s-parabola predictor of section 3.5, made to work online on a small computer."""

from onboard.pilot.predictor.prediction import REFUSAL, Prediction, PredictorKind
from onboard.pilot.predictor.track import TrackPredictor
from onboard.pilot.predictor.trainer import Trainer

__all__ = ["REFUSAL", "Prediction", "PredictorKind", "TrackPredictor", "Trainer"]
