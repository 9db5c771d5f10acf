"""What starting costs: `--help` of each program, Table 1 interpreted and compiled, a track's prediction.

Promises: `--help` of any command 0.25 CPU-seconds, Table 1 compiled below one. CPU time of the processes, the
best of some; the first compiled run compiles and is not measured.
`python -m tests.benchmarks.bench_start`, or with pytest.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from math import cos, sin
from time import process_time

import numpy as np

from onboard.core.math.vectors import Vec
from onboard.pilot.predictor.track import TrackPredictor
from onboard.pilot.predictor.trainer import Trainer
from sim_bridge.campaign.kernel_folder import FOLDER
from tests.benchmarks import yardstick
from tests.support import benchmark_record
from tests.support.paths import ROOT

HELPS = (
    ("onboard.cli",), ("gcs.cli",), ("gcs.cli", "status"), ("gcs.cli", "keys", "init"),
    ("sim_bridge.cli",), ("sim_bridge.cli", "planar"), ("sim_bridge.cli", "campaign", "run"),
)  # fmt: skip
TABLE = ("sim_bridge.cli", "planar", "--json")
RUNS = 3
HELP_S, COMPILED_S = 0.25, 1.0  # promised
TRACK_S = 40.0


def spent(words: tuple[str, ...], **environment: str) -> tuple[float, bytes]:
    """CPU seconds of `python -m words`, the best of some runs, and what it prints."""
    best, said = float("inf"), b""
    for _ in range(RUNS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        said = subprocess.run(
            [sys.executable, "-m", *words], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        ).stdout  # fmt: skip
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        best = min(best, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return best, said


def tracked() -> float:
    """CPU seconds a second of one track at 10 Hz, predicted at 20 Hz by a predictor that learns."""
    rng, track, trainer = np.random.default_rng(1), TrackPredictor(1), Trainer()
    north = east = heading = 0.0
    begun = process_time()
    for step in range(round(TRACK_S * 20.0)):
        t = step * 0.05
        heading += 0.05 * 0.3 * sin(0.4 * t)
        moving = Vec(15.0 * cos(heading), 15.0 * sin(heading), 0.0)
        north, east = north + 0.05 * moving.x, east + 0.05 * moving.y
        if step % 2 == 0:
            off = rng.normal(0.0, 0.15, 3).tolist()
            seen = Vec(north + off[0], east + off[1], off[2] - 50.0)
            track.add(t, seen, moving, (0.0225, 0.0225, 0.0225, 0.01, 0.01, 0.01))
        trainer.advance(t, {1: track})
        track.prepare()
        assert track.predict(t + 0.3).usable
    return (process_time() - begun) / TRACK_S


def tracked_apart() -> float:
    """`tracked` in a process of its own, with one thread for linear algebra as every program has it."""
    code = "from tests.benchmarks.bench_start import tracked; print(tracked())"
    told = subprocess.run(
        [sys.executable, "-c", code], check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
    )  # fmt: skip
    return float(told.stdout)


def report() -> tuple[dict[str, float], float, float]:
    """Measure, keep the costs, write the page: helps, Table 1 interpreted and compiled [CPU s]."""
    helps = {}
    for words in HELPS:
        name = " ".join((*words, "--help"))
        helps[name], _ = spent((*words, "--help"))
        yardstick.cost(name, helps[name])
    spent((*TABLE, "--compile"))
    compiled, one = spent(TABLE)
    yardstick.cost("Table 1, compiled before", compiled)
    interpreted, other = spent(TABLE, **{FOLDER: "off"})
    yardstick.cost("Table 1, interpreted", interpreted)
    assert one == other
    track = min(tracked_apart() for _ in range(RUNS))
    yardstick.cost("a second of a track that is learnt", track)
    lines = [
        f"CPU time of whole processes, the best of {RUNS}.",
        "",
        "| what | CPU [s] | promised |",
        "|---|---|---|",
    ]
    lines += [f"| `python -m {name}` | {took:.2f} | {HELP_S} |" for name, took in helps.items()]
    lines += [
        f"| Table 1, `sim-bridge planar --json`, interpreted | {interpreted:.2f} | |",
        f"| the same compiled, kernels on disk: the same bytes | {compiled:.2f} | {COMPILED_S} |",
        f"| a second of a track at 10 Hz, learnt, predicted at 20 Hz | {track:.4f} | |",
    ]
    print("\n".join(lines))
    benchmark_record.write("start.md", "What starting costs", "python -m tests.benchmarks.bench_start", lines)
    return helps, interpreted, compiled


def test_programs_answer_at_once_and_table_1_plays_compiled() -> None:
    helps, interpreted, compiled = report()
    assert max(helps.values()) <= HELP_S, helps
    assert compiled < min(COMPILED_S, interpreted)


if __name__ == "__main__":
    report()
