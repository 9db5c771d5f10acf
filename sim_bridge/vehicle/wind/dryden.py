"""Dryden gusts after MIL-F-8785C, discretised exactly. Kernel style.

Frozen turbulence met at airspeed V: the longitudinal component is white noise through
H_u = 1/(1 + τ s), the lateral and vertical ones through (1 + √3 τ s)/(1 + τ s)², with τ = L/V. The
states are normalised, so that the components have unit variance whatever the time step and while L and V
change; the rms value multiplies at the end.

Axes: along the mean wind up to 1000 ft, along the body from 2000 ft up; between, the two gusts are
interpolated over height.
"""

from __future__ import annotations

from math import cos, exp, sin, sqrt
from typing import NamedTuple

from onboard.core.math.vectors import Vec
from sim_bridge.draws import WORD, Key, normal, threefry

FOOT = 0.3048  # [m]
ROOT3 = sqrt(3.0)
LOW = 1000.0 * FOOT  # [m] up to here gusts lie along the mean wind
MEDIUM = 2000.0 * FOOT  # [m] from here on along the body
SLOWEST = 1.0  # [m/s] gusts pass a vehicle at rest this fast


class GustState(NamedTuple):
    """States of the gust filters of one vehicle, normalised to unit variance."""

    u: float
    v1: float
    v2: float
    w1: float
    w2: float


class GustNoise(NamedTuple):
    """Five independent standard normal numbers: the drive of one step."""

    u: float
    v1: float
    v2: float
    w1: float
    w2: float


GUST_WORDS = 5  # random numbers an instant of one vehicle's gusts


def gust_noise(key: Key, tick: int) -> GustNoise:
    """What drives one vehicle's gusts at a tick of their grid; `key` is of its gusts' numbers."""
    a, b = threefry(key.a, key.b, tick & WORD, 0)
    c, d = threefry(key.a, key.b, tick & WORD, 1)
    e, _spare = threefry(key.a, key.b, tick & WORD, 2)
    return GustNoise(normal(a), normal(b), normal(c), normal(d), normal(e))


class Scales(NamedTuple):
    """Scale lengths of the turbulence [m]."""

    horizontal: float  # L_u = L_v
    vertical: float  # L_w


def power12(x: float) -> float:
    """x^1.2 for positive x, by roots: x · x^(1/5); interpreted and compiled alike."""
    # Newton for the fifth root of x, from a guess good for 0.1 … 10
    r = 1.0 + 0.2 * (x - 1.0)
    if r < 0.4:
        r = 0.4
    for _ in range(8):
        r4 = r * r * r * r
        r = (4.0 * r + x / r4) / 5.0
    return x * r


def scales(height: float) -> Scales:
    """Scale lengths at `height` above ground [m].

    Low altitude (10–1000 ft): L_w = h, L_u = h / (0.177 + 0.000823 h)^1.2 [ft]. From 2000 ft up 1750 ft;
    linear between.
    """
    h = height / FOOT
    if h < 10.0:
        h = 10.0
    if h >= 2000.0:
        return Scales(1750.0 * FOOT, 1750.0 * FOOT)
    if h > 1000.0:
        both = (1000.0 + 750.0 * (h - 1000.0) / 1000.0) * FOOT
        return Scales(both, both)
    return Scales(h / power12(0.177 + 0.000823 * h) * FOOT, h * FOOT)


def first_gust(noise: GustNoise) -> GustState:
    """A state drawn from the stationary distribution."""
    a = sqrt(0.5)
    b = 0.25 / a
    c = sqrt(0.125)
    return GustState(
        noise.u,
        a * noise.v1,
        b * noise.v1 + c * noise.v2,
        a * noise.w1,
        b * noise.w1 + c * noise.w2,
    )


class Pair(NamedTuple):
    """States of a second-order filter."""

    first: float
    second: float


def step_pair(first: float, second: float, r: float, n1: float, n2: float) -> Pair:
    """(1 + √3 τ s)/(1 + τ s)² over a step of r = dt/τ: exact transition and exact noise covariance."""
    e = exp(-r)
    e2 = e * e
    q11 = 0.5 * (1.0 - e2)
    q12 = 0.25 - e2 * (0.5 * r + 0.25)
    q22 = 0.25 - e2 * (0.5 * r * r + 0.5 * r + 0.25)
    if r < 0.02:  # the differences above cancel: their series
        q12 = r * r * (0.5 - 2.0 * r / 3.0)
        q22 = r * r * r * (1.0 / 3.0 - 0.5 * r)
    l11 = sqrt(max(q11, 1e-300))
    l21 = q12 / l11
    l22 = sqrt(max(0.0, q22 - l21 * l21))
    return Pair(e * first + l11 * n1, e * (second + r * first) + l21 * n1 + l22 * n2)


def step_gust(state: GustState, airspeed: float, height: float, dt: float, noise: GustNoise) -> GustState:
    """The gusts `dt` seconds on, met at `airspeed` [m/s] and `height` above ground [m]."""
    v = airspeed if airspeed > SLOWEST else SLOWEST
    lengths = scales(height)
    r = v * dt / lengths.horizontal
    e = exp(-r)
    lateral = step_pair(state.v1, state.v2, r, noise.v1, noise.v2)
    vertical = step_pair(state.w1, state.w2, v * dt / lengths.vertical, noise.w1, noise.w2)
    return GustState(
        e * state.u + sqrt(max(0.0, 1.0 - e * e)) * noise.u,
        lateral.first,
        lateral.second,
        vertical.first,
        vertical.second,
    )


class GustAxes(NamedTuple):
    """Along what a vehicle's gusts are longitudinal."""

    wind_x: float  # level unit vector along the mean wind [NED]
    wind_y: float
    yaw: float  # of the nose [rad]
    pitch: float  # of the nose [rad, up]
    height: float  # above ground [m]


def body_share(height: float) -> float:
    """Share of the body's axes at `height` above ground [m]: 0 to 1000 ft, 1 from 2000 ft, linear between."""
    if height <= LOW:
        return 0.0
    if height >= MEDIUM:
        return 1.0
    return (height - LOW) / (MEDIUM - LOW)


def gust_of(state: GustState, sigma: float, axes: GustAxes) -> Vec:
    """The gust [m/s; NED], rms `sigma` an axis below 1000 ft and above 2000 ft.

    Between, the gust in the mean wind's axes and that in the body's are interpolated, as the standard has
    it. The body's lateral axis is taken level: above 2000 ft the lateral and the vertical gust have one
    spectrum, so that a bank changes neither.
    """
    u = sigma * state.u
    v = sigma * (ROOT3 * state.v1 + (1.0 - ROOT3) * state.v2)
    w = sigma * (ROOT3 * state.w1 + (1.0 - ROOT3) * state.w2)
    share = body_share(axes.height)
    low = 1.0 - share
    c = cos(axes.yaw)
    s = sin(axes.yaw)
    up = sin(axes.pitch)
    level = cos(axes.pitch)
    along = u * level + w * up  # of the body's u and w, level and along the heading
    return Vec(
        low * (u * axes.wind_x - v * axes.wind_y) + share * (along * c - v * s),
        low * (u * axes.wind_y + v * axes.wind_x) + share * (along * s + v * c),
        low * w + share * (w * level - u * up),
    )
