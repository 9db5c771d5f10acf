"""Tracks to compare predictors on: recorded (CSV), simulated from a scenario, or a weave."""

from __future__ import annotations

import csv
from math import cos, isfinite, pi, sin
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt

from onboard.config.strict import ConfigError
from onboard.core.game.advance import advance
from onboard.core.game.referee import GameResult
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO, Vec, along
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario, load
from onboard.pilot.track_filter import Variance
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
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: not UTF-8 text") from None
    except (OSError, csv.Error) as error:
        raise ConfigError(f"{path}: {str(getattr(error, 'strerror', None) or error).lower()}") from None
    if rows and "t_s" in rows[0]:
        rows = _exported(path, rows)
    found = list(rows[0]) if rows else []
    for key in ("t", "north", "east", "down"):
        if key not in found:
            raise ConfigError(f"{path}: {key}: found columns {', '.join(map(str, found)) or 'none'}, "
                              "expected t,north,east,down[,vn,ve,vd][,sigma]")
    moving = all(key in found for key in ("vn", "ve", "vd"))
    samples = []
    for number, row in enumerate(rows, start=2):
        def cell(key: str, row: dict[str, str] = row, number: int = number) -> float:
            try:
                value = float(row[key])
            except (TypeError, ValueError):
                value = float("nan")
            if not isfinite(value):
                raise ConfigError(
                    f"{path}: line {number}: {key}: found {row[key]!r}, expected a finite number"
                )
            return value

        sigma = cell("sigma") if "sigma" in found else 3.0
        v = 1.0 if moving else -1.0
        variance = (sigma * sigma, sigma * sigma, sigma * sigma, v, v, v)
        velocity = Vec(cell("vn"), cell("ve"), cell("vd")) if moving else None
        place = Vec(cell("north"), cell("east"), cell("down"))
        samples.append(Sample(cell("t"), place, velocity, variance, cell("t")))
    known = sorted({s.t: s.position for s in samples}.items())
    if len(known) < 2:
        raise ConfigError(f"{path}: found {len(known)} instants, expected at least 20")
    times = np.array([t for t, _ in known])
    return Recording(path.name, tuple(samples), times, np.array([p for _, p in known]), False)


def _exported(path: Path, rows: list[dict[str, str]]) -> list[dict[str, str]]:
    """The rows of a table of `gcs export` as those of a track. Raises ConfigError."""
    ids = sorted({row.get("id") or "" for row in rows})
    if len(ids) > 1:
        found = ", ".join(map(str, ids))
        raise ConfigError(f"{path}: id: found {found}, expected one vehicle: gcs export RUN --id ID")
    return [{EXPORTED.get(str(key), key): value for key, value in row.items()} for row in rows]


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
