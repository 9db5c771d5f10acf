"""The campaign of the spatial game: many seeds, paired, with the strategy and flying straight at the target.

A seed draws where the pursuers start (about the scenario's places), where the mean wind comes from,
the gusts and the tracks' noise. Both ways of flying meet the same draw.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import degrees, exp, radians, sqrt
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import Game, Params, begin
from onboard.core.game.referee import GameResult
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import ZERO, Vec, scale, sub, unit, yaw_of
from onboard.game.scenario import Scenario, load
from onboard.runtime.resources import configs
from sim_bridge.campaign.compiled import KERNELS as CORE
from sim_bridge.campaign.compiled import register
from sim_bridge.campaign.plane_in_wind import GUST_EVERY, Climate, Flown, launched, wind_at
from sim_bridge.campaign.spatial_game import Band, Fleet, Sensor, SpatialPlay, play
from sim_bridge.vehicle.flight import KERNELS as FLIGHT
from sim_bridge.vehicle.flight.aircraft import named, within
from sim_bridge.vehicle.flight.plane import Command, Steer, start_state, trimmed
from sim_bridge.vehicle.wind import KERNELS as WIND
from sim_bridge.vehicle.wind.dryden import GustNoise
from sim_bridge.vehicle.wind.field import wind_vector

KERNELS = (
    *CORE,
    *FLIGHT,
    *WIND,
    "sim_bridge.campaign.plane_in_wind",
    "sim_bridge.campaign.spatial_game",
)
FILTER_TIME = 0.8  # [s] over which a track filter averages
PLACE_SIGMA = 300.0  # [m] by which a seed moves each pursuer's start, level
HEIGHT_SIGMA = 60.0  # [m] and in height
REVERSAL = radians(10.0)  # a turn one way, then the other
WITHIN = 2.0  # [s]

Array = NDArray[np.float64]


class Played(NamedTuple):
    """One game of the campaign."""

    verdict: GameResult
    time: float  # [s]
    smallest: float  # distance of any pursuer [m]
    reversals: int  # of the evader's flown course
    decided_reversals: int  # of the course it decided on
    play: SpatialPlay
    log: Array  # (steps, players, 5): position [m; NED], flown and decided course [rad]


class Draw(NamedTuple):
    """Everything a seed fixes."""

    game: Game
    params: Params
    fleet: Fleet
    climate: Climate
    sensor: Sensor
    band: Band
    players: list[Flown]
    gusts: Array
    tracks: Array


def spatial(name: str) -> Scenario:
    """`configs/scenarios/spatial/<name>.toml`."""
    return load(configs() / "scenarios" / "spatial" / f"{name}.toml")


def draw(scenario: Scenario, seed: int) -> Draw:
    """The game of a seed; seed 0 starts from the scenario's places exactly."""
    rng = np.random.default_rng([scenario.seed, seed])
    p = scenario.parameters
    spec = scenario.evader
    wind = scenario.flight.wind
    reference = wind_vector(wind.speed, wind.from_deg if seed == 0 else float(rng.uniform(0.0, 360.0)))
    axis = unit(reference, Vec(1.0, 0.0, 0.0))
    climate = Climate(reference, wind.shear, wind.gust_sigma, axis.x, axis.y)
    target = ZERO if spec.target is None else Vec(spec.target[0], spec.target[1], -spec.target[2])
    has_target = spec.target is not None
    params = Params(
        p.R, scenario.rho, p.lambda_, p.beta, p.epsilon_min, p.dt, p.horizon, p.separation, False, has_target,
        target,
    )  # fmt: skip
    starts = [spec.start()]
    for other in scenario.pursuers:
        n = rng.standard_normal(3) * (0.0 if seed == 0 else 1.0)
        off = Vec(PLACE_SIGMA * float(n[0]), PLACE_SIGMA * float(n[1]), HEIGHT_SIGMA * float(n[2]))
        start = other.start()
        starts.append(Vec(start.x + off.x, start.y + off.y, start.z + off.z))
    count = len(starts)
    aircraft = named(scenario.flight.airframe.value).model
    fleet = Fleet(within(aircraft, spec.limits()), within(aircraft, scenario.pursuers[0].limits()))
    ticks = int(p.horizon / fleet.evader.dt) // GUST_EVERY + 8
    steps = int(p.horizon / p.dt) + 8
    gusts = rng.standard_normal((ticks, count, 5))
    tracks = filtered(rng.standard_normal((steps, count, 6)), p.dt)
    players: list[Flown] = []
    vehicles: list[Vehicle] = []
    for index, (vehicle, start) in enumerate(zip(scenario.vehicles, starts, strict=True)):
        aim = target if index == 0 else starts[0]
        heading = unit(sub(aim, start), Vec(1.0, 0.0, 0.0))
        yaw = yaw_of(heading) if vehicle.heading_deg is None else radians(vehicle.heading_deg)
        model = fleet.evader if index == 0 else fleet.pursuer
        plane = trimmed(start_state(start, yaw, vehicle.speed, wind_at(climate, start)), model)
        players.append(launched(plane, GustNoise(*map(float, gusts[0, index]))))
        vehicles.append(Vehicle(start, scale(heading, vehicle.speed), float(vehicle.speed)))
    limits = tuple(v.limits() for v in scenario.vehicles)
    game = begin(vehicles[0], tuple(vehicles[1:]), limits[0], limits[1:])
    spec_sensor = scenario.flight.sensor
    left = sqrt(2.0 / (spec_sensor.rate_hz * FILTER_TIME))  # of white noise, by a constant-velocity filter
    noise = Sensor(spec_sensor.sigma * min(1.0, left), spec_sensor.sigma_velocity * min(1.0, left))
    fence = scenario.flight.fence
    band = Band(-1e9, 1e9) if fence is None else Band(fence.height_min, fence.height_max)
    return Draw(game, params, fleet, climate, noise, band, players, gusts, tracks)


def filtered(white: Array, dt: float) -> Array:
    """White noise (steps, …) as a track filter leaves it: unit variance, correlated over FILTER_TIME."""
    from scipy.signal import lfilter

    a = exp(-dt / FILTER_TIME)
    first = white[:1] * a / sqrt(1.0 - a * a)  # stationary from the start
    padded = np.concatenate([first, white])
    return np.ascontiguousarray(lfilter([sqrt(1.0 - a * a)], [1.0, -a], padded, axis=0)[1:])


@cache
def compiled_play() -> Callable[..., SpatialPlay]:
    """The game compiled; once for each number of pursuers."""
    import numba

    register(KERNELS)
    found: Callable[..., SpatialPlay] = numba.njit(nogil=True)(play)
    return found


def _list(items: list[Any], compiled: bool) -> Any:
    if not compiled:
        return list(items)
    from numba.typed import List

    typed = List()
    for item in items:
        typed.append(item)
    return typed


def play_seed(scenario: Scenario, seed: int, brave: bool, compiled: bool = True) -> Played:
    """One game of a scenario: with the evader's strategy, or `brave`, straight at its target."""
    d = draw(scenario, seed)
    log = np.zeros((d.tracks.shape[0], len(d.players), 5))
    still = [Command(Steer.COURSE, 0.0, 0.0, 0.0)] * len(d.players)
    found = (compiled_play() if compiled else play)(
        d.game, d.params, _list(d.players, compiled), _list(still, compiled), d.fleet, d.climate, d.sensor,
        d.band, brave, d.gusts, d.tracks, log,
    )  # fmt: skip
    log = log[: found.steps]
    span = round(WITHIN / d.params.dt)
    return Played(
        GameResult(found.game.score.verdict),
        found.game.score.time,
        found.game.score.smallest,
        reversals(log[:, 0, 3], span),
        reversals(log[:, 0, 4], span),
        found,
        log,
    )


def reversals(course: Array, span: int) -> int:
    """How often a course turned by more than 10° and back by more than 10° within `span` samples.

    Counted once each: a window that holds one is left behind.
    """
    angle = np.unwrap(course)
    count = 0
    k = 0
    while k < len(angle) - span:
        window = angle[k : k + span + 1]
        high, low = int(np.argmax(window)), int(np.argmin(window))
        up_down = min(window[high] - window[0], window[high] - window[-1])
        down_up = min(window[0] - window[low], window[-1] - window[low])
        if max(up_down, down_up) > REVERSAL:
            count += 1
            k += span
        else:
            k += 1
    return count


class Tally(NamedTuple):
    """One way of flying over all seeds."""

    way: str
    games: int
    captured: int
    arrived: int
    neither: int
    arrival_time: float  # mean of those that arrived [s]; nan where none did
    smallest: float  # median smallest distance [m]
    reversals: int
    decided_reversals: int
    flown_s: float
    pitch_deg: tuple[float, float]
    speed: tuple[float, float]  # share of the declared airspeed
    lowest: float  # [m]


def tally(way: str, games: list[Played]) -> Tally:
    """Counts of one way of flying."""
    verdicts = [g.verdict for g in games]
    arrivals = [g.time for g in games if g.verdict == GameResult.ARRIVED]
    reach = [g.play.envelope for g in games]
    return Tally(
        way,
        len(games),
        verdicts.count(GameResult.CAPTURED),
        verdicts.count(GameResult.ARRIVED),
        verdicts.count(GameResult.ESCAPED),
        float(np.mean(arrivals)) if arrivals else float("nan"),
        float(np.median([g.smallest for g in games])),
        sum(g.reversals for g in games),
        sum(g.decided_reversals for g in games),
        sum(g.time for g in games),
        (degrees(min(e.pitch_low for e in reach)), degrees(max(e.pitch_high for e in reach))),
        (min(e.speed_low for e in reach), max(e.speed_high for e in reach)),
        min(e.lowest for e in reach),
    )


class Contest(NamedTuple):
    """Both ways over the same seeds."""

    scenario: str
    strategy: Tally
    straight: Tally
    saved: int  # captured straight, not with the strategy
    lost: int  # captured with the strategy, not straight
    p_value: float  # exact McNemar test on those pairs, two-sided


def contest(scenario: Scenario, seeds: range, compiled: bool = True) -> Contest:
    """Play all seeds both ways."""
    with_it = [play_seed(scenario, seed, False, compiled) for seed in seeds]
    straight = [play_seed(scenario, seed, True, compiled) for seed in seeds]
    pairs = [
        (a.verdict == GameResult.CAPTURED, b.verdict == GameResult.CAPTURED)
        for a, b in zip(with_it, straight, strict=True)
    ]
    saved = sum(b and not a for a, b in pairs)
    lost = sum(a and not b for a, b in pairs)
    return Contest(
        scenario.name,
        tally("strategy of 3.4.1", with_it),
        tally("straight at the target", straight),
        saved,
        lost,
        mcnemar(saved, lost),
    )


def mcnemar(saved: int, lost: int) -> float:
    """Exact two-sided test that both discordant outcomes are as likely."""
    from scipy.stats import binomtest

    return float(binomtest(saved, saved + lost, 0.5).pvalue) if saved + lost else 1.0


def wilson(count: int, games: int) -> tuple[float, float]:
    """95 % confidence interval of a share."""
    z = 1.959963984540054
    share = count / games
    middle = share + z * z / (2 * games)
    spread = z * sqrt(share * (1 - share) / games + z * z / (4 * games * games))
    below = 1 + z * z / games
    return (middle - spread) / below, (middle + spread) / below


def table(contests: list[Contest]) -> str:
    """Contests as a Markdown table."""
    lines = [
        "| scenario | evader | captured (95 %) | arrived (95 %) | neither | arrival time [s] |"
        " median smallest distance [m] | reversals flown (decided) per minute |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for c in contests:
        for t in (c.strategy, c.straight):
            minutes = t.flown_s / 60.0
            lines.append(
                f"| {c.scenario} | {t.way} | {_share(t.captured, t.games)} | {_share(t.arrived, t.games)} |"
                f" {t.neither} | {t.arrival_time:.0f} | {t.smallest:.0f} |"
                f" {t.reversals / minutes:.3f} ({t.decided_reversals / minutes:.3f}) |"
            )
    lines.append("")
    for c in contests:
        lines.append(
            f"{c.scenario}: of the same {c.strategy.games} games, {c.saved} were captured only straight and"
            f" {c.lost} only with the strategy (McNemar, exact: p = {c.p_value:.1e}). Pitch"
            f" {c.strategy.pitch_deg[0]:.1f} to {c.strategy.pitch_deg[1]:.1f} deg, airspeed"
            f" {100 * c.strategy.speed[0]:.1f} to {100 * c.strategy.speed[1]:.1f} % of the declared, lowest"
            f" height {c.strategy.lowest:.0f} m."
        )
    return "\n".join(lines)


def _share(count: int, games: int) -> str:
    low, high = wilson(count, games)
    return f"{count} = {100 * count / games:.0f} % ({100 * low:.0f}–{100 * high:.0f})"


def output(folder: Path, name: str, text: str) -> Path:
    """Write a result."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_text(text + "\n", encoding="utf-8")
    return path
