"""Lion and man with k-capture: how deep an evader stands among as fast pursuers. In the plane."""

from __future__ import annotations

from math import atan2, cos, pi, sin
from typing import NamedTuple

from onboard.core.math.vectors import Vec

ASIDE = 1e-7  # [rad] from the heading across a pursuer's bearing, to either side of it


class Depth(NamedTuple):
    """How many pursuers are ahead of an evader whatever it does."""

    ahead: int  # the least number over all headings
    way: Vec  # in the middle of the headings with that number (unit)


def depth(evader: Vec, pursuers: tuple[Vec, ...]) -> Depth:
    """The evader's half-plane (Tukey) depth among the pursuers' places [m].

    Bopardikar and Suri, arXiv 1108.1561: of equally fast pursuers, k are at the evader at once in the end if
    and only if it lies in their k-hull: every open half-plane at it holds k or more. On a straight flight
    those ahead can be at it, those behind cannot.
    """
    bearings = [atan2(p.y - evader.y, p.x - evader.x) for p in pursuers]
    turns = sorted((b + side * 0.5 * pi) % (2.0 * pi) for b in bearings for side in (-1.0, 1.0))
    best = Depth(len(pursuers) + 1, Vec(1.0, 0.0, 0.0))
    widest = -1.0
    for number, start in enumerate(turns):
        width = (turns[(number + 1) % len(turns)] - start) % (2.0 * pi) or 2.0 * pi * (len(turns) == 1)
        middle = start + 0.5 * width
        front = sum(cos(b - middle) > 0.0 for b in bearings)
        if width > ASIDE and (front, -width) < (best.ahead, -widest):
            best, widest = Depth(front, Vec(cos(middle), sin(middle), 0.0)), width
    return best if pursuers else Depth(0, best.way)
