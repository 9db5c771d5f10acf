"""Setpoints while the disk under an agent's log, and the reader of its standard error, stand still.

A real agent in flight writes its telemetry log into a pipe whose reader stops for five seconds, and its lines
to a reader that never reads. Promise: no gap above 0.2 s between two setpoints, less the lateness of a bare
20 Hz loop in a process beside it: on a busy machine that much is the machine's.
`python -m tests.benchmarks.bench_blocked_disk`, or with pytest.
"""

from __future__ import annotations

import asyncio
import contextlib
import fcntl
import os
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import pytest

from onboard.runtime.bus_zenoh import open_zenoh
from tests.benchmarks.bench_agent import ENV, PURSUER, Stage, agent, udp_port
from tests.support import benchmark_record
from tests.support.bus_stages import free_port
from tests.support.real_time import until
from tests.support.setpoint_stopwatch import Stopwatch

FROZEN_S, ROUNDS = 5.0, 3
PROMISED_S = 0.2
PIPE_BYTES = 4096
BARE = """
import asyncio, time
async def main():
    last = time.monotonic()
    while True:
        await asyncio.sleep(0.05)
        now = time.monotonic()
        print(now - last - 0.05, flush=True)
        last = now
asyncio.run(main())
"""


class Found(NamedTuple):
    """One freeze."""

    setpoints: int  # during it
    gap_s: float  # the longest between two of them
    bare_s: float  # the greatest lateness of the bare loop meanwhile


async def freeze(folder: Path) -> Found:
    """An agent in flight whose log freezes."""
    port, endpoint, log = udp_port(), f"tcp/127.0.0.1:{free_port()}", folder / "log.tlog"
    os.mkfifo(log)
    reader = os.open(log, os.O_RDWR | os.O_NONBLOCK)
    fcntl.fcntl(reader, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
    watch = Stopwatch(port, fresh=False)
    bus = await open_zenoh(endpoint, listen=True)
    world = asyncio.create_task(Stage(watch, bus, None).run())  # cancelled below
    loop = asyncio.get_running_loop()

    def drain() -> None:
        with contextlib.suppress(BlockingIOError):
            os.read(reader, 1 << 16)

    loop.add_reader(reader, drain)
    pipe = subprocess.PIPE
    command = agent(PURSUER, port, endpoint, "--log", str(log))
    with subprocess.Popen(command, stderr=pipe, env=ENV) as process:  # noqa: ASYNC220
        assert process.stderr is not None
        fcntl.fcntl(process.stderr.fileno(), fcntl.F_SETPIPE_SZ, PIPE_BYTES)  # nobody ever reads it
        try:
            await until(lambda: len(watch.arrivals_ns) >= 60 or world.done(), 60.0)
            bare_loop = [sys.executable, "-c", BARE]
            with subprocess.Popen(bare_loop, stdout=pipe, text=True) as bare:  # noqa: ASYNC220
                await asyncio.sleep(1.0)
                watch.restart()
                loop.remove_reader(reader)
                await asyncio.sleep(FROZEN_S)
                stamps = list(watch.arrivals_ns)
                bare.kill()
                assert bare.stdout is not None
                late = [float(line) for line in bare.stdout.read().split()]
        finally:
            loop.remove_reader(reader)
            loop.add_reader(reader, drain)
            process.terminate()
            while process.poll() is None:  # noqa: ASYNC110
                await asyncio.sleep(0.05)
            world.cancel()
            await asyncio.gather(world, return_exceptions=True)
            watch.close()
            loop.remove_reader(reader)
            os.close(reader)
            await bus.close()
    gaps = [(b - a) / 1e9 for a, b in pairwise(stamps)]
    return Found(len(stamps), max(gaps, default=FROZEN_S), max(0.0, *late[10:]))


def report() -> list[Found]:
    """Measure, print and write down."""
    found = []
    for _ in range(ROUNDS):
        with TemporaryDirectory() as name:
            found.append(asyncio.run(freeze(Path(name))))
    lines = [
        f"A log on a disk that freezes for {FROZEN_S:g} s, a standard error that nobody reads; 20 Hz.",
        f"Promised: gaps of {PROMISED_S:g} s at most, less the lateness of a bare 20 Hz loop beside it.",
        "",
        "| setpoints meanwhile | longest gap [s] | bare loop late by [s] |",
        "|---|---|---|",
        *(f"| {one.setpoints} | {one.gap_s:.3f} | {one.bare_s:.3f} |" for one in found),
    ]
    print("\n".join(lines))
    command = "python -m tests.benchmarks.bench_blocked_disk"
    benchmark_record.write("blocked-disk.md", "A disk that stands still", command, lines)
    return found


@pytest.mark.real
def test_a_disk_that_stands_still_leaves_no_gap_in_the_setpoints() -> None:
    for one in report():
        assert one.setpoints > 0.8 * 20.0 * FROZEN_S
        assert one.gap_s - one.bare_s <= PROMISED_S


if __name__ == "__main__":
    report()
