"""Windows of the last displacements, turned into the frame of their own heading.

The frame's first axis points along the net horizontal displacement of the window, the second to its
right (east of north), the third stays down: what is learnt on one course holds on every other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from onboard.pilot.predictor.activation import Array

Indices = npt.NDArray[np.intp]


class Windows(NamedTuple):
    """Displacements before several origins, in heading frames."""

    moves: Array  # (k, L, 3) [m a step], newest first; the newest is the base velocity
    cos: Array  # (k,) of the heading
    sin: Array  # (k,)


def windows(positions: Array, velocities: Array, origins: Indices, points: int) -> Windows:
    """Windows of `points` positions ending at each origin.

    positions (n, 3) [m]; velocities (n, 3) [m a step]: the constant velocity at each instant, which takes
    the place of the newest displacement; origins (k,), each at least points − 1."""
    length = points - 1
    back = origins[:, None] - np.arange(length + 1)  # (k, L + 1), newest first
    places = positions[back]
    moves = places[:, :-1] - places[:, 1:]
    moves[:, 0] = velocities[origins]
    net = places[:, 0] - places[:, -1]
    size = np.hypot(net[:, 0], net[:, 1])
    still = size < 1e-9
    size = np.where(still, 1.0, size)
    cos = np.where(still, 1.0, net[:, 0] / size)
    sin = net[:, 1] / size
    return Windows(turn(moves, cos, sin), cos, sin)


def turn(vectors: Array, cos: Array, sin: Array) -> Array:
    """Vectors (k, …, 3) of the game frame in the heading frames (k,); with −sin, back again."""
    shape = (-1,) + (1,) * (vectors.ndim - 2)
    c, s = cos.reshape(shape), sin.reshape(shape)
    out = np.empty_like(vectors)
    out[..., 0] = c * vectors[..., 0] + s * vectors[..., 1]
    out[..., 1] = c * vectors[..., 1] - s * vectors[..., 0]
    out[..., 2] = vectors[..., 2]
    return out
