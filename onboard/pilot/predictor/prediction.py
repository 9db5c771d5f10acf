"""What a predictor says: a place, a velocity, how sure it is, and which method spoke."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from onboard.core.math.vectors import ZERO, Vec


class PredictorKind(IntEnum):
    """Which predictor spoke."""

    NOTHING = 0  # no usable sample: a refusal
    LAST_KNOWN = 1  # one sample: the place where the target was, with a large error
    CONSTANT_VELOCITY = 2  # the track filter, carried forward
    RIDGE = 3  # linear regression over the last points
    NETWORK = 4  # s-parabola network over the ridge
    MANOEUVRE = 5  # constant velocity and coordinated turn, weighed by how well each explains the track


SPEAKING = (PredictorKind.RIDGE, PredictorKind.NETWORK)  # what was learnt speaks


class Prediction(NamedTuple):
    """A predicted state of a target; not `usable` where nothing can be said: do not steer by it."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground, NED]
    sigma: float  # root mean square distance error of the position [m]; finite unless unusable
    source: PredictorKind
    usable: bool


REFUSAL = Prediction(ZERO, ZERO, float("inf"), PredictorKind.NOTHING, False)
