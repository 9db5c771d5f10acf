"""A copy of the project in which mutants are made, and which tests run each line of it."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import subprocess
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

from tests.support.paths import ROOT

COPIED = ("onboard", "gcs", "sim_bridge", "tests", "configs", "docs", "examples", "locks", "pyproject.toml")
LEFT_OUT = (
    "_BitOr_",  # `X | None` in annotations, which nothing evaluates
    "Variable",  # these need to be told names
)
BUDGET_S = 60.0  # of tests for one mutant, the quickest first
PATIENCE = 3.0  # times as long as the tests took unchanged is too long
CHOSEN = "chosen.txt"  # names of tests, a line each
PYTEST = ("-m", "pytest", "-n", "0", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:randomly")


class Mutant(NamedTuple):
    """One change: an operator of cosmic-ray, at its n-th place in a file."""

    file: str
    operator: str
    occurrence: int
    line: int  # where, 1 is the first


class Verdict(NamedTuple):
    """What became of a mutant."""

    killed: bool
    tests: int  # that run its line


def mutants(files: list[str]) -> list[Mutant]:
    """All mutants of some files and folders."""
    found = []
    operators = [name for name in operator_names() if not any(part in name for part in LEFT_OUT)]
    for place in files:
        for path in sorted((ROOT / place).rglob("*.py")) if (ROOT / place).is_dir() else [ROOT / place]:
            nodes = list(ast_nodes(get_ast(path.read_text(encoding="utf-8"))))
            for name in operators:
                operator = get_operator(name)()
                lines = [start[0] for node in nodes for start, _ in operator.mutation_positions(node)]
                file = str(path.relative_to(ROOT))
                found += [Mutant(file, name, n, line) for n, line in enumerate(lines)]
    return found


def changed(mutant: Mutant) -> str:
    """A file as a mutant has it."""
    whole = (ROOT / mutant.file).read_text(encoding="utf-8")
    return mutate_code(whole, get_operator(mutant.operator)(), mutant.occurrence) or whole


class Bench:
    """A copy of the project in `place`, and for one room of tests which of them run which line."""

    def __init__(self, place: Path, tests: list[str]) -> None:
        self._tree = place / "tree"
        self._tests = tests
        self._run_by: dict[str, dict[int, set[str]]] = {}
        self._took: dict[str, float] = {}
        if not self._tree.exists():
            for part in COPIED:
                copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy2
                (self._tree / part).parent.mkdir(parents=True, exist_ok=True)
                copy(ROOT / part, self._tree / part)  # type: ignore[operator]

    def look(self, files: list[str]) -> None:
        """Run the room's tests once, unchanged. Raises RuntimeError where they do not pass."""
        data, times = self._tree / ".coverage", self._tree / "times.xml"
        data.unlink(missing_ok=True)
        words = [*PYTEST, *self._tests, "--cov-context=test", "--cov-report=", f"--junitxml={times}",
                 "-o", "junit_family=xunit1", *(f"--cov={Path(file).parent}" for file in files)]  # fmt: skip
        done = self._python(words, 1200.0)
        if done is None or done.returncode:
            raise RuntimeError(f"the tests fail unchanged: {done.stdout[-2000:] if done else 'too slow'}")
        for case in ElementTree.parse(times).iter("testcase"):
            name = f"{case.get('file')}::{case.get('name')}"
            self._took[name] = float(case.get("time") or 0.0)
        self._listed(sorted(self._took))
        again = self._python([*PYTEST, "--collect-only", f"@{self._tree / CHOSEN}"], 120.0)
        if again is None or again.returncode:  # else every mutant would seem killed
            raise RuntimeError(f"the tests are not found by name: {again.stdout[-2000:] if again else ''}")
        with sqlite3.connect(data) as rows:
            query = ("select file.path, context.context, line_bits.numbits from line_bits "
                     "join file on file.id = file_id join context on context.id = context_id")  # fmt: skip
            for path, context, bits in rows.execute(query):
                name = context.partition("|")[0]
                of_file = self._run_by.setdefault(str(Path(path).relative_to(self._tree)), {})
                for line in range(8 * len(bits)):
                    if name in self._took and bits[line // 8] >> line % 8 & 1:
                        of_file.setdefault(line, set()).add(name)

    def covering(self, mutant: Mutant) -> list[str]:
        """The tests that run a mutant's line, the quickest first; all where the line runs on import."""
        names = self._run_by.get(mutant.file, {}).get(mutant.line) or set(self._took)
        chosen, total = [], 0.0
        for name in sorted(names, key=lambda name: self._took[name]):
            total += self._took[name]
            if total > BUDGET_S:
                break
            chosen.append(name)
        return chosen

    def judge(self, mutant: Mutant) -> Verdict:
        """Make a mutant, run what covers it."""
        names = self.covering(mutant)
        file = self._tree / mutant.file
        whole = (ROOT / mutant.file).read_text(encoding="utf-8")
        limit_s = 20.0 + PATIENCE * sum(self._took[name] for name in names)
        self._write(file, changed(mutant))
        try:
            self._listed(names)
            done = self._python([*PYTEST, f"@{self._tree / CHOSEN}"], limit_s)
        finally:
            self._write(file, whole)
        return Verdict(done is None or done.returncode != 0, len(names))

    def _listed(self, names: list[str]) -> None:
        (self._tree / CHOSEN).write_text("\n".join(names), encoding="utf-8")

    def _write(self, file: Path, text: str) -> None:
        file.write_text(text, encoding="utf-8")
        for stale in (file.parent / "__pycache__").glob(f"{file.stem}.*"):
            stale.unlink()  # its stamp counts seconds

    def _python(self, words: list[str], limit_s: float) -> subprocess.CompletedProcess[str] | None:
        """Run the project's Python in the copy; None where it takes too long."""
        env = {**os.environ, "PYTHONPATH": str(self._tree)}
        env.pop("PYTHONDONTWRITEBYTECODE", None)
        command = [str(ROOT / ".venv/bin/python"), *words]
        try:
            return subprocess.run(
                command, cwd=self._tree, env=env, capture_output=True, text=True, timeout=limit_s, check=False
            )
        except subprocess.TimeoutExpired:
            return None


class Ledger:
    """What was found so far, in a file, so that a run that was ended goes on."""

    def __init__(self, file: Path | None) -> None:
        self._file = file
        self._found: dict[str, list[int]] = {}
        if file is not None and file.exists():
            self._found = json.loads(file.read_text(encoding="utf-8"))

    def get(self, mutant: Mutant) -> Verdict | None:
        """What became of a mutant, if it was tried."""
        found = self._found.get(self._name(mutant))
        return Verdict(bool(found[0]), found[1]) if found else None

    def put(self, mutant: Mutant, verdict: Verdict) -> None:
        """Remember."""
        self._found[self._name(mutant)] = [int(verdict.killed), verdict.tests]
        if self._file is not None:
            self._file.write_text(json.dumps(self._found, indent=0), encoding="utf-8")

    def _name(self, mutant: Mutant) -> str:
        return f"{mutant.file} {mutant.operator} {mutant.occurrence}"
