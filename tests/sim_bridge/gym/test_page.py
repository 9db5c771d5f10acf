"""docs/gym.md says what the code says, and its examples run."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path
from time import monotonic

import pytest

from sim_bridge.gym.describe import described
from sim_bridge.gym.task import Wish
from tests.support.paths import ROOT
from tests.support.real_time import patience

PAGE = (ROOT / "docs" / "gym.md").read_text(encoding="utf-8")


def test_the_tables_are_those_of_the_code() -> None:
    assert described().strip() in PAGE, "run python -m sim_bridge.gym.describe and put it into the page"
    for row in re.findall(r"^\| `(\w+)` \|.*\| *\|$", described(), re.MULTILINE):
        pytest.fail(f"{row} has no words")
    assert all(f"| `{key}` |" in PAGE for key in Wish.__struct_fields__)


@pytest.mark.long
def test_the_examples_run() -> None:
    blocks = re.findall(r"^```python\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    assert len(blocks) == 2
    said = []
    for block in blocks:
        done = subprocess.run(
            [sys.executable, "-c", block], capture_output=True, text=True, cwd=ROOT, timeout=patience(120.0),
            check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        said.append(done.stdout)
    assert "'verdict':" in said[0]
    assert said[1] == "(256, 5, 10)\n"


@pytest.mark.long
@pytest.mark.timeout(900)
def test_from_an_empty_folder_to_the_first_step_takes_less_than_five_minutes(tmp_path: Path) -> None:
    """A fresh environment, the distribution with its extras from the index that pip has, and a step."""
    ask = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", str(tmp_path)]
    if subprocess.run([*ask, "gymnasium"], capture_output=True, check=False).returncode != 0:
        pytest.skip("pip reaches no index here")
    source = tmp_path / "apollonius"
    pages = ("README.md", "LICENSE", "CHANGELOG.md", "ARCHITECTURE.md")
    rooms = ("onboard", "gcs", "sim_bridge", "configs", "pyproject.toml", *pages)
    for name in rooms:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            source.mkdir(exist_ok=True)
            shutil.copy(ROOT / name, source / name)
    step = ("import gymnasium; e = gymnasium.make('sim_bridge.gym:apollonius/Plane-v0'); e.reset(seed=1);"
            "print(e.step(e.action_space.sample())[1])")  # fmt: skip
    python = tmp_path / "venv" / "bin" / "python"
    clean = {"PATH": "/usr/local/bin:/usr/bin:/bin", "HOME": str(tmp_path)}
    begun = monotonic()
    for words, env in (
        ([sys.executable, "-m", "venv", str(tmp_path / "venv")], None),
        ([str(python), "-m", "pip", "install", "--quiet", f"{source}[sim,gym]"], None),
        ([str(python), "-c", step], clean),
    ):
        done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, env=env, check=False)
        assert done.returncode == 0, done.stderr[-2000:]
    took = monotonic() - begun
    print(f"from an empty folder to the first step: {took:.0f} s")
    assert float(done.stdout) != 0.0
    assert took < patience(300.0)
