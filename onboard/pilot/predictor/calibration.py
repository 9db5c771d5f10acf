"""Stated errors that hold: 68 % of the facts within one of them, 95 % within two.

The held-out errors of a training state how far a model was off then. What becomes of the predictions at grid
points tells how far it is off now: each horizon has a factor that rises by a step where a fact lies outside
and falls by less where it lies inside, so that in the long run the wanted share lies inside, whatever the
target does (Gibbs and Candès, "Adaptive conformal inference under distribution shift", NeurIPS 2021). It
never falls below one: a model that was lucky is not thereby sure.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor.activation import Array

ONE, TWO = 0.32, 0.05  # shares of the facts that may lie outside one and two stated errors
RATE = 0.08  # of a factor's logarithm a grid point, at the shortest horizons
LARGEST = 5.0  # no factor is larger
_BEFORE = -(1 << 62)  # before every grid point


class _Said(NamedTuple):
    point: int  # index of the grid point
    places: Array  # (H, 3) [m]
    sigma: Array  # (H,) [m] as trained, without a factor


class Calibration:
    """Follows the stated errors of one track's predictions at grid points."""

    def __init__(self, horizons: tuple[int, ...]) -> None:
        self._horizons = horizons
        self._said: deque[_Said] = deque(maxlen=max(horizons) + 1)
        self._one = np.zeros(len(horizons))  # logarithms of the factors
        self._two = np.zeros(len(horizons))
        self._seen = _BEFORE

    def clear(self) -> None:
        """Forget: the grid began anew."""
        self._said.clear()
        self._one[:] = 0.0
        self._two[:] = 0.0
        self._seen = _BEFORE

    def factors(self) -> Array:
        """(H,) by which the errors found in training are multiplied, 1 … LARGEST."""
        out: Array = np.exp(np.maximum(self._one, self._two))
        return out

    def tell(self, index: int, places: Array, sigma: Array) -> None:
        """Keep what was said at a grid point: places (H, 3) [m] and their errors (H,) [m] as trained."""
        self._said.append(_Said(index, places, sigma))

    def judge(self, newest: int, positions: Array) -> None:
        """Compare with the grid's positions (n, 3) [m], the last of which has index `newest`."""
        for index in range(max(self._seen + 1, newest - len(positions) + 1), newest + 1):
            self._judge(index, positions[len(positions) - 1 - (newest - index)])
        self._seen = newest

    def _judge(self, index: int, position: Array) -> None:
        for said in self._said:
            ahead = index - said.point
            if ahead in self._horizons:
                i = self._horizons.index(ahead)
                if not np.isfinite(said.sigma[i]):
                    continue
                off = float(np.linalg.norm(position - said.places[i])) / max(float(said.sigma[i]), 1e-6)
                for factor, outside, size in ((self._one, ONE, 1.0), (self._two, TWO, 2.0)):
                    missed = off > size * np.exp(factor[i])
                    factor[i] += RATE * (missed - outside)
                    factor[i] = min(max(factor[i], 0.0), np.log(LARGEST))
