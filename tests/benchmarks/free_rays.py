"""What the search for the free ray costs compiled: `python -m tests.benchmarks.free_rays`.

All pairs of edges (what few cones are searched by where it is interpreted) beside the search one cone after
another, on the same situations in turn. The page is benchmarks/results/free-rays.md.
"""

from __future__ import annotations

from collections.abc import Callable
from time import process_time
from typing import Annotated, Any

import numpy as np
import typer

from onboard.core.geometry import edges
from onboard.core.geometry.cones import Ray, blocked_cones
from onboard.core.math.each import MANY, each
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec
from sim_bridge.campaign.compiled import register, register_strategies
from sim_bridge.campaign.kernel_cache import kernel
from tests.support import benchmark_record

COMMAND = "python -m tests.benchmarks.free_rays"
ROUNDS = 7


def placed(index: int, _number: int, row: Any) -> Vehicle:
    """A pursuer of a situation (for `each`)."""
    return Vehicle(Vec(row[index, 0], row[index, 1], row[index, 2]), ZERO, 4.0)


def searching(search: Callable[..., Ray], count: int) -> Callable[..., None]:
    """A kernel that searches many situations of so many pursuers."""
    team = tuple(range(count))

    def run(rows: Any, found: Any) -> None:
        for number in range(rows.shape[0]):
            cones = blocked_cones(Vehicle(ZERO, ZERO, 5.0), each(placed, team, rows[number]), 4.0)
            found[number] = search(cones, NORTH).closeness

    register()
    register_strategies((placed,))
    return kernel(run, error_model="numpy")


def situations(count: int, games: int) -> Any:
    """(games, count, 3) [m]: pursuers 20 to 200 m away all around, one of them ahead."""
    rng = np.random.default_rng(count)
    ways = rng.standard_normal((games, count, 3))
    ways[:, 0] = (1.0, 0.0, 0.0) + 0.3 * ways[:, 0]
    far = rng.uniform(20.0, 200.0, (games, count, 1))
    return far * ways / np.linalg.norm(ways, axis=2, keepdims=True)


def row(count: int) -> str:
    """The table's row of so many cones."""
    rows = situations(count, max(400, 20000 // count))
    ways = [
        searching(search, count)
        for search in (edges.by_pairs, edges.one_by_one if count < MANY else edges.of_many)
    ]
    found = np.zeros((2, len(rows)))
    best = [np.inf, np.inf]
    for number in range(ROUNDS + 1):
        for k, way in enumerate(ways):
            begin = process_time()
            way(rows, found[k])
            if number:  # the first compiles
                best[k] = min(best[k], (process_time() - begin) / len(rows))
    off = float(abs(found[0] - found[1]).max())
    closed = float((found[0] < -1.5).mean())
    before, now = (1e9 * seconds for seconds in best)
    times = f"{before:,.0f} | {now:,.0f} | {before / now:.2f}"
    text = f"| {count} | {100 * closed:.0f} % | {times} | {off:.1e} |"
    print(text, flush=True)
    return text


def main(sizes: Annotated[str, typer.Option(help="Numbers of cones.")] = "5,8,10,20,50") -> None:
    """Measure and write benchmarks/results/free-rays.md."""
    lines = [
        "Cones of pursuers all around at 0.8 times the evader's speed, one of them ahead. CPU nanoseconds a",
        "situation, its cones included, the least of seven turns; interpreted and compiled are one source.",
        "Both find the same of few cones; of eight and more the search takes any of rays that are as near.",
        "",
        "| cones | nothing free | all pairs | one by one | times faster | closeness differs by at most |",
        "|---|---|---|---|---|---|",
        *[row(int(size)) for size in sizes.split(",")],
    ]
    benchmark_record.write("free-rays.md", "The search for the free ray, compiled", COMMAND, lines)


if __name__ == "__main__":
    typer.run(main)
