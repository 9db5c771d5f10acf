"""Mean wind over height: the MIL-F-8785C profile of the standard wind-shear block.

u_w = W20 ln(h / z0) / ln(20 ft / z0), for 3 ft < h < 1000 ft; constant beyond. z0 is 0.15 ft for flight
phases of category C (terminal) and 2.0 ft for all others. Kernel style.
"""

from __future__ import annotations

from math import log

from onboard.core.math.vectors import Vec

FOOT = 0.3048  # [m]
REFERENCE = 20.0 * FOOT  # [m] height of W20
LOWEST = 3.0 * FOOT
HIGHEST = 1000.0 * FOOT
ROUGHNESS_TERMINAL = 0.15 * FOOT  # z0, category C
ROUGHNESS = 2.0 * FOOT  # z0, categories A and B: cruise and manoeuvre


def shear_factor(height: float, roughness: float) -> float:
    """Wind at `height` above ground [m] as a multiple of the wind at 20 ft."""
    h = LOWEST if height < LOWEST else (HIGHEST if height > HIGHEST else height)
    return log(h / roughness) / log(REFERENCE / roughness)


def mean_wind(at_reference: Vec, height: float, shear: bool, roughness: float) -> Vec:
    """Mean wind at `height` above ground [m/s; NED], given that at 20 ft."""
    if not shear:
        return at_reference
    k = shear_factor(height, roughness)
    return Vec(at_reference.x * k, at_reference.y * k, at_reference.z * k)
