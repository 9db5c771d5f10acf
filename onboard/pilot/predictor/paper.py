"""The paper's two-layer network and its training, step by step: section 3.5.1, (25)–(29).

Corrections of the print: the branch of the inverse in (27)–(28) follows from the sign of the
target, y_g − β (the printed rule, the sign of the current s, stays behind a switch: it mirrors
targets to the wrong branch and diverges); (28) means s_i, (29) means δ_(i,in).
The inputs are positions relative to the newest one, the targets are scaled into [0.2, 0.8]; both
can be switched off.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor.activation import Array, SParabola


class PaperSettings(NamedTuple):
    """Settings of the paper's training; what the paper leaves open is chosen here."""

    inputs: int = 5  # n
    neurons: int = 5  # m
    activation: SParabola = SParabola()
    eta: float = 0.3  # η at the start, falling linearly by epoch to 1/epochs of it
    epochs: int = 1000
    stop: float = 0.002  # mean |δ_out| of an epoch that ends the training, in scaled units
    printed_inverse: bool = False  # (27)–(28) as printed
    relative: bool = True  # inputs relative to the newest point, targets scaled into [0.2, 0.8]


class Epoch(NamedTuple):
    """What an epoch came to."""

    error: float  # mean |δ_out|
    eta: float


class PaperNetwork:
    """Predicts the next element of one coordinate's series from the last n."""

    def __init__(self, rng: np.random.Generator, settings: PaperSettings | None = None) -> None:
        self.settings = PaperSettings() if settings is None else settings
        n, m = self.settings.inputs, self.settings.neurons
        self.first = rng.uniform(-0.5, 0.5, (n + 1, m))  # w¹: row 0 holds the biases w_0j
        self.second = rng.uniform(-0.5, 0.5, m + 1)  # w²: element 0 is the bias w_01
        self.input_scale = 1.0
        self.target_middle = 0.0
        self.target_scale = 1.0

    def output(self, x: Array) -> float:
        """(25)–(26) for one input, shape (n,), in scaled units."""
        f = self.settings.activation.value
        hidden = f(self.first[0] + x @ self.first[1:])
        return float(f(np.asarray(self.second[0] + hidden @ self.second[1:])))

    def step(self, x: Array, wanted: float, eta: float) -> float:
        """Steps 2–4 for one sample; returns |δ_out| before the correction."""
        act, first, second = self.settings.activation, self.first, self.second
        s1 = first[0] + x @ first[1:]  # (m,)
        y1 = act.value(s1)
        s2 = np.asarray(second[0] + y1 @ second[1:])
        out = float(act.value(s2))
        target = np.asarray(wanted)
        if self.settings.printed_inverse:
            delta2 = float(act.inverse_printed(target, s2) - s2)  # (27)
        else:
            delta2 = float(act.inverse(target) - s2)
        k2 = float(np.abs(second).sum()) + 1e-12
        given = y1 + delta2 * second[1:] / k2  # y_ig = y_i + δ_iout
        s_given = act.inverse_printed(given, s1) if self.settings.printed_inverse else act.inverse(given)
        delta1 = s_given - s1  # (28)
        k1 = np.abs(first).sum(axis=0) + 1e-12  # (m,)
        move = eta * delta1 / k1  # (29)
        first[0] += move
        first[1:] += x[:, None] * move
        second[1:] += eta * delta2 / k2 * y1
        second[0] += eta * delta2 / k2
        return abs(wanted - out)

    def fit(self, series: Array, after: Callable[[int], None] = lambda epoch: None) -> list[Epoch]:
        """Train on a series, shape (samples,); returns the epochs, the last with error NaN if it diverged.

        `after` is called with the number of epochs that are done.
        """
        inputs, targets = self._scaled(np.asarray(series, dtype=np.float64))
        epochs: list[Epoch] = []
        with np.errstate(over="ignore", invalid="ignore"):
            for k in range(self.settings.epochs):
                eta = self.settings.eta * (1.0 - k / self.settings.epochs)
                errors = [self.step(x, float(y), eta) for x, y in zip(inputs, targets, strict=True)]
                epochs.append(Epoch(float(np.mean(errors)), eta))
                after(len(epochs))
                if not epochs[-1].error < 1e6:
                    epochs[-1] = Epoch(float("nan"), eta)
                    break
                if epochs[-1].error < self.settings.stop:
                    break
        return epochs

    def next(self, window: Array) -> float:
        """The next element after a window, shape (n,)."""
        newest = float(window[-1]) if self.settings.relative else 0.0
        x = (window - newest) / self.input_scale
        return newest + self.target_middle + (self.output(x) - self._centre) * self.target_scale

    def roll(self, window: Array, steps: int) -> Array:
        """`steps` elements after a window: each prediction becomes an input."""
        n = self.settings.inputs
        path = [float(v) for v in window[-n:]]
        for _ in range(steps):
            path.append(self.next(np.array(path[-n:])))
        return np.array(path[n:])

    @property
    def _centre(self) -> float:
        return 0.5 if self.settings.relative else 0.0

    def _scaled(self, series: Array) -> tuple[Array, Array]:
        """Inputs (k, n) and targets (k,) in scaled units; keeps the scales."""
        n = self.settings.inputs
        windows = np.lib.stride_tricks.sliding_window_view(series, n)[:-1]  # (k, n)
        targets = series[n:]
        if not self.settings.relative:
            return windows, targets
        newest = windows[:, -1]
        windows = windows - newest[:, None]
        targets = targets - newest
        low, high = float(targets.min()), float(targets.max())
        self.input_scale = float(np.abs(windows).max()) or 1.0
        self.target_middle = 0.5 * (low + high)
        self.target_scale = (high - low) / 0.6 or 1.0
        return windows / self.input_scale, self._centre + (targets - self.target_middle) / self.target_scale
