"""Stated errors that hold: 68 % of the facts within one of them, 95 % within two.

The held-out errors of a training state how far a model was off then. What becomes of the predictions at grid
points tells how far it is off now: each horizon has a factor that rises by a step where a fact lies outside
and falls by less where it lies inside, so that in the long run the wanted share lies inside, whatever the
target does (Gibbs and Candès, "Adaptive conformal inference under distribution shift", NeurIPS 2021). It
never falls below one: a model that was lucky is not thereby sure.
"""

from __future__ import annotations

from math import exp, hypot, isfinite, log
from typing import NamedTuple

from onboard.pilot.predictor.said import Numbers, Rows, Said

ONE, TWO = 0.32, 0.05  # shares of the facts that may lie outside one and two stated errors
RATE = 0.08  # of a factor's logarithm a grid point, at the shortest horizons
LARGEST = 5.0  # no factor is larger


class _Words(NamedTuple):
    places: Rows  # (H, 3) [m]
    sigma: Numbers  # (H,) [m] as trained, without a factor


class Off(NamedTuple):
    """How far a prediction was off."""

    horizon: int  # its index
    said: int  # the grid point it was said at
    times: float  # of the error that training stated


class Calibration:
    """Follows the stated errors of one track's predictions at grid points."""

    def __init__(self, horizons: tuple[int, ...]) -> None:
        self._said: Said[_Words] = Said(horizons)
        self._one = [0.0] * len(horizons)  # logarithms of the factors
        self._two = [0.0] * len(horizons)

    def clear(self) -> None:
        """Forget: the grid began anew."""
        self._said.clear()
        self._one = [0.0] * len(self._one)
        self._two = [0.0] * len(self._two)

    def factors(self) -> list[float]:
        """(H,) by which the errors found in training are multiplied, 1 … LARGEST."""
        return [exp(max(one, two)) for one, two in zip(self._one, self._two, strict=True)]

    def tell(self, index: int, places: Rows, sigma: Numbers) -> None:
        """Keep what was said at a grid point: places (H, 3) [m] and their errors (H,) [m] as trained."""
        self._said.keep(index, _Words(places, sigma))

    def judge(self, newest: int, positions: Rows) -> list[Off]:
        """Compare with the grid's last places (n, 3 or more) [m], the last of which has index `newest`; gives
        how far the predictions were off whose truth came."""
        found = []
        for index, place, told in self._said.facts(newest, positions):
            for i, (ahead, said) in enumerate(told):
                if said is None or not isfinite(said.sigma[i]):
                    continue
                x, y, z = (float(place[axis] - said.places[i][axis]) for axis in range(3))
                off = hypot(x, y, z) / max(float(said.sigma[i]), 1e-6)
                self._one[i] = _moved(self._one[i], off, ONE, 1.0)
                self._two[i] = _moved(self._two[i], off, TWO, 2.0)
                found.append(Off(i, index - ahead, off))
        return found


def _moved(factor: float, off: float, outside: float, size: float) -> float:
    """The logarithm of a factor after a fact `off` stated errors away."""
    missed = off > size * exp(factor)
    return min(max(factor + RATE * (missed - outside), 0.0), log(LARGEST))
