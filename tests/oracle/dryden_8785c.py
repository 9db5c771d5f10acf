"""MIL-F-8785C, 3.7: Dryden gusts from the published transfer functions. SciPy alone, feet inside.

Forming filters driven by white noise of unit two-sided spectral density, L in ft, V in ft/s:
H_u = σ √(2 τ_u) / (1 + τ_u s), H_v = σ √τ_v (1 + √3 τ_v s)/(1 + τ_v s)², the same with τ_w, τ = L / V.
(The standard's spectra are one-sided in Ω, over 0…∞, and divided by π: σ² 2L/π / (1 + (LΩ)²) and
σ² L/π (1 + 3 (LΩ)²)/(1 + (LΩ)²)², each of which gives σ².)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm, solve_continuous_lyapunov
from scipy.signal import tf2ss

Array = NDArray[np.float64]
FOOT = 0.3048


def lengths(feet: float) -> tuple[float, float]:
    """L_u = L_v and L_w [ft] at a height [ft]: low altitude, from 2000 ft up, linear between."""
    if feet <= 1000.0:
        return feet / (0.177 + 0.000823 * feet) ** 1.2, feet
    if feet >= 2000.0:
        return 1750.0, 1750.0
    low = 1000.0 / (0.177 + 0.823) ** 1.2
    share = (feet - 1000.0) / 1000.0
    return low + share * (1750.0 - low), 1000.0 + share * 750.0


def spectrum(component: str, feet: float, knots_fps: float, sigma: float, omega: Array) -> Array:
    """One-sided spectrum over ω [(ft/s)²/(rad/s)] met at a speed [ft/s]: Φ(Ω)/V at Ω = ω/V."""
    horizontal, vertical = lengths(feet)
    length = vertical if component == "w" else horizontal
    x = (length * omega / knots_fps) ** 2
    if component == "u":
        return sigma**2 * 2.0 * length / np.pi / (1.0 + x) / knots_fps
    return sigma**2 * length / np.pi * (1.0 + 3.0 * x) / (1.0 + x) ** 2 / knots_fps


class Filter:
    """One component as a state space, driven by white noise: covariances by Lyapunov's equation."""

    def __init__(self, component: str, feet: float, fps: float, sigma: float) -> None:
        horizontal, vertical = lengths(feet)
        tau = (vertical if component == "w" else horizontal) / fps
        if component == "u":
            top, bottom = [sigma * np.sqrt(2.0 * tau)], [tau, 1.0]
        else:
            scale = sigma * np.sqrt(tau)
            top, bottom = [scale * np.sqrt(3.0) * tau, scale], [tau**2, 2.0 * tau, 1.0]
        self.a, self.b, self.c, _ = tf2ss(top, bottom)
        self.spread = solve_continuous_lyapunov(self.a, -self.b @ self.b.T)

    @property
    def variance(self) -> float:
        """Of the component, [(ft/s)²]."""
        return float((self.c @ self.spread @ self.c.T).item())

    def covariance(self, lag: float) -> float:
        """Of the component with itself `lag` [s] later."""
        return float((self.c @ expm(self.a * lag) @ self.spread @ self.c.T).item())

    def density(self, omega: Array) -> Array:
        """One-sided spectrum over ω: |H(jω)|² / π."""
        one = np.eye(len(self.a))
        response = [(self.c @ np.linalg.solve(1j * w * one - self.a, self.b)).item() for w in omega]
        return np.abs(np.array(response)) ** 2 / np.pi
