"""Elementary functions without a branch or a table, so that a compiler runs them for several numbers at once.

Range reductions and polynomials of fdlibm (Sun Microsystems, 1993: k_sin.c, k_cos.c, e_asin.c, e_log.c),
within a few units in the last place of the functions of `math` that they stand for. Kernel style. What they
ask of their arguments is what flight gives: angles below 1e5 rad, arguments of `exp` within ±700, of `log`
above 1e-300.
"""

from __future__ import annotations

from math import floor, pi, sqrt
from typing import NamedTuple

import numpy as np

from onboard.core.math.angles import TURN

TWO_OVER_PI = 2.0 / pi
HALF_PI_HIGH = 1.57079632673412561417e00  # 33 bits of π/2
HALF_PI_LOW = 6.07710050650619224932e-11  # and the rest
LOG2_E = 1.4426950408889634
LN2_HIGH = 6.93147180369123816490e-01
LN2_LOW = 1.90821492927058770002e-10
ROOT2 = 1.4142135623730951
MANTISSA = 0xFFFFFFFFFFFFF
ONE = 0x3FF0000000000000  # the bits of 1.0


class SinCos(NamedTuple):
    """Both of an angle."""

    sin: float
    cos: float


def sin_cos(angle: float) -> SinCos:
    """Sine and cosine of an angle [rad]."""
    n = floor(angle * TWO_OVER_PI + 0.5)
    r = (angle - n * HALF_PI_HIGH) - n * HALF_PI_LOW
    z = r * r
    s = 2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)
    s = 8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * s)
    s = r + r * z * (-1.66666666666666324348e-01 + z * s)
    c = -2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)
    c = -1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 + z * c)
    c = 1.0 - 0.5 * z + z * z * (4.16666666666666019037e-02 + z * c)
    quarter = n - 4.0 * floor(n * 0.25)
    odd = quarter == 1.0 or quarter == 3.0
    first = c if odd else s
    second = s if odd else c
    return SinCos(
        -first if quarter >= 2.0 else first, -second if (quarter == 1.0 or quarter == 2.0) else second
    )


def lane_sin(angle: float) -> float:
    """Sine of an angle [rad]."""
    return sin_cos(angle).sin


def lane_cos(angle: float) -> float:
    """Cosine of an angle [rad]."""
    return sin_cos(angle).cos


def lane_tan(angle: float) -> float:
    """Tangent of an angle [rad]."""
    both = sin_cos(angle)
    return both.sin / both.cos


def lane_wrap(angle: float) -> float:
    """The same direction as `angle` [rad], as an angle in [−π, π)."""
    return angle - TURN * floor((angle + pi) / TURN)


def lane_asin(x: float) -> float:
    """Arc sine [rad] of a number in [−1, 1]."""
    a = abs(x)
    steep = a > 0.5
    t = 0.5 * (1.0 - a) if steep else a * a
    p = -4.00555345006794114027e-02 + t * (7.91534994289814532176e-04 + t * 3.47933107596021167570e-05)
    p = -3.25565818622400915405e-01 + t * (2.01212532134862925881e-01 + t * p)
    p = t * (1.66666666666666657415e-01 + t * p)
    q = -6.88283971605453293030e-01 + t * 7.70381505559019352791e-02
    q = 1.0 + t * (-2.40339491173441421878e00 + t * (2.02094576023350569471e00 + t * q))
    root = sqrt(t)
    found = 0.5 * pi - 2.0 * (root + root * (p / q)) if steep else a + a * (p / q)
    return -found if x < 0.0 else found


def lane_atan(x: float) -> float:
    """Arc tangent [rad]."""
    a = abs(x)
    far = a > 1.0
    t = 1.0 / a if far else a
    found = lane_asin(t / sqrt(1.0 + t * t))
    found = 0.5 * pi - found if far else found
    return -found if x < 0.0 else found


def lane_exp(x: float) -> float:
    """e to the power of a number."""
    n = floor(x * LOG2_E + 0.5)
    r = (x - n * LN2_HIGH) - n * LN2_LOW
    p = 1.0 / 39916800.0 + r / 479001600.0
    p = 1.0 / 40320.0 + r * (1.0 / 362880.0 + r * (1.0 / 3628800.0 + r * p))
    p = 1.0 / 120.0 + r * (1.0 / 720.0 + r * (1.0 / 5040.0 + r * p))
    p = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * p))))
    return float(p * np.int64((np.int64(n) + 1023) << 52).view(np.float64))


def lane_log(x: float) -> float:
    """Natural logarithm of a positive number."""
    bits = np.float64(x).view(np.int64)
    exponent = np.float64((bits >> 52) - 1023)
    m = np.int64((bits & MANTISSA) | ONE).view(np.float64)
    high = m > ROOT2
    m = 0.5 * m if high else m
    k = exponent + 1.0 if high else exponent
    f = m - 1.0
    s = f / (2.0 + f)
    z = s * s
    r = 1.818357216161805012e-01 + z * (1.531383769920937332e-01 + z * 1.479819860511658591e-01)
    r = 2.857142874366239149e-01 + z * (2.222219843214978396e-01 + z * r)
    r = z * (6.666666666666735130e-01 + z * (3.999999999940941908e-01 + z * r))
    h = 0.5 * f * f
    return float(k * LN2_HIGH - ((h - (s * (h + r) + k * LN2_LOW)) - f))


def lane_power12(x: float) -> float:
    """x^1.2 for positive x."""
    return lane_exp(1.2 * lane_log(x))
