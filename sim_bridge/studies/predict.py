"""`sim-bridge predict`: compares predictors on a recorded or simulated track; the example of 3.5.2."""

from __future__ import annotations

import csv
from itertools import pairwise
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
from onboard.core.math.vectors import ZERO, Vec, along, distance
from onboard.game.scenario import Scenario, load
from onboard.pilot.predictor import PredictorKind, TrackPredictor, Trainer
from onboard.pilot.predictor.paper import PaperNetwork, PaperSettings
from onboard.pilot.track_filter import Variance
from onboard.runtime.clock import RealClock
from onboard.runtime.plugins import evader_strategy, pursuer_strategy
from sim_bridge.plane_game.setup import conditions_of, game_of
from sim_bridge.vehicle.motion import Motion
from sim_bridge.world.sensor import Sensor

Array = npt.NDArray[np.float64]

HORIZONS = (0.2, 0.5, 1.0, 2.0, 4.0)  # [s]
LAST, STEADY, FLYING, PAPER = "last known", "constant velocity (filtered)", "s-parabola", "paper's network"
STEP = 0.2  # of the paper's series [s]
FIGURE4_POINTS = 300
FIGURE4_TRAINED = 200


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


class Row(msgspec.Struct, frozen=True):
    """Errors of one predictor."""

    predictor: str
    mean_error: tuple[float, ...]  # by horizon [m]
    stated: tuple[float, ...]  # root mean square of the stated error [m]; 0: none stated
    worst: tuple[float, ...]  # [m]


class Comparison(msgspec.Struct, frozen=True):
    """What `sim-bridge predict` found."""

    track: str
    simulated: bool
    samples: int
    horizons: tuple[float, ...]  # [s]
    instants: int  # at which all predicted
    rows: tuple[Row, ...]
    spoke: dict[str, int]  # how often each kind of the s-parabola predictor spoke, 1 s ahead


class Drawn(NamedTuple):
    """A comparison with what its figure needs."""

    comparison: Comparison
    recording: Recording
    paths: dict[str, Array]  # predicted places 1 s ahead (instants, 3)
    at: Array  # instants they are of (instants,)
    errors: dict[str, Array]  # (instants, horizons)


class Example(msgspec.Struct, frozen=True):
    """The example of 3.5.2: one network a coordinate."""

    coordinate: str
    error_training: float  # mean |error| on the training set [m]
    error_test: float  # mean |error| on the test set [m]
    epochs: int
    time: float  # of the training [s]


class Figure4(NamedTuple):
    """The example with its series."""

    results: tuple[Example, Example]
    truth: Array  # (n, 2)
    predicted: Array  # (n, 2); the first five are NaN


def example(seed: int = 3, epochs: int = 1000, printed: bool = False) -> Figure4:
    """Predict the next point of a smooth plane trajectory, a network for x and one for y (3.5.2)."""
    clock = RealClock()
    t = STEP * np.arange(FIGURE4_POINTS)
    truth = np.stack(
        [7.0 * t + 25.0 * np.sin(t / 7.0), 60.0 * np.sin(t / 9.0) + 20.0 * np.cos(t / 4.0)], axis=1
    )
    settings = PaperSettings(epochs=epochs, printed_inverse=printed)
    n = settings.inputs
    predicted = np.full_like(truth, np.nan)
    results = []
    for column, name in enumerate("xy"):
        series = truth[:, column]
        network = PaperNetwork(np.random.default_rng([seed, column]), settings)
        begun = clock.monotonic_ns()
        done = network.fit(series[:FIGURE4_TRAINED])
        spent = (clock.monotonic_ns() - begun) * 1e-9
        with np.errstate(over="ignore", invalid="ignore"):
            for k in range(n, len(series)):
                predicted[k, column] = network.next(series[k - n : k])
        misses = np.abs(predicted[:, column] - series)
        trained, test = misses[n:FIGURE4_TRAINED], misses[FIGURE4_TRAINED:]
        results.append(Example(name, float(trained.mean()), float(test.mean()), len(done), spent))
    return Figure4((results[0], results[1]), truth, predicted)


def compare(recording: Recording, seed: int = 1, paper: bool = True) -> Drawn:
    """Let every predictor follow the track as it arrives and predict from the second half on."""
    track, trainer = TrackPredictor(seed), Trainer()
    samples = sorted(recording.samples, key=lambda s: s.arrival)
    if len(samples) < 20:
        raise ConfigError(f"{recording.name}: found {len(samples)} samples, expected at least 20")
    half = 0.5 * (samples[0].arrival + samples[-1].arrival)
    last = recording.truth_t[-1]
    networks: list[PaperNetwork] = []
    at, spoke = [], {kind.name.lower(): 0 for kind in PredictorKind}
    names = (LAST, STEADY, FLYING, *((PAPER,) if paper else ()))
    errors: dict[str, list[list[float]]] = {name: [] for name in names}
    stated: dict[str, list[list[float]]] = {name: [] for name in (STEADY, FLYING)}
    paths: dict[str, list[Vec]] = {name: [] for name in names}
    for sample in samples:
        track.add(sample.t, sample.position, sample.velocity, sample.variance)
        now = sample.arrival
        trainer.advance(now, {1: track}, 2)
        if now < half or track.filter.empty or now + HORIZONS[-1] > last:
            continue
        if paper and not networks:
            networks = _paper(track, seed)
        newest = track.filter.estimate(track.filter.newest)
        rolled = _rolled(track, networks, now + HORIZONS[-1]) if networks else []
        rows: dict[str, list[float]] = {name: [] for name in errors}
        sure: dict[str, list[float]] = {name: [] for name in stated}
        for ahead in HORIZONS:
            truth = _truth(recording, now + ahead)
            flying = track.predict(now + ahead)
            steady = track.filter.estimate(now + ahead)
            said = {LAST: newest.position, STEADY: steady.position, FLYING: flying.position}
            if paper:
                said[PAPER] = _on(rolled, now + ahead, steady.position)
            for name, place in said.items():
                rows[name].append(distance(place, truth))
                if ahead == 1.0:
                    paths[name].append(place)
            sure[STEADY].append(steady.sigma)
            sure[FLYING].append(flying.sigma)
            if ahead == 1.0:
                spoke[flying.source.name.lower()] += 1
        at.append(now + 1.0)
        for name, row in rows.items():
            errors[name].append(row)
        for name, row in sure.items():
            stated[name].append(row)
    if not at:
        raise ConfigError(f"{recording.name}: the track is too short to predict {HORIZONS[-1]:g} s ahead")
    found = {name: np.array(rows) for name, rows in errors.items()}
    lines = []
    for name, misses in found.items():
        sure_rms = _rms(np.array(stated[name])) if name in stated else (0.0,) * len(HORIZONS)
        mean, worst = misses.mean(axis=0).tolist(), misses.max(axis=0).tolist()
        lines.append(Row(name, tuple(mean), sure_rms, tuple(worst)))
    comparison = Comparison(
        recording.name, recording.simulated, len(samples), HORIZONS, len(at), tuple(lines),
        {kind: count for kind, count in spoke.items() if count},
    )
    return Drawn(comparison, recording, {n: np.array(p) for n, p in paths.items()}, np.array(at), found)


def table(comparison: Comparison) -> str:
    """The comparison for people."""
    of = "the true places" if comparison.simulated else "the places measured later (noise included)"
    lines = [
        f"{comparison.track}: {comparison.samples} samples, {comparison.instants} predictions; "
        f"mean distance [m] from {of}, and the stated error",
        f"{'ahead':30}" + "".join(f"{h:>15g} s" for h in comparison.horizons),
    ]
    for row in comparison.rows:
        cells = [
            f"{error:9.2f}" + (f" ±{sure:6.2f}" if sure else " " * 8)
            for error, sure in zip(row.mean_error, row.stated, strict=True)
        ]
        lines.append(f"{row.predictor:30}" + "".join(cells))
    spoke = ", ".join(f"{kind.replace('_', ' ')} {count}" for kind, count in comparison.spoke.items())
    lines.append(f"who spoke for the s-parabola predictor 1 s ahead: {spoke}")
    return "\n".join(lines)


def example_table(figure: Figure4) -> str:
    """The example of 3.5.2 for people."""
    lines = ["Example of 3.5.2: the next of a trajectory's points from the last five, a network a coordinate"]
    for one in figure.results:
        lines.append(
            f"  {one.coordinate}: mean error {one.error_training:.3f} m on the training set, "
            f"{one.error_test:.3f} m on the test set; {one.epochs} epochs in {one.time:.2f} s"
        )
    return "\n".join(lines)


def recording_of(path: Path, seed: int = 0) -> Recording:
    """A track: a CSV file (t,north,east,down[,vn,ve,vd][,sigma]) or a scenario's evader, simulated.

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
    sensor = Sensor(spec, (1,), np.random.default_rng([scenario.seed, seed]))
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
    """Read a track from a CSV file with a header; see `recording_of`. Raises ConfigError."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: not UTF-8 text") from None
    except (OSError, csv.Error) as error:
        raise ConfigError(f"{path}: {str(getattr(error, 'strerror', None) or error).lower()}") from None
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


def _truth(recording: Recording, t: float) -> Vec:
    places = [float(np.interp(t, recording.truth_t, recording.truth[:, axis])) for axis in range(3)]
    return Vec(places[0], places[1], places[2])


def _paper(track: TrackPredictor, seed: int) -> list[PaperNetwork]:
    """The paper's networks, one a coordinate, trained on the grid so far."""
    positions, _ = track.grid.arrays()
    if len(positions) < 20:
        return []
    networks = []
    for axis in range(3):
        network = PaperNetwork(np.random.default_rng([seed, axis]), PaperSettings(epochs=100))
        network.fit(positions[:, axis])
        networks.append(network)
    return networks


def _rolled(track: TrackPredictor, networks: list[PaperNetwork], until: float) -> list[tuple[float, Vec]]:
    """The paper's networks rolled on from the newest sample."""
    newest = track.filter.newest
    window = track.grid.window(track.filter, 6)
    if window is None:
        return []
    steps = int((until - newest) / STEP) + 2
    with np.errstate(over="ignore", invalid="ignore"):
        columns = [network.roll(window[:, axis], steps) for axis, network in enumerate(networks)]
    path = [(newest, Vec(*window[-1].tolist()))]
    for k in range(steps):
        path.append((newest + (k + 1) * STEP, Vec(*(float(column[k]) for column in columns))))
    return path


def _on(path: list[tuple[float, Vec]], t: float, otherwise: Vec) -> Vec:
    """The place at `t` on a polygon of (instant, place)."""
    for (a, here), (b, there) in pairwise(path):
        if a <= t <= b:
            u = (t - a) / (b - a)
            return along(along(ZERO, here, 1.0 - u), there, u)
    return otherwise


def _rms(values: Array) -> tuple[float, ...]:
    return tuple(np.sqrt((values * values).mean(axis=0)).tolist())


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


def predict(
    source: Path | None = None,
    figures: Path | None = None,
    json: bool = False,
    seed: int = 1,
    printed: bool = False,
    epochs: int = 1000,
) -> None:
    """The command: compare predictors on `source` (a CSV track or a scenario), or, without one, play the
    example of 3.5.2 and compare on a weave. Prints a table (or JSON lines); draws into `figures`.

    `printed` trains the example by the printed rule (27)–(28). Raises ConfigError for bad input."""
    if epochs < 1:
        raise ConfigError(f"--epochs: found {epochs}, expected 1 or more")
    if source is None:
        played = example(epochs=epochs, printed=printed)
        for one in played.results if json else ():
            print(msgspec.json.encode(one).decode())
        if not json:
            print(example_table(played) + "\n")
        if figures is not None:
            from sim_bridge.studies.predict_figures import draw_activation, draw_example

            draw_activation(figures)
            draw_example(played, figures)
    drawn = compare(weave() if source is None else recording_of(source, seed), seed)
    print(msgspec.json.encode(drawn.comparison).decode() if json else table(drawn.comparison))
    if figures is not None:
        from sim_bridge.studies.predict_figures import draw_comparison

        written = draw_comparison(drawn, figures)
        if not json:
            print(f"figure: {written[0]}")
