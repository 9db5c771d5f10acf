"""Tracking filters of the textbooks, by filterpy: nothing here comes from the product.

Constant velocity, Singer's model, a coordinated turn by an extended Kalman filter, and an interacting
multiple model of the first and the third. All see the horizontal places of a sensor. Each has one or two
numbers to tune, on seeds that nothing is judged on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product
from math import cos, sin
from typing import Any, NamedTuple, Protocol

import numpy as np
from filterpy.common import van_loan_discretization
from filterpy.kalman import ExtendedKalmanFilter, IMMEstimator, KalmanFilter

from tests.benchmarks.predictor.families import Array

PLACES = np.array([[1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0]])  # of (n, e, vn, ve, turn rate)


class Baseline(Protocol):
    """A filter of horizontal places at a fixed rate."""

    def add(self, place: Array) -> None:
        """Take a measurement (2,) [m], one step after the one before."""
        ...

    def ahead(self, seconds: Array) -> Array:
        """Expected places (n, 2) [m] so long (n,) after the newest measurement."""
        ...


class ConstantVelocity:
    """White acceleration of density q [m²/s³]."""

    def __init__(self, first: Array, dt: float, sigma: float, q: float) -> None:
        self.f = KalmanFilter(dim_x=5, dim_z=2)
        start(self.f, first, sigma, sigma**2)
        self.f.F = np.eye(5)
        self.f.F[0, 2] = self.f.F[1, 3] = dt
        self.f.F[4, 4] = 0.0
        self.f.Q = white(dt, q, 1e-3)

    def add(self, place: Array) -> None:
        self.f.predict()
        self.f.update(place)

    def ahead(self, seconds: Array) -> Array:
        return straight(self.f.x.ravel(), seconds)


class Singer:
    """Acceleration as a first-order Gauss–Markov process (Singer, IEEE Trans. AES-6, 1970): its standard
    deviation [m/s²] and correlation time [s]."""

    def __init__(self, first: Array, dt: float, sigma: float, strength: float, tau: float) -> None:
        self.tau = tau
        a = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0 / tau]])
        drive = np.array([[0.0], [0.0], [np.sqrt(2.0 / tau) * strength]])
        f, q = van_loan_discretization(a, drive, dt)
        self.axes = []
        for place in first:
            one = KalmanFilter(dim_x=3, dim_z=1)
            one.x = np.array([[place], [0.0], [0.0]])
            one.P = np.diag([sigma**2, 60.0**2, strength**2])
            one.F, one.Q, one.H, one.R = f, q, np.array([[1.0, 0.0, 0.0]]), np.array([[sigma**2]])
            self.axes.append(one)

    def add(self, place: Array) -> None:
        for one, value in zip(self.axes, place, strict=True):
            one.predict()
            one.update(value)

    def ahead(self, seconds: Array) -> Array:
        fade = 1.0 - np.exp(-seconds / self.tau)
        columns = []
        for one in self.axes:
            p, v, a = one.x.ravel()
            columns.append(p + v * seconds + a * self.tau * (seconds - self.tau * fade))
        return np.stack(columns, axis=1)


class Turn(ExtendedKalmanFilter):  # type: ignore[misc]
    """A coordinated turn whose rate wanders by density w [rad²/s³]."""

    def __init__(self, first: Array, dt: float, sigma: float, q: float, w: float) -> None:
        super().__init__(dim_x=5, dim_z=2)
        start(self, first, sigma, 0.3**2)
        self.dt = dt
        self.Q = white(dt, q, w * dt)

    def predict_x(self, u: Any = 0) -> None:
        """Turn on; the derivative is taken by differences."""
        x = self.x.ravel()
        base = turned(x, self.dt)
        step = 1e-5
        self.F = np.stack([(turned(x + step * e, self.dt) - base) / step for e in np.eye(5)], axis=1)
        self.x = base.reshape(-1, 1)

    def update(self, z: Array, *_: Any, **__: Any) -> None:
        super().update(np.reshape(z, (2, 1)), lambda _: PLACES, lambda x: PLACES @ x)

    def add(self, place: Array) -> None:
        self.predict()
        self.update(place)

    def ahead(self, seconds: Array) -> Array:
        return np.array([turned(self.x.ravel(), s)[:2] for s in seconds])


class Interacting:
    """Constant velocity and turn, each left after `stay` [s] on the mean."""

    def __init__(self, first: Array, dt: float, sigma: float, q: float, stay: float) -> None:
        steady, turn = ConstantVelocity(first, dt, sigma, q).f, Turn(first, dt, sigma, q, 0.02)
        leave = dt / stay
        change = np.array([[1.0 - leave, leave], [leave, 1.0 - leave]])
        self.imm = IMMEstimator([steady, turn], np.array([0.5, 0.5]), change)
        self.turn = turn

    def add(self, place: Array) -> None:
        self.imm.predict()
        self.imm.update(np.reshape(place, (2, 1)))

    def ahead(self, seconds: Array) -> Array:
        steady, turn = (one.x.ravel() for one in self.imm.filters)
        round_ = np.array([turned(turn, s)[:2] for s in seconds])
        return self.imm.mu[0] * straight(steady, seconds) + self.imm.mu[1] * round_  # type: ignore[no-any-return]


def start(f: Any, first: Array, sigma: float, rate: float) -> None:
    """Begin a filter of five states at a first place."""
    f.x = np.array([[first[0]], [first[1]], [0.0], [0.0], [0.0]])
    f.P = np.diag([sigma**2, sigma**2, 60.0**2, 60.0**2, rate])
    f.H, f.R = PLACES, np.eye(2) * sigma**2


def white(dt: float, q: float, rate: float) -> Array:
    """Noise of white acceleration in both axes, and of the turn rate."""
    _, one = van_loan_discretization(np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [np.sqrt(q)]]), dt)
    out = np.zeros((5, 5))
    out[np.ix_([0, 2], [0, 2])] = out[np.ix_([1, 3], [1, 3])] = one
    out[4, 4] = rate
    return out


def straight(x: Array, seconds: Array) -> Array:
    """Places at constant velocity."""
    out: Array = x[:2] + seconds[:, None] * x[2:4]
    return out


def turned(x: Array, dt: float) -> Array:
    """A state after a turn at constant rate."""
    n, e, vn, ve, w = x.tolist()
    w = w if abs(w) > 1e-7 else 1e-7
    s, c = sin(w * dt), cos(w * dt)
    north, east = n + (s * vn - (1.0 - c) * ve) / w, e + ((1.0 - c) * vn + s * ve) / w
    return np.array([north, east, c * vn - s * ve, s * vn + c * ve, w])


class Kind(NamedTuple):
    """A baseline and the numbers to choose from."""

    make: Callable[..., Baseline]
    choices: tuple[tuple[float, ...], ...]


KINDS = {
    "constant velocity": Kind(ConstantVelocity, ((10.0, 30.0, 100.0, 300.0),)),
    "Singer": Kind(Singer, ((10.0, 20.0), (1.0, 3.0))),
    "coordinated turn, EKF": Kind(Turn, ((3.0,), (0.01, 0.03, 0.1, 0.3))),
    "IMM of both": Kind(Interacting, ((1.0, 3.0), (2.0, 5.0))),
}


def forecasts(one: Baseline, places: Iterable[Array], seconds: Array, since: int) -> Array:
    """Expected places (k, n, 2) after each measurement from number `since` on."""
    out = []
    for number, place in enumerate(places, start=1):
        one.add(place)
        if number >= since:
            out.append(one.ahead(seconds))
    return np.array(out)


def choices(kind: Kind) -> list[tuple[float, ...]]:
    """All combinations of its numbers."""
    return list(product(*kind.choices))
