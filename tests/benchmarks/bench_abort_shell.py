"""`gcs command abort --all` from a shell: from the start of the process until the first agent has the order.

Promise: 0.3 s on a computer that has nothing else to do, which is what the processor's time says on any. What
else it does shows in the yardstick, taken in turns: a bare Python that opens Zenoh and asks the same keys.
`python -m tests.benchmarks.bench_abort_shell`, or with pytest.
"""

from __future__ import annotations

import asyncio
import os
import sys
from statistics import median
from time import perf_counter

import psutil  # type: ignore[import-untyped]

from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.protocols import Bus
from onboard.wire.bus.topics import COMMAND
from tests.support import benchmark_record
from tests.support.bus_stages import free_port
from tests.support.paths import ROOT

ROUNDS, VEHICLES, GAME = 30, 6, "bench"
PROMISED_S = 0.3
NOWHERE = asyncio.subprocess.DEVNULL
BARE = """
import json, sys, zenoh
config = zenoh.Config()
for name, value in (("mode", "client"), ("connect/endpoints", [sys.argv[1]]), ("listen/endpoints", []),
                    ("scouting/multicast/enabled", False)):
    config.insert_json5(name, json.dumps(value))
session = zenoh.open(config)
list(session.get(sys.argv[2], payload=b"bare", target=zenoh.QueryTarget.ALL, timeout=1.0))
session.close()
"""


class Ears:
    """Agents that note when the first order of a process came; they answer nothing of use."""

    def __init__(self, bus: Bus) -> None:
        self.heard: tuple[float, float] | None = None  # (instant, processor's time of who ordered) [s]
        self.process: psutil.Process | None = None
        for i in range(1, VEHICLES + 1):
            bus.serve(COMMAND.key(GAME, i), self._hear)

    def _hear(self, _: bytes) -> bytes:
        if self.heard is None and self.process is not None:
            used = self.process.cpu_times()
            self.heard = (perf_counter(), used.user + used.system)
        return b""


async def took(ears: Ears, *arguments: str) -> tuple[float, float]:
    """From the start of a process to the first order: (time, processor's time) [s]."""
    ears.heard, ears.process = None, None
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # as it is installed: with compiled modules
    started = perf_counter()
    process = await asyncio.create_subprocess_exec(
        sys.executable, *arguments, env=environment,
        stdin=NOWHERE, stdout=NOWHERE, stderr=NOWHERE,
    )  # fmt: skip
    ears.process = psutil.Process(process.pid)
    await process.wait()
    assert ears.heard is not None
    return ears.heard[0] - started, ears.heard[1]


async def rounds(count: int) -> list[tuple[float, float, float, float]]:
    """The command's time and processor's time, then the yardstick's [s], taken in turns."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    bus = await open_zenoh(endpoint, listen=True)
    ears = Ears(bus)
    where = ("--bus", endpoint, "--game", GAME)
    found = []
    try:
        for _ in range(count + 1):
            mine = await took(ears, "-m", "gcs.cli", "command", "abort", "--all", "--within", "0.3", *where)
            found.append((*mine, *await took(ears, "-c", BARE, endpoint, COMMAND.key(GAME))))
    finally:
        await bus.close()
    return found[1:]  # the first one compiles


def run(count: int = ROUNDS) -> list[tuple[float, float, float, float]]:
    """`count` rounds; says and writes what they took."""
    found = asyncio.run(rounds(count))
    columns = [sorted(each) for each in zip(*found, strict=True)]
    used = "its processor's time"
    names = ("`gcs command abort --all`", used, "bare Python and Zenoh", used)
    lines = [
        "From the start of the process until an agent has the order, in turns with a bare Python that opens",
        "a session of Zenoh and asks the same keys. The processor's time does not depend on what else runs.",
        "",
        "| | least [ms] | median [ms] | 90 % [ms] |",
        "|---|---|---|---|",
        *(f"| {name} | {1e3 * t[0]:.0f} | {1e3 * median(t):.0f} | {1e3 * t[int(0.9 * len(t))]:.0f} |"
          for name, t in zip(names, columns, strict=True)),
        "",
        f"Ratio of the processor's times: {median(columns[1]) / median(columns[3]):.1f}; {count} rounds.",
    ]  # fmt: skip
    benchmark_record.write(
        "abort-shell.md", "An abort from a shell", "python -m tests.benchmarks.bench_abort_shell", lines
    )
    print("\n".join(lines))
    return found


def test_an_abort_from_a_shell_leaves_at_once() -> None:
    found = run()
    assert median(used for _, used, _, _ in found) < PROMISED_S
    assert min(time for time, _, _, _ in found) < PROMISED_S


if __name__ == "__main__":
    run()
