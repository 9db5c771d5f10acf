"""Who speaks at a horizon, by what each said of the points held out.

Constant velocity unless a model is better by a margin; ridge or network, whichever was nearer; and the share
of the manoeuvre filter beside it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor.activation import Array
from onboard.pilot.predictor.prediction import PredictorKind

WITNESSES = 40.0  # no choice is held surer than by so many independent points
FEW = 0.55  # Student's t: 68 % lie within 1 + 0.55 / n of the deviation that n errors gave
ODDS = 0.4  # of what was learnt against what needs no learning, before any witness: a far horizon has few
HANDICAP = 1.2  # of what was learnt against what needs no learning, in mean square error


class Held(NamedTuple):
    """Innovations of one horizon at the points held out, each (k, 3) [m a step]."""

    fact: Array
    base: Array  # what the ridge said; zeros below the ladder
    said: Array  # what the network said on top
    turning: Array  # what the manoeuvre filter said; NaN where it was silent
    measured: Array  # what came, as the sensor says: `fact` is filtered, and lags in a turn


class Verdict(NamedTuple):
    """What the points held out say of one horizon."""

    kind: PredictorKind
    shrink: float
    believed: float
    sigma: float
    turning: float


class Verdicts(NamedTuple):
    """Those of all horizons, each (H,)."""

    kinds: tuple[PredictorKind, ...]
    shrink: Array
    believed: Array
    sigma: Array
    turning: Array


def verdicts(each: list[Verdict]) -> Verdicts:
    """Put those of single horizons side by side."""
    kinds, *columns = zip(*each, strict=True)
    return Verdicts(kinds, *(np.array(column) for column in columns))


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
    turning = _blend(held, whole, independent)
    if turning > 0.0:
        whole = whole + turning * (held.turning - whole)
        if kind is PredictorKind.CONSTANT_VELOCITY and turning > 0.5:
            kind = PredictorKind.MANOEUVRE
    if kind not in (PredictorKind.RIDGE, PredictorKind.NETWORK):
        shrink = 0.0
    error = _root_mean_square(fact - whole) * (1.0 + FEW / independent)
    return Verdict(kind, shrink, believed, horizon * error, turning)


def _blend(held: Held, whole: Array, independent: float) -> float:
    """The share of the manoeuvre filter beside what the model says: how likely it is the better of the two.

    Witness is each independent point held out, by mean square errors against the sensor (two Gaussian errors
    of unknown size); what was learnt bears a handicap, and before any witness the lesser odds."""
    if np.isnan(held.turning).any():
        return 0.0
    mine = float(((held.measured - whole) ** 2).sum(axis=1).mean())
    other = float(((held.measured - held.turning) ** 2).sum(axis=1).mean())
    odds = ODDS * (other / max(mine * HANDICAP, 1e-12)) ** min(independent, WITNESSES)
    return float(1.0 / (1.0 + odds))


def _share(said: Array, fact: Array) -> float:
    """The multiple of `said` nearest to `fact`, both (k, 3), clipped to 0…1."""
    power = float((said * said).sum())
    return min(max(float((said * fact).sum()) / power, 0.0), 1.0) if power > 0.0 else 0.0


def _root_mean_square(errors: Array) -> float:
    return float(np.sqrt((errors * errors).sum(axis=1).mean()))


def mean_distance(errors: Array) -> float:
    """Mean distance of error vectors (k, 3); infinite for none."""
    return float(np.sqrt((errors * errors).sum(axis=1)).mean()) if len(errors) else float("inf")
