"""Which predictor carries a track forward: a choice of the configuration and of scenarios."""

from __future__ import annotations

from enum import Enum


class Predicting(Enum):
    """How tracks are carried forward to now and beyond."""

    NETWORK = "network"  # the s-parabola network over its ridge base, where it is better than its rivals
    RIDGE = "ridge"  # the ridge base alone, or constant velocity
    CONSTANT_VELOCITY = "constant-velocity"  # the track filter alone: nothing is learnt
