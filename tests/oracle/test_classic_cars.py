"""The two games of cars against a solve of their level sets on a grid, which knows no optimal path."""

from __future__ import annotations

from math import hypot, pi

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from sim_bridge.classic.values.cars import Miss, chauffeur_time, straightened, two_cars

Array = NDArray[np.float64]


def arc(heading: Array | float, turn: float, h: float) -> tuple[Array | float, Array | float]:
    """Where a car of speed and turning radius 1 is after `h`, right and ahead of where it was."""
    if turn == 0.0:
        return np.sin(heading) * h, np.cos(heading) * h
    return (np.cos(heading) - np.cos(heading + turn * h)) / turn, (
        np.sin(heading + turn * h) - np.sin(heading)
    ) / turn


def seen_from(dx: Array, dy: Array, turned: float) -> tuple[Array, Array]:
    """The same place from a pursuer that has turned right by so much."""
    return dx * np.cos(turned) - dy * np.sin(turned), dx * np.sin(turned) + dy * np.cos(turned)


def chauffeur_times(w: float, radius: float, half: float, cells: int, h: float) -> Array:
    """Times to capture on a grid: least over the pursuer's turns of the most over the evader's headings."""
    axis = np.linspace(-half, half, cells)
    x, y = np.meshgrid(axis, axis, indexing="ij")
    nexts = []
    for turn in (-1.0, 0.0, 1.0):
        px, py = arc(0.0, turn, h)
        moves = []
        for course in np.arange(16) * 2 * pi / 16:
            place = seen_from(x + w * h * np.sin(course) - px, y + w * h * np.cos(course) - py, turn * h)
            moves.append((np.array(place) + half) / (2 * half) * (cells - 1))
        nexts.append(moves)
    times, far = np.zeros((cells, cells)), np.hypot(x, y)
    for _ in range(round(13.0 / h)):
        worst = [
            np.max([map_coordinates(times, at, order=1, mode="nearest") for at in moves], axis=0)
            for moves in nexts
        ]
        times = np.where(far <= radius, (far - radius), h + np.min(worst, axis=0))
    return times


LONG = pytest.mark.long


@pytest.mark.parametrize(
    ("cells", "h", "aside", "tolerance"),
    [(101, 0.22, 45.0, 0.05), pytest.param(141, 0.18, 60.0, 0.025, marks=LONG)],
)
def test_the_chauffeur_catches_as_soon_as_the_grid_says(
    cells: int, h: float, aside: float, tolerance: float
) -> None:
    """At three turning radii, so many degrees off the nose; what is behind a barrier takes far longer."""
    w, radius, half = 8.0 / 15.0, 0.465, 5.2
    times = chauffeur_times(w, radius, half, cells, h)
    rng = np.random.default_rng(1)

    def both(far: float, bearing: float) -> tuple[float, float]:
        x, y = far * np.sin(bearing), far * np.cos(bearing)
        at = (np.array([[x], [y]]) + half) / (2 * half) * (len(times) - 1)
        return chauffeur_time(x, y, w, radius), float(map_coordinates(times, at, order=1)[0])

    for _ in range(60):
        formula, grid = both(rng.uniform(3.0, 4.3), np.radians(rng.uniform(-aside, aside)))
        assert formula == pytest.approx(grid, rel=tolerance)
    formula, grid = both(2.5, 1.5)
    assert grid > 1.3 * formula


def passes(half: float, cells: int, headings: int, h: float) -> Array:
    """Least distances of two identical cars on a grid of places and headings."""
    axis, theta = np.linspace(-half, half, cells), np.arange(headings) * 2 * pi / headings
    x, y, t = np.meshgrid(axis, axis, theta, indexing="ij")
    nexts = {}
    for p in (-1.0, 0.0, 1.0):
        for e in (-1.0, 0.0, 1.0):
            (ex, ey), (px, py) = arc(t, e, h), arc(0.0, p, h)
            place = seen_from(x + ex - px, y + ey - py, p * h)
            turned = ((t + (e - p) * h) % (2 * pi)) / (2 * pi) * headings
            nexts[p, e] = np.stack([*((one + half) / (2 * half) * (cells - 1) for one in place), turned])
    far = np.hypot(x, y)
    least = far
    for _ in range(round(2.4 / h)):
        around = np.concatenate([least, least[:, :, :1]], axis=2)
        seen = {k: map_coordinates(around, at, order=1, mode="nearest") for k, at in nexts.items()}
        worst = [np.max([seen[p, e] for e in (-1.0, 0.0, 1.0)], axis=0) for p in (-1.0, 0.0, 1.0)]
        least = np.minimum(far, np.min(worst, axis=0))
    return least


def regular(x: float, y: float, found: Miss) -> bool:
    """Where the problem says that its value is known (`two-cars` in `sim_bridge/classic/chases.py`)."""
    saddle = found.guaranteed - found.distance < 0.02 and abs(found.evader * found.pursuer) == 1.0
    return saddle and 0.1 < found.distance < min(1.0, hypot(x, y) - 0.15) and found.margin > 0.1


@pytest.mark.parametrize(
    ("cells", "headings", "h", "tolerance"),
    [(29, 24, 0.16, 0.15), pytest.param(61, 48, 0.1, 0.06, marks=LONG)],
)
def test_identical_cars_pass_as_near_as_the_grid_says(
    cells: int, headings: int, h: float, tolerance: float
) -> None:
    """Within so many turning radii where turns that are kept are a saddle; elsewhere they can be far off."""
    half = 3.0
    grid = passes(half, cells, headings, h)
    around = np.concatenate([grid, grid[:, :, :1]], axis=2)
    rng = np.random.default_rng(2)
    inside, outside = [], []
    while len(inside) < 20:
        x, y, t = float(rng.uniform(-1.6, 1.6)), float(rng.uniform(0, 1.6)), float(rng.uniform(0, 2 * pi))
        found = two_cars(x, y, t)
        per_m = (grid.shape[0] - 1) / (2 * half)
        at = [[(x + half) * per_m], [(y + half) * per_m], [t / (2 * pi) * grid.shape[2]]]
        off = found.distance - float(map_coordinates(around, at, order=1)[0])
        known = regular(x, y, found) and found.when < 2.0
        if known and straightened(x, y, t, found) > found.distance - 0.01:
            inside.append(off)
        elif not known:
            outside.append(abs(off))
    assert max(map(abs, inside)) < tolerance
    assert max(outside) > 1.3 * tolerance
