"""Small campaigns by the command line, in processes of their own, and what they leave in a folder."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import time
from pathlib import Path

from tests.support.paths import ROOT
from tests.support.real_time import patience

DUEL = """
name = "a duel"
seed = 5
[evader]
position = [0, 0]
target = [60, 0]
speed = 5
[[pursuers]]
position = [10, 20]
speed = 4
strategy = "paper"
[parameters]
R = 4.0
horizon = 20.0
"""
"""One on one in the plane; who wins hangs on where the pursuer begins."""


def duel(folder: Path) -> Path:
    """The scenario file of a duel."""
    path = folder / "duel.toml"
    path.write_text(DUEL, "utf-8")
    return path


def command(*words: object) -> list[str]:
    """The command line of `sim-bridge campaign`."""
    return [sys.executable, "-m", "sim_bridge.cli", "campaign", *map(str, words)]


def environment() -> dict[str, str]:
    """In which a command finds this checkout."""
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def ran(*words: object, within_s: float = 60.0, code: int = 0) -> subprocess.CompletedProcess[str]:
    """Run `sim-bridge campaign` to its end, which has this exit code."""
    done = subprocess.run(
        command(*words), capture_output=True, text=True, timeout=patience(within_s), env=environment(),
        check=False,
    )  # fmt: skip
    assert done.returncode == code, done.stderr
    return done


def begin(*words: object) -> subprocess.Popen[bytes]:
    """Start `sim-bridge campaign` and let it run; what it says goes nowhere."""
    nowhere = subprocess.DEVNULL
    return subprocess.Popen(
        command(*words), env=environment(), stdout=nowhere, stderr=nowhere, start_new_session=True
    )


def wait_for_shard(folder: Path, process: subprocess.Popen[bytes], within_s: float = 60.0) -> None:
    """Wait until a campaign has written a shard, or has ended."""
    end = time.monotonic() + patience(within_s)
    while not list(folder.glob("*.parquet")) and process.poll() is None:
        assert time.monotonic() < end, "no shard came"
        time.sleep(0.01)


def contents(folder: Path) -> dict[str, str]:
    """Every file of a folder, hidden ones too, with a hash of its bytes."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.iterdir())}
