"""Who speaks at a horizon, by what each said of the points held out.

Constant velocity unless a model is better by a margin; ridge or network, whichever was nearer; and the share
of the manoeuvre filter beside it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor.activation import Array
from onboard.pilot.predictor.prediction import PredictorKind


class Held(NamedTuple):
    """Innovations of one horizon at the points held out, each (k, 3) [m a step]."""

    fact: Array
    base: Array  # what the ridge said; zeros below the ladder
    said: Array  # what the network said on top
    turning: Array  # what the manoeuvre filter said; NaN where it was silent


class Verdict(NamedTuple):
    """What the points held out say of one horizon."""

    kind: PredictorKind
    shrink: float
    believed: float
    sigma: float
    turning: float


def judge(held: Held, horizon: int, linear: bool, margin: float) -> Verdict:
    """Choose for a horizon [steps] between constant velocity, ridge and network by what each said of points
    held out, and the share of the manoeuvre filter beside it; shares are least squares', clipped to 0…1."""
    fact, count = held.fact, len(held.fact)
    if count < max(3, horizon // 2):
        return Verdict(PredictorKind.CONSTANT_VELOCITY, 0.0, 1.0, float("nan"), 0.0)
    rest = fact - held.base
    independent = count / horizon  # overlapping horizons are no independent evidence
    shrink = _share(held.said, rest) * independent / (independent + 1.0)
    by_net = mean_distance(rest - shrink * held.said) if shrink > 0.0 else np.inf
    by_ridge = mean_distance(rest) if linear else np.inf
    kind, whole, believed = PredictorKind.CONSTANT_VELOCITY, np.zeros_like(fact), 1.0
    if min(by_net, by_ridge) < np.inf:
        spoke = PredictorKind.NETWORK if by_net < by_ridge else PredictorKind.RIDGE
        told = held.base + shrink * held.said if spoke is PredictorKind.NETWORK else held.base
        share = _share(told, fact)
        if mean_distance(fact - share * told) < (1.0 - margin) * mean_distance(fact):
            believed = float(np.sqrt(share))  # judged on 70 % of the points, it flies with all of them
            kind, whole = spoke, believed * told
    turning = _blend(held, whole, independent, kind is PredictorKind.CONSTANT_VELOCITY, margin)
    if turning > 0.0:
        whole = whole + turning * (held.turning - whole)
        kind = PredictorKind.MANOEUVRE if kind is PredictorKind.CONSTANT_VELOCITY else kind
    if kind not in (PredictorKind.RIDGE, PredictorKind.NETWORK):
        shrink = 0.0
    return Verdict(kind, shrink, believed, horizon * _root_mean_square(fact - whole), turning)


def _blend(held: Held, whole: Array, independent: float, alone: bool, margin: float) -> float:
    """The share of the manoeuvre filter beside what the model says, 0 where it brings nothing: least squares,
    drawn towards one half by as much as one independent point, since two fair guesses are best averaged."""
    if np.isnan(held.turning).any():
        return 0.0
    apart, rest = held.turning - whole, held.fact - whole
    power, match = float((apart * apart).mean()), float((apart * rest).mean())
    if power < 1e-12:
        return 0.0
    middle = 0.0 if alone else 0.5
    share = (match * independent + middle * power) / (power * (independent + 1.0))
    share = min(max(share, 0.0), 1.0)
    better = mean_distance(rest - share * apart) < (1.0 - margin * alone) * mean_distance(rest)
    return share if better else 0.0


def _share(said: Array, fact: Array) -> float:
    """The multiple of `said` nearest to `fact`, both (k, 3), clipped to 0…1."""
    power = float((said * said).sum())
    return min(max(float((said * fact).sum()) / power, 0.0), 1.0) if power > 0.0 else 0.0


def _root_mean_square(errors: Array) -> float:
    return float(np.sqrt((errors * errors).sum(axis=1).mean()))


def mean_distance(errors: Array) -> float:
    """Mean distance of error vectors (k, 3); infinite for none."""
    return float(np.sqrt((errors * errors).sum(axis=1)).mean()) if len(errors) else float("inf")
