"""The example of 3.5.2: the paper's network predicts the next point of a smooth plane trajectory."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import msgspec
import numpy as np

from onboard.pilot.predictor.paper import PaperNetwork, PaperSettings
from onboard.runtime.clock import RealClock
from onboard.runtime.progress import Tell, part, silent
from sim_bridge.studies.tracks import Array

STEP = 0.2  # of the paper's series [s]
FIGURE4_POINTS = 300
FIGURE4_TRAINED = 200  # the first of them: the training set


class Example(msgspec.Struct, frozen=True):
    """The example of 3.5.2: one network a coordinate."""

    coordinate: str
    error_training: float  # mean |error| on the training set [m]
    error_test: float  # mean |error| on the test set [m]
    error_steady: float  # the same of the last displacement carried on (constant velocity) [m]
    epochs: int
    time: float  # of the training [s]


class Figure4(NamedTuple):
    """The example with its series."""

    results: tuple[Example, Example]
    truth: Array  # (n, 2)
    predicted: Array  # (n, 2); the first five are NaN


def example(seed: int = 3, epochs: int = 1000, printed: bool = False, tell: Tell = silent) -> Figure4:
    """Predict the next point of a smooth plane trajectory, a network for x and one for y (3.5.2)."""
    clock = RealClock()
    t = STEP * np.arange(FIGURE4_POINTS)
    truth = np.stack(
        [7.0 * t + 25.0 * np.sin(t / 7.0), 60.0 * np.sin(t / 9.0) + 20.0 * np.cos(t / 4.0)], axis=1
    )
    settings = PaperSettings(epochs=epochs, printed_inverse=printed)
    n = settings.inputs
    predicted = np.full_like(truth, np.nan)
    results = []
    for column, name in enumerate("xy"):
        series = truth[:, column]
        network = PaperNetwork(np.random.default_rng([seed, column]), settings)
        begun = clock.monotonic_ns()
        done = network.fit(series[:FIGURE4_TRAINED], _after(part(tell, column, 2), epochs, name))
        spent = (clock.monotonic_ns() - begun) * 1e-9
        with np.errstate(over="ignore", invalid="ignore"):
            for k in range(n, len(series)):
                predicted[k, column] = network.next(series[k - n : k])
        misses = np.abs(predicted[:, column] - series)
        trained, test = misses[n:FIGURE4_TRAINED], misses[FIGURE4_TRAINED:]
        steady = np.abs(np.diff(series, n=2)[FIGURE4_TRAINED - 2 :])
        errors = (float(trained.mean()), float(test.mean()), float(steady.mean()))
        results.append(Example(name, *errors, len(done), spent))
    return Figure4((results[0], results[1]), truth, predicted)


def _after(tell: Tell, epochs: int, name: str) -> Callable[[int], None]:
    return lambda epoch: tell(epoch / epochs, f"example of 3.5.2: training for {name}")


def example_table(figure: Figure4) -> str:
    """The example of 3.5.2 for people."""
    lines = ["Example of 3.5.2: the next of a trajectory's points from the last five, a network a coordinate"]
    for one in figure.results:
        lines.append(
            f"  {one.coordinate}: mean error {one.error_training:.3f} m on the training set, "
            f"{one.error_test:.3f} m on the test set; {one.epochs} epochs in {one.time:.2f} s"
        )
    better = " and ".join(f"{one.error_steady:.3f} m in {one.coordinate}" for one in figure.results)
    lines.append(f"  constant velocity, which learns nothing, errs by {better} on the test set")
    return "\n".join(lines)
