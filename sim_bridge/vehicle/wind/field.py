"""The wind of a scenario: what air each vehicle meets, from one frozen seed.

Gusts advance on a grid of their own (`TICK`), so that the same seed gives the same wind whatever time
steps the vehicles are moved with. Each vehicle has numbers of its own, by counter (`sim_bridge.draws`): the
same in the compiled games, and whoever else flies; where the scenario
asks for it, what they draw is correlated by their distance, exp(−d / ℓ).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, radians, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from onboard.core.math.each import new
from onboard.core.math.vectors import ZERO, Vec, unit
from onboard.game.scenario import WindSpec
from sim_bridge.draws import Purpose, Stream, key_of
from sim_bridge.vehicle.motion import CALM, Air, Motion
from sim_bridge.vehicle.wind.dryden import (
    GUST_WORDS,
    GustAxes,
    GustNoise,
    GustState,
    first_gust,
    gust_of,
    step_gust,
)
from sim_bridge.vehicle.wind.recorded import RecordedWind, read
from sim_bridge.vehicle.wind.shear import ROUGHNESS, mean_wind

TICK = 0.02  # [s] of the gusts' grid
REMIX = 25  # ticks after which the correlation is computed anew from the distances


def wind_vector(speed: float, from_deg: float) -> Vec:
    """A wind of `speed` [m/s] that comes from `from_deg`, as a vector [m/s; NED, where the air moves to]."""
    angle = radians(from_deg)
    return Vec(-speed * cos(angle), -speed * sin(angle), 0.0)


class WindField:
    """The air around vehicles."""

    def __init__(self, spec: WindSpec, seed: int, ids: Sequence[int], base: Path | None = None) -> None:
        """`ids` name the vehicles, and with them what each draws; `base` is the folder that a recorded
        wind's path is relative to. Raises ConfigError."""
        self._reference = wind_vector(spec.speed, spec.from_deg)
        self._shear = spec.shear
        self._sigma = spec.gust_sigma
        self._correlation = spec.correlation_m
        self._recorded: RecordedWind | None = None
        if spec.recorded:
            self._recorded = read((base or Path()) / spec.recorded)
        axis = unit(self._reference, Vec(1.0, 0.0, 0.0))
        self._axis = (axis.x, axis.y)
        self._streams = [Stream(key_of(seed, id, Purpose.GUST), GUST_WORDS) for id in ids]
        self._mix: NDArray[np.float64] = np.eye(len(self._streams))
        self._mixed = -1  # the tick for which the correlation was reckoned
        self._ticks = [-1] * len(self._streams)  # that each vehicle's gusts have reached
        self._places = [ZERO] * len(self._streams)
        self._states = [GustState(0.0, 0.0, 0.0, 0.0, 0.0)] * len(self._streams)

    def air(self, vehicle: int, motion: Motion, time: float) -> Air:
        """The air at vehicle number `vehicle` (from 0) in `motion` at `time` [s; never falls].

        Its airspeed is how fast it meets the gusts, and above 1000 ft they lie along its nose. Ground is at
        the height of the game's origin.
        """
        position = motion.position
        if self._recorded is not None:
            return self._recorded.at(time)
        height = -position.z
        wind = mean_wind(self._reference, height, self._shear, ROUGHNESS)
        if self._sigma <= 0.0:
            return CALM if wind == ZERO else Air(wind, ZERO)
        self._places[vehicle] = position
        self._advance(vehicle, int(time / TICK + 1e-6), motion.airspeed)
        axes = new(GustAxes, (*self._axis, motion.yaw, motion.pitch, height))
        air = new(Air, (wind, gust_of(self._states[vehicle], self._sigma, axes)))
        return air

    def _advance(self, vehicle: int, tick: int, airspeed: float) -> None:
        """One vehicle's gusts up to a tick."""
        if tick == self._ticks[vehicle]:
            return
        state, height = self._states[vehicle], -self._places[vehicle].z
        for number in range(self._ticks[vehicle] + 1, tick + 1):
            noise = GustNoise(*self._noise(vehicle, number))
            state = step_gust(state, airspeed, height, TICK, noise) if number else first_gust(noise)
        self._states[vehicle] = state
        self._ticks[vehicle] = max(tick, self._ticks[vehicle])

    def _noise(self, vehicle: int, tick: int) -> list[float]:
        """What drives a vehicle's gusts at a tick; with a correlation, of all that were drawn before it."""
        if self._correlation <= 0.0:
            return self._streams[vehicle].at(tick)
        remix = tick - tick % REMIX
        if remix != self._mixed:
            self._mixed, self._mix = remix, mixing(np.array(self._places), self._correlation)
        drawn = np.array([stream.at(tick) for stream in self._streams[: vehicle + 1]])
        mixed: list[float] = (self._mix[vehicle, : vehicle + 1] @ drawn).tolist()
        return mixed


def mixing(places: NDArray[np.float64], length: float) -> NDArray[np.float64]:
    """Lower triangle M with M Mᵀ = exp(−d / length): (n, n), for places (n, 3)."""
    apart = np.sqrt(np.sum((places[:, None, :] - places[None, :, :]) ** 2, axis=2))
    correlation = np.exp(-apart / length) + 1e-9 * np.eye(len(places))
    return np.asarray(np.linalg.cholesky(correlation / (1.0 + 1e-9)), dtype=np.float64)
