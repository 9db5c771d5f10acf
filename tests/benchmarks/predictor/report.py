"""Runs all parts of the comparison, holds them against the targets, and writes the results."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from tests.benchmarks.predictor import games, regime, study
from tests.benchmarks.predictor.families import CONDITIONS, FAMILIES, Array, trajectory
from tests.benchmarks.predictor.methods import Flying, Paper
from tests.benchmarks.predictor.study import HORIZONS, Study
from tests.support import benchmark_record

STEADY, MINE, BASE, ONLINE = "constant velocity", "s-parabola", "ridge base", "s-parabola, online"
CLEAN, WIND, BOTH = CONDITIONS


class Target(NamedTuple):
    """A target and what was measured."""

    name: str
    found: float
    limit: float

    @property
    def met(self) -> bool:
        """Whether the measured value is at most the limit."""
        return self.found <= self.limit


class Measured(NamedTuple):
    """Everything one run measured."""

    study: Study
    few: dict[int, dict[str, Array]]
    paper_fit: float  # [s] the paper's training of 200 samples, 1000 epochs
    mine_fit: float  # [s] interleaved with it
    regimes: list[regime.Regime]
    load: regime.Load
    cost: regime.Cost
    plain: dict[str, games.Statistics]
    weaving: dict[str, games.Statistics]
    seconds: float


def measure(say: Callable[[str], None]) -> Measured:
    """Run all parts."""
    begun = perf_counter()
    ours = study.run(say)
    few = study.few(say)
    say("times of the fits")
    paper, mine = [], []
    for seed in range(3):
        seen, true = trajectory("turns", CONDITIONS[WIND], seed)
        paper.append(study.trial(Paper(), seen, true, study.LEARN, seed).fit)
        mine.append(study.trial(Flying(), seen, true, study.LEARN, seed).fit)
    say("the game's regime")
    regimes = [regime.regime(rate, say) for rate in regime.RATES]
    say("load")
    return Measured(
        ours,
        few,
        float(np.median(paper)),
        float(np.median(mine)),
        regimes,
        regime.load(),
        regime.activation(),
        games.games(False, games.SEEDS, say),
        games.games(True, games.WEAVING, say),
        perf_counter() - begun,
    )


def targets(m: Measured) -> list[Target]:
    """All targets of the comparison."""
    s = m.study
    out = []
    for condition, limits in ((WIND, (0.80, 0.70, 0.65, 0.65)), (BOTH, (0.85, 0.75, 0.70, 0.70))):
        found = study.ratio(s, condition, MINE, STEADY)
        out += [
            Target(f"{condition}: error to constant velocity's at {h} steps", float(x), limit)
            for h, x, limit in zip(HORIZONS, found, limits, strict=True)
        ]
    out.append(
        Target(
            f"{CLEAN}: error to constant velocity's at 5 steps",
            float(study.ratio(s, CLEAN, MINE, STEADY)[1]),
            0.15,
        )
    )
    for condition in CONDITIONS:
        out.append(
            Target(
                f"{condition}: error to the ridge base's, largest over the horizons",
                float(study.ratio(s, condition, MINE, BASE).max()),
                1.03,
            )
        )
    for samples, by in m.few.items():
        found = max(float(ratios[1:].max()) for ratios in by.values())
        out.append(
            Target(f"{samples} samples: error to constant velocity's at 5 steps and more", found, 1.05)
        )
    out.append(
        Target(
            "online, worst trajectory: error to constant velocity's at 5 steps",
            study.worst(s, ONLINE, 5)[0],
            1.10,
        )
    )
    for other in ("LSTM 32", "GRU 32"):
        for condition in CONDITIONS:
            found = study.ratio(s, condition, MINE, other)
            out += [
                Target(f"{condition}: error to {other}'s at {h} steps", float(x), 1.0)
                for h, x in zip(HORIZONS, found, strict=True)
            ]
    fit, ask = (
        study.median_time(s, MINE, what) / study.median_time(s, "GRU 32", what)
        for what in ("fit", "predict")
    )
    out.append(Target("time of a fit to the GRU's", fit, 1.0 / 8.0))
    out.append(Target("time of a prediction to the GRU's", ask, 1.0 / 3.0))
    out.append(
        Target("time of a fit of 200 samples to the paper's training", m.mine_fit / m.paper_fit, 1.0 / 20.0)
    )
    for r in m.regimes:
        out.append(
            Target(
                f"50 m/s, 3 m, {r.rate:g} Hz: error to the filtered constant velocity's, largest",
                float(r.ratio.max()),
                1.0,
            )
        )
    out.append(
        Target("training's part of a control step, worst [ms of CPU]", 1e3 * m.load.training_worst, 5.0)
    )
    out.append(Target("memory of a running predictor [MB]", m.load.memory / 1e6, 5.0))
    return out


def write(m: Measured, folder: Path) -> int:
    """Write predictor.md and predictor.json; returns how many targets were missed."""
    found = targets(m)
    missed = sum(not target.met for target in found)
    (folder / "predictor.md").write_text("\n".join(_page(m, found, missed)) + "\n", encoding="utf-8")
    (folder / "predictor.json").write_text(json.dumps(_data(m, found), indent=1) + "\n", encoding="utf-8")
    return missed


def _page(m: Measured, found: list[Target], missed: int) -> list[str]:
    s = m.study
    lines = [
        "# Predictors compared",
        "",
        f"One run of `make bench-predictor` of {m.seconds / 60.0:.0f} minutes on "
        f"{benchmark_record.machine()}, NumPy {np.__version__}, one thread. Only ratios of "
        f"times mean something.",
        "",
        f"{len(FAMILIES)} families × {len(study.SEEDS)} held-out seeds, 15 m/s, 0.2 s steps; "
        f"200 samples to learn "
        "from, origins 200 to 279. Error: mean distance to the true place [m], geometric mean "
        "over the families, "
        "at 1 / 5 / 10 / 20 steps. LSTM and GRU get the same windows, frames, mirrored copies "
        "and targets as the "
        f"s-parabola predictor. The paper's training has 300 epochs and "
        f"{len(study.PAPER_SEEDS)} seed a family. "
        "All learn once, but for the row 'online', which is the predictor as it flies: its times hold the "
        "forty steps before the first prediction, and a fit of the ridge at each prediction.",
        "",
        "| method | fit ms | predict µs | " + " | ".join(CONDITIONS) + " |",
        "|---|---|---|" + "---|" * len(CONDITIONS),
    ]
    for name in study.METHODS:
        cells = [_row(study.geometric(study.family_errors(s, c, name))) for c in CONDITIONS]
        fit, ask = study.median_time(s, name, "fit"), study.median_time(s, name, "predict")
        lines.append(f"| {name} | {1e3 * fit:.1f} | {1e6 * ask:.0f} | " + " | ".join(cells) + " |")
    lines += [
        "",
        "## Ratio to constant velocity",
        "",
        "| method | " + " | ".join(CONDITIONS) + " |",
        "|---|" + "---|" * len(CONDITIONS),
    ]
    for name in study.METHODS:
        lines.append(
            f"| {name} | " + " | ".join(_row(study.ratio(s, c, name, STEADY)) for c in CONDITIONS) + " |"
        )
    ratio, where = study.worst(s, MINE, 5)
    online, there = study.worst(s, ONLINE, 5)
    lines += [
        "",
        f"Worst trajectory at 5 steps: {ratio:.2f} of constant velocity learnt once ({where}); "
        f"{online:.2f} online "
        f"({there}).",
        "",
        "## By family, wind: ratio to constant velocity",
        "",
        "| family | ridge base | s-parabola | LSTM 32 | GRU 32 |",
        "|---|---|---|---|---|",
    ]
    for row, family in enumerate(FAMILIES):
        steady = study.family_errors(s, WIND, STEADY)[row]
        cells = [
            _row(study.family_errors(s, WIND, name)[row] / steady)
            for name in (BASE, MINE, "LSTM 32", "GRU 32")
        ]
        lines.append(f"| {family} | " + " | ".join(cells) + " |")
    lines += [
        "",
        "## Few samples: ratio to constant velocity",
        "",
        "| samples | " + " | ".join(CONDITIONS) + " |",
        "|---|" + "---|" * len(CONDITIONS),
    ]
    lines += [f"| {n} | " + " | ".join(_row(by[c]) for c in CONDITIONS) + " |" for n, by in m.few.items()]
    lines += [
        "",
        "## The game's own regime",
        "",
        f"50 m/s in gusts, {regime.SIGMA:g} m of position noise, no velocity measured, "
        f"{len(regime.SEEDS)} seeds a "
        "family, predictions from the 40th second on, through the track filter, at "
        + " / ".join(f"{a:g}" for a in regime.AHEAD)
        + " s.",
        "",
        "| rate | filtered constant velocity [m] | s-parabola [m] | ratio | worst family "
        "| error ÷ stated error |",
        "|---|---|---|---|---|---|",
    ]
    for r in m.regimes:
        parts = (r.steady, r.mine, r.ratio, r.worst_family, r.calibration)
        lines.append(f"| {r.rate:g} Hz | " + " | ".join(map(_row, parts)) + " |")
    lines += [
        "",
        "## Games with a late sensor",
        "",
        games.__doc__.split("\n\n", 1)[1].strip().replace("\n", " ") if games.__doc__ else "",
        f"{len(games.SEEDS)} seeds ({len(games.WEAVING)} of the weave) of {games.SECONDS:g} s; "
        f"smallest distance of any "
        f"pursuer [m]; the evader keeps {games.SAFE:g} m from pursuers by rule 1.",
        "",
        "| evader | track carried by | mean | quartiles | track's error [m] | nearer than last known |",
        "|---|---|---|---|---|---|",
    ]
    for name, table in (("paper's rules", m.plain), ("the same with a weave", m.weaving)):
        for way, x in table.items():
            lines.append(
                f"| {name} | {way} | {x.mean:.1f} | {x.lower:.1f} / {x.median:.1f} / {x.upper:.1f} | "
                f"{x.error:.1f} | {100 * x.nearer:.0f} % |"
            )
    x = m.load
    lines += [
        "",
        "## What it costs an agent",
        "",
        f"Six tracks at 20 Hz, CPU time of the thread: a control step's share "
        f"{1e3 * x.step_median:.2f} ms in the "
        f"median, {1e3 * x.step_worst:.2f} ms at worst; of it training {1e3 * x.training_median:.2f} and "
        f"{1e3 * x.training_worst:.2f} ms; {1e3 * x.per_second:.0f} ms a second of game. One "
        f"track with its training "
        f"takes {x.memory / 1e6:.2f} MB at its peak. A fit of 200 samples takes "
        f"{1e3 * m.mine_fit:.0f} ms, the "
        f"paper's training {m.paper_fit:.1f} s.",
        "",
        "## The activation",
        "",
        "| ns an element | s-parabola | sigmoid | tanh |",
        "|---|---|---|---|",
    ]
    for name, cost in (("NumPy", m.cost.numpy), ("compiled (numba)", m.cost.compiled)):
        lines.append(
            f"| {name} | " + " | ".join(f"{cost[k]:.2f}" for k in ("s-parabola", "sigmoid", "tanh")) + " |"
        )
    lines += [
        "",
        f"## Targets: {len(found) - missed} of {len(found)} met",
        "",
        "| target | found | at most | |",
        "|---|---|---|---|",
    ]
    lines += [
        f"| {t.name} | {t.found:.3f} | {t.limit:.3f} | {'met' if t.met else '**missed**'} |" for t in found
    ]
    return lines


def _row(values: Array) -> str:
    return " ".join(f"{x:.2f}" if x < 9.95 else f"{x:.1f}" for x in values)


def _data(m: Measured, found: list[Target]) -> dict[str, Any]:
    s = m.study
    return {
        "horizons_steps": HORIZONS,
        "errors_m": {
            c: {n: study.geometric(study.family_errors(s, c, n)).tolist() for n in study.METHODS}
            for c in CONDITIONS
        },
        "errors_by_family_m": {
            c: {
                n: dict(zip(FAMILIES, study.family_errors(s, c, n).tolist(), strict=True))
                for n in study.METHODS
            }
            for c in CONDITIONS
        },
        "fit_s": {n: study.median_time(s, n, "fit") for n in study.METHODS},
        "predict_s": {n: study.median_time(s, n, "predict") for n in study.METHODS},
        "few": {str(n): {c: r.tolist() for c, r in by.items()} for n, by in m.few.items()},
        "regime": [
            {k: v if isinstance(v, float) else v.tolist() for k, v in r._asdict().items()}
            for r in m.regimes
        ],
        "games": {
            "plain": {k: v._asdict() for k, v in m.plain.items()},
            "weaving": {k: v._asdict() for k, v in m.weaving.items()},
        },
        "load": m.load._asdict(),
        "activation_ns": m.cost._asdict(),
        "paper_fit_s": m.paper_fit,
        "mine_fit_s": m.mine_fit,
        "targets": [{**t._asdict(), "met": t.met} for t in found],
    }
