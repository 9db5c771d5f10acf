"""What a trained model says now: in plain floats, for a window is so small that arrays cost more than sums.

The same numbers as the arrays of `ridge` and `network` give (to 1e-12), four times sooner.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import copysign, hypot, isfinite, sqrt
from operator import mul
from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor.activation import Array, SParabola
from onboard.pilot.predictor.model import REACH, SQUEEZE, Model, ModelSettings
from onboard.pilot.predictor.prediction import SPEAKING, PredictorKind
from onboard.pilot.predictor.said import Numbers

Row = Sequence[float]


class Plain(NamedTuple):
    """A model in plain floats: see Model."""

    points: int
    ridge: list[list[list[float]]]  # (H, 3, L + 1)
    kinds: tuple[PredictorKind, ...]
    believed: list[float]
    sigma: list[float]
    turning: list[float]
    layers: list[list[list[float]]]  # by neuron: its weights, the bias first
    inputs: list[tuple[int, int, float, float]]  # axis, lag, middle and scale of each
    outputs: list[list[float]]  # (H, axes) [m a step] for one unit of output
    axes: tuple[int, ...]
    activation: SParabola


class Learnt(NamedTuple):
    """What a model says of one window by itself."""

    innovation: list[
        list[float]
    ]  # (H, 3) [m a step] in the heading frame, where ridge or network speak; else zero
    cos: float  # of the heading
    sin: float


class Answer(NamedTuple):
    """Mean velocities to the horizons."""

    velocities: list[list[float]]  # (H, 3) [m a step], game frame
    kinds: tuple[PredictorKind, ...]
    sigma: list[float]  # (H,) [m]


class Forecast(NamedTuple):
    """The same in arrays."""

    velocities: Array  # (H, 3) [m a step], game frame
    kinds: tuple[PredictorKind, ...]
    sigma: Array  # (H,) [m]


def plain(model: Model, settings: ModelSettings) -> Plain:
    """A model in plain floats."""
    places = [(axis, lag) for axis in model.axes for lag in model.lags]
    inputs = zip(places, model.middle.tolist(), model.scale.tolist(), strict=True)
    return Plain(
        model.points, model.coefficients.tolist(), model.kinds, model.believed.tolist(), model.sigma.tolist(),
        model.turning.tolist(), [layer.T.tolist() for layer in model.weights],
        [(axis, lag, middle, scale) for (axis, lag), middle, scale in inputs],
        (model.spread * model.shrink[:, None] / SQUEEZE).tolist(), model.axes, settings.activation,
    )  # fmt: skip


def forecast(
    model: Model,
    positions: Array,
    velocity: Array,
    settings: ModelSettings,
    trust: Numbers | None = None,
    turned: Array | None = None,
) -> Forecast:
    """Predict from the last positions (at least model.points, 3) and the velocity now (3,) [m a step].

    `trust` (H,) scales what was learnt: see Trust. `turned` (H, 2) are the places that a manoeuvre filter
    expects; without them the model speaks alone."""
    one, moving = plain(model, settings), velocity.tolist()
    said = answer(
        one, learnt(one, positions.tolist(), moving), positions[-1].tolist(), moving, settings.horizons,
        (trust, None if turned is None else turned.tolist()),
    )  # fmt: skip
    return Forecast(np.array(said.velocities), said.kinds, model.sigma)


def learnt(model: Plain, places: Sequence[Row], velocity: Row) -> Learnt:
    """What ridge and network say of the last places and the velocity now (units: `forecast`)."""
    moves, cos, sin = window(places[-model.points :], velocity)
    rows = ([*moves[0], 1.0], [*moves[1], 0.0], [*moves[2], 1.0])  # as `ridge.features`
    innovation = [
        [sum(map(mul, c, row)) for c, row in zip(axes, rows, strict=True)] if kind in SPEAKING else [0.0] * 3
        for kind, axes in zip(model.kinds, model.ridge, strict=True)
    ]
    if PredictorKind.NETWORK in model.kinds:
        said = iter(_by_network(model, moves))
        for kind, own, scales in zip(model.kinds, innovation, model.outputs, strict=True):
            for axis, scale in zip(model.axes, scales, strict=True):
                value = (next(said) - 0.5) * scale
                if kind is PredictorKind.NETWORK:
                    own[axis] += value
    return Learnt(innovation, cos, sin)


Beside = tuple[Numbers | None, Sequence[Row] | None]


def answer(
    model: Plain,
    said: Learnt,
    here: Row,
    velocity: Row,
    horizons: tuple[int, ...],
    beside: Beside = (None, None),
) -> Answer:
    """The forecast from `here` (3,) [m] of what was learnt; `beside`: `trust` and `turned` of `forecast`."""
    trust, turned = beside
    c, s = said.cos, said.sin
    shares = model.believed
    if trust is not None:
        shares = [believed * share for believed, share in zip(shares, trust, strict=True)]
    out = []
    for (x, y, z), share in zip(said.innovation, shares, strict=True):
        x, y = x * share, y * share
        out.append([c * x - s * y, c * y + s * x, z * share])
    v = velocity
    if turned and all(isfinite(x) and isfinite(y) for x, y in turned):
        n, e, _ = here
        for own, (x, y), h, w in zip(out, turned, horizons, model.turning, strict=True):
            own[0] += w * ((x - n) / h - v[0] - own[0])
            own[1] += w * ((y - e) / h - v[1] - own[1])
            own[2] -= w * own[2]
    velocities = [[v[0] + x, v[1] + y, v[2] + z] for x, y, z in out]
    return Answer(velocities, model.kinds, model.sigma)


def window(places: Sequence[Row], newest: Row) -> tuple[tuple[Row, Row, Row], float, float]:
    """Moves by axis, newest first, in the heading frame of places (oldest first; the first three numbers of
    each), with the heading's cosine and sine: `heading.windows` of one window."""
    back = pairwise(places[-2::-1])
    steps = [(newest[0], newest[1], newest[2]), *((p[0] - q[0], p[1] - q[1], p[2] - q[2]) for p, q in back)]
    north, east = places[-1][0] - places[0][0], places[-1][1] - places[0][1]
    size = hypot(north, east)
    c, s = (1.0, east) if size < 1e-9 else (north / size, east / size)
    forward = [c * n + s * e for n, e, _ in steps]
    right = [c * e - s * n for n, e, _ in steps]
    return (forward, right, [d for _, _, d in steps]), c, s


def _by_network(model: Plain, moves: tuple[Row, Row, Row]) -> list[float]:
    """Outputs for the window: `network.output` of one sample."""
    values = [
        min(max((moves[axis][lag] - middle) / scale, -REACH), REACH)
        for axis, lag, middle, scale in model.inputs
    ]
    double, beta = 2.0 * model.activation.p, model.activation.beta
    for layer in model.layers:
        values = [1.0, *values]
        sums = [sum(map(mul, column, values)) for column in layer]
        values = [copysign(sqrt(abs(double * s)), s) + beta for s in sums]
    return values
