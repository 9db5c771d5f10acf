"""One track trains at a time, in slices between control steps; counted, so that it is deterministic."""

from __future__ import annotations

from collections.abc import Generator, Hashable, Mapping
from typing import Any

from onboard.core.math.constants import NEVER
from onboard.pilot.predictor.track import TrackPredictor

Training = Generator[None, None, None]
Tracks = Mapping[Any, TrackPredictor]  # by any hashable key


class Trainer:
    """Gives training time to the predictors of several tracks.

    One track trains at a time, each at most once in `period` seconds, the longest waiting first. The
    ridges of the others are kept up between, one a call. `advance` counts slices, not wall time: the
    same calls give the same result."""

    def __init__(self, period: float = 4.0) -> None:
        self.period = period  # [s]
        self._begun: dict[Hashable, float] = {}  # track → instant of its last training [s]
        self._refreshed: dict[Hashable, int] = {}  # track → number of the call that last fitted its ridge
        self._calls = 0
        self._running: Training | None = None

    @property
    def busy(self) -> bool:
        """Whether a training is under way."""
        return self._running is not None

    def advance(self, now: float, tracks: Tracks, slices: int = 1) -> int:
        """Fit at most one ridge anew and do at most `slices` slices of training (about 1 ms each) at instant
        `now` [s]; returns how many slices were done."""
        self._calls += 1
        self._refresh(tracks)
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

    def _refresh(self, tracks: Tracks) -> None:
        stale = [key for key, track in tracks.items() if track.stale]
        if stale:
            self._refreshed = {key: call for key, call in self._refreshed.items() if key in tracks}
            chosen = min(stale, key=lambda key: self._refreshed.get(key, 0))
            self._refreshed[chosen] = self._calls
            tracks[chosen].refresh()

    def _next(self, now: float, tracks: Tracks) -> Training | None:
        self._begun = {key: t for key, t in self._begun.items() if key in tracks and t <= now}
        due = [
            key
            for key, track in tracks.items()
            if track.trainable and now - self._begun.get(key, NEVER) >= self.period
        ]
        if not due:
            return None
        chosen = min(due, key=lambda key: self._begun.get(key, NEVER))
        self._begun[chosen] = now
        return tracks[chosen].train()
