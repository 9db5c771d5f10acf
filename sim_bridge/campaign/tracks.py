"""The sensor of the bridge and the track filters of the agents, as arrays in a compiled game. Kernel style.

Everybody hears the same measurements, so that one filter a vehicle stands for those of all who see it. What a
measurement draws depends on its vehicle and its number alone, as in `sim_bridge.world.sensor`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec
from onboard.pilot.kalman import Axis, Learning, Measured, carry, corrected
from sim_bridge.draws import WORD, Key, normal, threefry, uniform

Array = NDArray[np.float64]
WIDTH = 16  # of a filter in its array: three axes of five numbers, then the density


class Eye(NamedTuple):
    """The sensor and the filters behind it."""

    period: int  # samples of the aircraft between two measurements
    delay: int  # samples until a measurement is heard
    sigma: float  # [m]
    sigma_velocity: float  # [m/s]
    dropout: float  # share of the measurements that are lost
    floor: float  # the filter's least variance
    density: float  # to begin with [m²/s³]
    learning: Learning
    keys: tuple[Key, ...]  # of everybody's random numbers, evader first


class Tracks(NamedTuple):
    """What is under way and what the filters hold."""

    waiting: Array  # (slots, players, 7): measured place [m] and velocity [m/s], 1 where it was not lost
    filters: Array  # (players, WIDTH)
    stamps: Array  # (players,) sample of each filter's newest measurement; −1: none


def no_tracks(players: int, eye: Eye) -> Tracks:
    """Before the first measurement."""
    slots = eye.delay // eye.period + 2
    return Tracks(
        np.zeros((slots, players, 7)), np.zeros((players, WIDTH)), np.full(players, -1.0, dtype=np.float64)
    )


def measure(tracks: Tracks, eye: Eye, number: int, states: Array) -> None:
    """Measurement `number` of everybody, of their states (players, 6) now."""
    slot = number % tracks.waiting.shape[0]
    for i in range(states.shape[0]):
        key = eye.keys[i]
        a, b = threefry(key.a, key.b, number & WORD, 0)
        c, d = threefry(key.a, key.b, number & WORD, 1)
        e, f = threefry(key.a, key.b, number & WORD, 2)
        g, _spare = threefry(key.a, key.b, number & WORD, 3)
        row = tracks.waiting[slot, i]
        row[0] = states[i, 0] + eye.sigma * normal(b)
        row[1] = states[i, 1] + eye.sigma * normal(c)
        row[2] = states[i, 2] + eye.sigma * normal(d)
        row[3] = states[i, 3] + eye.sigma_velocity * normal(e)
        row[4] = states[i, 4] + eye.sigma_velocity * normal(f)
        row[5] = states[i, 5] + eye.sigma_velocity * normal(g)
        row[6] = 0.0 if uniform(a) < eye.dropout else 1.0


def hear(tracks: Tracks, eye: Eye, number: int, dt: float) -> None:
    """Give measurement `number` to the filters; `dt` [s] is a sample."""
    slot = number % tracks.waiting.shape[0]
    p = max(eye.sigma * eye.sigma, eye.floor)
    v = max(eye.sigma_velocity * eye.sigma_velocity, eye.floor)
    now = number * eye.period
    for i in range(tracks.filters.shape[0]):
        m = tracks.waiting[slot, i]
        if m[6] == 0.0:
            continue
        f = tracks.filters[i]
        if tracks.stamps[i] < 0.0:
            for axis in range(3):
                k = 5 * axis
                f[k] = m[axis]
                f[k + 1] = m[axis + 3]
                f[k + 2] = p
                f[k + 3] = 0.0
                f[k + 4] = v
            f[15] = eye.density
        else:
            measured = Measured(Vec(m[0], m[1], m[2]), Vec(m[3], m[4], m[5]), (p, p, p, v, v, v))
            gap = (now - tracks.stamps[i]) * dt
            found = corrected(carry(axes_of(f), gap, f[15]), f[15], measured, eye.learning)
            for axis in range(3):
                k = 5 * axis
                a = found.axes[axis]
                f[k] = a.x
                f[k + 1] = a.v
                f[k + 2] = a.xx
                f[k + 3] = a.xv
                f[k + 4] = a.vv
            f[15] = found.density
        tracks.stamps[i] = now


def axes_of(f: Array) -> tuple[Axis, Axis, Axis]:
    """The axes of a filter in its array."""
    return (
        Axis(f[0], f[1], f[2], f[3], f[4]),
        Axis(f[5], f[6], f[7], f[8], f[9]),
        Axis(f[10], f[11], f[12], f[13], f[14]),
    )


def watched(tracks: Tracks, eye: Eye, sample: int, states: Array, dt: float) -> None:
    """What sensor and filters do at a sample, with the states (players, 6) of everybody now."""
    if sample % eye.period == 0:
        measure(tracks, eye, sample // eye.period, states)
    heard = sample - eye.delay
    if heard >= 0 and heard % eye.period == 0:
        hear(tracks, eye, heard // eye.period, dt)


def track_of(tracks: Tracks, index: int, sample: int, dt: float) -> Vehicle:
    """Where player `index` is taken to be at a sample, and its velocity over ground [m/s]."""
    i, f = index, tracks.filters
    left = (sample - tracks.stamps[i]) * dt
    velocity = Vec(f[i, 1], f[i, 6], f[i, 11])
    place = Vec(f[i, 0] + left * velocity.x, f[i, 5] + left * velocity.y, f[i, 10] + left * velocity.z)
    return Vehicle(place, velocity, 0.0)
