"""Costs in rounds of a yardstick: what `make bench` keeps, and what it says got slower."""

from __future__ import annotations

import re
import subprocess
import sys
import sysconfig
from pathlib import Path
from time import process_time

import pytest

from tests.benchmarks import compare, yardstick
from tests.benchmarks.yardstick import Cost, Rates, Yard
from tests.support import benchmark_record
from tests.support.paths import ROOT

PAGES = ("benchmarks", "figures", "soak", "fuzz", "mutants")


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    """Committed and latest costs of a folder of their own."""
    monkeypatch.setattr(yardstick, "LATEST", tmp_path / "latest.json")
    return tmp_path / "costs.json", tmp_path / "latest.json"


def test_a_cost_is_the_same_on_a_machine_of_half_the_speed(
    files: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = []
    for slow in (1.0, 2.0):
        monkeypatch.setattr(yardstick, "rates", lambda slow=slow: Rates(25.0 / slow, 600.0 / slow))
        yardstick.cost("decision", 30e-6 * slow)
        yardstick.cost("step", 1e-7 * slow, Yard.COMPILED)
        found.append(yardstick.read(files[1]))
    assert found[0] == found[1] == {"decision": Cost(750.0, Yard.PYTHON), "step": Cost(60.0, Yard.COMPILED)}


def test_the_yardstick_s_own_loop_costs_as_many_rounds_as_it_has(files: tuple[Path, Path]) -> None:
    spent = []
    for _ in range(7):
        begin = process_time()
        yardstick._loop(100_000)
        spent.append(process_time() - begin)
    yardstick.cost("itself", min(spent))
    assert yardstick.read(files[1])["itself"].value == pytest.approx(100_000, rel=0.5)


def test_what_got_slower_is_named_and_is_the_exit_code(
    files: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    committed, latest = files
    before = {"a": 100.0, "b": 100.0, "c": 100.0, "gone": 1.0, "other yard": 5.0}
    now = {"a": 124.0, "b": 126.0, "c": 60.0, "fresh": 2.0}
    yardstick.write(committed, {name: Cost(value, Yard.PYTHON) for name, value in before.items()})
    kept = {name: Cost(value, Yard.PYTHON) for name, value in now.items()}
    yardstick.write(latest, kept | {"other yard": Cost(500.0, Yard.COMPILED)})
    assert compare.main([], committed, latest) == 1
    told = capsys.readouterr().out
    said = {row.split()[-1]: row.split()[0] for row in told.splitlines()[1:-1]}
    assert said == {"a": "as", "b": "SLOWER", "c": "faster", "gone": "not", "fresh": "new", "yard": "new"}
    assert told.splitlines()[-1] == "slower by more than 25%: b"
    assert compare.main(["--tolerance", "0.3"], committed, latest) == 0
    assert compare.main(["--tolerance", "0.2"], committed, latest) == 1
    assert compare.main(["--accept"], committed, latest) == 0
    assert compare.main(["--tolerance", "0.01"], committed, latest) == 0
    assert yardstick.read(committed).keys() == {*before, *now}


def test_another_machine_is_no_reason_and_what_stands_out_there_is_one(
    files: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    committed, latest = files
    names = [*"abcdefghi"]
    before = {name: Cost(100.0, Yard.PYTHON) for name in names}
    yardstick.write(committed, before | {"r": Cost(2.0, Yard.NONE)})

    def compared(machine: float, **odd: float) -> tuple[int, str]:
        now = {name: Cost(100.0 * machine * odd.get(name, 1.0), Yard.PYTHON) for name in names}
        yardstick.write(latest, now | {"r": Cost(2.0 * odd.get("r", 1.0), Yard.NONE)})
        return compare.main([], committed, latest), capsys.readouterr().out.splitlines()[-1]

    for machine in (0.8, 1.0, 1.24):
        assert compared(machine) == (0, "slower by more than 25%: nothing")
        assert compared(machine, d=1.3, e=0.5) == (1, "slower by more than 25%: d")
        assert compared(machine, r=1.3) == (1, "slower by more than 25%: r")
    assert compared(1.3) == (1, "slower by more than 25%: all in rounds of the Python loop")


def test_nothing_to_compare_is_no_success(
    files: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    committed, latest = files
    assert compare.main([], committed, latest) == 2
    latest.write_text('{"a": {"value": "fast", "yard": "ratio within the run"}}')
    assert compare.main([], committed, latest) == 2
    assert re.search(r"latest.json: Expected `float`, got `str` .*\$\[...\]\.value", capsys.readouterr().err)
    with pytest.raises(SystemExit) as end:
        compare.main(["--tolerance", "-1"], committed, latest)
    assert end.value.code == 2


@pytest.mark.parametrize("value", [0.0, -1.0, float("inf"), float("nan")])
def test_a_cost_is_above_zero(files: tuple[Path, Path], value: float) -> None:
    with pytest.raises(ValueError, match="decision: a cost must be above zero"):
        yardstick.cost("decision", value)


def test_every_page_s_head_is_written_in_one_place() -> None:
    """Machine, build and yardsticks stand on each: no benchmark asks the platform by itself."""
    assert re.search(
        r"PGO.*yardsticks [0-9.]+ in Python, ([0-9]+ compiled|no numba)", benchmark_record.machine()
    )
    asking = [
        file.relative_to(ROOT).as_posix()
        for room in PAGES
        for file in (ROOT / "tests" / room).rglob("*.py")
        if re.search(r"^\s*(import platform|from platform)", file.read_text(encoding="utf-8"), re.M)
    ]
    assert asking == []


def test_the_build_is_the_one_that_the_interpreter_tells(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = subprocess.run(
        [sys.executable, "-c", "import sysconfig; print(sysconfig.get_config_var('CONFIG_ARGS'))"],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    assert (yardstick.build() == "PGO build") == ("--enable-optimizations" in shown)
    for told, word in (("'--enable-optimizations' '--with-lto'", "PGO build"), (None, "build unknown")):
        monkeypatch.setattr(sysconfig, "get_config_var", lambda name, told=told: told)
        assert yardstick.build() == word
