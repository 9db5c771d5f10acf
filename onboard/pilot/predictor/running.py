"""The ridge base kept up from grid point to grid point, without fitting it anew.

A new grid point is the fact that one window of each horizon waited for, and the oldest point takes its
window with it: a rank-one change of the normal equations each. The inverse of a loaded normal matrix A
follows by Sherman and Morrison, (A ± x xᵀ)⁻¹ = A⁻¹ ∓ A⁻¹x (A⁻¹x)ᵀ / (1 ± xᵀA⁻¹x), and the coefficients
with it (recursive least squares). The load, relative to the features' mean squares, is that of the last
exact solution. One is made every EXACT changes, when windows became a quarter more, and where a change
would cost digits (FIRM); in between the coefficients differ from the exact ones under the same load by
less than BOUND of the largest.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor import ridge
from onboard.pilot.predictor.activation import Array
from onboard.pilot.predictor.forecast import Row, window
from onboard.pilot.predictor.grid import UNALTERED, Grid
from onboard.pilot.predictor.model import Model, ModelSettings, lessons
from onboard.pilot.predictor.prediction import SPEAKING

EXACT = 100  # changes from one exact solution to the next
MORE = 1.25  # times the windows of the last exact solution
FIRM = 0.01  # least 1 − xᵀA⁻¹x of a window that is taken away
BACK = 8  # so many points are taken back where a late sample altered them
BOUND = 1e-7  # of the largest coefficient: see above


class _Window(NamedTuple):
    """A window that is learnt from, by its last point."""

    features: Array  # (3, F)
    cos: float  # of its heading
    sin: float
    place: Row  # (3,) [m]
    facts: dict[int, Row]  # innovation (3,) [m a step] in its heading frame, by index of the horizon


class RunningRidge:
    """Keeps up one model's ridge, for the horizons at which it speaks."""

    def __init__(self, settings: ModelSettings) -> None:
        self._settings = settings
        self._which: list[int] = []  # indices of horizons
        self._windows: deque[_Window] = deque()
        self._newest = 0  # grid point of the newest window
        self._points = 0  # of a window
        self._changes = self._counted = 0  # since the last exact solution, and its windows
        self._inverse: Array | None = None  # (W, 3, F, F)
        self._found: Array = np.zeros(0)  # (W, 3, F)
        self.load: Array = np.zeros(0)  # (W, 3, F) on the diagonals, since the last exact solution

    def clear(self) -> None:
        """Begin anew with the next point: the model is another one."""
        self._inverse = None

    def follow(self, grid: Grid, model: Model) -> Model:
        """The model with its ridge fitted to the grid as it is now; choice and network stay."""
        altered, grid.altered = grid.altered, UNALTERED
        if self._inverse is not None and not self._which:
            return model
        if self._inverse is None or not self._changed(grid, altered):
            self._solve(grid, model)
            if not self._which:
                return model
        coefficients = np.zeros_like(model.coefficients)
        coefficients[self._which] = self._found
        return model._replace(coefficients=coefficients)

    # ── exactly ──

    def _solve(self, grid: Grid, model: Model) -> None:
        settings, points, total = self._settings, model.points, len(grid)
        self._inverse = np.zeros(0)
        self._which = []
        if total < max(settings.ladder[1], 2 * points):
            self.clear()
            return
        counts = [max(0, total - h - points + 1) for h in settings.horizons]
        self._which = [
            i for i, kind in enumerate(model.kinds)
            if kind in SPEAKING and counts[i] >= points and model.coefficients[i].any()
        ]  # fmt: skip
        if not self._which:
            return
        positions, velocities = grid.arrays()
        view, rows, wanted = lessons(positions, velocities, points, settings)
        penalties = np.array([settings.penalties[model.penalty[i]] for i in self._which])
        gram, right = ridge.normal(rows, wanted[:, self._which], [counts[i] for i in self._which])
        loaded = ridge.loaded(gram, penalties[:, None, None])
        self._inverse = np.asarray(np.linalg.inv(loaded), np.float64)
        self._found = np.asarray(np.linalg.solve(loaded, right[..., None])[..., 0], np.float64)
        self.load = np.einsum("...ii->...i", loaded - gram)
        facts = [
            {i: row[i] for i, count in enumerate(counts) if k < count}
            for k, row in enumerate(wanted.tolist())
        ]
        self._windows = deque(
            map(_Window, rows.transpose(1, 0, 2), view.cos.tolist(), view.sin.tolist(),
                positions[points - 1 :].tolist(), facts)
        )  # fmt: skip
        self._points, self._newest = points, grid.last
        self._changes, self._counted = 0, len(self._windows)

    # ── by changes ──

    def _changed(self, grid: Grid, altered: int) -> bool:
        """Take back, take away and add what the grid's points ask for; False where it must be solved anew."""
        if altered <= self._newest - BACK or grid.last - self._newest > BACK:
            return False
        while self._newest >= altered:
            if not self._take_back():
                return False
        added = grid.last - self._newest
        rows = grid.tail(self._points + added - 1)
        for k in range(added):
            self._newest += 1
            if not self._add(rows[k : k + self._points], grid.step):
                return False
        first = grid.last - len(grid) + self._points  # the first window whose points are all there
        while self._newest - len(self._windows) + 1 < first:
            if not self._take_away():
                return False
        return self._changes < EXACT and len(self._windows) < MORE * self._counted

    def _add(self, rows: Sequence[Row], step: float) -> bool:
        """The window of the newest point, the last of the grid's rows, and the facts that it is to others."""
        here, velocity = rows[-1][:3], [v * step for v in rows[-1][3:6]]
        moves, cos, sin = window(rows, velocity)
        features = np.array(([*moves[0], 1.0], [*moves[1], 0.0], [*moves[2], 1.0]))
        self._windows.append(_Window(features, cos, sin, here, {}))
        for i, horizon in enumerate(self._settings.horizons):
            if horizon < len(self._windows):
                origin = self._windows[-1 - horizon]
                origin.facts[i] = _innovation(origin, here, horizon)
        return self._change(self._of_newest(), 1.0)

    def _of_newest(self) -> list[tuple[Array, Row]]:
        """The windows that the newest point is a fact to, with that fact; for each horizon kept up."""
        found = []
        for i in self._which:
            horizon = self._settings.horizons[i]
            if horizon >= len(self._windows):
                return []
            origin = self._windows[-1 - horizon]
            found.append((origin.features, origin.facts[i]))
        return found

    def _take_back(self) -> bool:
        """Undo the newest point."""
        changes = self._of_newest()
        if not changes or not self._change(changes, -1.0):
            return False
        self._windows.pop()
        self._newest -= 1
        for i, horizon in enumerate(self._settings.horizons):
            if horizon <= len(self._windows):
                self._windows[-horizon].facts.pop(i, None)
        return True

    def _take_away(self) -> bool:
        """Forget the oldest window."""
        oldest = self._windows[0]
        if any(i not in oldest.facts for i in self._which):
            return False
        if not self._change([(oldest.features, oldest.facts[i]) for i in self._which], -1.0):
            return False
        self._windows.popleft()
        return True

    def _change(self, pairs: Sequence[tuple[Array, Row]], sign: float) -> bool:
        """Add (1) or take away (−1) a window of each horizon; False where digits would be lost."""
        if self._inverse is None or len(pairs) != len(self._which):
            return False
        x = np.array([features for features, _ in pairs])  # (W, 3, F)
        facts = np.array([fact for _, fact in pairs])  # (W, 3)
        self._changes += 1
        return change(self._inverse, self._found, (x, facts), sign)


def change(inverse: Array, found: Array, window: tuple[Array, Array], sign: float) -> bool:
    """Add (sign 1) to least squares, or take away (−1), one row each: `inverse` (…, F, F) of the normal
    matrices and the solutions `found` (…, F) change in place, by rows (…, F) and right sides (…). False, and
    nothing is changed, where that would cost more than two digits."""
    x, facts = window
    gain = (inverse @ x[..., None])[..., 0]
    left = 1.0 + sign * (x * gain).sum(axis=-1)
    if not left.min() >= FIRM:
        return False
    off = facts - (found * x).sum(axis=-1)
    share = gain / left[..., None]
    found += sign * off[..., None] * share
    inverse -= (sign * share)[..., :, None] * gain[..., None, :]
    return True


def _innovation(origin: _Window, here: Row, horizon: int) -> Row:
    """Mean velocity to a place so many steps after a window, less its own velocity, in its heading frame."""
    n, e, d = ((now - then) / horizon for now, then in zip(here, origin.place, strict=True))
    c, s = origin.cos, origin.sin
    ahead, right, down = origin.features[:, 0].tolist()
    return [c * n + s * e - ahead, c * e - s * n - right, d - down]
