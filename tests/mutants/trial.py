"""A copy of the project in which mutants are made, and which tests run each line of it."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple, NoReturn
from xml.etree import ElementTree

import hypothesis  # noqa: F401  (imported once, for all forks)
import numpy  # noqa: F401
import pymavlink.dialects.v20.ardupilotmega  # noqa: F401
import pytest
import zenoh  # noqa: F401
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

from tests.support.paths import ROOT

COPIED = ("onboard", "gcs", "sim_bridge", "tests", "configs", "docs", "examples", "locks", "pyproject.toml")
LEFT_OUT = (
    "_BitOr_",  # `X | None` in annotations, which nothing evaluates
    "Variable",  # these need to be told names
)
BUDGET_S = 30.0  # of tests for one mutant, the quickest first
PATIENCE = 3.0  # times as long as the tests took unchanged is too long
PYTEST = ("-n", "0", "-x", "-q", "-p", "no:cacheprovider")
OWN = ("onboard", "gcs", "sim_bridge", "tests", "conftest")
LOOK_S = 0.05


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
    """A copy of the project in `place`, and for one room of tests which of them run which line.

    Both stay in `place` for the next run.
    """

    def __init__(self, place: Path, room: str, tests: list[str]) -> None:
        self._tree = place / "tree"
        self._known = place / f"{room}.json"
        self._tests = tests
        self._run_by: dict[str, dict[int, list[str]]] = {}
        self._took: dict[str, float] = {}
        if not self._tree.exists():
            self._tree.mkdir(parents=True)
            for part in COPIED:
                copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy2
                copy(ROOT / part, self._tree / part)  # type: ignore[operator]

    def look(self, files: list[str]) -> None:
        """Run the room's tests once, unchanged. Raises RuntimeError where they do not pass."""
        if self._known.exists():
            self._took, lines = json.loads(self._known.read_text(encoding="utf-8"))
            self._run_by = {file: {int(n): t for n, t in of.items()} for file, of in lines.items()}
            return
        data, times = self._tree / ".coverage", self._tree / "times.xml"
        data.unlink(missing_ok=True)
        folders = {str(ROOT / file if (ROOT / file).is_dir() else (ROOT / file).parent) for file in files}
        words = [*PYTEST, *self._tests, "--cov-context=test", "--cov-report=", f"--junitxml={times}",
                 "-o", "junit_family=xunit1",
                 *(f"--cov={Path(folder).relative_to(ROOT)}" for folder in sorted(folders))]  # fmt: skip
        command = [str(ROOT / ".venv/bin/python"), "-m", "pytest", *words]
        env = {**os.environ, "PYTHONPATH": str(self._tree)}
        done = subprocess.run(command, cwd=self._tree, env=env, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"the tests fail unchanged: {done.stdout[-2000:]}")
        for case in ElementTree.parse(times).iter("testcase"):
            name = f"{case.get('file')}::{case.get('name')}"
            self._took[name] = float(case.get("time") or 0.0)
        if self._run(sorted(self._took), 300.0, "--collect-only") != 0:  # else every mutant would seem killed
            raise RuntimeError("the tests are not found by their names")
        with sqlite3.connect(data) as rows:
            query = ("select file.path, context.context, line_bits.numbits from line_bits "
                     "join file on file.id = file_id join context on context.id = context_id")  # fmt: skip
            for path, context, bits in rows.execute(query):
                name = context.partition("|")[0]
                of_file = self._run_by.setdefault(str(Path(path).relative_to(self._tree)), {})
                for line in range(8 * len(bits)):
                    runs = name in self._took and bits[line // 8] >> line % 8 & 1
                    if runs and name not in of_file.setdefault(line, []):
                        of_file[line].append(name)
        self._known.write_text(json.dumps([self._took, self._run_by]), encoding="utf-8")

    def covering(self, mutant: Mutant) -> list[str]:
        """The tests that run a mutant's line, the quickest first; all where the line runs on import."""
        names = self._run_by.get(mutant.file, {}).get(mutant.line) or list(self._took)
        chosen, total = [], 0.0
        for name in sorted(names, key=lambda name: (self._took[name], name)):
            total += self._took[name]
            if chosen and total > BUDGET_S:
                break
            chosen.append(name)
        return chosen

    def judge(self, mutant: Mutant) -> Verdict:
        """Make a mutant, run what covers it."""
        names = self.covering(mutant)
        file = self._tree / mutant.file
        whole = (ROOT / mutant.file).read_text(encoding="utf-8")
        limit_s = 60.0 + PATIENCE * sum(self._took[name] for name in names)
        self._write(file, changed(mutant))
        try:
            return Verdict(self._run(names, limit_s) != 0, len(names))
        finally:
            self._write(file, whole)

    def _write(self, file: Path, text: str) -> None:
        file.write_text(text, encoding="utf-8")
        for stale in (file.parent / "__pycache__").glob(f"{file.stem}.*"):
            stale.unlink()  # its stamp counts seconds

    def _run(self, names: list[str], limit_s: float, *more: str) -> int:
        """Run tests by name in a fork, which has the libraries already; its exit code, -1: too long."""
        chosen = self._tree / "chosen.txt"
        chosen.write_text("\n".join(names), encoding="utf-8")
        child = os.fork()
        if child == 0:
            self._in_child([*PYTEST, *more, f"@{chosen}"])
        for _ in range(round(limit_s / LOOK_S)):
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                return os.waitstatus_to_exitcode(status)
            time.sleep(LOOK_S)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return -1

    def _in_child(self, words: list[str]) -> NoReturn:
        """Forget the project as it is, and run pytest on the copy."""
        code: int = 3
        try:
            os.chdir(self._tree)
            for name in [name for name in sys.modules if name.partition(".")[0] in OWN]:
                del sys.modules[name]
            sys.path[:] = [str(self._tree), *(p for p in sys.path if p not in ("", str(ROOT)))]
            sys.dont_write_bytecode = False
            with Path(os.devnull).open("w", encoding="utf-8") as nowhere:
                os.dup2(nowhere.fileno(), 1)
                os.dup2(nowhere.fileno(), 2)
            code = int(pytest.main(words))
        finally:
            os._exit(code)


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
