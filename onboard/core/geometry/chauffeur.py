"""The homicidal chauffeur (Isaacs): a slower evader that turns at once, a faster pursuer that cannot."""

from __future__ import annotations

from math import asin, sqrt


def sure_radius(v_e: float, v_p: float, turn_rate: float) -> float:
    """The capture radius [m] above which one pursuer captures such an evader from everywhere in the plane.

    r (√(1 − w²) + w asin w − 1), with r = v_p / ω the turning radius, w = v_e / v_p < 1: there the two
    barriers just touch. Below it they meet, and the evader slips aside for ever if it starts outside them.
    `turn_rate` is the pursuer's ω [rad/s], 0 = it turns at once.
    """
    if turn_rate <= 0.0 or v_p <= 0.0:
        return 0.0
    w = min(1.0, v_e / v_p)
    return v_p / turn_rate * (sqrt(1.0 - w * w) + w * asin(w) - 1.0)
