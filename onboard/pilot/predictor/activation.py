"""The s-parabola activation: (23)–(26), its derivative and its inverse.

Both branches: f(s) = β + √(2 p s) for s > 0 and β − √(−2 p s) for s < 0, so f(0) = β. The
second derivatives are printed with x in the denominator; differentiating gives 2x:
f'' = ∓ p / (2 |x| √(2 p |x|)). The paper states β ∈ [0, 1) and uses β = −0.5 in 3.5.2: any
real number is accepted here.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class SParabola(NamedTuple):
    """The activation with its two parameters. Every method works element by element."""

    p: float = 0.25  # > 0: the parabola's parameter
    beta: float = -0.5  # displacement along OY

    def value(self, s: Array) -> Array:
        """f(s), (25)–(26)."""
        out: Array = np.copysign(np.sqrt(np.abs(2.0 * self.p * s)), s) + self.beta
        return out

    def slope(self, s: Array) -> Array:
        """f'(s), (23)–(24): even in s, infinite at 0."""
        with np.errstate(divide="ignore"):
            out: Array = self.p / np.sqrt(np.abs(2.0 * self.p * s))
        return out

    def curvature(self, s: Array) -> Array:
        """f''(s), (23)–(24) corrected: odd in s, negative on the upper branch."""
        size = np.abs(s)
        with np.errstate(divide="ignore"):
            out: Array = -np.copysign(self.p / (2.0 * size * np.sqrt(2.0 * self.p * size)), s)
        return out

    def inverse(self, y: Array) -> Array:
        """s with f(s) = y: the branch follows from the sign of y − β (the corrected (27)–(28))."""
        rise = y - self.beta
        out: Array = rise * np.abs(rise) / (2.0 * self.p)
        return out

    def inverse_printed(self, y: Array, s: Array) -> Array:
        """(27)–(28) as printed: the branch follows from the sign of the current s."""
        rise = y - self.beta
        out: Array = np.copysign(rise * rise / (2.0 * self.p), s)
        return out

    def upper(self, s: Array) -> Array:
        """The upper branch alone: β + √(2 p s), and β for s ≤ 0."""
        out: Array = np.sqrt(2.0 * self.p * np.maximum(s, 0.0)) + self.beta
        return out

    def upper_slope(self, s: Array) -> Array:
        """The upper branch's derivative: (23) for s > 0, zero below, infinite at 0."""
        out: Array = np.where(s < 0.0, 0.0, self.slope(s))
        return out

    def upper_inverse(self, y: Array) -> Array:
        """s ≥ 0 with upper(s) = y; 0 for y ≤ β."""
        rise = np.maximum(y - self.beta, 0.0)
        out: Array = rise * rise / (2.0 * self.p)
        return out


def smooth_root(s: Array, epsilon: float) -> Array:
    """s / (s² + ε²)^¼: the signed root √|s| with a finite slope at 0. For training only."""
    out: Array = s / np.sqrt(np.sqrt(s * s + epsilon * epsilon))
    return out


def smooth_root_slope(s: Array, epsilon: float) -> Array:
    """Derivative of `smooth_root`: (s²/2 + ε²) / (s² + ε²)^(5/4)."""
    square = s * s
    base = square + epsilon * epsilon
    out: Array = (0.5 * square + epsilon * epsilon) / (base * np.sqrt(np.sqrt(base)))
    return out
