"""The comparison on the families: errors, times, few samples."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import NamedTuple

import numpy as np

from tests.benchmarks.predictor.families import CONDITIONS, FAMILIES, Array, geometric, trajectory
from tests.benchmarks.predictor.methods import ConstantVelocity, Flying, Method, Online, Paper
from tests.benchmarks.predictor.recurrent import Recurrent

SEEDS = range(1000, 1006)  # never used while the predictor was designed
PAPER_SEEDS = range(1000, 1001)  # the paper's training takes seconds a trajectory
FEW = (40, 60, 100)
LEARN, ORIGINS = 200, range(200, 280)

METHODS: dict[str, Callable[[], Method]] = {
    "constant velocity": ConstantVelocity,
    "paper's training": lambda: Paper(300),
    "ridge base": lambda: Flying(networks=False),
    "s-parabola": Flying,
    "s-parabola, online": Online,
    "LSTM 32": lambda: Recurrent("LSTM", (1, 5, 10, 20)),
    "GRU 32": lambda: Recurrent("GRU", (1, 5, 10, 20)),
}
HORIZONS = (1, 5, 10, 20)


class Trial(NamedTuple):
    """One method on one trajectory."""

    errors: Array  # (H,) mean distance to the true places [m]
    fit: float  # [s]
    predict: float  # [s] median of a prediction


class Study(NamedTuple):
    """Trials by condition, method and family."""

    trials: dict[str, dict[str, dict[str, list[Trial]]]]


def moves_of(positions: Array) -> Array:
    """Velocities (n, 3) [m a step]: last displacements."""
    return np.vstack([positions[1:2] - positions[:1], np.diff(positions, axis=0)])


def trial(method: Method, seen: Array, true: Array, samples: int, seed: int) -> Trial:
    """Learn from the last `samples` of the first 200, predict from the origins 200 to 279."""
    velocities = moves_of(seen)
    begun = perf_counter()
    method.fit(seen[LEARN - samples : LEARN], velocities[LEARN - samples : LEARN], seed)
    fitted = perf_counter() - begun
    errors, times = [], []
    for k in ORIGINS:
        begun = perf_counter()
        said = method.predict(seen[: k + 1], velocities[k])
        times.append(perf_counter() - begun)
        errors.append(np.linalg.norm(said - true[k + np.array(HORIZONS)], axis=1))
    return Trial(np.mean(errors, axis=0), fitted, float(np.median(times)))


def run(say: Callable[[str], None]) -> Study:
    """All methods on all families, conditions and seeds, interleaved."""
    trials: dict[str, dict[str, dict[str, list[Trial]]]] = {}
    for condition, how in CONDITIONS.items():
        trials[condition] = {name: {family: [] for family in FAMILIES} for name in METHODS}
        for family in FAMILIES:
            say(f"{condition}: {family}")
            for seed in SEEDS:
                seen, true = trajectory(family, how, seed)
                for name, make in METHODS.items():
                    if name != "paper's training" or seed in PAPER_SEEDS:
                        trials[condition][name][family].append(trial(make(), seen, true, LEARN, seed))
    return Study(trials)


def few(say: Callable[[str], None]) -> dict[int, dict[str, Array]]:
    """Ratios to constant velocity (H,) of the s-parabola predictor by number of samples and condition."""
    out: dict[int, dict[str, Array]] = {}
    for samples in FEW:
        out[samples] = {}
        for condition, how in CONDITIONS.items():
            say(f"{samples} samples: {condition}")
            ratios = []
            for family in FAMILIES:
                mine, steady = [], []
                for seed in SEEDS:
                    seen, true = trajectory(family, how, seed)
                    mine.append(trial(Flying(), seen, true, samples, seed).errors)
                    steady.append(trial(ConstantVelocity(), seen, true, samples, seed).errors)
                ratios.append(np.mean(mine, axis=0) / np.mean(steady, axis=0))
            out[samples][condition] = geometric(ratios)
    return out


def family_errors(study: Study, condition: str, method: str, seeds: int | None = None) -> Array:
    """(families, H) mean errors."""
    by_family = study.trials[condition][method].values()
    return np.array([np.mean([t.errors for t in trials[:seeds]], axis=0) for trials in by_family])


def ratio(study: Study, condition: str, method: str, to: str) -> Array:
    """(H,) geometric mean over the families of a method's error over another's, on the seeds both have."""
    common = min(len(next(iter(study.trials[condition][name].values()))) for name in (method, to))
    mine, other = (family_errors(study, condition, name, common) for name in (method, to))
    return geometric(mine / other)


def median_time(study: Study, method: str, what: str) -> float:
    """Median time of a fit or a prediction over all trials [s]."""
    every = [t for c in study.trials.values() for trials in c[method].values() for t in trials]
    return float(np.median([getattr(t, what) for t in every]))


def worst(study: Study, method: str, horizon: int) -> tuple[float, str]:
    """The largest ratio of a method's error to constant velocity's on any trajectory, and which."""
    index = HORIZONS.index(horizon)
    found = (0.0, "")
    for condition, methods in study.trials.items():
        for family in FAMILIES:
            pairs = zip(methods[method][family], methods["constant velocity"][family], strict=True)
            for number, (mine, steady) in enumerate(pairs):
                ratio = float(mine.errors[index] / steady.errors[index])
                found = max(found, (ratio, f"{condition}, {family}, seed {SEEDS[number]}"))
    return found
