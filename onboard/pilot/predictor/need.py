"""Whether a track's model asks to be trained again: when what it was held to no longer holds.

A training states how far its model was off where it was held out. As long as predictions at grid points are
about so far off, another training would find the same model. It asks for one when

- there is no model yet, the grid has twice the points that the last one learnt from, or enough for another
  method, or it began anew;
- in a fading memory of its last predictions the error of some horizon exceeds the stated one (RISING): the
  target does what it did not do before. It goes on asking until no horizon exceeds FALLING;
- the errors of all horizons are far below the stated ones (CALM): a motion that ended is held against it.
"""

from __future__ import annotations

from collections.abc import Sequence

from onboard.pilot.predictor.calibration import Off

GROWTH = 2.0  # times the points of the last training
RISING, FALLING = 1.6, 1.2  # root mean square errors, in stated ones
CALM = 0.4
SHORTEST = 12.0  # memory [grid points] of the shortest horizons
OVERLAP = 2.0  # memory of a horizon, in times itself: predictions that overlap are no independent evidence


class Need:
    """Follows how far one model's predictions are off."""

    def __init__(self, horizons: tuple[int, ...], ladder: tuple[int, ...]) -> None:
        """`ladder`: numbers of points from which on another method learns."""
        self._ladder = ladder
        self._fade = [1.0 - 1.0 / max(SHORTEST, OVERLAP * h) for h in horizons]
        self._square = [0.0] * len(horizons)  # faded sums of squares, in stated errors
        self._count = [0.0] * len(horizons)  # and of their numbers
        self._learnt = 0  # points that the last training learnt from
        self._since = 0  # the grid point of that training: what was said before is no fault of its model
        self._firm = [0.5 / (1.0 - fade) for fade in self._fade]  # half a memory
        self.rising = self.calm = False

    def clear(self) -> None:
        """Forget: the grid began anew."""
        self.trained(0, 0)
        self.rising = False

    def trained(self, points: int, index: int) -> None:
        """A model was trained on so many points, the newest of which has index `index`."""
        self._square = [0.0] * len(self._square)
        self._count = [0.0] * len(self._count)
        self._learnt, self._since = points, index
        self.calm = False

    def hear(self, found: Sequence[Off]) -> None:
        """Take how far predictions were off."""
        for i, said, times in found:
            if said < self._since:
                continue
            self._square[i] = self._fade[i] * self._square[i] + min(times, 1e6) ** 2
            self._count[i] = self._fade[i] * self._count[i] + 1.0
        firm = [
            (square / count) ** 0.5
            for square, count, enough in zip(self._square, self._count, self._firm, strict=True)
            if count > enough
        ]
        if firm:
            worst = max(firm)
            self.rising = worst > (FALLING if self.rising else RISING)
            self.calm = worst < CALM and len(firm) == len(self._fade)

    def asks(self, points: int, capacity: int) -> bool:
        """Whether a grid of so many points, at most `capacity`, should be learnt from."""
        learnt = self._learnt
        grown = points >= min(GROWTH * learnt, capacity) > learnt
        other = points < learnt or any(learnt < step <= points for step in self._ladder)
        return not learnt or grown or other or self.rising or self.calm
