"""Tracks to compare predictors on: recorded (CSV), simulated from a scenario, or a weave."""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt

from onboard.config.strict import ConfigError
from onboard.config.table_file import demand_seconds, read_table
from onboard.core.game.advance import advance
from onboard.core.game.referee import GameResult
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO, Vec, along
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario, load
from onboard.pilot.kalman import Variance
from sim_bridge.plane_game.setup import conditions_of, game_of
from sim_bridge.vehicle.motion import Motion
from sim_bridge.world.sensor import Sensor

EXPORTED = {
    "t_s": "t", "north_m": "north", "east_m": "east", "down_m": "down",
    "v_north_m_s": "vn", "v_east_m_s": "ve", "v_down_m_s": "vd", "sigma_m": "sigma",
}  # fmt: skip
"""The columns of `gcs export`'s tables, and what they are called in a track."""
Array = npt.NDArray[np.float64]


class Sample(NamedTuple):
    """A row of a track."""

    t: float  # [s] the instant it is of
    position: Vec  # [m; NED]
    velocity: Vec | None  # [m/s; ground, NED]
    variance: Variance
    arrival: float  # [s] when it came


class Recording(NamedTuple):
    """A track, and the truth where it is known (a simulation) or its own later samples."""

    name: str
    samples: tuple[Sample, ...]
    truth_t: Array  # (n,)
    truth: Array  # (n, 3)
    simulated: bool


def recording_of(path: Path, seed: int = 0) -> Recording:
    """A track: a CSV file (see `read_csv`) or a scenario's evader, simulated.

    Raises ConfigError for a file that is neither."""
    if path.suffix == ".toml":
        return simulate(load(path), seed)
    return read_csv(path)


def simulate(scenario: Scenario, seed: int = 0) -> Recording:
    """Play the scenario in the core and measure the evader as the scenario's sensor would; a sensor
    without noise is given 3 m, so that there is something to filter."""
    conditions = conditions_of(scenario)
    flee, chase = evader_strategy(scenario.evader.strategy), pursuer_strategy("")
    game = game_of(scenario)
    times, states = [0.0], [game.evader]
    while game.score.verdict == GameResult.RUNNING:
        game = advance(game, conditions, flee, chase)
        times.append(game.time)
        states.append(game.evader)
    spec = scenario.flight.sensor
    if spec.sigma == 0.0:
        spec = msgspec.structs.replace(spec, sigma=3.0, sigma_velocity=1.0)
    sensor = Sensor(spec, (1,), scenario.seed + seed)
    samples = []
    for t, state in zip(times, states, strict=True):
        now = round(t * NS_PER_S)
        motion = Motion(state.position, state.velocity, state.speed, 0.0, 0.0, 0.0)
        for track in sensor.step(now, {1: motion}):
            of = track.stamp_ns * 1e-9
            place, speed = Vec(*track.position), Vec(*track.velocity)
            samples.append(Sample(of, place, speed, track.covariance, t))
    truth = np.array([state.position for state in states])
    return Recording(scenario.name, tuple(samples), np.array(times), truth, True)


def read_csv(path: Path) -> Recording:
    """Read a track from a CSV file with a header: `t,north,east,down[,vn,ve,vd][,sigma]` in s, m and m/s.

    The files of `gcs export` are read too: their columns have the units in their names (EXPORTED). One of
    several vehicles is refused. Raises ConfigError.
    """
    aliases = {name: (other,) for other, name in EXPORTED.items()}
    rows = read_table(path, aliases, ("t", "north", "east", "down"))
    found = rows[0].cells if rows else {}
    ids = sorted({row.cells.get("id", "") for row in rows})
    if len(ids) > 1:
        raise ConfigError(f"{path}: id: found {', '.join(ids)}, expected one vehicle: gcs export RUN --id ID")
    moving = all(key in found for key in ("vn", "ve", "vd"))
    samples = []
    for row in rows:
        sigma = row.number("sigma") if "sigma" in found else 3.0
        v = 1.0 if moving else -1.0
        variance = (sigma * sigma, sigma * sigma, sigma * sigma, v, v, v)
        velocity = Vec(row.number("vn"), row.number("ve"), row.number("vd")) if moving else None
        place = Vec(row.number("north"), row.number("east"), row.number("down"))
        samples.append(Sample(row.number("t"), place, velocity, variance, row.number("t")))
    demand_seconds(path, [sample.t for sample in samples])
    known = sorted({s.t: s.position for s in samples}.items())
    if len(known) < 2:
        raise ConfigError(f"{path}: found {len(known)} instants, expected at least 20")
    times = np.array([t for t, _ in known])
    return Recording(path.name, tuple(samples), times, np.array([p for _, p in known]), False)


def weave(seconds: float = 60.0, speed: float = 50.0, rate: float = 10.0, seed: int = 0) -> Recording:
    """A weaving target seen by a 3 m sensor: a track to try predictors on without any file."""
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, seconds, 1.0 / rate)
    place, places = ZERO, []
    for t in times:
        heading = 0.5 + 0.6 * sin(2.0 * pi * t / 9.0)
        place = along(place, Vec(cos(heading), sin(heading), 0.0), speed / rate)
        places.append(place)
    truth = np.array(places)
    noise = rng.normal(0.0, 3.0, truth.shape)
    variance = (9.0, 9.0, 9.0, -1.0, -1.0, -1.0)
    samples = tuple(
        Sample(float(t), Vec(*(p + n).tolist()), None, variance, float(t))
        for t, p, n in zip(times, truth, noise, strict=True)
    )
    return Recording("weave at 50 m/s, 3 m of noise", samples, times, truth, True)
