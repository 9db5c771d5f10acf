"""One track trains at a time, in slices between control steps; counted, so that it is deterministic."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping

from onboard.pilot.predictor.track import TrackPredictor


class Trainer:
    """Gives training time to the predictors of several tracks.

    One track trains at a time, each at most once in `period` seconds, the longest waiting first.
    `advance` counts slices, not wall time: the same calls give the same result."""

    def __init__(self, period: float = 4.0) -> None:
        self.period = period  # [s]
        self._begun: dict[Hashable, float] = {}  # track → instant of its last training [s]
        self._running: Iterator[None] | None = None

    @property
    def busy(self) -> bool:
        """Whether a training is under way."""
        return self._running is not None

    def advance(self, now: float, tracks: Mapping[Hashable, TrackPredictor], slices: int = 1) -> int:
        """Do at most `slices` slices (about 1 ms each) at instant `now` [s]; returns how many were done."""
        done = 0
        while done < slices:
            if self._running is None:
                self._running = self._next(now, tracks)
                if self._running is None:
                    break
            try:
                next(self._running)
            except StopIteration:
                self._running = None
            done += 1
        return done

    def _next(self, now: float, tracks: Mapping[Hashable, TrackPredictor]) -> Iterator[None] | None:
        self._begun = {key: t for key, t in self._begun.items() if key in tracks and t <= now}
        due = [key for key in tracks if now - self._begun.get(key, float("-inf")) >= self.period]
        due = [key for key in due if tracks[key].trainable]
        if not due:
            return None
        chosen = min(due, key=lambda key: self._begun.get(key, float("-inf")))
        self._begun[chosen] = now
        return tracks[chosen].train()
