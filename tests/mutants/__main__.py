"""Mutants: would the tests notice? cosmic-ray changes the code a little, and the tests of its room are run.

`python -m tests.mutants [--seed N] [--each N] [ROOM ...]`: of each room a sample of so many mutants, drawn
with the seed. Killed are those upon which a test fails or takes too long. Equivalent ones are among the
survivors.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import NamedTuple

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

from tests.support import benchmark_record
from tests.support.paths import ROOT

ROOMS = {
    "safety": (["onboard/core/safety"], ["tests/onboard/core/safety"]),
    "signing": (["onboard/wire/mavlink/signing.py"], ["tests/onboard/wire/test_signing.py"]),
    "commands": (["gcs/picture/command_book.py"], ["tests/gcs/picture/test_commands.py"]),
    "agent": (["onboard/agent/core"], ["tests/onboard/agent", "-m", "not real"]),
}
LIMIT_S = 300.0
COPIED = ("onboard", "gcs", "sim_bridge", "tests", "configs", "docs", "pyproject.toml")
LEFT_OUT = (
    "_BitOr_",  # `X | None` in annotations, which nothing evaluates
    "Variable",  # these need to be told names
)


class Mutant(NamedTuple):
    """One change: an operator of cosmic-ray, at its n-th place in a file."""

    file: str
    operator: str
    occurrence: int


def mutants(files: list[str]) -> list[Mutant]:
    """All mutants of some files and folders."""
    found = []
    operators = [name for name in operator_names() if not any(part in name for part in LEFT_OUT)]
    for place in files:
        for path in sorted((ROOT / place).rglob("*.py")) if (ROOT / place).is_dir() else [ROOT / place]:
            nodes = list(ast_nodes(get_ast(path.read_text(encoding="utf-8"))))
            for name in operators:
                operator = get_operator(name)()
                places = sum(1 for node in nodes for _ in operator.mutation_positions(node))
                found += [Mutant(str(path.relative_to(ROOT)), name, n) for n in range(places)]
    return found


def survives(mutant: Mutant, tests: list[str], tree: Path) -> bool:
    """Whether all tests pass upon a mutant, which is made in a copy of the project."""
    file = tree / mutant.file
    whole = file.read_text(encoding="utf-8")
    changed = mutate_code(whole, get_operator(mutant.operator)(), mutant.occurrence)
    if changed is None:
        return True
    file.write_text(changed, encoding="utf-8")
    command = [str(ROOT / ".venv/bin/python"), "-m", "pytest", *tests, "-n", "0", "-x", "-q",
               "-p", "no:cacheprovider", "--hypothesis-seed", "1"]  # fmt: skip
    env = {**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        run = subprocess.run(command, cwd=tree, env=env, capture_output=True, timeout=LIMIT_S, check=False)
    except subprocess.TimeoutExpired:
        return False
    finally:
        file.write_text(whole, encoding="utf-8")
    return run.returncode == 0


def line_of(mutant: Mutant) -> str:
    """The line that a mutant changes, as it becomes."""
    whole = (ROOT / mutant.file).read_text(encoding="utf-8")
    changed = mutate_code(whole, get_operator(mutant.operator)(), mutant.occurrence) or whole
    pairs = enumerate(zip(whole.splitlines(), changed.splitlines(), strict=False), 1)
    return next((f"{number}: `{new.strip()}`" for number, (old, new) in pairs if old != new), "?")


def main() -> None:
    """Draw, try, tell."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", type=int, default=40)
    parser.add_argument("rooms", nargs="*", default=list(ROOMS), metavar="ROOM")
    asked = parser.parse_args()
    lines = ["| room | mutants there are | tried | killed |", "|---|---|---|---|"]
    left: list[Mutant] = []
    with TemporaryDirectory() as name:
        for part in COPIED:
            copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy2
            copy(ROOT / part, Path(name) / part)  # type: ignore[operator]
        for room in asked.rooms:
            files, tests = ROOMS[room]
            there = mutants(files)
            drawn = Random(f"{asked.seed} {room}").sample(there, min(asked.each, len(there)))
            alive = []
            for mutant in drawn:
                if survives(mutant, tests, Path(name)):
                    alive.append(mutant)
                print(f"{room}: {'SURVIVES' if mutant in alive else 'killed'} {mutant}", flush=True)
            left += alive
            killed = len(drawn) - len(alive)
            lines.append(f"| {room} | {len(there)} | {len(drawn)} | {killed} ({killed / len(drawn):.0%}) |")
    lines += ["", "Survivors, equivalent ones among them:", ""]
    lines += [f"- {mutant.file}:{line_of(mutant)} ({mutant.operator})" for mutant in left] or ["- none"]
    print("\n".join(lines))
    command = f"python -m tests.mutants --seed {asked.seed} --each {asked.each} {' '.join(asked.rooms)}"
    benchmark_record.write("mutants.md", "Mutants that the tests notice", command, lines)


if __name__ == "__main__":
    sys.exit(main())
