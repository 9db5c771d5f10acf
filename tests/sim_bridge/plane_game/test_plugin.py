"""A strategy from another distribution: found by its entry point, played, and refused where it is wrong."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from sim_bridge.plane_game.program import table1
from tests.support.paths import ROOT
from tests.support.real_time import patience

EXAMPLE = ROOT / "examples" / "strategy-plugin"


def install(site: Path, name: str, target: str) -> None:
    """What pip leaves behind: a folder that names the entry point."""
    info = site / f"{name}-0.1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 0.1.0\n", encoding="utf-8")
    (info / "entry_points.txt").write_text(f"[apollonius.strategies]\n{name} = {target}\n", encoding="utf-8")


def planar(site: Path, *words: str) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(site), str(ROOT)])
    return subprocess.run(
        [sys.executable, "-m", "sim_bridge.cli", "planar", *words], capture_output=True, text=True,
        timeout=patience(40.0), check=False, env={**os.environ, "PYTHONPATH": path},
    )  # fmt: skip


@pytest.mark.real
def test_the_example_is_installed_by_pip_and_played(tmp_path: Path) -> None:
    site = tmp_path / "site"
    subprocess.run(
        [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index",
         "--disable-pip-version-check", "--target", str(site), str(EXAMPLE)],
        check=True, timeout=patience(40.0), capture_output=True,
    )  # fmt: skip
    done = planar(site, str(table1()[9]), "--strategy", "flank")
    assert (done.returncode, done.stderr) == (0, "")
    assert "flank: " in done.stdout
    scenario = tmp_path / "mine.toml"
    text = table1()[9].read_text(encoding="utf-8").split("[expect]")[0]
    scenario.write_text(text, encoding="utf-8")
    listed = planar(site, str(scenario), "--strategy", "nobody")
    assert listed.returncode == 2
    assert listed.stderr.rstrip().endswith("flank")  # its name stands among those to choose from


@pytest.mark.real
@pytest.mark.parametrize(
    ("source", "target", "said"),
    [
        ("class S:\n    role = 'evader'\n    decide = print\n", "wrong:S", "is for the role 'evader'"),
        ("class S:\n    role = 'pursuer'\n", "wrong:S", "has no function 'decide'"),
        ("import no_such_module\n", "wrong:S", "does not load: No module named 'no_such_module'"),
        ("", "wrong:S", "does not load: module 'wrong' has no attribute 'S'"),
        ("raise RuntimeError('first line\\nsecond line')\n", "wrong:S", "first line second line"),
    ],
)  # fmt: skip
def test_a_plugin_that_is_wrong_costs_one_line(source: str, target: str, said: str, tmp_path: Path) -> None:
    install(tmp_path, "mine", target)
    (tmp_path / "wrong.py").write_text(source, encoding="utf-8")
    done = planar(tmp_path, "--strategy", "mine")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("sim-bridge: strategy: 'mine'")
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
