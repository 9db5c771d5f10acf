"""A track on a regular grid of instants: what the model learns from."""

from __future__ import annotations

from collections import deque
from itertools import islice, pairwise
from math import floor

import numpy as np

from onboard.core.math.constants import NEVER
from onboard.pilot.predictor.activation import Array
from onboard.pilot.track_filter import TrackFilter

UNALTERED = 1 << 62  # after every grid point
_Row = tuple[float, ...]  # position, velocity, measured position


class Grid:
    """The filtered track at the newest multiples of `step`, at most `capacity` of them, without a hole.

    A silence longer than `gap` breaks it: the points before are forgotten."""

    def __init__(self, step: float, capacity: int, gap: float) -> None:
        self.step = step  # [s]
        self.gap = gap  # [s]
        self.added = 0  # points ever added
        self._rows: deque[_Row] = deque(maxlen=capacity)  # position [m], velocity [m/s], measured [m]
        self._last = 0  # the newest point is at instant _last · step
        self._seen = NEVER  # newest sample that was taken in [s]
        self.altered = UNALTERED  # the oldest point altered or forgotten since a reader set this back

    def __len__(self) -> int:
        return len(self._rows)

    @property
    def last(self) -> int:
        """The newest point is at instant last · step."""
        return self._last

    def clear(self) -> None:
        """Forget everything."""
        self._forget()
        self._seen = NEVER

    def extend(self, track: TrackFilter) -> None:
        """Add the points up to the newest sample."""
        newest = track.newest
        if newest - self._seen > self.gap:
            self._forget()
            self._last = floor(newest / self.step + 1e-9) - 1
        self._seen = newest
        while (self._last + 1) * self.step <= newest + 1e-9:
            self._last += 1
            t = self._last * self.step
            here = track.estimate(t)
            self._rows.append((*here.position, *here.velocity, *track.measured(t)))
            self.added += 1

    def revise(self, track: TrackFilter, t: float) -> None:
        """A late sample of instant `t` came: compute the points after its predecessor anew."""
        since = max(track.before(t), track.oldest)
        while self._rows and self._last * self.step > since:
            self._rows.pop()
            self.altered = min(self.altered, self._last)
            self._last -= 1
            self.added -= 1
        self.extend(track)

    def _forget(self) -> None:
        self._rows.clear()
        self.altered = -UNALTERED

    def tail(self, count: int) -> list[_Row]:
        """The newest points, at most `count`, oldest first: position [m], velocity [m/s], measured [m]."""
        return list(islice(reversed(self._rows), count))[::-1]

    def arrays(self) -> tuple[Array, Array]:
        """Positions (n, 3) [m] and velocities (n, 3) [m a step], oldest first."""
        both = np.array(tuple(self._rows)).reshape(-1, 9)
        return both[:, :3], both[:, 3:6] * self.step

    def measured(self) -> Array:
        """Measured positions (n, 3) [m], oldest first: noisy, but with no lag."""
        return np.array(tuple(self._rows)).reshape(-1, 9)[:, 6:]

    def window(self, track: TrackFilter, points: int) -> list[list[float]] | None:
        """Places (points, 3) [m] at the newest sample and each `step` before it, oldest first; None where
        the grid is too short. Cubic between the grid's points; the two newest come from the filter."""
        newest = track.newest
        u = newest / self.step - self._last  # of the newest sample past the newest point, in steps
        if len(self._rows) < points or not -1e-6 <= u < 1.0 + 1e-6:
            return None
        far = u * u * (3.0 - 2.0 * u)
        near = 1.0 - far
        leaving, coming = u * (1.0 - u) * (1.0 - u) * self.step, u * u * (1.0 - u) * self.step
        rows = list(islice(reversed(self._rows), 1, points))  # newest first
        out = [
            [
                a0 * near + b0 * far + v0 * leaving - w0 * coming,
                a1 * near + b1 * far + v1 * leaving - w1 * coming,
                a2 * near + b2 * far + v2 * leaving - w2 * coming,
            ]
            for (b0, b1, b2, w0, w1, w2, *_), (a0, a1, a2, v0, v1, v2, *_) in pairwise(rows)
        ]
        out.reverse()
        out.append(list(track.estimate(newest - self.step).position))
        out.append(list(track.estimate(newest).position))
        return out
