"""`sim-bridge` as people start it: a process, its words, its end, and who is left afterwards."""

from __future__ import annotations

import fcntl
import os
import socket
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil

from tests.support.real_time import patience

SHORT = """
name = "short"
seed = 3

[evader]
position = [0, 0]
speed = 5
target = [150, 0]

[[pursuers]]
position = [90, 40]
speed = 4

[parameters]
horizon = {horizon}

[flight]
ready_s = {ready}
prediction = "constant-velocity"

[flight.sensor]
sigma = 0.1
delay_s = 0.05
dropout = 0.05

[flight.impairment]
loss = {loss}
delay_s = 0.01
jitter_s = 0.01
bus = {bus}
"""


def short(
    folder: Path, *, horizon: float = 3.0, ready: float = 1.0, loss: float = 0.0, bus: bool = False
) -> Path:
    """A game of two vehicles that is soon over, as a scenario file."""
    path = folder / "short.toml"
    text = SHORT.format(horizon=horizon, ready=ready, loss=loss, bus=str(bus).lower())
    path.write_text(text, encoding="utf-8")
    return path


def bridge(*arguments: object, promised_s: float = 30.0) -> subprocess.CompletedProcess[str]:
    """Run `sim-bridge` to its end; patience is given `promised_s` [s]."""
    command = [sys.executable, "-m", "sim_bridge.cli", *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, timeout=patience(promised_s), check=False
    )


@contextmanager
def started(*arguments: object) -> Iterator[subprocess.Popen[str]]:
    """`sim-bridge` while it runs, in a process group of its own; what is left at the end is killed."""
    command = [sys.executable, "-m", "sim_bridge.cli", *map(str, arguments)]
    child = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, process_group=0
    )
    try:
        yield child
    finally:
        for process in (*descendants(child.pid), child):
            process.kill()
        child.wait()
        for pipe in (child.stdout, child.stderr):
            if pipe is not None:
                pipe.close()


def descendants(pid: int) -> list[psutil.Process]:
    """The processes that a process has started and that still run."""
    try:
        return psutil.Process(pid).children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def until_said(child: subprocess.Popen[str], word: str) -> list[str]:
    """The lines up to the one that begins with `word`. Raises AssertionError where it ends before."""
    assert child.stdout is not None
    lines: list[str] = []
    for line in child.stdout:
        lines.append(line)
        if line.startswith(word):
            return lines
    assert child.stderr is not None
    raise AssertionError(f"ended before '{word}': {lines} {child.stderr.read()}")


@contextmanager
def well_known_ports() -> Iterator[None]:
    """Alone with UDP 14540 and up, whichever tests run beside this one."""
    path = Path(tempfile.gettempdir()) / f"apollonius-ports-{os.getuid()}.lock"
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def free_port() -> int:
    """A TCP port that is free now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
