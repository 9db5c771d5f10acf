"""Kernels on disk: found again, never stale, shared, done without where nothing can be kept."""

from __future__ import annotations

import logging
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from math import atan2, sin
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
import pytest

from sim_bridge.campaign import kernel_cache
from sim_bridge.campaign.fingerprint import UnknownContentError, fingerprint
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.campaign.kernel_folder import FOLDER, folder
from tests.support.paths import ROOT
from tests.support.real_time import patience

# `angle_between` calls `norm`: what a kernel contains is more than its own code.
CHILD = """
from onboard.core.math.vectors import NORTH, Vec, angle_between
from sim_bridge.campaign.compiled import register
from sim_bridge.campaign.kernel_cache import kernel
register()
machine = kernel(angle_between)
print(machine(NORTH, Vec(0.6, 0.0, 0.8)), sum(machine.stats.cache_hits.values()))
"""


def child(package: Path, cache: Path) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONPATH": str(package), FOLDER: str(cache)}
    return subprocess.Popen(
        [sys.executable, "-c", CHILD], cwd=package, env=environment, text=True, stdout=subprocess.PIPE
    )


def said(process: subprocess.Popen[str]) -> tuple[float, int]:
    out, _ = process.communicate(timeout=120.0)
    assert process.returncode == 0
    answer, hits = out.split()
    return float(answer), int(hits)


def test_two_processes_at_once_compile_once_and_a_changed_called_function_answers_anew(
    tmp_path: Path,
) -> None:
    package, cache = tmp_path / "package", tmp_path / "cache"
    for room in ("onboard/core", "sim_bridge/campaign"):
        shutil.copytree(ROOT / room, package / room, ignore=shutil.ignore_patterns("__pycache__"))
        for name in ("onboard", "sim_bridge"):
            (package / name).mkdir(exist_ok=True)
            (package / name / "__init__.py").touch()
    first = [child(package, cache), child(package, cache)]
    answers = [said(process) for process in first]
    assert [answer for answer, _ in answers] == [atan2(0.8, 0.6)] * 2
    assert sorted(hits for _, hits in answers) == [0, 1]
    assert len(list(cache.glob("*.kernel"))) == 1
    assert len(list(cache.iterdir())) == 1
    vectors = package / "onboard/core/math/vectors.py"
    text = vectors.read_text()
    line = "    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z)"
    assert line in text
    vectors.write_text(text.replace(line, line.replace("return", "return 2.0 *")))
    assert said(child(package, cache)) == (atan2(1.6, 0.6), 0)
    assert len(list(cache.glob("*.kernel"))) == 2


# One kernel calls C alone, one LAPACK, which numba finds when it imports its linear algebra; one draws.
THREE = """
import sys
import numpy as np
from math import sin, tanh
from sim_bridge.campaign.kernel_cache import kernel
def plain(x): return sin(x) + tanh(x)
def solved(a, b): return np.linalg.solve(a, b)
def drawn(rng, n): return rng.standard_normal(n).sum()
machines = [kernel(plain), kernel(solved), kernel(drawn)]
a = np.array([[2.0, 1.0], [1.0, 3.0]])
answers = [machines[0](3.0)]
light = not {"scipy.linalg", "numba.np.linalg", "numba.np.arrayobj"} & sys.modules.keys()
answers += [*machines[1](a, np.array([1.0, 2.0])), machines[2](np.random.default_rng(1), 5)]
print(light, sum(sum(m.stats.cache_hits.values()) for m in machines), *(float(x).hex() for x in answers))
"""


def test_a_kernel_is_loaded_without_numba_s_implementations_unless_it_calls_them(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), FOLDER: str(tmp_path)}
    said = [
        subprocess.run(
            [sys.executable, "-c", THREE], env=environment, text=True, capture_output=True, check=True,
            timeout=patience(120.0), cwd=ROOT,
        ).stdout.split()
        for _ in range(2)
    ]  # fmt: skip
    assert said[0][:2] == ["False", "0"]
    assert said[1][:2] == ["True", "3"]
    assert said[0][2:] == said[1][2:]


def rooms(**changes: str) -> FunctionType:
    """A kernel `outer` over three modules: a function called by a name, one called through a module, a
    constant, an enum's member, a default value and a closure."""
    lines = {
        "factor": "FACTOR = 2.0",
        "inner": "def inner(x):\n    '''Said.'''\n    return FACTOR * x",
        "far": "def far(x, more=(1, 2)):\n    return x + more[0]",
        "kind": "class Kind(IntEnum):\n    A = 1\n    B = 2",
        "made": "def made(n):\n    def add(x):\n        return x + n\n    return add",
        "three": "add = made(3)",
        "outer": "def outer(x):\n    return inner(x) + module.far(x) + sin(x) + Kind.A + add(x)",
    } | changes
    module = ModuleType("module")
    exec(lines["far"], vars(module))
    names: dict[str, Any] = {"__name__": "rooms", "module": module, "sin": sin}
    exec("from enum import IntEnum", names)
    for name, line in lines.items():
        if name != "far":
            exec(line, names)
    found = names["outer"]
    assert isinstance(found, FunctionType)
    return found


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("factor", "FACTOR = 2"),  # an integer divides otherwise
        ("factor", "FACTOR = -2.0"),
        ("inner", "def inner(x):\n    return FACTOR + x"),
        ("far", "def far(x, more=(1, 2)):\n    return x + more[1]"),
        ("far", "def far(x, more=(4, 2)):\n    return x + more[0]"),
        ("kind", "class Kind(IntEnum):\n    A = 3\n    B = 2"),
        ("made", "def made(n):\n    def add(x):\n        return x - n\n    return add"),
        ("three", "add = made(4)"),
        ("outer", "def outer(x):\n    return inner(x) + module.far(x) + sin(x) + Kind.B + add(x)"),
    ],
)
def test_whatever_a_kernel_reaches_is_in_its_fingerprint(name: str, line: str) -> None:
    assert fingerprint(rooms(**{name: line})) != fingerprint(rooms())


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("inner", "# A word.\n\ndef inner(x):\n    '''Said otherwise.'''\n    return FACTOR * x"),
        ("inner", "def inner(x: float) -> float:\n    '''Said.'''\n    return FACTOR * x"),
        ("kind", "OTHER = 5.0\nclass Kind(IntEnum):\n    A = 1\n    B = 2"),
    ],
)
def test_words_and_what_is_not_reached_are_not(name: str, line: str) -> None:
    assert fingerprint(rooms(**{name: line})) == fingerprint(rooms())


def test_arrays_and_what_nobody_can_compare() -> None:
    def reading(table: object) -> FunctionType:
        def read(k: int) -> Any:
            return table[k]  # type: ignore[index]

        assert isinstance(read, FunctionType)
        return read

    assert fingerprint(reading(np.zeros(3))) != fingerprint(reading(np.ones(3)))
    assert fingerprint(reading(np.zeros(3))) != fingerprint(reading(np.zeros((3, 1))))
    with pytest.raises(UnknownContentError, match="list"):
        fingerprint(reading([1, 2]))


def twice(x: float) -> float:
    return 2.0 * x


def hits(machine: Callable[..., Any]) -> int:
    stats: Any = machine
    return sum(stats.stats.cache_hits.values())


def test_a_folder_that_cannot_be_made_is_told_once_and_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv(FOLDER, str(tmp_path / "file" / "kernels"))
    kernel_cache._tell.cache_clear()
    with caplog.at_level(logging.WARNING):
        assert kernel(twice)(4.0) == 8.0
        assert kernel(twice)(4) == 8.0
    assert [r.getMessage() for r in caplog.records] == [
        f"kernels are compiled anew at every start: {tmp_path}/file/kernels: not a directory"
    ]


def test_a_damaged_file_is_made_again_and_off_keeps_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(FOLDER, str(tmp_path))
    assert kernel(twice)(4.0) == 8.0
    (file,) = tmp_path.iterdir()
    whole = file.read_bytes()
    for damaged in (b"", whole[:1000], whole[:-1] + b"!"):
        file.write_bytes(damaged)
        machine = kernel(twice)
        assert (machine(4.0), hits(machine)) == (8.0, 0)
    machine = kernel(twice)
    assert (machine(4.0), hits(machine)) == (8.0, 1)
    monkeypatch.setenv(FOLDER, "off")
    machine = kernel(twice)
    assert (machine(4.0), hits(machine)) == (8.0, 0)


def test_room_is_made_of_what_was_not_used_for_longest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(FOLDER, str(tmp_path))
    old, used = tmp_path / "old.kernel", tmp_path / "used.kernel"
    for age, path in ((2000.0, old), (1000.0, used)):
        path.write_bytes(bytes(1000))
        os.utime(path, (1e9 - age, 1e9 - age))
    monkeypatch.setattr(kernel_cache, "ROOM", 100_000)
    assert kernel(twice)(4.0) == 8.0
    assert old.exists()
    assert used.exists()
    new = next(path for path in tmp_path.iterdir() if path not in (old, used))
    monkeypatch.setattr(kernel_cache, "ROOM", new.stat().st_size + 1500)
    new.unlink()
    assert kernel(twice)(4.0) == 8.0
    assert new.exists()
    assert used.exists()
    assert not old.exists()


@pytest.mark.parametrize(
    ("environment", "expected"),
    [
        ({"XDG_CACHE_HOME": "/var/c"}, Path("/var/c/apollonius/kernels")),
        ({"XDG_CACHE_HOME": "relative", "HOME": "/home/a"}, Path("/home/a/.cache/apollonius/kernels")),
        ({"HOME": "/home/a"}, Path("/home/a/.cache/apollonius/kernels")),
        ({"HOME": "/home/a", FOLDER: "/k"}, Path("/k")),
        ({"HOME": "/home/a", FOLDER: "off"}, None),
    ],
)
def test_the_folder(
    environment: dict[str, str], expected: Path | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("XDG_CACHE_HOME", "HOME", FOLDER):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert folder() == expected
