"""The game that `make demo` shows first: a ring that closes, and that soon."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from onboard.game.go_or_no_go import engagement_of, lines
from onboard.game.scenario import load
from onboard.runtime.resources import SCENARIOS, shipped_file
from tests.support.paths import ROOT
from tests.support.real_time import patience


def first() -> Path:
    """The scenario that `make demo` flies in real time."""
    [name] = re.findall(r"sim-bridge fly ([\w-]+) &&", (ROOT / "Makefile").read_text("utf-8"))
    return shipped_file(Path(name), SCENARIOS)


def flown(folder: Path, seed: int) -> dict[str, object]:
    """The summary of a game."""
    command = [
        sys.executable, "-m", "sim_bridge.cli", "fly", "--fast", "--quiet", "--no-report",
        "--seed", str(seed), "--runs", str(folder), str(first()),
    ]  # fmt: skip
    subprocess.run(command, check=True, cwd=ROOT, timeout=patience(60.0))
    [run] = folder.iterdir()
    found: dict[str, object] = json.loads((run / "summary.json").read_text("utf-8"))
    return found


def test_it_is_five_on_one_on_a_closed_ring_and_never_lasts_long() -> None:
    scenario = load(first())
    assert len(scenario.pursuers) == 5
    assert scenario.evader.speed > max(one.speed for one in scenario.pursuers)
    assert lines(engagement_of(scenario))[0].startswith("go: ")
    assert scenario.parameters.horizon <= 35.0


def test_it_ends_with_a_capture(tmp_path: Path) -> None:
    summary = flown(tmp_path, load(first()).seed)
    assert summary["verdict"] == "captured", summary


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_four_of_five_end_so_whatever_the_noise(tmp_path: Path) -> None:
    verdicts = [flown(tmp_path / str(seed), seed)["verdict"] for seed in range(1, 21)]
    assert verdicts.count("captured") >= 16, verdicts
