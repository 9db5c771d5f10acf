"""What got slower: the costs of the last `make bench` beside the committed ones, in rounds of a yardstick.

A plain loop does not feel a machine's memory as whole programs do: beside another machine's, all costs of a
yard move together (by 12 % between two of one kind). So each is judged beside the median of its yard, and a
median that is slower than the tolerance allows is told as such: then the machine is another, or everything
got slower.

`python -m tests.benchmarks.compare [--tolerance 0.25] [--accept]`. Ends with 0 where nothing is slower than
the tolerance allows, with 1 where something is, with 2 where there is nothing to compare. `--accept` makes
what was measured the committed costs; what was not measured stays.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from statistics import median

from tests.benchmarks.yardstick import COSTS, LATEST, Cost, Yard, read, words, write

TOLERANCE = 0.25  # of a cost: two runs of one state on a busy machine differ by up to some 20 %
ENOUGH = 8  # costs of a yard, for their median to say how they moved together


def moved(before: dict[str, Cost], now: dict[str, Cost]) -> dict[Yard, float]:
    """How many times the costs of each yard are what they were, by their median; 1 for ratios and for few."""
    times: dict[Yard, list[float]] = {yard: [] for yard in Yard}
    for name in before.keys() & now.keys():
        old, new = before[name], now[name]
        if old.yard == new.yard != Yard.NONE:
            times[new.yard].append(new.value / old.value)
    return {yard: median(found) if len(found) >= ENOUGH else 1.0 for yard, found in times.items()}


def changes(before: dict[str, Cost], now: dict[str, Cost], tolerance: float) -> tuple[list[str], list[str]]:
    """What to say of each cost, in order of name, and the names of those that are slower.

    A cost that changed its yard is new: it cannot be compared."""
    lines, slower = [], []
    together = moved(before, now)
    for yard, times in together.items():
        if times != 1.0:
            lines.append(f"{'together':9} {times:8.2f} x all in {yard.value}, their median")
        if times > 1.0 + tolerance:
            slower.append(f"all in {yard.value}")
    for name in sorted(before.keys() | now.keys()):
        old, new = before.get(name), now.get(name)
        if new is None:
            lines.append(f"not measured         {name}")
        elif old is None or old.yard != new.yard:
            lines.append(f"new       {new.value:10.4g} {name}")
        else:
            times = new.value / old.value / together[new.yard]
            word = "faster" if times < 1.0 / (1.0 + tolerance) else "as before"
            if times > 1.0 + tolerance:
                word = "SLOWER"
                slower.append(name)
            lines.append(f"{word:9} {times:8.2f} x {name}")
    return lines, slower


def main(given: list[str], committed: Path = COSTS, latest: Path = LATEST) -> int:
    """Compare, print, and say by the exit code whether something is slower."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.compare", description=__doc__)
    parser.add_argument("--tolerance", type=float, default=TOLERANCE, help="share of a cost (%(default)s)")
    parser.add_argument("--accept", action="store_true", help="commit to what was measured")
    chosen = parser.parse_args(given)
    if not 0.0 < chosen.tolerance < float("inf"):
        parser.error(f"--tolerance must be above zero, not {chosen.tolerance:g}")
    try:
        now = read(latest) if latest.exists() else {}
        before = read(committed) if committed.exists() else {}
    except ValueError as problem:
        print(problem, file=sys.stderr)
        return 2
    if not now:
        print(f"nothing was measured: {latest} has no costs; run `make bench`", file=sys.stderr)
        return 2
    if chosen.accept:
        write(committed, {**before, **now})
        print(f"{len(now)} costs are the committed ones now: {committed}")
        return 0
    lines, slower = changes(before, now, chosen.tolerance)
    print(f"costs in rounds of the yardstick, beside {committed.name}; {words()}")
    print("\n".join(lines))
    print(f"slower by more than {chosen.tolerance:.0%}: {', '.join(slower) or 'nothing'}")
    return 1 if slower else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
