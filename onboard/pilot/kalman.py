"""The Kalman filter of a track: three axes at constant velocity under white acceleration. Kernel style.

The strength of that acceleration follows the innovations: it rises while they are larger than the filter
believes and falls while they are smaller.
"""

from __future__ import annotations

from math import exp, log
from typing import NamedTuple

from onboard.core.math.vectors import Vec

Variance = tuple[float, float, float, float, float, float]  # diagonal: position [m²], velocity [m²/s²]
SURPRISE_MAX = 25.0  # a larger innovation teaches no more than this


class Axis(NamedTuple):
    """One axis: estimate and covariance."""

    x: float  # [m]
    v: float  # [m/s]
    xx: float  # [m²]
    xv: float  # [m²/s]
    vv: float  # [m²/s²]


Axes = tuple[Axis, Axis, Axis]  # north, east, down


class Measured(NamedTuple):
    """A measurement of a track."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    variance: Variance  # velocity entries < 0: not measured


class Learning(NamedTuple):
    """How the density follows the innovations."""

    density_min: float  # [m²/s³]
    density_max: float
    rate: float  # per measurement, logarithmic


class Filtered(NamedTuple):
    """A filter after a measurement."""

    axes: Axes
    density: float  # of the white acceleration [m²/s³]


class Correction(NamedTuple):
    """An axis after a measurement, and how much it was surprised."""

    axis: Axis
    surprise: float  # normalised innovations squared, summed
    terms: int  # how many


def carry_axis(a: Axis, dt: float, density: float) -> Axis:
    """An axis `dt` seconds later under white acceleration of a density."""
    return Axis(
        a.x + dt * a.v,
        a.v,
        a.xx + dt * (2.0 * a.xv + dt * (a.vv + density * dt / 3.0)),
        a.xv + dt * (a.vv + density * dt / 2.0),
        a.vv + density * dt,
    )


def carry(axes: Axes, dt: float, density: float) -> Axes:
    """All axes `dt` seconds later."""
    a, b, c = axes
    return (carry_axis(a, dt, density), carry_axis(b, dt, density), carry_axis(c, dt, density))


def correct_axis(axis: Axis, x: float, r: float, v: float, rv: float) -> Correction:
    """An axis that meets a position `x` of variance `r`, then a velocity `v` of variance `rv` (< 0: none)."""
    s = axis.xx + r
    y = x - axis.x
    surprise = y * y / s
    terms = 1
    kx = axis.xx / s
    kv = axis.xv / s
    axis = Axis(axis.x + kx * y, axis.v + kv * y, axis.xx * r / s, axis.xv * r / s, axis.vv - kv * axis.xv)
    if rv >= 0.0:
        s = axis.vv + rv
        y = v - axis.v
        surprise += y * y / s
        terms = 2
        kx = axis.xv / s
        kv = axis.vv / s
        axis = Axis(
            axis.x + kx * y, axis.v + kv * y, axis.xx - kx * axis.xv, axis.xv * rv / s, axis.vv * rv / s
        )
    return Correction(axis, surprise, terms)


def corrected(axes: Axes, density: float, m: Measured, learning: Learning) -> Filtered:
    """The filter after a measurement, its axes carried to that instant before."""
    r = m.variance
    a = correct_axis(axes[0], m.position.x, r[0], m.velocity.x, r[3])
    b = correct_axis(axes[1], m.position.y, r[1], m.velocity.y, r[4])
    c = correct_axis(axes[2], m.position.z, r[2], m.velocity.z, r[5])
    ratio = min((a.surprise + b.surprise + c.surprise) / (a.terms + b.terms + c.terms), SURPRISE_MAX)
    level = log(density) + learning.rate * (ratio - 1.0)
    low = log(learning.density_min)
    high = log(learning.density_max)
    return Filtered((a.axis, b.axis, c.axis), exp(min(max(level, low), high)))
