"""`make install`: the locked releases whatever the index has, silent, and one line for what people meet."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support import real_time, wheels

ROOT = Path(__file__).parents[2]
PROJECT = """
[build-system]
requires = []
build-backend = "backend"
backend-path = ["."]
[project]
name = "apollonius"
version = "0"
"""
BACKEND = """
from pathlib import Path
from wheels import write_wheel
def build_editable(folder, settings=None, metadata=None):
    return write_wheel(Path(folder), "apollonius", "0").name
"""
OLD = ("3.10", "3.9", "3.8", "3.7", "3.6")


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """Give a small project under this project's Makefile and install.py, with an empty lock."""
    tree = tmp_path / "tree"
    (tree / "locks").mkdir(parents=True)
    shutil.copy(ROOT / "Makefile", tree)
    shutil.copy(ROOT / "locks/install.py", tree / "locks")
    shutil.copy(ROOT / "tests/support/wheels.py", tree)
    (tree / "backend.py").write_text(BACKEND, encoding="utf-8")
    (tree / "pyproject.toml").write_text(PROJECT, encoding="utf-8")
    (tree / "locks/all.lock").write_text("", encoding="utf-8")
    return tree


def make(
    tree: Path, *words: str, python: str = sys.executable, **settings: object
) -> tuple[int, list[str], str]:
    """Run make in a clean environment with these settings; give its status, stderr's lines and stdout."""
    clean = {
        "PATH": os.environ["PATH"],
        "HOME": str(tree.parent),
        "PIP_CONFIG_FILE": os.devnull,
        "LC_ALL": "C",
    }
    done = subprocess.run(
        ["make", *(words or ("install",)), f"PYTHON={python}"], cwd=tree, capture_output=True, text=True,
        timeout=real_time.patience(40.0), check=False,
        env=clean | {name: str(value) for name, value in settings.items()},
    )  # fmt: skip
    return done.returncode, done.stderr.splitlines(), done.stdout


def remedy(tree: Path, python: str = sys.executable, **settings: object) -> str:
    """Give the one line that a failing `make install` prints beside make's own."""
    status, lines, _ = make(tree, python=python, **settings)
    assert status == 2
    assert len(lines) == 2, lines
    assert lines[1].startswith("make: *** [")
    assert not (tree / ".venv/.installed").exists()
    return lines[0]


@pytest.mark.real
def test_newer_releases_in_the_index_change_nothing(tree: Path, tmp_path: Path) -> None:
    index = tmp_path / "index"
    index.mkdir()
    lock = [
        wheels.write_wheel(index, "asking", "1.0", ["asked[more]>=1"]),
        wheels.write_wheel(index, "asked", "1.0", ["third>=1; extra == 'more'"], extra="more"),
        wheels.write_wheel(index, "third", "1.0", ["beyond"]),  # not locked: whoever resolves must stop here
    ]
    (tree / "locks/all.lock").write_text("".join(map(wheels.locked, lock)), encoding="utf-8")
    for name in ("asking", "asked", "third", "beyond"):
        wheels.write_wheel(index, name, "2.0", extra="more")
    # The user's own settings, in pip's file: they count, and what pip says about them stays unsaid.
    settings = tmp_path / "pip.conf"
    settings.write_text(
        f"[global]\nno-index = true\nfind-links = {index}\n  {tmp_path}/nowhere\n", encoding="utf-8"
    )
    status, errors, said = make(tree, PIP_CONFIG_FILE=settings)
    assert (status, errors) == (0, [])
    assert len(said.splitlines()) == 1
    python = tree / ".venv/bin/python"
    versions = subprocess.run(
        [python, "-c", "import asking as a, asked as b, third as c; print(a.VERSION, b.VERSION, c.VERSION)"],
        capture_output=True, text=True, check=True, cwd=tmp_path,
    )  # fmt: skip
    assert versions.stdout.split() == ["1.0", "1.0", "1.0"]

    # The same index stops an installation that resolves, with every release of pip.
    resolving = subprocess.run(
        [python, "-m", "pip", "install", "--dry-run", "--ignore-installed", "--require-hashes", "--no-index",
         "--find-links", index, "-r", tree / "locks/all.lock"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "must have their versions pinned" in resolving.stderr

    # The second time nothing runs, and make demo begins at once.
    assert make(tree)[2] == "make: Nothing to be done for 'install'.\n"
    assert "install.py" not in make(tree, "-n", "demo")[2]


def test_every_lock_is_installed_by_the_same_program_or_without_dependencies() -> None:
    lines = (ROOT / "Makefile").read_text(encoding="utf-8").replace("\\\n", " ").splitlines()
    installing = [
        line for line in lines if line.startswith("\t") and ".lock" in line and "uv pip compile" not in line
    ]
    assert len(installing) == 3
    for line in installing:
        assert "locks/install.py" in line or "--no-deps --require-hashes" in line


@pytest.mark.real
def test_an_index_out_of_reach(tree: Path, tmp_path: Path) -> None:
    (tree / "locks/all.lock").write_text(
        wheels.locked(wheels.write_wheel(tmp_path, "asked", "1.0")), encoding="utf-8"
    )
    said = remedy(tree, PIP_INDEX_URL="http://127.0.0.1:9/", PIP_RETRIES=1)
    assert said.startswith("the package index cannot be reached; check the network, or set PIP_INDEX_URL")
    log = Path(said.rsplit(": ")[-1])
    assert "Connection refused" in (tree / log).read_text(encoding="utf-8")
    assert remedy(tree, PIP_NO_INDEX=1).startswith("the package index has no asked==1.0 for this Python")


@pytest.mark.parametrize(
    ("printed", "said"),
    [
        (
            "ERROR: Could not install packages due to an OSError: [Errno 28] No space left on device",
            "no space left",
        ),
        ("OSError: [Errno 122] Disk quota exceeded", "no space left"),
        (
            "ERROR: Could not install packages due to an OSError: [Errno 13] Permission denied: '/x'",
            "no permission",
        ),
        ("ERROR: THESE PACKAGES DO NOT MATCH THE HASHES FROM THE REQUIREMENTS FILE.", "sent other files"),
        (
            "WARNING: Retrying ... SSLError(SSLCertVerificationError(1, '[SSL: CERTIFICATE_VERIFY_FAILED]",
            "PIP_CERT",
        ),
        (
            "WARNING: Retrying ... NameResolutionError: Failed to resolve 'x'\nERROR: No matching",
            "check the network",
        ),
        ("WARNING: a\nERROR: what nobody foresaw\n", "ERROR: what nobody foresaw; the whole output: .venv/"),
    ],
)
def test_what_pip_says_becomes_one_line_with_the_remedy(tree: Path, printed: str, said: str) -> None:
    python = tree / ".venv/bin/python"
    python.parent.mkdir(parents=True)
    (tree / "printed").write_text(printed, encoding="utf-8")
    python.write_text('#!/bin/sh\n[ "$1" = -c ] && exit 0\ncat printed\nexit 1\n', encoding="utf-8")
    python.chmod(0o755)
    assert said in remedy(tree)


def test_no_python_of_that_name(tree: Path) -> None:
    assert remedy(tree, python="no-such-python").startswith("there is no no-such-python; install Python 3.11")


def test_a_python_without_the_venv_module(tree: Path, tmp_path: Path) -> None:
    # What a Debian without python3-venv lacks is ensurepip.
    (tmp_path / "ensurepip.py").write_text(
        "raise ModuleNotFoundError('No module named ensurepip')", encoding="utf-8"
    )
    said = remedy(tree, PYTHONPATH=tmp_path)
    assert "has no venv module" in said
    assert said.endswith(f"apt install python3.{sys.version_info.minor}-venv")


def test_a_python_that_is_too_old(tree: Path, tmp_path: Path) -> None:
    text = (ROOT / "locks/install.py").read_text(encoding="utf-8")
    ast.parse(text, feature_version=(3, 6))
    (tmp_path / "sitecustomize.py").write_text(
        "import sys; sys.version_info = (3, 8, 18, 'final', 0)", encoding="utf-8"
    )
    said = remedy(tree, PYTHONPATH=tmp_path)
    assert said.startswith("Python 3.11 or later is needed")
    assert "is 3.8; name another: make PYTHON=" in said


@pytest.mark.parametrize("version", OLD)
def test_a_real_old_python(tree: Path, version: str) -> None:
    places = [shutil.which(f"python{version}"), *Path.home().glob(f".pyenv/versions/{version}.*/bin/python")]
    for place in filter(None, places):
        if subprocess.run([place, "--version"], capture_output=True, check=False).returncode == 0:
            assert f"is {version}; name another" in remedy(tree, python=str(place))
            return
    pytest.skip(f"no Python {version} on this machine; a stand-in is tested above")
