"""Interacting multiple models over one track: constant velocity, and a coordinated turn of unknown rate.

Blom and Bar-Shalom, "The interacting multiple model algorithm for systems with Markovian switching
coefficients", IEEE Trans. Automatic Control 33 (1988); the turn's model as in Bar-Shalom, Li and Kirubarajan,
*Estimation with Applications to Tracking and Navigation*, 11.7. Both models live in the horizontal plane with
the state (north, east, velocities, turn rate); height is left to others. A sample older than the newest is
left out: what a filter of two models would gain by replaying it is little.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, exp, isfinite, nan, pi, sin
from typing import NamedTuple

import numpy as np

from onboard.core.math.constants import NEVER
from onboard.core.math.vectors import Vec
from onboard.pilot.kalman import Variance
from onboard.pilot.predictor.activation import Array

STATES = 5  # north, east [m], velocities [m/s], turn rate [rad/s], positive to the right
STRAIGHT, TURNING = 0, 1  # the models


class ManoeuvreSettings(NamedTuple):
    """Settings of the filter."""

    density: tuple[float, float] = (0.3, 2.0)  # white acceleration of each model [m²/s³]
    turn_density: float = 0.01  # of the turn rate's random walk [rad²/s³]
    turn_unknown: float = 0.3  # turn rate before anything is known [rad/s]
    stay: float = 8.0  # mean time in a model [s]
    gap_max: float = 2.0  # a longer silence begins anew [s]
    velocity_unknown: float = 30.0  # velocity error before any was measured [m/s]


class ManoeuvreFilter:
    """Follows one target and says where it goes if it keeps turning as it does."""

    def __init__(self, settings: ManoeuvreSettings | None = None) -> None:
        self.settings = ManoeuvreSettings() if settings is None else settings
        self.newest = NEVER  # instant of the newest sample [s]
        self.shares = np.array([0.5, 0.5])  # probability of each model
        self._x = np.zeros((2, STATES))
        self._p = np.zeros((2, STATES, STATES))
        self._noise_of = (0.0, self._p)  # time carried over last, and the noise of that

    def clear(self) -> None:
        """Forget everything."""
        self.newest = NEVER

    def add(self, t: float, position: Vec, velocity: Vec | None, variance: Variance) -> None:
        """Take a sample that a TrackFilter has taken (units: TrackFilter.add); an older one is left out."""
        measured = velocity is not None and min(variance[3:5]) >= 0.0
        moving = velocity if velocity is not None and measured else Vec(0.0, 0.0, 0.0)
        if not 0.0 < t - self.newest <= self.settings.gap_max:
            if t > self.newest:
                self._begin(t, position, moving, variance, measured)
            return
        self._carry(t - self.newest)
        self.newest = t
        wanted = (position.x, position.y, moving.x, moving.y)
        spread = (*variance[:2], *variance[3:5])
        score = np.zeros(2)
        for i in range(4 if measured else 2):
            score += self._correct(i, wanted[i], max(spread[i], 1e-4))
        if not self._sound(score):
            self._begin(t, position, moving, variance, measured)
            return
        weight = self.shares * np.exp(score - score.max())
        self.shares = np.maximum(weight / weight.sum(), 1e-4)
        self.shares /= self.shares.sum()

    def places(self, ahead: Sequence[float] | Array) -> list[tuple[float, float]]:
        """Expected places (n, 2) [m; north, east] so many seconds (n,) after the newest sample."""
        models = list(zip(self.shares.tolist(), self._x.tolist(), strict=True))
        out = []
        for time in ahead:
            north = east = 0.0
            for share, x in models:
                n, e = _carried(x, time)
                north, east = north + share * n, east + share * e
            out.append((north, east))
        return out

    def _begin(self, t: float, position: Vec, velocity: Vec, variance: Variance, measured: bool) -> None:
        """Begin anew with one sample."""
        unknown = self.settings.velocity_unknown**2
        vn, ve = variance[3:5] if measured else (unknown, unknown)
        self.newest = t
        self.shares = np.array([0.5, 0.5])
        self._x = np.array([[position.x, position.y, velocity.x, velocity.y, 0.0]] * 2)
        rate = self.settings.turn_unknown**2
        self._p = np.array([np.diag([variance[0], variance[1], vn, ve, rate])] * 2)

    def _carry(self, dt: float) -> None:
        """Mix the models, then carry each by `dt` [s]."""
        keep = exp(-dt / self.settings.stay)
        change = np.array([[keep, 1.0 - keep], [1.0 - keep, keep]])
        after = self.shares @ change
        weights = (self.shares[:, None] * change / after).T  # (to, from)
        mixed = weights @ self._x
        apart = self._x[None] - mixed[:, None]  # (to, from, 5)
        spread = self._p[None] + apart[..., :, None] * apart[..., None, :]
        covariance = (weights[:, :, None, None] * spread).sum(axis=1)
        self.shares = after
        straight, state = _straight(dt), mixed[TURNING].tolist()
        moves = np.array([straight, turning(state, dt)])
        mixed[STRAIGHT, 4] = 0.0
        self._p = moves @ covariance @ moves.transpose(0, 2, 1) + self._noise(dt)
        self._x = np.array([straight @ mixed[STRAIGHT], turned(state, dt)])

    def _noise(self, dt: float) -> Array:
        """Process noise (2, 5, 5) over `dt` [s]; samples mostly come evenly."""
        if dt == self._noise_of[0]:
            return self._noise_of[1]
        out = np.zeros((2, STATES, STATES))
        for model, q in enumerate(self.settings.density):
            for i in (0, 1):
                out[model, i, i] = q * dt**3 / 3.0
                out[model, i, i + 2] = out[model, i + 2, i] = q * dt**2 / 2.0
                out[model, i + 2, i + 2] = q * dt
        out[TURNING, 4, 4] = self.settings.turn_density * dt
        out[STRAIGHT, 4, 4] = self.settings.turn_unknown**2 * 0.1
        self._noise_of = (dt, out)
        return out

    def _correct(self, i: int, wanted: float, r: float) -> Array:
        """Take one measured element of the state; gives each model's log-likelihood."""
        s = self._p[:, i, i] + r
        y = wanted - self._x[:, i]
        gain = self._p[:, :, i] / s[:, None]
        self._x = self._x + gain * y[:, None]
        self._p = self._p - gain[:, :, None] * self._p[:, None, i, :]
        out: Array = -0.5 * (y * y / s + np.log(2.0 * pi * np.maximum(s, 1e-12)))
        return out

    def _sound(self, score: Array) -> bool:
        """Whether numbers are finite and variances positive: digits run out between samples good to a
        millimetre and such good to a thousand kilometres."""
        variances = self._p.reshape(2, -1)[:, :: STATES + 1]
        return isfinite(score.sum()) and isfinite(self._x.sum()) and bool(variances.min() >= 0.0)


def _straight(dt: float) -> Array:
    """The transition of constant velocity; the turn rate is forgotten."""
    out = np.eye(STATES)
    out[0, 2] = out[1, 3] = dt
    out[4, 4] = 0.0
    return out


def _carried(x: list[float], dt: float) -> tuple[float, float]:
    """Place north and east [m] of a state after `dt` seconds of its turn; NaN where digits ran out."""
    rate = x[4] if abs(x[4]) > 1e-6 else 1e-6
    angle = rate * dt
    if not isfinite(angle):
        return nan, nan
    along, across = sin(angle) / rate, (1.0 - cos(angle)) / rate
    return x[0] + along * x[2] - across * x[3], x[1] + across * x[2] + along * x[3]


def turned(x: list[float], dt: float) -> list[float]:
    """A state after `dt` seconds of its turn."""
    n, e, vn, ve, rate = x
    safe = rate if abs(rate) > 1e-6 else 1e-6
    angle = safe * dt
    s, c = np.sin(angle), np.cos(angle)
    along, across = s / safe, (1.0 - c) / safe
    north, east = n + along * vn - across * ve, e + across * vn + along * ve
    return [north, east, c * vn - s * ve, s * vn + c * ve, rate]


def turning(x: list[float], dt: float) -> Array:
    """Derivative (5, 5) of `turned` by the state."""
    _, _, vn, ve, rate = x
    safe = rate if abs(rate) > 1e-6 else 1e-6
    angle = safe * dt
    s, c = np.sin(angle), np.cos(angle)
    along, across = s / safe, (1.0 - c) / safe
    dalong = (angle * c - s) / (safe * safe)
    dacross = (angle * s - (1.0 - c)) / (safe * safe)
    out = np.eye(STATES)
    out[0, 2], out[0, 3], out[0, 4] = along, -across, dalong * vn - dacross * ve
    out[1, 2], out[1, 3], out[1, 4] = across, along, dacross * vn + dalong * ve
    out[2, 2], out[2, 3], out[2, 4] = c, -s, dt * (-s * vn - c * ve)
    out[3, 2], out[3, 3], out[3, 4] = s, c, dt * (c * vn - s * ve)
    return out
