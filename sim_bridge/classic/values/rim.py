"""Perimeter defence: a defender that moves on a circle only, an intruder from outside. In the plane."""

from __future__ import annotations

from math import acos, sqrt
from typing import NamedTuple

from onboard.core.math.vectors import clamp


class Breach(NamedTuple):
    """Where an intruder does best on the circle, and by how much."""

    angle: float  # from its own bearing to the breach, away from the defender [rad]
    path: float  # of the intruder to it [radii]
    value: float  # what is left between defender and breach then [rad of the circle]; negative: it is met


def breach(r: float, between: float, ratio: float) -> Breach:
    """The intruder's best point on the unit circle, from `r` > 1, `between` ≥ 0 [rad] from the defender.

    Shishika and Kumar, arXiv 1909.03989, the one against one game: with the intruder's speed `ratio` ≤ 1
    times the defender's, the arc still between them, between + φ − L(φ) / ratio, is greatest where
    dL/dφ = ratio, r cos φ = ratio² + √((r² − ratio²)(1 − ratio²)).
    """
    square = ratio * ratio
    c = (square + sqrt((r * r - square) * (1.0 - square))) / r
    angle = acos(clamp(c, -1.0, 1.0))
    path = sqrt(max(0.0, r * r + 1.0 - 2.0 * r * clamp(c, -1.0, 1.0)))
    return Breach(angle, path, between + angle - path / ratio)
