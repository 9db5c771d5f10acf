"""The predictor that flies: a ridge base and an s-parabola network over it, chosen by held-out error.

Positions on a regular grid in, mean velocities to several horizons out, each horizon predicted
directly. The target is the innovation: the mean velocity to the horizon minus the constant
velocity now, in the heading frame. The ladder: below 8 points constant velocity; up to 30 a small
network over constant velocity; from then on the ridge with the network over its rest. Every
horizon keeps constant velocity unless the last 30 % of the points, held out, say that the model is
better by a margin. A manoeuvre filter beside it (constant velocity and coordinated turn) has the share in
each horizon that the same points give it.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from onboard.pilot.predictor import network, ridge
from onboard.pilot.predictor.activation import Array, SParabola
from onboard.pilot.predictor.choice import Held, judge, mean_distance, verdicts
from onboard.pilot.predictor.heading import Indices, Windows, turn, windows
from onboard.pilot.predictor.prediction import PredictorKind

Known = npt.NDArray[np.bool_]


class ModelSettings(NamedTuple):
    """Settings of the predictor that flies."""

    horizons: tuple[int, ...] = (1, 2, 5, 10, 20)  # [steps]
    points: int = 20  # of a window
    ladder: tuple[int, int] = (8, 30)  # from here the network over constant velocity; from here the ridge
    penalties: tuple[float, ...] = (3e-3, 1e-6, 1e-4, 3e-2)  # of the ridge; the first is preferred
    preference: float = 0.9  # another penalty must bring the held-out error below this share
    held_out: float = 0.3  # share of the points, the newest
    margin: float = 0.03  # by which a model must beat constant velocity
    activation: SParabola = SParabola()
    neurons: int = 5
    lags: int = 6  # moves of a window that the network sees
    epsilon: float = 0.05  # smoothing of the slope at 0 in training
    decay: float = 0.1  # pull of the weights towards zero
    iterations: int = 8  # of Levenberg–Marquardt before the choice
    finishing: int = 3  # and after it, on all points
    networks: bool = True  # off: no network over the ridge
    manoeuvres: bool = True  # off: no manoeuvre filter beside them


class Model(NamedTuple):
    """What training came to: frozen, used by `forecast.forecast`."""

    points: int  # of a window
    coefficients: Array  # (H, 3, L + 1) of the ridge; zeros on the lower ladder
    kinds: tuple[PredictorKind, ...]  # (H,) who speaks at each horizon
    penalty: tuple[int, ...]  # (H,) index of the chosen penalty
    shrink: Array  # (H,) share of the network's answer that is believed, 0…1
    believed: Array  # (H,) share of the whole innovation that is believed, 0…1
    weights: network.Weights
    lags: tuple[int, ...]
    axes: tuple[int, ...]  # the network's axes: forward, right and, in space, down
    middle: Array  # (inputs,) subtracted from the network's inputs
    scale: Array  # (inputs,) and divided by
    spread: Array  # (H, axes) scale of the network's outputs [m a step]
    sigma: Array  # (H,) root mean square distance error, held out [m]; NaN where nothing was held out
    turning: Array  # (H,) share of the manoeuvre filter in the answer, 0…1


class Heard(NamedTuple):
    """What a manoeuvre filter expected at each grid point, and what came."""

    places: Array  # (n, H, 2) expected at the horizons [m]; NaN: it was silent
    measured: Array  # (n, 3) as the sensor says [m]: noisy, but with no lag of a filter


SQUEEZE = 0.15  # outputs have this standard deviation about 0.5: on the upper branch, as in 3.5.2
REACH = 2.5  # inputs are clipped to this many standard deviations: no answer far from what was seen


def fit(
    positions: Array,
    velocities: Array,
    settings: ModelSettings,
    rng: np.random.Generator,
    heard: Heard | None = None,
) -> Generator[None, None, Model | None]:
    """Train on a grid: positions (n, 3) [m], velocities (n, 3) [m a step], and what was heard of a manoeuvre
    filter (None: it is not asked).

    Yields after each slice of about 1 ms; returns None where there are too few points."""
    total = len(positions)
    if total < settings.ladder[0]:
        return None
    horizons = np.array(settings.horizons)
    points = min(settings.points, max(4, total // 5))
    origins = np.arange(points - 1, total)
    view = windows(positions, velocities, origins, points)
    wanted, known = _targets(positions, view, origins, horizons)
    rows = ridge.features(view.moves)
    cut = total - max(2, round(settings.held_out * total))  # index of the first point held out
    early = [max(0, int(cut - h - origins[0])) for h in horizons]  # rows whose target lies before the cut
    late = [slice(max(0, int(cut - origins[0])), max(0, int(total - h - origins[0]))) for h in horizons]
    yield

    linear = total >= settings.ladder[1]
    enough = [linear and count >= points for count in early]
    chosen, base = _base(rows, wanted, early, late, enough, settings)
    yield

    net = _prepare(view, wanted - base, early, horizons, settings)
    data = _batch(net, wanted - base, known, early)
    act = settings.activation
    weights = network.start(act, data, settings.neurons, rng, settings.epsilon, 1e-3)
    yield
    if settings.networks:
        weights = yield from network.train(
            act, weights, data, settings.iterations, settings.epsilon, settings.decay
        )
    answer = _answer(act, weights, net, len(horizons)) * settings.networks
    turn_on, came = _turning(heard if settings.manoeuvres else None, positions, view, origins, horizons)
    held = [Held(wanted[part, i], base[part, i], answer[part, i], turn_on[part, i], came[part, i])
            for i, part in enumerate(late)]
    verdict = verdicts([judge(held[i], int(h), enough[i], settings.margin) for i, h in enumerate(horizons)])
    yield

    every = [max(0, int(total - h - origins[0])) for h in horizons]
    coefficients = _final(rows, wanted, every, enough, chosen, settings)
    base = ridge.predict(coefficients, rows)
    if PredictorKind.NETWORK in verdict.kinds:
        yield
        data = _batch(net, wanted - base, known, every)
        weights = yield from network.train(
            act, weights, data, settings.finishing, settings.epsilon, settings.decay
        )
    return Model(
        points, coefficients, verdict.kinds, chosen, verdict.shrink, verdict.believed, weights, net.lags,
        net.axes, net.middle, net.scale, net.spread, verdict.sigma, verdict.turning,
    )  # fmt: skip


def refresh(positions: Array, velocities: Array, model: Model, settings: ModelSettings) -> Model:
    """The model with its ridge fitted anew to a grid; choice and network stay."""
    total = len(positions)
    if total < max(settings.ladder[1], 2 * model.points) or not model.coefficients.any():
        return model
    _, rows, wanted = lessons(positions, velocities, model.points, settings)
    counts = [max(0, total - h - model.points + 1) for h in settings.horizons]
    enough = [bool(model.coefficients[i].any()) and count >= model.points for i, count in enumerate(counts)]
    fresh = _final(rows, wanted, counts, enough, model.penalty, settings)
    return model._replace(coefficients=fresh)


def lessons(
    positions: Array, velocities: Array, points: int, settings: ModelSettings
) -> tuple[Windows, Array, Array]:
    """All windows of a grid, their features (3, k, F) and innovations (k, H, 3), zero where not known yet."""
    origins = np.arange(points - 1, len(positions))
    view = windows(positions, velocities, origins, points)
    wanted, _ = _targets(positions, view, origins, np.array(settings.horizons))
    return view, ridge.features(view.moves), wanted


class _Net(NamedTuple):
    """The network's view of the windows."""

    inputs: Array  # (k, n) scaled
    mirrored: Array  # (k, n) of the mirrored copies
    lags: tuple[int, ...]
    axes: tuple[int, ...]
    middle: Array
    scale: Array
    spread: Array  # (H, axes)


def _targets(positions: Array, view: Windows, origins: Indices, horizons: Indices) -> tuple[Array, Known]:
    """Innovations (k, H, 3) [m a step] in the heading frames, and which are known (k, H)."""
    ahead = origins[:, None] + horizons  # (k, H)
    known = ahead < len(positions)
    ends = positions[np.minimum(ahead, len(positions) - 1)]
    mean = (ends - positions[origins][:, None]) / horizons[None, :, None]
    out = turn(mean, view.cos, view.sin) - view.moves[:, :1]
    return np.where(known[..., None], out, 0.0), known


def _turning(
    heard: Heard | None, positions: Array, view: Windows, origins: Indices, horizons: Indices
) -> tuple[Array, Array]:
    """Innovations (k, H, 3) [m a step] in the heading frames: those that the manoeuvre filter expected (NaN:
    it was silent), and those that the sensor measured."""
    shape = (len(origins), len(horizons), 3)
    if heard is None:
        return np.full(shape, np.nan), np.zeros(shape)
    here, steps = positions[origins][:, None], horizons[None, :, None]
    mean = np.zeros(shape)
    mean[..., :2] = (heard.places[origins] - here[..., :2]) / steps
    expected = turn(mean, view.cos, view.sin) - view.moves[:, :1]
    expected[..., 2] = np.where(np.isnan(expected[..., 0]), np.nan, 0.0)
    ends = heard.measured[np.minimum(origins[:, None] + horizons, len(positions) - 1)]
    return expected, turn((ends - here) / steps, view.cos, view.sin) - view.moves[:, :1]


def _base(
    rows: Array,
    wanted: Array,
    early: list[int],
    late: list[slice],
    enough: list[bool],
    settings: ModelSettings,
) -> tuple[tuple[int, ...], Array]:
    """The penalty chosen for each horizon, and the ridge's answers (k, H, 3) learnt before the cut."""
    base = np.zeros_like(wanted)
    chosen = (0,) * len(early)
    if not any(enough):
        return chosen, base
    tried = ridge.fit(rows, wanted, early, settings.penalties)
    answers = [ridge.predict(coefficients, rows) for coefficients in tried]
    score = np.zeros(len(tried))
    count = 0
    for i in range(len(early)):
        if enough[i]:
            errors = [mean_distance(wanted[late[i], i] - answer[late[i], i]) for answer in answers]
            if np.isfinite(errors[0]):
                score += np.log(np.array(errors) + 1e-9)
                count += 1
    best = int(np.argmin(score))
    if count and score[best] - score[0] < count * np.log(settings.preference):
        chosen = (best,) * len(early)
    for i in range(len(early)):
        if enough[i]:
            base[:, i] = answers[chosen[i]][:, i]
    return chosen, base


def _final(
    rows: Array,
    wanted: Array,
    counts: list[int],
    enough: list[bool],
    chosen: tuple[int, ...],
    settings: ModelSettings,
) -> Array:
    """Coefficients (H, 3, F) learnt from all points."""
    out = np.zeros((len(counts), 3, rows.shape[2]))
    for penalty in set(chosen):
        which = [i for i in range(len(counts)) if enough[i] and chosen[i] == penalty]
        if which:
            out[which] = ridge.fit(
                rows, wanted[:, which], [counts[i] for i in which], (settings.penalties[penalty],)
            )[0]
    return out


def _inputs(moves: Array, lags: tuple[int, ...], axes: tuple[int, ...]) -> Array:
    """(k, axes · lags): the chosen moves, axis by axis."""
    out: Array = moves[:, lags][:, :, axes].transpose(0, 2, 1).reshape(len(moves), -1)
    return out


def _prepare(
    view: Windows, rest: Array, early: list[int], horizons: Indices, settings: ModelSettings
) -> _Net:
    """Inputs and scales of the network, from the rows before the cut."""
    moves = view.moves
    length = moves.shape[1]
    lags = tuple(sorted({round(i * (length - 1) / (settings.lags - 1)) for i in range(settings.lags)}))
    power = np.abs(moves).mean(axis=(0, 1))
    axes = (0, 1, 2) if power[2] > 1e-6 * power.max() + 1e-12 else (0, 1)
    first = max(1, max(early))
    raw = _inputs(moves, lags, axes)
    side = np.repeat([axis == 1 for axis in axes], len(lags))
    middle = np.where(side, 0.0, raw[:first].mean(axis=0))
    centred = raw - middle
    scale = np.sqrt((centred[:first] ** 2).mean(axis=0))
    scale = np.where(scale < 1e-6 * (power.max() + 1e-9), 1.0, scale)
    spread = np.ones((len(horizons), len(axes)))
    for i, count in enumerate(early):
        if count > 0:
            spread[i] = np.sqrt((rest[:count, i][:, axes] ** 2).mean(axis=0))
    spread = np.where(spread < 1e-9, 1e-9, spread)
    inputs = np.clip(centred / scale, -REACH, REACH)
    return _Net(inputs, np.where(side, -inputs, inputs), lags, axes, middle, scale, spread)


def _batch(net: _Net, rest: Array, known: Known, counts: list[int]) -> network.Batch:
    """Windows and their mirrored copies, with the targets that may be learnt from."""
    first = max(1, max(counts))
    scaled = rest[:first][:, :, net.axes] / net.spread  # (k, H, axes)
    mask = known[:first] & (np.arange(first)[:, None] < np.array(counts))
    masks = np.repeat(mask[:, :, None], len(net.axes), axis=2).reshape(first, -1).astype(np.float64)
    mirror = np.where(np.array(net.axes) == 1, -1.0, 1.0)
    both = np.concatenate([scaled, scaled * mirror]).reshape(2 * first, -1)
    return network.batch(
        np.concatenate([net.inputs[:first], net.mirrored[:first]]),
        0.5 + SQUEEZE * np.clip(both, -6.0, 6.0),
        np.concatenate([masks, masks]),
    )


def _answer(act: SParabola, weights: network.Weights, net: _Net, count: int) -> Array:
    """The network's answers (k, H, 3) [m a step]."""
    ones = np.ones((len(net.inputs), 1))
    raw = network.output(act, weights, np.hstack([ones, net.inputs]))
    out = np.zeros((len(raw), count, 3))
    out[:, :, net.axes] = (raw.reshape(len(raw), count, -1) - 0.5) / SQUEEZE * net.spread
    return out
