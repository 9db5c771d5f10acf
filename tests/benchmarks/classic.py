"""What our strategies reach of the classical problems' values, and the problems' pictures.

    python -m tests.benchmarks.classic --starts 20 --feints 5

A table a problem: optimal play of both, every pursuers' strategy against the optimal evader and every evader
against optimal pursuers, from the file's start and others near it; the last column is the share that is left
when the opponent begins aside of optimal play in four ways and the worst of five games counts. What a problem
took is kept in `runs/classic`: broken off, it goes on where it was.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
from pathlib import Path

import msgspec

from sim_bridge.classic.problem import Problem
from sim_bridge.classic.problems import PROBLEMS, start_of
from sim_bridge.programs.classic import picture
from sim_bridge.programs.classic.command import HEADINGS, figures, won_of
from sim_bridge.programs.classic.measure import Row, measured, starts_near
from tests.support import benchmark_record
from tests.support.paths import ROOT

KEPT = Path("runs/classic")


class Kept(msgspec.Struct):
    """The rows of a problem."""

    plain: list[Row]
    feinted: list[Row]


def played_by(name: str) -> str:
    """A hash of what decides these games; words do not."""
    rooms = ("sim_bridge/classic", "onboard/core")
    files = [path for room in rooms for path in ROOT.glob(f"{room}/**/*.py")]
    files.append(ROOT / "sim_bridge" / "programs" / "classic" / "measure.py")
    found = hashlib.sha256()
    for path in sorted(files):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
                node.value = ""
        found.update(ast.dump(tree).encode())
    found.update((ROOT / "configs" / "scenarios" / "classic" / f"{name}.toml").read_bytes())
    return found.hexdigest()[:12]


def rows_of(problem: Problem, starts: int, feints: int) -> Kept:
    """A problem's rows, played or kept from before."""
    kept = KEPT / f"{problem.name}-{starts}-{feints}-{played_by(problem.name)}.json"
    if kept.exists():
        return msgspec.json.decode(kept.read_bytes(), type=Kept)
    start = start_of(problem)
    drawn = starts_near(problem, start, max(starts, feints), 1)
    chasers = [name for name in problem.chasers if name not in problem.evaders or name == "paper"]
    found = Kept(
        measured(problem, drawn[:starts]),
        [row for row in measured(problem, drawn[:feints], chasers, feints=True) if row.side == "pursuers"],
    )
    kept.parent.mkdir(parents=True, exist_ok=True)
    kept.write_bytes(msgspec.json.encode(found))
    return found


def table(problem: Problem, found: Kept) -> list[str]:
    """A problem's table and what is to be said of it."""
    worst = {row.strategy: figures(problem, row)[3] for row in found.feinted}
    lines = [
        f"## {problem.title} (`{problem.name}`)\n",
        f"Payoff: {problem.payoff}.\n",
        f"| {' | '.join(HEADINGS)} | with feints |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in found.plain:
        last = worst.get(row.strategy, "–") if row.side == "pursuers" else "–"
        cells = (row.side, row.strategy, won_of(row), *figures(problem, row), last)
        lines.append(f"| {' | '.join(cells)} |")
    return [*lines, f"\nWhere ours fall short: {problem.why}.\n"]


def main() -> None:
    """Write the page and the pictures."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.classic", description=__doc__)
    parser.add_argument("--starts", type=int, default=20)
    parser.add_argument("--feints", type=int, default=5)
    parser.add_argument("--only", nargs="*", help="play these alone, and write no page")
    given = parser.parse_args()
    found = {
        name: rows_of(problem, given.starts, given.feints)
        for name, problem in PROBLEMS.items()
        if not given.only or name in given.only
    }
    if given.only:
        return
    lines = [" ".join(__doc__.split("\n\n")[2].split()) + "\n"]
    for name, rows in found.items():
        lines += table(PROBLEMS[name], rows)
        picture.draw(
            PROBLEMS[name], start_of(PROBLEMS[name]), ROOT / "docs" / "pictures" / f"classic-{name}.svg"
        )
    command = f"python -m tests.benchmarks.classic --starts {given.starts} --feints {given.feints}"
    benchmark_record.write("classic.md", "Classical problems: what ours reach of the value", command, lines)


if __name__ == "__main__":
    main()
