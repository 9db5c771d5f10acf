"""Families of trajectories on which predictors are compared.

Each trajectory has 300 samples 0.2 s apart at about 15 m/s (or another speed, with lengths scaled
alike). Wind displaces the vehicle by Ornstein–Uhlenbeck gusts; measurement noise comes on top.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

SUBSTEPS = 10


class Conditions(NamedTuple):
    """What disturbs a trajectory."""

    gust: float = 0.0  # σ of the gusts an axis [m/s]
    tau: float = 2.0  # their correlation time [s]
    noise: float = 0.0  # σ of the measured position an axis [m]


CONDITIONS = {
    "clean": Conditions(),
    "wind": Conditions(gust=1.5),
    "wind + measurement": Conditions(gust=1.5, noise=0.15),
}

# A family: (rng, times (n,), speed) → velocities (n, 3), or a path that needs feedback.
Course = Callable[[np.random.Generator, Array, float], Array]


def _velocities(heading: Array, climb: Array, speed: float) -> Array:
    return speed * np.stack(
        [np.cos(heading) * np.cos(climb), np.sin(heading) * np.cos(climb), -np.sin(climb)], axis=1
    )


def _limited(wanted: Array, dt: float, rate: float) -> Array:
    """Heading that follows `wanted` at no more than `rate` [rad/s]."""
    out = np.empty_like(wanted)
    out[0] = wanted[0]
    for k in range(1, len(wanted)):
        error = (wanted[k] - out[k - 1] + np.pi) % (2 * np.pi) - np.pi
        out[k] = out[k - 1] + min(max(error, -rate * dt), rate * dt)
    return out


def smooth(rng: np.random.Generator, t: Array, speed: float) -> Array:
    """A smooth curve like Figure 4: slow sines in the heading."""
    heading = rng.uniform(-np.pi, np.pi) * np.ones_like(t)
    for period in (rng.uniform(35.0, 60.0), rng.uniform(15.0, 25.0)):
        heading += rng.uniform(0.5, 1.0) * np.sin(2 * np.pi * t / period + rng.uniform(0.0, 2 * np.pi))
    return _velocities(heading, np.zeros_like(t), speed)


def turns(rng: np.random.Generator, t: Array, speed: float) -> Array:
    """Turns of random rate and length, rolled into within half a second."""
    dt = t[1] - t[0]
    rate, wanted, left = 0.0, 0.0, 0.0
    heading = np.empty_like(t)
    now = rng.uniform(-np.pi, np.pi)
    for k in range(len(t)):
        if left <= 0.0:
            wanted, left = rng.uniform(-0.4, 0.4), rng.uniform(2.0, 7.0)
        left -= dt
        rate += (wanted - rate) * dt / 0.5
        now += rate * dt
        heading[k] = now
    return _velocities(heading, np.zeros_like(t), speed)


def weave(rng: np.random.Generator, t: Array, speed: float) -> Array:
    """A sinusoidal weave about a straight course."""
    period, swing = rng.uniform(6.0, 12.0), rng.uniform(0.4, 0.9)
    course = rng.uniform(-np.pi, np.pi)
    heading = course + swing * np.sin(2 * np.pi * t / period + rng.uniform(0.0, 2 * np.pi))
    return _velocities(heading, np.zeros_like(t), speed)


def zigzag(rng: np.random.Generator, t: Array, speed: float) -> Array:
    """Legs of equal length left and right of a course, turned between at 1 rad/s."""
    period, swing = rng.uniform(5.0, 10.0), rng.uniform(0.5, 0.9)
    side = np.where((t / period + rng.uniform(0.0, 1.0)) % 1.0 < 0.5, 1.0, -1.0)
    heading = _limited(rng.uniform(-np.pi, np.pi) + swing * side, t[1] - t[0], 1.0)
    return _velocities(heading, np.zeros_like(t), speed)


def _flee(rng: np.random.Generator, t: Array, speed: float, spatial: bool) -> Array:
    """Flees five pursuers of 0.8 of its speed in a potential field, tethered to a place; turns at 1 rad/s."""
    dt = t[1] - t[0]
    size = 40.0 * speed / 15.0
    me = np.zeros(3)
    others = rng.normal(0.0, 2.0 * size, (5, 3))
    others[:, 2] *= 1.0 if spatial else 0.0
    ahead = np.array([1.0, 0.0, 0.0])
    out = np.empty((len(t), 3))
    for k in range(len(t)):
        away = me - others
        far = np.linalg.norm(away, axis=1, keepdims=True)
        force = (away / np.maximum(far, 1.0) ** 3).sum(axis=0) * size**2 - me / (2.0 * size)
        if spatial:
            force[2] *= 0.5
        wanted = force / (np.linalg.norm(force) + 1e-9)
        side = wanted - ahead * (wanted @ ahead)
        turn = min(np.arccos(np.clip(wanted @ ahead, -1.0, 1.0)), 1.0 * dt)
        ahead = ahead * np.cos(turn) + side / (np.linalg.norm(side) + 1e-9) * np.sin(turn)
        ahead /= np.linalg.norm(ahead)
        out[k] = speed * ahead
        me = me + out[k] * dt
        chase = me - others
        gap = np.maximum(np.linalg.norm(chase, axis=1, keepdims=True), 1.0)
        others = others + 0.8 * speed * dt * chase / gap
        caught = np.linalg.norm(me - others, axis=1) < 0.2 * size
        if caught.any():  # a caught pursuer begins anew, so that the flight goes on
            fresh = me + rng.normal(0.0, 2.0 * size, (5, 3)) * np.array([1.0, 1.0, 1.0 if spatial else 0.0])
            others[caught] = fresh[caught]
    return out


def flee_plane(rng: np.random.Generator, t: Array, speed: float) -> Array:
    """A fleeing evader in the plane."""
    return _flee(rng, t, speed, False)


def flee_space(rng: np.random.Generator, t: Array, speed: float) -> Array:
    """A fleeing evader in space."""
    return _flee(rng, t, speed, True)


FAMILIES: dict[str, Course] = {
    "smooth": smooth,
    "turns": turns,
    "weave": weave,
    "zigzag": zigzag,
    "flee, plane": flee_plane,
    "flee, space": flee_space,
}


def trajectory(
    family: str, conditions: Conditions, seed: int, samples: int = 300, dt: float = 0.2, speed: float = 15.0
) -> tuple[Array, Array]:
    """(measured, true) positions, each (samples, 3), of one seed; the same seed flies the same course in
    every condition."""
    index = list(FAMILIES).index(family)
    course, air, sensor = (np.random.default_rng([seed, index, k]) for k in range(3))
    fine = dt / SUBSTEPS
    t = fine * np.arange(samples * SUBSTEPS)
    velocity = FAMILIES[family](course, t, speed)
    spatial = family.endswith("space")
    if conditions.gust > 0.0:
        keep = np.exp(-fine / conditions.tau)
        kick = air.normal(0.0, conditions.gust * np.sqrt(1.0 - keep * keep), velocity.shape)
        kick[0] = air.normal(0.0, conditions.gust, 3)
        gust = np.empty_like(kick)
        gust[0] = kick[0]
        for k in range(1, len(t)):
            gust[k] = keep * gust[k - 1] + kick[k]
        gust[:, 2] *= 1.0 if spatial else 0.0
        velocity = velocity + gust
    true = np.cumsum(velocity, axis=0)[SUBSTEPS - 1 :: SUBSTEPS] * fine
    noise = sensor.normal(0.0, 1.0, true.shape) * conditions.noise
    noise[:, 2] *= 1.0 if spatial else 0.0
    return true + noise, true


def geometric(rows: Array | list[Array]) -> Array:
    """Geometric mean over the first axis."""
    out: Array = np.exp(np.mean(np.log(np.asarray(rows)), axis=0))
    return out
