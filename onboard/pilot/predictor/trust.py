"""How far a model is believed, by what became of its last predictions.

The choice by held-out error is made once a training; a target that changes its ways in between
would be mispredicted until the next. So every prediction at a grid point is kept until its truth
arrives, and the share of the innovation that would have been right (least squares with a fading
memory, begun with a prior of full belief) scales what is said next.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor.activation import Array

FADE = 0.97  # memory: about 33 grid points
_BEFORE = -(1 << 62)  # before every grid point
PRIOR = 5.0  # predictions' worth of full belief


class _Said(NamedTuple):
    point: int  # index of the grid point
    position: Array  # (3,) [m]
    velocity: Array  # (3,) [m a step]
    innovation: Array  # (H, 3) [m a step]


class Trust:
    """Follows one model's predictions at grid points."""

    def __init__(self, horizons: tuple[int, ...]) -> None:
        self._horizons = horizons
        self._said: deque[_Said] = deque(maxlen=max(horizons) + 1)
        self._power = np.zeros(len(horizons))  # Σ said · said
        self._match = np.zeros(len(horizons))  # Σ said · fact
        self._seen = _BEFORE  # index of the newest grid point judged

    def clear(self) -> None:
        """Forget: the grid began anew."""
        self._said.clear()
        self._power[:] = 0.0
        self._match[:] = 0.0
        self._seen = _BEFORE

    def judge(self, newest: int, positions: Array) -> None:
        """Compare with the grid's positions (n, 3), the last of which has index `newest`."""
        for index in range(max(self._seen + 1, newest - len(positions) + 1), newest + 1):
            self._judge(index, positions[len(positions) - 1 - (newest - index)])
        self._seen = newest

    def tell(self, index: int, position: Array, velocity: Array, innovation: Array) -> None:
        """Keep what was said at a grid point."""
        self._said.append(_Said(index, position, velocity, innovation))

    def shares(self) -> Array:
        """(H,) shares of the innovations to believe, 0…1."""
        prior = PRIOR * (1.0 - FADE) * self._power + 1e-12
        out: Array = np.clip((self._match + prior) / (self._power + prior), 0.0, 1.0)
        return out

    def _judge(self, index: int, position: Array) -> None:
        self._power *= FADE
        self._match *= FADE
        for said in self._said:
            ahead = index - said.point
            if ahead in self._horizons:
                i = self._horizons.index(ahead)
                fact = (position - said.position) / ahead - said.velocity
                told = said.innovation[i]
                self._power[i] += float(told @ told)
                self._match[i] += float(told @ fact)
