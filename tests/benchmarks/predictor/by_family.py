"""`python -m tests.benchmarks.predictor.by_family [FOLDER] [--seeds N] [--first SEED]`: beside tuned filters.

50 m/s, 10 Hz, 3 m of noise, gusts of 1.5 m/s; seven families, among them the paper's evader. The filters
(filterpy's) are tuned on seeds of their own. Writes predictor-by-family.md: errors by family against each
filter and the best of them, what ridge, network and manoeuvre filter bring, and whether stated errors hold.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from math import cos, pi, sin
from pathlib import Path
from typing import NamedTuple

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

import numpy as np  # noqa: E402  (threads are set before anything imports NumPy)

from onboard.core.game.advance import Conditions, begin, decide_pursuers, moved, still_view  # noqa: E402
from onboard.core.game.rules import Control, Rules, Target  # noqa: E402
from onboard.core.game.views import sighted  # noqa: E402
from onboard.core.math.states import FREE, Vehicle  # noqa: E402
from onboard.core.math.vectors import NORTH, ZERO, Vec, along, scale, unit  # noqa: E402
from onboard.game.plugins import evader_strategy, pursuer_strategy  # noqa: E402
from onboard.pilot.predictor import TrackPredictor, Trainer  # noqa: E402
from onboard.pilot.predictor.model import ModelSettings  # noqa: E402
from onboard.pilot.predictor.track import PredictorSettings  # noqa: E402
from tests.benchmarks.predictor import families  # noqa: E402
from tests.benchmarks.predictor.families import FAMILIES, Array, geometric  # noqa: E402
from tests.benchmarks.predictor.games import TURN, turned_by  # noqa: E402
from tests.support import benchmark_record  # noqa: E402

AHEAD = np.array([0.2, 0.5, 1.0, 2.0, 4.0])  # [s]
RATE, SPEED, SIGMA, SECONDS, SINCE = 10.0, 50.0, 3.0, 60.0, 400
NOISE = (SIGMA**2, SIGMA**2, SIGMA**2, -1.0, -1.0, -1.0)
PAPER = "the paper's evader"
ALL = (*FAMILIES, PAPER)
TUNING = range(2000, 2001)
PARTS = {
    "all": ModelSettings(),
    "no network": ModelSettings(networks=False),
    "no manoeuvre filter": ModelSettings(manoeuvres=False),
}


def evader_flight(seed: int) -> Array:
    """True places (n, 3) at RATE of an evader that runs for a target by the paper's rules."""
    rng = np.random.default_rng([seed, 5])
    bearings, ranges = rng.uniform(-pi, pi, 6), rng.uniform(400.0, 900.0, 5)
    places = [Vec(r * cos(b), r * sin(b), 0.0) for r, b in zip(ranges, bearings[:5], strict=True)]
    target = Vec(4000.0 * cos(bearings[5]), 4000.0 * sin(bearings[5]), 0.0)
    dt = 0.05
    rules = Rules(0.01, 4.0, epsilon_min=0.01, horizon=SECONDS, planar=True)
    conditions = Conditions(rules, Target(True, target), Control(dt))
    evader = Vehicle(ZERO, scale(unit(target, NORTH), SPEED), SPEED)
    game = begin(evader, tuple(Vehicle(p, ZERO, 40.0) for p in places), FREE, (FREE,) * 5)
    flee, chase = evader_strategy(""), pursuer_strategy("")
    out = []
    for k in range(round(SECONDS / dt) + 1):
        if k % round(1.0 / RATE / dt) == 0:
            out.append(list(game.evader.position))
        wanted = flee(still_view(game, conditions)).direction
        heading = turned_by(unit(game.evader.velocity, NORTH), wanted, TURN * dt)
        runner = Vehicle(game.evader.position, scale(heading, SPEED), SPEED)
        sighting = sighted(runner, heading, conditions.control.lookahead)
        pursuers = decide_pursuers(game, sighting, conditions, chase)
        game = game._replace(
            time=game.time + dt,
            pursuers=tuple(moved(p, d, dt) for p, d in zip(game.pursuers, pursuers, strict=True)),
            evader=runner._replace(position=along(runner.position, runner.velocity, dt)),
        )
    return np.array(out)


def flight(family: str, seed: int) -> tuple[Array, Array]:
    """(measured, true) places, each (n, 3), at RATE."""
    if family == PAPER:
        true = evader_flight(seed)
    else:
        air, count = families.Conditions(gust=1.5), int(SECONDS * RATE) + 1
        _, true = families.trajectory(family, air, seed, count, 1.0 / RATE, SPEED)
    noise = np.random.default_rng([seed, 77]).normal(0.0, SIGMA, true.shape)
    return true + noise, true


def errors_of(said: Array, true: Array, last: int) -> Array:
    """Distances (k, A) of forecasts (k, A, 2 or 3) made at the samples SINCE − 1 … from the truth."""
    at = np.arange(SINCE - 1, last)[:, None] + np.rint(AHEAD * RATE).astype(int)
    size = said.shape[2]
    out: Array = np.linalg.norm(said[: len(at)] - true[at][:, :, :size], axis=2)
    return out


def last_of(true: Array) -> int:
    """One past the last sample whose forecasts can all be judged."""
    return len(true) - round(float(AHEAD[-1]) * RATE)


class Followed(NamedTuple):
    """The predictor on one flight."""

    errors: Array  # (k, A) horizontal distance [m]
    whole: Array  # (k, A) distance in space [m]
    stated: Array  # (k, A) [m]


def follow(settings: ModelSettings, family: str, seed: int) -> Followed:
    """Let the predictor learn and predict as it does in flight."""
    seen, true = flight(family, seed)
    track, trainer = TrackPredictor(seed, PredictorSettings(model=settings)), Trainer()
    said, stated = [], []
    for k, place in enumerate(seen.tolist()):
        t = k / RATE
        track.add(t, Vec(*place), None, NOISE)
        trainer.advance(t, {1: track}, 2)
        if SINCE - 1 <= k < last_of(true):
            answers = [track.predict(t + ahead) for ahead in AHEAD.tolist()]
            said.append([list(answer.position) for answer in answers])
            stated.append([answer.sigma for answer in answers])
    places = np.array(said)
    last = last_of(true)
    return Followed(errors_of(places[:, :, :2], true, last), errors_of(places, true, last), np.array(stated))


def filtered(name: str, numbers: tuple[float, ...], family: str, seed: int) -> Array:
    """Horizontal errors (k, A) of a baseline."""
    from tests.benchmarks.predictor.baselines import KINDS, forecasts

    seen, true = flight(family, seed)
    one = KINDS[name].make(seen[0, :2], 1.0 / RATE, SIGMA, *numbers)
    said = forecasts(one, seen[1:, :2], AHEAD, SINCE - 1)
    return errors_of(said, true, last_of(true))


def tune(pool: ProcessPoolExecutor, name: str) -> tuple[float, ...]:
    """The numbers with the least geometric mean error over families and horizons on the tuning seeds."""
    from tests.benchmarks.predictor.baselines import KINDS, choices

    best: tuple[float, tuple[float, ...]] = (np.inf, ())
    jobs = [(family, seed) for family in ALL for seed in TUNING]
    for numbers in choices(KINDS[name]):
        found = pool.map(partial(filtered, name, numbers), *zip(*jobs, strict=True))
        best = min(best, (float(geometric([one.mean(axis=0) for one in found]).prod()), numbers))
    return best[1]


def compare(pool: ProcessPoolExecutor, seeds: range) -> tuple[dict[str, tuple[float, ...]], list[str]]:
    """The tuned numbers of each baseline, and the lines of the page."""
    from tests.benchmarks.predictor.baselines import KINDS

    numbers = {name: tune(pool, name) for name in KINDS}
    jobs = [(family, seed) for family in ALL for seed in seeds]
    split = [slice(i * len(seeds), (i + 1) * len(seeds)) for i in range(len(ALL))]

    def by_family(errors: list[Array]) -> Array:
        means = np.array([one.mean(axis=0) for one in errors])
        return np.array([means[part].mean(axis=0) for part in split])

    others = {
        name: by_family(list(pool.map(partial(filtered, name, numbers[name]), *zip(*jobs, strict=True))))
        for name in KINDS
    }
    flown = {
        part: list(pool.map(partial(follow, settings), *zip(*jobs, strict=True)))
        for part, settings in PARTS.items()
    }
    mine = {part: by_family([one.errors for one in found]) for part, found in flown.items()}
    best = np.min([*others.values()], axis=0)
    lines = ["## Error over a filter's, by family", "", _head(("", *KINDS, "the best of them"))]
    for row, family in enumerate(ALL):
        cells = [_row(mine["all"][row] / other[row]) for other in (*others.values(), best)]
        lines.append(_line((family, *cells)))
    whole = [_row(geometric(mine["all"] / other)) for other in (*others.values(), best)]
    lines.append(_line(("geometric mean", *whole)))
    worst = float((mine["all"] / best).max())
    lines += ["", f"Worst against the best filter, any family and horizon: {worst:.2f} (wanted: 1.05)."]
    lines += ["", "## What the parts bring: error without a part over the whole's", ""]
    lines += [_head(("family", *list(PARTS)[1:]))]
    for row, family in enumerate(ALL):
        cells = [_row(mine[part][row] / mine["all"][row]) for part in list(PARTS)[1:]]
        lines.append(_line((family, *cells)))
    means = [_row(geometric(mine[part] / mine["all"])) for part in list(PARTS)[1:]]
    lines.append(_line(("geometric mean", *means)))
    lines += ["", "## Stated errors: share of the facts within one and two of them [%]", ""]
    lines += [_head(("family", "one (68 wanted)", "two (95 wanted)"))]
    for part, family in zip(split, ALL, strict=True):
        errors = np.concatenate([one.whole for one in flown["all"][part]])
        stated = np.concatenate([one.stated for one in flown["all"][part]])
        cells = [" ".join(f"{100 * x:.0f}" for x in (errors <= k * stated).mean(axis=0)) for k in (1, 2)]
        lines.append(_line((family, *cells)))
    return numbers, lines


def _head(cells: Sequence[str]) -> str:
    return f"{_line(cells)}\n{'|---' * len(cells)}|"


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _row(values: Array) -> str:
    return " ".join(f"{value:.2f}" for value in values)


def main(arguments: Sequence[str] | None = None) -> int:
    """Compare and write the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.predictor.by_family")
    parser.add_argument("folder", nargs="?", default="benchmarks/results", type=Path)
    parser.add_argument("--seeds", type=int, default=6, metavar="N", help="flights a family (6)")
    parser.add_argument("--first", type=int, default=5000, metavar="SEED", help="of the flights (5000)")
    options = parser.parse_args(arguments)
    with ProcessPoolExecutor(2) as pool:
        numbers, lines = compare(pool, range(options.first, options.first + options.seeds))
    tuned = "; ".join(f"{name} {', '.join(f'{n:g}' for n in found)}" for name, found in numbers.items())
    page = [
        "# The predictor beside tuned filters, by family",
        "",
        f"`python -m tests.benchmarks.predictor.by_family --seeds {options.seeds} --first {options.first}` on"
        f" {benchmark_record.machine()}. {SPEED:g} m/s, {RATE:g} Hz, {SIGMA:g} m of noise, gusts of 1.5 m/s"
        f" (none for {PAPER}); {options.seeds} flights a family, forecasts from the 40th second on, at"
        f" {' / '.join(f'{a:g}' for a in AHEAD)} s. Errors: mean horizontal distance. Filters: filterpy's,"
        f" tuned on seeds of their own over the same families: {tuned}.",
        "",
        *lines,
    ]
    (options.folder / "predictor-by-family.md").write_text("\n".join(page) + "\n", encoding="utf-8")
    print("\n".join(page))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
