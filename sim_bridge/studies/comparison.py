"""Predictors compared on one track: each predicts ahead as the track arrives, and its errors are told."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import NamedTuple

import msgspec
import numpy as np

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import ZERO, Vec, along, distance
from onboard.pilot.predictor import PredictorKind, TrackPredictor, Trainer
from onboard.pilot.predictor.paper import PaperNetwork, PaperSettings
from onboard.runtime.progress import Tell, over, silent
from sim_bridge.studies.paper_example import STEP
from sim_bridge.studies.tracks import Array, Recording

HORIZONS = (0.2, 0.5, 1.0, 2.0, 4.0)  # [s]
ONE_S = HORIZONS.index(1.0)
LAST, STEADY = "last known", "constant velocity (filtered)"
FLYING, PAPER = "ridge + s-parabola", "paper's network"


class Row(msgspec.Struct, frozen=True):
    """Errors of one predictor on one track."""

    predictor: str
    mean_error: tuple[float, ...]  # by horizon [m]
    stated: tuple[float, ...]  # root mean square of the stated error [m]; 0: none stated
    worst: tuple[float, ...]  # [m]


class Comparison(msgspec.Struct, frozen=True):
    """Errors of all predictors on one track, as `sim-bridge predict` prints them."""

    track: str
    simulated: bool
    samples: int
    horizons: tuple[float, ...]  # [s]
    instants: int  # at which all predicted
    rows: tuple[Row, ...]
    spoke: dict[str, int]  # how often each part of it spoke, 1 s ahead


class Drawn(NamedTuple):
    """A comparison with what its figure needs."""

    comparison: Comparison
    recording: Recording
    paths: dict[str, Array]  # predicted places 1 s ahead (instants, 3)


class Instant(NamedTuple):
    """What all predictors said at one instant, by horizon."""

    places: dict[str, list[Vec]]  # predicted [m; NED]
    sigmas: dict[str, list[float]]  # stated error [m], of those that state one
    source: PredictorKind  # what spoke for the s-parabola predictor 1 s ahead


def compare(recording: Recording, seed: int = 1, paper: bool = True, tell: Tell = silent) -> Drawn:
    """Let every predictor follow the track as it arrives and predict from the second half on.

    `paper` False leaves out the paper's network; `seed` is that of all networks' training.
    Raises ConfigError for a track that is too short.
    """
    track, trainer = TrackPredictor(seed), Trainer()
    samples = sorted(recording.samples, key=lambda s: s.arrival)
    if len(samples) < 20:
        raise ConfigError(f"{recording.name}: found {len(samples)} samples, expected at least 20")
    half = 0.5 * (samples[0].arrival + samples[-1].arrival)
    last = recording.truth_t[-1]
    networks: list[PaperNetwork] = []
    at: list[float] = []
    said: list[Instant] = []
    for sample in over(samples, tell, f"following {recording.name}"):
        track.add(sample.t, sample.position, sample.velocity, sample.variance)
        now = sample.arrival
        trainer.advance(now, {1: track}, 2)
        if now < half or track.filter.empty or now + HORIZONS[-1] > last:
            continue
        if paper and not networks:
            networks = _paper(track, seed)
        at.append(now)
        said.append(_predict(track, networks if paper else None, now))
    if not at:
        raise ConfigError(f"{recording.name}: the track is too short to predict {HORIZONS[-1]:g} s ahead")
    truths = [[_truth(recording, now + ahead) for ahead in HORIZONS] for now in at]
    misses = {
        name: np.array([
            [distance(*pair) for pair in zip(one.places[name], truth, strict=True)]
            for one, truth in zip(said, truths, strict=True)
        ])
        for name in said[0].places
    }  # fmt: skip
    stated = {name: _rms(np.array([one.sigmas[name] for one in said])) for name in said[0].sigmas}
    none = (0.0,) * len(HORIZONS)
    rows = tuple(
        Row(name, tuple(m.mean(axis=0).tolist()), stated.get(name, none), tuple(m.max(axis=0).tolist()))
        for name, m in misses.items()
    )
    spoke = Counter(one.source for one in said)
    comparison = Comparison(
        recording.name, recording.simulated, len(samples), HORIZONS, len(at), rows,
        {kind.name.lower(): spoke[kind] for kind in PredictorKind if spoke[kind]},
    )  # fmt: skip
    paths = {name: np.array([one.places[name][ONE_S] for one in said]) for name in misses}
    return Drawn(comparison, recording, paths)


def _predict(track: TrackPredictor, networks: list[PaperNetwork] | None, now: float) -> Instant:
    """Every predictor's word at `now`; networks None: the paper's is left out, empty: not trained yet."""
    newest = track.filter.estimate(track.filter.newest)
    steady = [track.filter.estimate(now + ahead) for ahead in HORIZONS]
    flying = [track.predict(now + ahead) for ahead in HORIZONS]
    places = {
        LAST: [newest.position] * len(HORIZONS),
        STEADY: [one.position for one in steady],
        FLYING: [one.position for one in flying],
    }
    if networks is not None:
        rolled = _rolled(track, networks, now + HORIZONS[-1]) if networks else []
        places[PAPER] = [
            _on(rolled, now + ahead, one.position) for ahead, one in zip(HORIZONS, steady, strict=True)
        ]
    sigmas = {STEADY: [one.sigma for one in steady], FLYING: [one.sigma for one in flying]}
    return Instant(places, sigmas, flying[ONE_S].source)


def table(comparison: Comparison) -> str:
    """A comparison as lines for people."""
    of = "the true places" if comparison.simulated else "the places measured later (noise included)"
    lines = [
        f"{comparison.track}: {comparison.samples} samples, {comparison.instants} predictions; "
        f"mean distance [m] from {of}, and the stated error",
        f"{'ahead':30}" + "".join(f"{h:>15g} s" for h in comparison.horizons),
    ]
    for row in comparison.rows:
        cells = [
            f"{error:9.2f}" + (f" ±{sure:6.2f}" if sure else " " * 8)
            for error, sure in zip(row.mean_error, row.stated, strict=True)
        ]
        lines.append(f"{row.predictor:30}" + "".join(cells))
    spoke = ", ".join(f"{kind.replace('_', ' ')} {count}" for kind, count in comparison.spoke.items())
    lines.append(f"who spoke for ridge + s-parabola 1 s ahead: {spoke}")
    return "\n".join(lines)


def _truth(recording: Recording, t: float) -> Vec:
    places = [float(np.interp(t, recording.truth_t, recording.truth[:, axis])) for axis in range(3)]
    return Vec(places[0], places[1], places[2])


def _paper(track: TrackPredictor, seed: int) -> list[PaperNetwork]:
    """The paper's networks, one a coordinate, trained on the grid so far."""
    positions, _ = track.grid.arrays()
    if len(positions) < 20:
        return []
    networks = []
    for axis in range(3):
        network = PaperNetwork(np.random.default_rng([seed, axis]), PaperSettings(epochs=100))
        network.fit(positions[:, axis])
        networks.append(network)
    return networks


def _rolled(track: TrackPredictor, networks: list[PaperNetwork], until: float) -> list[tuple[float, Vec]]:
    """The paper's networks rolled on from the newest sample."""
    newest = track.filter.newest
    places = track.grid.window(track.filter, 6)
    if places is None:
        return []
    window = np.array(places)
    steps = int((until - newest) / STEP) + 2
    with np.errstate(over="ignore", invalid="ignore"):
        columns = [network.roll(window[:, axis], steps) for axis, network in enumerate(networks)]
    path = [(newest, Vec(*window[-1].tolist()))]
    for k in range(steps):
        path.append((newest + (k + 1) * STEP, Vec(*(float(column[k]) for column in columns))))
    return path


def _on(path: list[tuple[float, Vec]], t: float, otherwise: Vec) -> Vec:
    """The place at `t` on a polygon of (instant, place)."""
    for (a, here), (b, there) in pairwise(path):
        if a <= t <= b:
            u = (t - a) / (b - a)
            return along(along(ZERO, here, 1.0 - u), there, u)
    return otherwise


def _rms(values: Array) -> tuple[float, ...]:
    return tuple(np.sqrt((values * values).mean(axis=0)).tolist())
