"""The evader's and the pursuer's decision in NumPy: the same mathematics, vectorised as one would.

The measure for the interpreted core. All pursuers, all candidate rays and all their tests against
all cones are arrays; nothing is computed that the core leaves out, and the early exits that help
(a free goal ray, an empty list of intersections) are taken.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
EDGE = 1e-9


@cache
def _pairs(n: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    return np.triu_indices(n, 1)


def evader(e: Array, v_e: float, p: Array, v_p: Array, g: Array, R: float, rho: float, lam: float,
           beta: float) -> Array:  # fmt: skip
    """Unit direction: the free ray nearest to the goal, else along (22). `p` (n, 3), `v_p` (n,)."""
    goal = g - e
    far = np.sqrt(goal @ goal)
    goal = goal / far
    line = p - e  # (n, 3)
    d = np.sqrt(np.einsum("ij,ij->i", line, line))  # (n,)
    axes = line / d[:, None]
    sa = v_p / v_e
    ca = np.sqrt(1.0 - sa * sa)
    sb = np.minimum(1.0, rho / d)
    cb = np.sqrt(1.0 - sb * sb)
    cosines = ca * cb - sa * sb
    sines = sa * cb + ca * sb
    edge = cosines + EDGE * sines
    pa = axes @ goal  # (n,)
    if (pa <= edge).all():
        return goal
    side = goal - pa[:, None] * axes
    n = np.sqrt(np.einsum("ij,ij->i", side, side))
    side = side / np.maximum(n, 1e-12)[:, None]
    candidates = [axes * cosines[:, None] + side * sines[:, None]]
    i, j = _pairs(len(d))
    c = np.einsum("ij,ij->i", axes[i], axes[j])
    k = 1.0 - c * c
    k = np.where(k <= 1e-12, np.inf, k)
    a = (cosines[i] - cosines[j] * c) / k
    b = (cosines[j] - cosines[i] * c) / k
    square = 1.0 - a * a - b * b - 2.0 * a * b * c
    meet = (square >= 0.0) & np.isfinite(k)
    if meet.any():
        i, j, a, b = i[meet], j[meet], a[meet], b[meet]
        t = np.sqrt(square[meet] / k[meet])
        base = a[:, None] * axes[i] + b[:, None] * axes[j]
        x, y = axes[i], axes[j]
        across = np.empty_like(x)
        across[:, 0] = x[:, 1] * y[:, 2] - x[:, 2] * y[:, 1]
        across[:, 1] = x[:, 2] * y[:, 0] - x[:, 0] * y[:, 2]
        across[:, 2] = x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]
        across *= t[:, None]
        candidates += [base + across, base - across]
    rays = np.concatenate(candidates)  # (m, 3)
    free = (rays @ axes.T <= edge).all(axis=1)
    if free.any():
        near = np.where(free, rays @ goal, -2.0)
        best: Array = rays[near.argmax()]
        return best
    weight = lam / np.maximum(d - 2.0 * R, 1e-3)
    force = -weight @ axes + (beta + 1.0 / far) * goal
    found: Array = force / np.sqrt(force @ force)
    return found


class Aim(NamedTuple):
    """What a pursuer's decision says."""

    direction: Array  # unit (3,)
    point: Array  # (3,)
    time: float
    miss: float


def pursuer(e: Array, heading: Array, v_e: float, p: Array, v_p: float) -> Aim:
    """The rules of 3.4.2 in the vector functions of NumPy, as a script of this subject has them."""
    line = p - e
    dd = np.dot(line, line)
    b = v_e * np.dot(line, heading)
    inside = b * b - (v_e * v_e - v_p * v_p) * dd
    if b > 0.0 and inside >= 0.0:
        time = dd / (b + np.sqrt(inside))
        point = e + heading * (v_e * time)
        miss = 0.0
    elif b > 0.0:
        gamma = v_p / v_e
        root = np.sqrt(1.0 - gamma * gamma)
        s = np.dot(line, heading)
        h = np.linalg.norm(np.cross(heading, line))
        time = (s + h * gamma / root) / v_e
        point = e + heading * (v_e * time)
        miss = np.maximum(0.0, h * root - s * gamma)
    else:
        return Aim(heading, p + heading * v_p, 1.0, float(np.linalg.norm(line)))
    way = point - p
    return Aim(way / np.linalg.norm(way), point, float(time), float(miss))


def pursuer_lean(e: Array, heading: Array, v_e: float, p: Array, v_p: float) -> Array:
    """The direction alone, with as few and as cheap NumPy calls as can be: Python floats elsewhere."""
    line = p - e
    s = float(line @ heading)
    if s <= 0.0:
        return heading
    dd = float(line @ line)
    inside = (v_e * s) ** 2 - (v_e * v_e - v_p * v_p) * dd
    if inside >= 0.0:
        time = dd / (v_e * s + np.sqrt(inside))
    else:
        gamma = v_p / v_e
        h = np.sqrt(max(0.0, dd - s * s))
        time = (s + h * gamma / np.sqrt(1.0 - gamma * gamma)) / v_e
    way = heading * (v_e * time) - line
    found: Array = way / np.sqrt(way @ way)
    return found
