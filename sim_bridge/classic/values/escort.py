"""Target, attacker and defender, and the return of who took the flag. In the plane, point capture."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, pi, sin, sqrt
from typing import NamedTuple

GOLDEN = 0.618033988749895


class Escort(NamedTuple):
    """Where the defender meets the attacker, and how far that is from the target."""

    y: float  # of the meeting point on the bisector of attacker and defender [m]
    value: float  # distance of attacker and target then [m]; negative: the attacker is at the target first


def escort(a: float, x: float, y: float, alpha: float) -> Escort:
    """Target, attacker and defender: attacker at (a, 0), as fast a defender at (−a, 0), target at (x, y) [m].

    Pachter, Garcia and Casbeer 2014; "The complete differential game of active target defense", arXiv
    2002.04054. `alpha` < 1 is the target's speed over theirs. Attacker and defender meet at (0, Y). A target
    on the defender's side (x ≤ 0) flies away from that point, and the attacker's best is the least of
    α √(a² + Y²) + √((Y − y)² + x²); one on the attacker's side flies through it, and its own best is the
    greatest of α √(a² + Y²) − √((Y − y)² + x²). Both are roots of a quartic, found here by search.
    """

    def own(s: float) -> float:
        return alpha * sqrt(a * a + s * s) + hypot(s - y, x)

    def through(s: float) -> float:
        return hypot(s - y, x) - alpha * sqrt(a * a + s * s)

    if x <= 0.0:
        best = least(own, min(0.0, y), max(0.0, y), 8)
        return Escort(best, own(best))
    reach = abs(y) + 4.0 * (a + x) / (1.0 - alpha)
    best = least(through, -reach, reach, 160)
    return Escort(best, -through(best))


def least(of: Callable[[float], float], low: float, high: float, cells: int) -> float:
    """Where a function is least between two numbers: the best of even cells, then golden section."""
    step = (high - low) / cells
    middle = low + step * min(range(cells + 1), key=lambda k: of(low + k * step))
    a, b = max(low, middle - step), min(high, middle + step)
    for _ in range(60):
        c, d = b - GOLDEN * (b - a), a + GOLDEN * (b - a)
        if of(c) <= of(d):
            b = d
        else:
            a = c
    return 0.5 * (a + b)


class Return(NamedTuple):
    """How the defender of a flag waits for who takes it, and how that ends."""

    bearing: float  # in which the defender flies while the attacker goes for the flag [rad, north to east]
    north: float  # of the place where the attacker is met on its way back [m north of the flag]


def flag_return(east: float, north: float, time: float, speeds: tuple[float, float]) -> Return:
    """Capture the flag: the defender's best place when the attacker takes the flag, home lying to the south.

    Garcia, Casbeer and Pachter, CDC 2018; Garcia and Casbeer 2025, both phases. The defender is (east, north)
    of the flag [m], the attacker takes it in `time` [s]; `speeds` are the attacker's v_A and the defender's
    v_D > v_A [m/s]. From a defender at p the attacker comes south as far as its Apollonius disc does,
    (−λ² p_n − λ |p|) / (1 − λ²), λ = v_A / v_D; the defender flies to where on
    its circle of radius v_D · time that is greatest.
    """
    slower = speeds[0] / speeds[1]
    reach = speeds[1] * time

    def south(bearing: float) -> float:
        n, e = north + reach * cos(bearing), east + reach * sin(bearing)
        return (slower * slower * n + slower * hypot(n, e)) / (1.0 - slower * slower)

    best = least(south, -pi, pi, 180)
    return Return(best, -south(best))
