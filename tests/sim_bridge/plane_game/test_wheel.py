"""The wheel: it carries the configuration, no tests, and plays Table 1 in an empty folder."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.support.paths import ROOT
from tests.support.progress_lines import without_progress
from tests.support.real_time import patience

CARRIED = ("onboard", "gcs", "sim_bridge", "configs", "pyproject.toml", "README.md", "LICENSE")


def call(*words: object, cwd: Path, **more: str) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(
        [*map(str, words)], cwd=cwd, capture_output=True, text=True, timeout=patience(40.0), check=False,
        env={**{k: v for k, v in os.environ.items() if k != "PYTHONPATH"}, **more},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return done


@pytest.mark.real
def test_the_wheel_plays_table_1_without_the_source_tree(tmp_path: Path) -> None:
    tree = tmp_path / "tree"  # the build sees only this copy
    tree.mkdir()
    for name in CARRIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
        elif source.exists():
            shutil.copy(source, tree / name)
    if not (tree / "README.md").exists():
        (tree / "README.md").write_text("Apollonius\n", encoding="utf-8")
    call(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--no-index",
         "-w", tmp_path, ".", cwd=tree)  # fmt: skip
    (wheel,) = tmp_path.glob("apollonius-*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    shipped = {str(p.relative_to(ROOT)) for p in (ROOT / "configs").rglob("*.toml")}
    assert len(shipped) > 10
    assert {f"onboard/{name}" for name in shipped} <= set(names)
    assert not [name for name in names if name.split("/")[0] in ("tests", "configs", "examples")]
    (scripts,) = [n for n in names if n.endswith("entry_points.txt")]
    assert "sim-bridge = sim_bridge.cli:main" in zipfile.ZipFile(wheel).read(scripts).decode()

    site, empty = tmp_path / "site", tmp_path / "empty"
    empty.mkdir()
    call(sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index",
         "--disable-pip-version-check", "--no-compile", "--target", site, wheel, cwd=empty)  # fmt: skip
    # The editable installation of this tree must not answer in the wheel's place: the target goes first.
    played = call(site / "bin" / "sim-bridge", "planar", "--dt", "0.1", cwd=empty, PYTHONPATH=str(site))
    assert "30 of 30 verdicts as in the paper" in played.stdout
    assert without_progress(played.stderr) == ""
    assert list(empty.iterdir()) == []
    where = call(sys.executable, "-c", "import onboard.runtime.resources as r; print(r.configs())", cwd=empty,
                 PYTHONPATH=str(site))  # fmt: skip
    assert Path(where.stdout.strip()) == site / "onboard" / "configs"
