"""How far a model is believed, by what became of its last predictions.

The choice by held-out error is made once a training; a target that changes its ways in between
would be mispredicted until the next. So every prediction at a grid point is kept until its truth
arrives, and the share of the innovation that would have been right (least squares with a fading
memory, begun with a prior of full belief) scales what is said next.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.pilot.predictor.said import Numbers, Rows, Said

FADE = 0.97  # memory: about 33 grid points
PRIOR = 5.0  # predictions' worth of full belief


class _Words(NamedTuple):
    position: Numbers  # (3,) [m]
    velocity: Numbers  # (3,) [m a step]
    innovation: Rows  # (H, 3) [m a step]


class Trust:
    """Follows one model's predictions at grid points."""

    def __init__(self, horizons: tuple[int, ...]) -> None:
        self._said: Said[_Words] = Said(horizons)
        self._power = [0.0] * len(horizons)  # Σ said · said
        self._match = [0.0] * len(horizons)  # Σ said · fact

    def clear(self) -> None:
        """Forget: the grid began anew."""
        self._said.clear()
        self._power = [0.0] * len(self._power)
        self._match = [0.0] * len(self._match)

    def judge(self, newest: int, positions: Rows) -> None:
        """Compare with the grid's last places (n, 3 or more) [m], the last of which has index `newest`."""
        for _, place, told in self._said.facts(newest, positions):
            for i, (ahead, said) in enumerate(told):
                power, match = self._power[i] * FADE, self._match[i] * FADE
                if said is not None:
                    for axis in range(3):
                        came = (place[axis] - said.position[axis]) / ahead - said.velocity[axis]
                        word = said.innovation[i][axis]
                        power += word * word
                        match += word * came
                self._power[i], self._match[i] = power, match

    def tell(self, index: int, position: Numbers, velocity: Numbers, innovation: Rows) -> None:
        """Keep what was said at a grid point."""
        self._said.keep(index, _Words(position, velocity, innovation))

    def shares(self) -> list[float]:
        """(H,) shares of the innovations to believe, 0…1."""
        found = []
        for power, match in zip(self._power, self._match, strict=True):
            prior = PRIOR * (1.0 - FADE) * power + 1e-12
            found.append(min(max((match + prior) / (power + prior), 0.0), 1.0))
        return found
