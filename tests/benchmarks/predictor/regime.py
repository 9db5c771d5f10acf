"""The game's own regime, the load of a control step, memory, and the activation's cost."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable
from time import perf_counter, thread_time
from typing import NamedTuple

import numpy as np

from onboard.core.math.vectors import Vec, distance
from onboard.pilot.predictor import TrackPredictor, Trainer
from onboard.pilot.predictor.activation import SParabola
from tests.benchmarks.predictor.families import FAMILIES, Array, Conditions, geometric, trajectory

AHEAD = (0.2, 0.5, 1.0, 2.0, 4.0)  # [s]
SPEED, SIGMA, RATES, SECONDS, FROM = 50.0, 3.0, (10.0, 20.0), 60.0, 40.0
SEEDS = range(1000, 1004)
NOISE = (SIGMA**2, SIGMA**2, SIGMA**2, -1.0, -1.0, -1.0)


class Regime(NamedTuple):
    """Of one rate: geometric means over the families."""

    rate: float  # [Hz]
    steady: Array  # (A,) filtered constant velocity [m]
    mine: Array  # (A,) [m]
    ratio: Array  # (A,)
    worst_family: Array  # (A,) the largest ratio of a family
    calibration: Array  # (A,) root mean square error over root mean square stated error


def measured(family: str, seed: int, rate: float) -> tuple[list[Vec], Array]:
    """(samples of the sensor, true places (n, 3)) of a gusty flight at 50 m/s."""
    how = Conditions(gust=1.5)
    count = int(SECONDS * rate) + 1
    _, true = trajectory(family, how, seed, count, 1.0 / rate, SPEED)
    noise = np.random.default_rng([seed, 77]).normal(0.0, SIGMA, true.shape)
    return [Vec(*row) for row in (true + noise).tolist()], true


def follow(family: str, seed: int, rate: float) -> tuple[Array, Array, Array]:
    """Errors of constant velocity and of the predictor, and the stated error, each (instants, A)."""
    samples, true = measured(family, seed, rate)
    places = [Vec(*row) for row in true.tolist()]
    track, trainer = TrackPredictor(seed), Trainer()
    steady, mine, stated = [], [], []
    for k, sample in enumerate(samples):
        t = k / rate
        track.add(t, sample, None, NOISE)
        trainer.advance(t, {1: track}, round(20.0 / rate))
        if t < FROM or k + round(AHEAD[-1] * rate) >= len(places):
            continue
        truths = [places[k + round(ahead * rate)] for ahead in AHEAD]
        said = [track.predict(t + ahead) for ahead in AHEAD]
        plain = [track.filter.estimate(t + ahead) for ahead in AHEAD]
        mine.append([distance(p.position, x) for p, x in zip(said, truths, strict=True)])
        stated.append([p.sigma for p in said])
        steady.append([distance(p.position, x) for p, x in zip(plain, truths, strict=True)])
    return np.array(steady), np.array(mine), np.array(stated)


def regime(rate: float, say: Callable[[str], None]) -> Regime:
    """The comparison at one rate."""
    steady, mine, calibration = [], [], []
    for family in FAMILIES:
        say(f"{rate:g} Hz: {family}")
        runs = [follow(family, seed, rate) for seed in SEEDS]
        steady.append(np.mean([run[0].mean(axis=0) for run in runs], axis=0))
        mine.append(np.mean([run[1].mean(axis=0) for run in runs], axis=0))
        square = np.mean([(run[1] ** 2).mean(axis=0) for run in runs], axis=0)
        stated = np.mean([(run[2] ** 2).mean(axis=0) for run in runs], axis=0)
        calibration.append(np.sqrt(square / stated))
    ratio = np.array(mine) / np.array(steady)
    return Regime(
        rate,
        geometric(steady),
        geometric(mine),
        geometric(ratio),
        ratio.max(axis=0),
        geometric(calibration),
    )


class Load(NamedTuple):
    """What prediction costs an agent with six tracks at 20 Hz; CPU time of its thread."""

    step_median: float  # a control step: six samples, six predictions, training [s]
    step_worst: float
    training_median: float  # the training's part of a step [s]
    training_worst: float
    per_second: float  # CPU time a second of game [s]
    memory: float  # of one trained track [byte]


def load() -> Load:
    """Drive six tracks for a minute, as an agent does."""
    flights = [measured(family, 2000, 20.0)[0] for family in FAMILIES]
    tracks = {number: TrackPredictor(number) for number in range(len(flights))}
    trainer = Trainer()
    steps, trainings = [], []
    gc.collect()
    gc.freeze()  # as an agent does: no collection walks through what this process imported besides
    for k in range(len(flights[0])):
        t = k / 20.0
        begun = thread_time()
        for number, track in tracks.items():
            track.add(t, flights[number][k], None, NOISE)
            track.predict(t + 0.5)
        middle = thread_time()
        trainer.advance(t, tracks, 1)
        end = thread_time()
        steps.append(end - begun)
        trainings.append(end - middle)
    tracemalloc.start()
    track, alone = TrackPredictor(0), Trainer()
    for k, sample in enumerate(flights[0]):
        track.add(k / 20.0, sample, None, NOISE)
        alone.advance(k / 20.0, {1: track}, 1)
    memory = tracemalloc.get_traced_memory()[1]  # the peak, training included
    tracemalloc.stop()
    return Load(
        float(np.median(steps)),
        max(steps),
        float(np.median(trainings)),
        max(trainings),
        sum(steps) / SECONDS,
        float(memory),
    )


class Cost(NamedTuple):
    """Time an element [ns]."""

    numpy: dict[str, float]
    compiled: dict[str, float]


def activation() -> Cost:
    """The s-parabola against sigmoid and tanh, in NumPy and compiled by numba."""
    import numba

    f = SParabola()
    s = np.random.default_rng(0).normal(0.0, 2.0, 100_000)
    out = np.empty_like(s)

    @numba.njit  # type: ignore[untyped-decorator,unused-ignore]
    def parabola(x: Array, y: Array) -> None:
        for i in range(x.size):
            y[i] = np.copysign(np.sqrt(abs(0.5 * x[i])), x[i]) - 0.5

    @numba.njit  # type: ignore[untyped-decorator,unused-ignore]
    def sigmoid(x: Array, y: Array) -> None:
        for i in range(x.size):
            y[i] = 1.0 / (1.0 + np.exp(-x[i]))

    @numba.njit  # type: ignore[untyped-decorator,unused-ignore]
    def tanh(x: Array, y: Array) -> None:
        for i in range(x.size):
            y[i] = np.tanh(x[i])

    in_numpy: dict[str, Callable[[], object]] = {
        "s-parabola": lambda: f.value(s),
        "sigmoid": lambda: 1.0 / (1.0 + np.exp(-s)),
        "tanh": lambda: np.tanh(s),
    }
    compiled: dict[str, Callable[[], object]] = {
        "s-parabola": lambda: parabola(s, out),
        "sigmoid": lambda: sigmoid(s, out),
        "tanh": lambda: tanh(s, out),
    }
    return Cost(_fastest(in_numpy, s.size), _fastest(compiled, s.size))


def _fastest(kinds: dict[str, Callable[[], object]], size: int) -> dict[str, float]:
    """Least time an element [ns], the kinds taking turns."""
    best = dict.fromkeys(kinds, float("inf"))
    for _ in range(100):
        for name, call in kinds.items():
            begun = perf_counter()
            call()
            best[name] = min(best[name], (perf_counter() - begun) / size * 1e9)
    return best
