"""What was said at the grid's points, kept until its truth arrives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Generic, NamedTuple, TypeVar

from onboard.pilot.predictor.activation import Array

Numbers = Sequence[float] | Array
Rows = Sequence[Sequence[float]] | Array
T = TypeVar("T")
_BEFORE = -(1 << 62)  # before every grid point


class Fact(NamedTuple, Generic[T]):
    """A grid point that came."""

    point: int  # its index
    place: Numbers  # (3 or more,) [m]
    told: list[tuple[int, T | None]]  # each horizon [steps] with what was said of it so long before


class Said(Generic[T]):
    """Words by grid point, and which points are new."""

    def __init__(self, horizons: tuple[int, ...]) -> None:
        self.horizons = horizons
        self._kept: dict[int, T] = {}  # by index of the grid point, in the order they were said
        self._seen = _BEFORE  # index of the newest grid point that was taken as a fact

    def clear(self) -> None:
        """Forget: the grid began anew."""
        self._kept.clear()
        self._seen = _BEFORE

    def keep(self, index: int, words: T) -> None:
        """Keep what was said at a grid point; what was said there before goes."""
        self._kept.pop(index, None)
        self._kept[index] = words
        while len(self._kept) > max(self.horizons) + 1:
            del self._kept[next(iter(self._kept))]

    def facts(self, newest: int, positions: Rows) -> Iterator[Fact[T]]:
        """The places at grid points not given yet, the last of `positions` being of point `newest`."""
        first = newest - len(positions) + 1
        since = max(self._seen + 1, first)
        self._seen = newest
        for index in range(since, newest + 1):
            yield Fact(
                index, positions[index - first], [(h, self._kept.get(index - h)) for h in self.horizons]
            )
