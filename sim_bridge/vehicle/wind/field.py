"""The wind of a scenario: what air each vehicle meets, from one frozen seed.

Gusts advance on a grid of their own (`TICK`), so that the same seed gives the same wind whatever time
steps the vehicles are moved with. Each vehicle draws from its own stream; where the scenario
asks for it, what they draw is correlated by their distance, exp(−d / ℓ).
"""

from __future__ import annotations

from math import cos, radians, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from onboard.core.math.vectors import ZERO, Vec, unit
from onboard.game.scenario import WindSpec
from sim_bridge.vehicle.motion import CALM, Air, Motion
from sim_bridge.vehicle.wind.dryden import GustAxes, GustNoise, GustState, first_gust, gust_of, step_gust
from sim_bridge.vehicle.wind.recorded import RecordedWind, read
from sim_bridge.vehicle.wind.shear import ROUGHNESS, mean_wind

TICK = 0.02  # [s] of the gusts' grid
BLOCK = 256  # ticks of noise drawn at once
REMIX = 25  # ticks after which the correlation is computed anew from the distances
FIRST_AIRSPEED = 20.0  # [m/s] at which a vehicle meets gusts until `air` is first told its own


def wind_vector(speed: float, from_deg: float) -> Vec:
    """A wind of `speed` [m/s] that comes from `from_deg`, as a vector [m/s; NED, where the air moves to]."""
    angle = radians(from_deg)
    return Vec(-speed * cos(angle), -speed * sin(angle), 0.0)


class WindField:
    """The air around `count` vehicles."""

    def __init__(
        self, spec: WindSpec, seed: int | np.random.SeedSequence, count: int, base: Path | None = None
    ) -> None:
        """`base` is the folder that a recorded wind's path is relative to. Raises ConfigError."""
        self._reference = wind_vector(spec.speed, spec.from_deg)
        self._shear = spec.shear
        self._sigma = spec.gust_sigma
        self._correlation = spec.correlation_m
        self._recorded: RecordedWind | None = None
        if spec.recorded:
            self._recorded = read((base or Path()) / spec.recorded)
        axis = unit(self._reference, Vec(1.0, 0.0, 0.0))
        self._axis = (axis.x, axis.y)
        sequence = seed if isinstance(seed, np.random.SeedSequence) else np.random.SeedSequence(seed)
        self._streams = [np.random.default_rng(child) for child in sequence.spawn(count)]
        self._noise: NDArray[np.float64] = np.empty((0, count, 5))
        self._drawn = 0
        self._mix: NDArray[np.float64] = np.eye(count)
        self._tick = 0
        self._places = [ZERO] * count
        self._speeds = [FIRST_AIRSPEED] * count
        self._states = [GustState(0.0, 0.0, 0.0, 0.0, 0.0)] * count
        self._started = False

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
        self._speeds[vehicle] = motion.airspeed
        self._advance(int(time / TICK + 1e-6))
        axes = GustAxes(*self._axis, motion.yaw, motion.pitch, height)
        return Air(wind, gust_of(self._states[vehicle], self._sigma, axes))

    def _advance(self, tick: int) -> None:
        if not self._started:
            self._started = True
            self._remix()
            self._states = [first_gust(noise) for noise in self._draw()]
        while self._tick < tick:
            self._tick += 1
            if self._tick % REMIX == 0:
                self._remix()
            for index, noise in enumerate(self._draw()):
                height = -self._places[index].z
                self._states[index] = step_gust(self._states[index], self._speeds[index], height, TICK, noise)

    def _draw(self) -> list[GustNoise]:
        """Noise of the next tick, one for each vehicle."""
        if self._drawn == len(self._noise):
            blocks = [stream.standard_normal((BLOCK, 5)) for stream in self._streams]
            self._noise = np.stack(blocks, axis=1)  # (BLOCK, count, 5)
            self._drawn = 0
        row = self._noise[self._drawn]
        self._drawn += 1
        if self._correlation > 0.0:
            row = self._mix @ row
        return [GustNoise(*values) for values in row.tolist()]

    def _remix(self) -> None:
        """Square root of the vehicles' correlation, from their distances."""
        if self._correlation > 0.0:
            self._mix = mixing(np.array(self._places), self._correlation)


def mixing(places: NDArray[np.float64], length: float) -> NDArray[np.float64]:
    """Lower triangle M with M Mᵀ = exp(−d / length): (n, n), for places (n, 3)."""
    apart = np.sqrt(np.sum((places[:, None, :] - places[None, :, :]) ** 2, axis=2))
    correlation = np.exp(-apart / length) + 1e-9 * np.eye(len(places))
    return np.asarray(np.linalg.cholesky(correlation / (1.0 + 1e-9)), dtype=np.float64)
