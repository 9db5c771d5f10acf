"""The ridge base: linear regression of the innovation over constant velocity, one fit a horizon.

Learning from mirrored copies of every window makes the forward and the vertical answer independent
of the lateral moves, and the lateral answer free of a constant: so each axis is regressed on its own
moves, which is the same solution for a fraction of the work.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onboard.pilot.predictor.activation import Array


def features(moves: Array) -> Array:
    """(3, k, L + 1): each axis' own moves (k, L, 3) and a constant (none for the lateral axis)."""
    count, length, _ = moves.shape
    out = np.empty((3, count, length + 1))
    out[:, :, :-1] = moves.transpose(2, 0, 1)
    out[:, :, -1] = np.array([1.0, 0.0, 1.0])[:, None]
    return out


def fit(rows: Array, targets: Array, counts: Sequence[int], penalties: Sequence[float]) -> Array:
    """Coefficients (penalties, H, 3, L + 1) from features (3, k, L + 1) and targets (k, H, 3).

    Horizon h learns from its first counts[h] rows (the later ones have no known target). A penalty is
    relative to the features' own mean squares, which amounts to features of unit variance."""
    gram, right = normal(rows, targets, counts)
    out = np.empty((len(penalties), *right.shape))
    for i, penalty in enumerate(penalties):
        out[i] = np.linalg.solve(loaded(gram, penalty), right[..., None])[..., 0]
    return out


def normal(rows: Array, targets: Array, counts: Sequence[int]) -> tuple[Array, Array]:
    """Normal matrices (H, 3, L + 1, L + 1) and right sides (H, 3, L + 1) of `fit`."""
    size = rows.shape[2]
    gram = np.empty((len(counts), 3, size, size))
    right = np.empty((len(counts), 3, size))
    running, done = np.zeros((3, size, size)), 0
    for h in sorted(range(len(counts)), key=lambda h: counts[h]):  # each has the rows of the one before
        count = counts[h]
        more = rows[:, done:count]
        running = running + more.transpose(0, 2, 1) @ more
        done = max(done, count)
        gram[h] = running
        right[h] = (targets[:count, h].T[:, None, :] @ rows[:, :count])[:, 0]
    return gram, right


def loaded(gram: Array, penalty: float | Array) -> Array:
    """Normal matrices (H, 3, F, F) with a penalty, a number or (H, 1, 1), relative to their own diagonals."""
    each = np.arange(gram.shape[-1])
    power = gram[..., each, each]
    floor = 1e-9 * power.max(initial=0.0) + 1e-12
    power = np.where(power < floor, np.maximum(floor, 1.0), power)
    out = gram.copy()
    out[..., each, each] += penalty * power
    return out


def predict(coefficients: Array, rows: Array) -> Array:
    """Innovations (k, H, 3) [m a step] from coefficients (H, 3, F) and features (3, k, F)."""
    out: Array = (rows @ coefficients.transpose(1, 2, 0)).transpose(1, 2, 0)  # (3, k, H) → (k, H, 3)
    return out
