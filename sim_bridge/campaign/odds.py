"""The table behind go or no-go: many compiled games from drawn starts, fitted, and judged on games held out.

`python -m sim_bridge.campaign.odds` writes onboard/game/odds.json, and of each kind a page in
benchmarks/results with its picture; `--kind space` makes one kind anew. Games that were played stay in the
folder `--parts`, so that a run that was stopped goes on.
"""

from __future__ import annotations

import argparse
import os
import platform
from hashlib import sha256
from importlib.util import find_spec
from math import atan2, cos, degrees, pi, radians, sin
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import Conditions, Game, begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import ZERO, Vec, scale, sub, unit
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.core.strategy.team.plan_types import Heights, Member
from onboard.game.go_or_no_go import engagement_of
from onboard.game.odds import (
    NAMES,
    Outcome,
    Sheet,
    Table,
    engagement,
    features,
    manners,
    ringed,
    said_of,
    staged,
)
from onboard.game.scenario import Scenario, VehicleSpec
from onboard.runtime.whole_files import write_whole
from sim_bridge.campaign.compiled import campaign, starts_of
from sim_bridge.campaign.odds_page import Judged, Shipped, page, reliability
from sim_bridge.campaign.plane_in_wind import drawn_wind
from sim_bridge.campaign.spatial_draw import (
    KERNELS,
    draw,
    drawn_scenario,
    kernel_of,
    log_of,
    sky_of,
    spatial,
)
from sim_bridge.campaign.spatial_game import Chosen

EVADING = ("paper", "evasive")
PURSUING = "constant-bearing"
SHIPPED = ("five", "six", "ring-4", "ring-5", "ring-6")  # that are compared with what is said of them
OUTCOMES = (("captured", GameResult.CAPTURED), ("arrived", GameResult.ARRIVED))
HELD_OUT = 4  # every so-manieth game judges, the others fit
RIDGE = 1.0  # of the standardised weights
SIZES = {"plane": (3, 4, 5, 6, 7), "space": (4, 5, 6)}
PLANE = Rules(R=2.0, rho=4.0, horizon=300.0, planar=True)

Array = NDArray[np.float64]


class Part(NamedTuple):
    """Games of one kind and size."""

    x: Array  # (games, features)
    ends: NDArray[np.int64]  # (games, evaders) verdicts
    sources: str  # hash of what played them


def bearings(rng: np.random.Generator, count: int) -> tuple[Array, Array]:
    """Bearings [rad] and distances (1 = the scale) about the evader: anywhere, or on a loose ring."""
    if rng.random() < 0.4:
        return rng.uniform(-pi, pi, count), rng.uniform(0.3, 1.7, count)
    even = rng.uniform(-pi, pi) + 2.0 * pi * np.arange(count) / count
    loose = rng.uniform(0.0, 0.6)
    off = rng.standard_normal((2, count)).clip(-2.0, 2.0)
    return even + loose * off[0], 1.0 + 0.4 * loose * off[1]


def plane_game(rng: np.random.Generator, count: int) -> tuple[Game, Vec]:
    """A start in the plane, and its target."""
    scale_m = rng.uniform(20.0, 100.0)
    yaws, far = bearings(rng, count)
    goal = rng.uniform(40.0, 250.0)
    target = Vec(goal, 0.0, 0.0)
    v_e, v_p = 5.0, float(rng.uniform(3.5, 4.5))
    evader = Vehicle(ZERO, Vec(v_e, 0.0, 0.0), v_e)
    team = []
    for yaw, d in zip(yaws, far, strict=True):
        place = Vec(float(max(8.0, scale_m * d) * cos(yaw)), float(max(8.0, scale_m * d) * sin(yaw)), 0.0)
        team.append(Vehicle(place, scale(unit(sub(ZERO, place), ZERO), v_p), v_p))
    return begin(evader, tuple(team), FREE, (FREE,) * count), target


def plane_part(games: int, count: int) -> Part:
    """Games in the plane against `count` pursuers."""
    rng = np.random.default_rng([1, count])
    drawn = [plane_game(rng, count) for _ in range(games)]
    starts = starts_of([game for game, _ in drawn], [target for _, target in drawn])
    conditions = Conditions(PLANE, Target(True, ZERO), Control(0.1))
    ends = [
        campaign(EVADERS[name].decide, PURSUERS[PURSUING].decide, count)(starts, conditions).verdicts
        for name in EVADING
    ]
    rows = []
    for game, target in drawn:
        team = tuple(Member(one, FREE, True) for one in game.pursuers)
        s = engagement(Member(game.evader, FREE, True), team, Target(True, target), PLANE, Heights(), 0.0)
        rows.append(features(s))
    return Part(np.array(rows), np.array(ends).T, sources())


def space_scenario(seed: int, count: int) -> Scenario:
    """A start of aircraft in space, in the world of `spatial/five`.

    Places and noses are drawn; every fourth time some staging from the places follows, every eighth time
    it is an even ring: then all noses are on parallel pursuit.
    """
    rng = np.random.default_rng([2, count, seed])
    base = spatial("five")
    replace = msgspec.structs.replace
    yaws, far = bearings(rng, count)
    scale_m, goal = rng.uniform(1200.0, 3500.0), rng.uniform(4000.0, 9000.0)
    speed = float(rng.uniform(35.0, 45.0))
    spec = replace(base.pursuers[0], speed=speed, speed_min=0.8 * speed)
    places = []
    for yaw, d in zip(yaws, far, strict=True):
        level = float(max(700.0, scale_m * d))
        places.append(Vec(level * cos(yaw), level * sin(yaw), -1500.0 + float(rng.normal(0.0, 60.0))))
    world = 10_000 * count + seed
    drawn = replace(
        base,
        evader=replace(base.evader, target=(float(goal), 0.0, 1500.0)),
        seed=world,
        flight=replace(base.flight, wind=replace(base.flight.wind, from_deg=drawn_wind(world))),
    )
    found = _placed(drawn, spec, places)
    kind, seconds, radius, phase = rng.uniform((0, 0, 1200, -pi), (1, 120, 3500, pi))
    if kind < 0.25:
        s = staged(engagement_of(found), float(seconds))
    elif kind < 0.375:
        s = ringed(engagement_of(found), float(radius), float(phase) / count * (kind < 0.3125))
    else:
        return _turned(found, rng)
    return _placed(drawn, spec, [member.vehicle.position for member in s.team])


def _turned(scenario: Scenario, rng: np.random.Generator) -> Scenario:
    """A scenario with its pursuers' noses as drawn: a third on parallel pursuit, a third all about as far off
    it, a third each anywhere."""
    kind, all_off = rng.integers(3), rng.uniform(-pi, pi)
    pursuers = []
    for spec in scenario.pursuers:
        off = (0.0, all_off + 0.3 * rng.standard_normal(), rng.uniform(-pi, pi))[kind]
        nose = degrees(wrap(radians(spec.heading_deg or 0.0) + off))
        pursuers.append(msgspec.structs.replace(spec, heading_deg=nose))
    return msgspec.structs.replace(scenario, pursuers=tuple(pursuers))


def _placed(scenario: Scenario, spec: VehicleSpec, places: list[Vec]) -> Scenario:
    """A scenario with pursuers like `spec` at `places`, their noses on parallel pursuit."""
    e = scenario.evader
    pursuers = []
    for place in places:
        nose = lead(place, spec.speed, e.start(), Vec(e.speed, 0.0, 0.0))
        told = degrees(atan2(nose.y, nose.x))
        there = (place.x, place.y, -place.z)
        pursuers.append(msgspec.structs.replace(spec, position=there, heading_deg=told))
    return msgspec.structs.replace(scenario, pursuers=tuple(pursuers))


def space_part(games: int, count: int, before: int = 0) -> Part:
    """Games of aircraft in wind, with noise, delay and gusts, against `count` pursuers; of the seeds that
    follow on `before`."""
    rows, ends = [], []
    for seed in range(before + 1, before + games + 1):
        scenario = space_scenario(seed, count)
        rows.append(features(engagement_of(scenario)))
        ends.append([_end(scenario, number) for number in range(len(EVADING))])
    return Part(np.array(rows), np.array(ends), sources())


def _end(scenario: Scenario, evader: int) -> int:
    """The verdict of a game of aircraft against the evader of this number."""
    play = kernel_of(tuple(EVADERS[name].decide for name in EVADING), (PURSUERS[PURSUING].decide,), True)
    d = draw(scenario, 0)
    chosen = Chosen(evader, (0,) * len(scenario.pursuers))
    return int(play(d.start, chosen, sky_of(d, True), log_of(d)).game.score.verdict)


def shipped(found: Sheet, games: int = 60) -> list[Shipped]:
    """What a sheet says of the shipped scenarios of aircraft, and how games from them end; two rows each."""
    rows = []
    for name in SHIPPED:
        base = spatial(name)
        starts = [drawn_scenario(base, seed) for seed in range(1, games + 1)]
        said = [said_of(found, EVADING[0], features(engagement_of(one))) for one in starts]
        ends = [_end(one, 0) for one in starts]
        for outcome, verdict in OUTCOMES:
            mean = sum(getattr(one, outcome).p for one in said) / games
            rows.append(Shipped(name, outcome, games, mean, ends.count(int(verdict))))
    return rows


def parts(folder: Path, kind: str, games: int) -> Part:
    """The games of a kind, those of the folder and the missing ones, which are played."""
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for count in SIZES[kind]:
        path = folder / f"{kind}-{count}-{games}-{PURSUING}.npz"
        if not path.exists():
            part = (plane_part if kind == "plane" else space_part)(games, count)
            np.savez(path, **part._asdict())
            print(f"played: {path}", flush=True)
        with np.load(path) as kept:
            found.append(Part(kept["x"], kept["ends"], str(kept["sources"])))
    by = "+".join(sorted({p.sources for p in found}))
    return Part(np.concatenate([p.x for p in found]), np.concatenate([p.ends for p in found]), by)


def fitted(z: Array, y: Array) -> Outcome:
    """Logistic regression by Newton's method, weights held small by RIDGE (not the constant)."""
    held = RIDGE * np.eye(z.shape[1])
    held[0, 0] = 1e-6
    w = np.zeros(z.shape[1])
    hessian = held
    for _ in range(50):
        p = 1.0 / (1.0 + np.exp(-np.clip(z @ w, -500, 500)))
        hessian = z.T @ (z * (p * (1.0 - p))[:, None]) + held
        step = np.linalg.solve(hessian, z.T @ (y - p) - held @ w)
        w += step
        if float(np.abs(step).max()) < 1e-9:
            break
    rounded = [[float(f"{v:.4g}") for v in row] for row in np.linalg.inv(hessian)]
    return Outcome(tuple(float(f"{v:.6g}") for v in w), tuple(tuple(row) for row in rounded))


def judged(kind: str, evader: str, outcome: str, said: Array, y: Array) -> Judged:
    """Brier score and reliability in ten bins."""
    bins = []
    for k in range(10):
        inside = (said >= k / 10) & ((said < (k + 1) / 10) | (k == 9))
        if inside.any():
            bins.append((float(said[inside].mean()), int(inside.sum()), int(y[inside].sum())))
    brier, plain = float(np.mean((said - y) ** 2)), float(y.mean() * (1 - y.mean()))
    return Judged(kind, evader, outcome, len(y), float(y.mean()), brier, plain, tuple(bins))


def sheet(kind: str, part: Part, command: str) -> tuple[Sheet, list[Judged]]:
    """A kind's fits, and how they do on every fourth game, which they have not seen."""
    x, games = part.x, len(part.x)
    held = np.arange(games) % HELD_OUT == 0
    mean, deviation = x.mean(axis=0), np.maximum(x.std(axis=0), 1e-9)
    z = (x - mean) / deviation
    z[:, 0] = 1.0
    fits: dict[str, dict[str, Outcome]] = {}
    told = []
    for number, evader in enumerate(EVADING):
        fits[evader] = {}
        left, rest = np.ones(games, bool), np.ones(int(held.sum()))  # games, and chances, without a capture
        for outcome, verdict in OUTCOMES:
            y = (part.ends[:, number] == int(verdict)).astype(float)
            fit = fitted(z[~held & left], y[~held & left])
            fits[evader][outcome] = fit
            said = rest / (1.0 + np.exp(-np.clip(z[held] @ np.array(fit.weights), -500, 500)))
            told.append(judged(kind, evader, outcome, said, y[held]))
            left, rest = left & (y == 0.0), rest - said

    def short(values: Array) -> tuple[float, ...]:
        return tuple(float(f"{v:.6g}") for v in values)

    low, high = short(np.quantile(x, 0.002, axis=0)), short(np.quantile(x, 0.998, axis=0))
    fewest, most = min(SIZES[kind]), max(SIZES[kind])
    turn, pitch = manners(engagement_of(spatial("five"))) if kind == "space" else (0.0, 0.0)
    evaders = (fewest, most), turn, pitch
    return Sheet(command, part.sources, games, *evaders, low, high, short(mean), short(deviation), fits), told


def sources() -> str:
    """Sixteen hexadecimal digits of the kernels that play, and of this file."""
    names = sorted({*KERNELS, __spec__.name if __spec__ else __name__})
    texts = [Path(str(find_spec(name).origin)).read_bytes() for name in names]  # type: ignore[union-attr]
    return sha256(b"\0".join(texts)).hexdigest()[:16]


PAGES = {"plane": "odds", "space": "odds-space"}
GAMES = {"plane": 1200, "space": 900}


def make(kind: str, given: Any) -> Sheet:
    """A kind's sheet, its page and its picture."""
    games = getattr(given, kind)
    command = f"python -m sim_bridge.campaign.odds --kind {kind} --{kind} {games}"
    found, told = sheet(kind, parts(given.parts, kind, games), command)
    where = f"{platform.machine()} ({os.cpu_count()} cores)"
    made = f"`{command}` on {where}, sources `{found.sources}`. {found.games} games against each evader, of"
    made += f" {', '.join(map(str, SIZES[kind]))} pursuers. Features: {', '.join(NAMES[1:])}."
    beside = shipped(found) if kind == "space" else []
    text = page(kind, told, beside, made, HELD_OUT, PURSUING)
    write_whole(given.pages / f"{PAGES[kind]}.md", text.encode())
    reliability(told, EVADING, given.pictures / f"{PAGES[kind]}.png")
    print(text)
    return found


def main() -> None:
    """Play what is missing, fit, judge, write."""
    parser = argparse.ArgumentParser(prog="python -m sim_bridge.campaign.odds", description=__doc__)
    parser.add_argument("--kind", choices=tuple(SIZES), help="make this one anew, keep the other")
    for kind in SIZES:
        parser.add_argument(f"--{kind}", type=int, default=GAMES[kind], help="games of each team's size")
    parser.add_argument("--parts", type=Path, default=Path(".odds"), help="folder of played games")
    parser.add_argument("--table", type=Path, default=Path("onboard/game/odds.json"))
    parser.add_argument("--pages", type=Path, default=Path("benchmarks/results"))
    parser.add_argument("--pictures", type=Path, default=Path("docs/pictures"))
    given = parser.parse_args()
    kept = {}
    if given.kind:
        kept = msgspec.json.decode(given.table.read_bytes(), type=Table).sheets
    sheets = kept | {kind: make(kind, given) for kind in SIZES if given.kind in (None, kind)}
    table = Table(PURSUING, sheets)
    write_whole(given.table, msgspec.json.format(msgspec.json.encode(table), indent=1) + b"\n")


if __name__ == "__main__":
    main()
