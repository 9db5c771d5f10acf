"""The page of speed: its pieces run, each row has what is wanted of it, and a miss is called one."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.benchmarks import speed, speed_work
from tests.benchmarks.speed import BEFORE, RELEASE, Cost, State
from tests.support.paths import ROOT

GAME = "`fly --fast demo`, constant velocity"
HERE = State("now", ROOT, sys.executable)


def test_a_script_measures_in_a_process_of_its_own() -> None:
    row = "picture and recorder, 200 vehicles at 20 Hz"
    script = speed_work.STATION.format(vehicles=12, every=4, seconds=2.0, row=row)
    found = speed.measure(HERE, script)
    assert set(found) == {row}
    assert 0.0 < found[row].value < 10.0
    assert found[row].words == "120 messages, all recorded"  # 12 vehicles at a quarter of 20 Hz for 2 s


def test_every_script_is_python_and_every_row_wanted_is_made_by_one() -> None:
    scripts = [one.script for one in speed_work.work()]
    for script in scripts:
        compile(speed_work.HEAD + script, "script", "exec")
    made = "".join(scripts)
    for row in speed_work.GOALS:
        stem = row.partition(": ")[0] if row.startswith(speed_work.ECHO) else row
        for role in (", pursuer", ", evader"):
            stem = stem.partition(role)[0] if stem.startswith(("share", "memory")) else stem
        assert stem in made, row


def test_the_newest_state_alone_does_what_others_cannot_and_the_oldest_is_measured_once() -> None:
    states = [State(name, ROOT, sys.executable) for name in (RELEASE, BEFORE)]
    states += [State("now, other", ROOT, "other"), HERE]
    pieces = {
        "all": speed_work.Work("", 2),
        "newest": speed_work.Work("", 1, newest=True, other=False),
        "once": speed_work.Work("", 2, once=True, other=False),
    }
    seen = {name: [state.name for state in speed.turns(states, one, 9)] for name, one in pieces.items()}
    assert seen["all"] == [RELEASE, BEFORE, "now, other", "now"] * 2
    assert seen["newest"] == ["now"]
    assert seen["once"] == [RELEASE, "now", "now"]


@pytest.mark.parametrize(("now", "word"), [(0.05, "met"), (0.09, "**missed**")])
def test_a_ratio_is_judged_against_the_release(now: float, word: str) -> None:
    each = {RELEASE: Cost(0.1, ""), BEFORE: Cost(0.12, ""), "now": Cost(now, "captured")}
    assert speed.judged(GAME, each) == f"1.7: {word}"
    lines = list(speed.page([RELEASE, BEFORE, "now"], {GAME: each}))
    told = next(line for line in lines if line.startswith(f"| {GAME}"))
    assert f"{now:.3g} ({0.1 / now:.2f}, {0.12 / now:.2f})" in told
    assert f"{GAME}: now: captured." in lines


def test_a_cost_is_judged_by_itself_and_what_was_not_measured_is_a_dash() -> None:
    row = "memory of an agent [MB], pursuer"
    each = {"now": Cost(70.0, "")}
    assert speed.judged(row, each) == "65: **missed**"
    assert f"| {row} | MB | – | 70 | 65: **missed** |" in list(speed.page([RELEASE, "now"], {row: each}))


def test_an_old_state_that_fails_leaves_a_dash_and_the_newest_raises() -> None:
    piece = speed_work.Work('tell({"a row": 1.0 / (Path.cwd().name == "here")})', 1)
    tree = ROOT / "tests"
    assert speed.costs([State(RELEASE, tree, sys.executable)], "", 1, [piece]) == {}
    with pytest.raises(subprocess.CalledProcessError):
        speed.costs([State("now", tree, sys.executable)], "", 1, [piece])
