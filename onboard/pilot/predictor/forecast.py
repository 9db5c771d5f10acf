"""What a trained model says now: in plain floats, for a window is so small that arrays cost more than sums.

The same numbers as the arrays of `ridge` and `network` give (to 1e-12), four times sooner.
"""

from __future__ import annotations

from math import copysign, hypot, isfinite, sqrt
from operator import mul
from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor.activation import Array, SParabola
from onboard.pilot.predictor.model import REACH, SQUEEZE, Model, ModelSettings
from onboard.pilot.predictor.network import Weights
from onboard.pilot.predictor.prediction import PredictorKind

Row = list[float]
SPEAKING = (PredictorKind.RIDGE, PredictorKind.NETWORK)


class Learnt(NamedTuple):
    """What a model says of one window by itself."""

    innovation: list[Row]  # (H, 3) [m a step] in the heading frame, where ridge or network speak; else zero
    cos: float  # of the heading
    sin: float


class Forecast(NamedTuple):
    """Mean velocities to the horizons."""

    velocities: Array  # (H, 3) [m a step], game frame
    kinds: tuple[PredictorKind, ...]
    sigma: Array  # (H,) [m]


def forecast(
    model: Model,
    positions: Array,
    velocity: Array,
    settings: ModelSettings,
    trust: Array | None = None,
    turned: Array | None = None,
) -> Forecast:
    """Predict from the last positions (at least model.points, 3) and the velocity now (3,) [m a step].

    `trust` (H,) scales what was learnt: see Trust. `turned` (H, 2) are the places that a manoeuvre filter
    expects; without them the model speaks alone."""
    return answer(
        model, learnt(model, positions, velocity, settings), positions[-1], velocity, settings,
        (trust, turned),
    )  # fmt: skip


def learnt(model: Model, positions: Array, velocity: Array, settings: ModelSettings) -> Learnt:
    """What ridge and network say of the last positions and the velocity now (units: `forecast`)."""
    moves, cos, sin = _window(positions[-model.points :].tolist(), velocity.tolist())
    rows = ([*moves[0], 1.0], [*moves[1], 0.0], [*moves[2], 1.0])  # as `ridge.features`
    innovation = [
        [sum(map(mul, c, row)) for c, row in zip(axes, rows, strict=True)] if kind in SPEAKING else [0.0] * 3
        for kind, axes in zip(model.kinds, model.coefficients.tolist(), strict=True)
    ]
    if PredictorKind.NETWORK in model.kinds:
        said = _by_network(model, moves, settings.activation)
        for i, kind in enumerate(model.kinds):
            if kind is PredictorKind.NETWORK:
                for axis, value in zip(model.axes, said[i], strict=True):
                    innovation[i][axis] += value
    return Learnt(innovation, cos, sin)


def answer(
    model: Model,
    said: Learnt,
    here: Array,
    velocity: Array,
    settings: ModelSettings,
    beside: tuple[Array | None, Array | None] = (None, None),
) -> Forecast:
    """The forecast from `here` (3,) [m] of what was learnt; `beside`: `trust` and `turned` of `forecast`."""
    trust, turned = beside
    shares = (model.believed if trust is None else model.believed * trust).tolist()
    c, s = said.cos, said.sin
    v = velocity.tolist()
    out = []
    for (x, y, z), share in zip(said.innovation, shares, strict=True):
        x, y = x * share, y * share
        out.append([c * x - s * y, c * y + s * x, z * share])
    places = [] if turned is None else turned.tolist()
    if places and all(isfinite(x) and isfinite(y) for x, y in places):
        n, e, _ = here.tolist()
        for own, (x, y), h, w in zip(out, places, settings.horizons, model.turning.tolist(), strict=True):
            own[0] += w * ((x - n) / h - v[0] - own[0])
            own[1] += w * ((y - e) / h - v[1] - own[1])
            own[2] -= w * own[2]
    velocities = np.array([[v[0] + x, v[1] + y, v[2] + z] for x, y, z in out])
    return Forecast(velocities, model.kinds, model.sigma)


def _window(places: list[Row], newest: Row) -> tuple[tuple[Row, Row, Row], float, float]:
    """Moves by axis, newest first, in the heading frame of places (oldest first), with the heading's cosine
    and sine: `heading.windows` of one window."""
    pairs = zip(places[-2:0:-1], places[-3::-1], strict=True)
    steps = [newest, *([p[0] - q[0], p[1] - q[1], p[2] - q[2]] for p, q in pairs)]
    north, east = places[-1][0] - places[0][0], places[-1][1] - places[0][1]
    size = hypot(north, east)
    c, s = (1.0, east) if size < 1e-9 else (north / size, east / size)
    forward = [c * n + s * e for n, e, _ in steps]
    right = [c * e - s * n for n, e, _ in steps]
    return (forward, right, [d for _, _, d in steps]), c, s


def _by_network(model: Model, moves: tuple[Row, Row, Row], act: SParabola) -> list[Row]:
    """What the network adds (H, axes) [m a step], as far as it is believed."""
    raw = [moves[axis][lag] for axis in model.axes for lag in model.lags]
    scaled = [
        min(max((x - middle) / scale, -REACH), REACH)
        for x, middle, scale in zip(raw, model.middle.tolist(), model.scale.tolist(), strict=True)
    ]
    flat = iter(_output(act, model.weights, scaled))
    return [
        [(next(flat) - 0.5) / SQUEEZE * spread * shrink for spread in spreads]
        for spreads, shrink in zip(model.spread.tolist(), model.shrink.tolist(), strict=True)
    ]


def _output(act: SParabola, weights: Weights, inputs: Row) -> Row:
    """Outputs for inputs without the leading 1: `network.output` of one sample."""
    values = inputs
    for layer in weights:
        values = [1.0, *values]
        values = [
            copysign(sqrt(abs(2.0 * act.p * s)), s) + act.beta
            for s in (sum(map(mul, column, values)) for column in layer.T.tolist())
        ]
    return values
