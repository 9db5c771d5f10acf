"""docs/campaigns.md as a reader follows it: its commands in their order, and the job script under a shell."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from sim_bridge.programs.campaigns.show import results
from tests.support.campaign_runs import duel
from tests.support.paths import ROOT
from tests.support.real_time import patience

PAGE = (ROOT / "docs" / "campaigns.md").read_text(encoding="utf-8")
pytestmark = [pytest.mark.real, pytest.mark.timeout(240)]


def block(language: str) -> str:
    """The page's first block of a language."""
    found = re.search(rf"^```{language}\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    assert found is not None
    return found[1]


def shell(script: str, folder: Path, within_s: float, **more: str) -> str:
    """What a script says; every command of it has to end well."""
    programs = folder / "bin"
    if not programs.exists():
        programs.mkdir()
        (programs / "sim-bridge").write_text(f'#!/bin/sh\nexec {sys.executable} -m sim_bridge.cli "$@"\n')
        (programs / "sim-bridge").chmod(0o755)
    path = f"{programs}:{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-e"], input=script, cwd=folder, capture_output=True, text=True, check=False,
        env={**os.environ, "PATH": path, "PYTHONPATH": str(ROOT), **more}, timeout=patience(within_s),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_job_script_of_a_cluster_plays_every_shard_once(tmp_path: Path) -> None:
    duel(tmp_path)
    script, out = block("bash"), tmp_path / "shared" / "five"
    assert re.search(r"^#SBATCH --array=1-40$.*/40$", script, re.DOTALL | re.MULTILINE)
    for printed, small in (
        ("--array=1-40", "--array=1-2"), ("_ID/40", "_ID/2"), ("five six", "duel.toml"),
        ("--evader all", "--evader paper --evader straight"), ("/shared/five", str(out)),
        ("--games 100000", "--games 90 --shard-games 20"),
    ):  # fmt: skip
        assert printed in script
        script = script.replace(printed, small)
    for task in ("2", "1"):
        before = {path: path.stat().st_mtime_ns for path in out.glob("*")}
        shell(script, tmp_path, 60.0, SLURM_ARRAY_TASK_ID=task)
        assert {path: path.stat().st_mtime_ns for path in before} == before
        assert len(list(out.glob("shard-*"))) - sum(path.suffix == ".parquet" for path in before) > 0
    before = {path: path.stat().st_mtime_ns for path in out.glob("*")}
    shell(script, tmp_path, 60.0, SLURM_ARRAY_TASK_ID="2")  # a job that is sent again
    assert {path: path.stat().st_mtime_ns for path in out.glob("*")} == before
    assert [len(cell.verdicts) for cell in results(out).cells] == [90, 90]


@pytest.mark.long
@pytest.mark.timeout(1800)
def test_the_first_commands_in_an_empty_folder(tmp_path: Path) -> None:
    """Aircraft are compiled, two hundred games of each strategy played, one drawn and one flown."""
    told = shell(block("sh"), tmp_path, 600.0)
    assert len(list((tmp_path / "pictures").glob("*.png"))) >= 3
    assert list((tmp_path / "figures").glob("*.png"))
    found = re.search(r"(captured|arrived|escaped|denied).* after [\d.]+ s, smallest distance", told)
    assert found is not None, told
    assert list((tmp_path / "runs").glob("*/recording.mcap")), told
