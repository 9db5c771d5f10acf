"""From how far a faster evader passes a wall of pursuers by one hard turn, whatever they do. Kernel style.

The evader flies at the middle of pursuers abreast that come head on. At time 0, d away, it turns as hard as
it can: after t it is r_e sin ω_e t on and y_e = r_e (1 − cos ω_e t) across, r = v/ω. No pursuer is farther
across than W + r_p (1 − cos ω_p t), W being half the wall's width, nor farther on than v_p t. Nobody captures
it where at every t of a quarter turn more than R is left, of d − v_p t − r_e sin ω_e t on and what it has won
across, y_e − W − r_p (1 − cos ω_p t). For small angles that is ½ (ω_e v_e − ω_p v_p) t² = W + R at
d = (v_e + v_p) t.
"""

from __future__ import annotations

from math import cos, inf, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.math.vectors import TINY

SAMPLES = 200  # of the turn until they meet, and after that
HALVINGS = 40


class Turner(NamedTuple):
    """How fast one flies and turns."""

    speed: float  # [m/s]
    rate: float  # [rad/s]


def on_at(t: float, evader: Turner, pursuer: Turner, far: float) -> float:
    """How much of the way is left from the evader to the farthest that pursuers can be on [m], or 0."""
    return max(0.0, far - pursuer.speed * t - evader.speed / evader.rate * sin(evader.rate * t))


def won_at(t: float, evader: Turner, pursuer: Turner, half_width: float) -> float:
    """How far across the evader is of the farthest that pursuers can be [m]; 0 while it is not."""
    swept = min(pursuer.rate * t, 0.5 * pi)
    theirs = half_width + pursuer.speed / pursuer.rate * (1.0 - cos(swept))
    theirs = theirs + pursuer.speed * max(0.0, t - swept / pursuer.rate)
    return max(0.0, evader.speed / evader.rate * (1.0 - cos(evader.rate * t)) - theirs)


def room_of(evader: Turner, pursuer: Turner, half_width: float, far: float) -> float:
    """The least distance from whatever pursuers can reach, in a dodge begun `far` [m] away [m]."""
    quarter = 0.5 * pi / evader.rate
    low, met = 0.0, quarter
    for _ in range(HALVINGS):
        middle = 0.5 * (low + met)
        if on_at(middle, evader, pursuer, far) > 0.0:
            low = middle
        else:
            met = middle
    least = inf
    for k in range(2 * SAMPLES + 1):
        t = met * k / SAMPLES if k <= SAMPLES else met + (quarter - met) * (k - SAMPLES) / SAMPLES
        on = on_at(t, evader, pursuer, far)
        across = won_at(t, evader, pursuer, half_width)
        least = min(least, sqrt(on * on + across * across))
    return least


def dodge_always(evader: Turner, pursuer: Turner, half_width: float, radius: float) -> float:
    """From which distance on a dodge passes a wall of `half_width` [m] for certain; inf: by no quarter turn.

    `radius` is R [m]; both turn no faster than their `rate` > 0. One pursuer is a wall of 0.
    """
    if evader.rate <= TINY or pursuer.rate <= TINY:
        return inf
    high = (0.5 * pi * pursuer.speed + evader.speed) / evader.rate  # they meet at the end of the turn
    if room_of(evader, pursuer, half_width, high) <= radius:
        return inf
    low = 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if room_of(evader, pursuer, half_width, middle) > radius:
            high = middle
        else:
            low = middle
    return high


def wall_needed(evader: Turner, pursuer: Turner, spacing: float, radius: float, far: float) -> int:
    """How many abreast, `spacing` [m] apart, no dodge begun within `far` [m] is certain to pass; 0: none.

    This is necessary for a capture of whoever dodges, not enough for it.
    """
    for count in range(1, 100):
        if dodge_always(evader, pursuer, 0.5 * (count - 1) * spacing, radius) > far:
            return count
    return 0
