"""The tutorial: what it tells to type exists, and what it says comes out."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from sim_bridge.plane_game import program as plane
from tests.support.paths import ROOT
from tests.support.real_time import patience

TEXT = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
TYPED = [line for block in re.findall(r"```\n(.*?)```", TEXT, re.DOTALL) for line in block.splitlines()]
PROGRAMS = {"sim-bridge": "sim_bridge.cli", "gcs": "gcs.cli"}


def run(line: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a line of the tutorial in a folder."""
    program, *words = line.split()
    command = [sys.executable, "-m", PROGRAMS[program], *words]
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=patience(60.0), check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip


def test_a_game_of_ones_own_is_made_checked_and_played(tmp_path: Path) -> None:
    """Section 2, as it stands, and its figure of the evader's arrival."""
    for line in TYPED[TYPED.index("sim-bridge scenario new mine.toml") :][:3]:
        done = run(line, tmp_path)
        assert done.returncode == 0, (line, done.stderr)
    (told,) = re.findall(r"arrives after ([\d.]+) s\. Move", TEXT)
    (scenario,) = plane.load_plane([tmp_path / "mine.toml"])
    assert f"{plane.result(plane.play(scenario, 'paper', None, keep=False)).time:.1f}" == told
    assert (tmp_path / "figs" / "my-game-paper.png").exists()


@pytest.mark.parametrize("line", [line for line in TYPED if line.split()[:1] and line.split()[0] in PROGRAMS])
def test_every_command_and_option_of_the_tutorial_exists(line: str, tmp_path: Path) -> None:
    """What is refused is a run or a file that is not there, never the way it was typed."""
    words = line.split()
    verb = [word for word in words[1:3] if not word.startswith("-") and "." not in word and "/" not in word]
    done = run(" ".join([words[0], *verb[: 2 if verb[:1] == ["scenario"] else 1], "--help"]), tmp_path)
    assert done.returncode == 0, done.stderr
    for option in (word for word in words if word.startswith("--")):
        assert option in done.stdout, (line, option)


def test_what_the_tutorial_links_to_exists() -> None:
    for place in re.findall(r"\]\(([\w./-]+)\)", TEXT):
        assert (ROOT / "docs" / place).exists(), place


@pytest.mark.long
def test_the_campaign_ends_as_the_tutorial_says(tmp_path: Path) -> None:
    folder = ROOT / "examples" / "strategy-plugin"
    done = subprocess.run(
        [sys.executable, "campaign.py", "400"], cwd=folder, capture_output=True, text=True, check=True,
        timeout=patience(300.0), env={**os.environ, "PYTHONPATH": f"{ROOT}:{folder}"},
    )  # fmt: skip
    for line in done.stdout.splitlines():
        assert line in TEXT
