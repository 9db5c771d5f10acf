"""A cluster of Dask on this machine: a scheduler and workers, each a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.support.campaign_runs import environment
from tests.support.real_time import patience


@contextmanager
def cluster(home: Path, workers: int = 2) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """A scheduler and its workers; its address, and the workers' processes."""
    told = home / "scheduler.json"
    nowhere = subprocess.DEVNULL

    def begin(program: str, *words: str) -> subprocess.Popen[bytes]:
        line = [sys.executable, "-m", f"distributed.cli.{program}", "--scheduler-file", str(told), *words]
        return subprocess.Popen(line, env=environment(), cwd=home, stdout=nowhere, stderr=nowhere)

    begun = [begin("dask_scheduler", "--port", "0", "--no-dashboard", "--host", "127.0.0.1")]
    try:
        end = time.monotonic() + patience(30.0)
        while not told.exists():
            assert time.monotonic() < end, "the scheduler did not come"
            time.sleep(0.05)
        for _ in range(workers):
            begun.append(begin("dask_worker", "--no-nanny", "--nthreads", "1", "--no-dashboard"))
        yield json.loads(told.read_text("utf-8"))["address"], begun[1:]
    finally:
        for process in begun:
            process.kill()
            process.wait()
