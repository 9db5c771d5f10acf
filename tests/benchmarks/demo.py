"""How long `make demo` takes once everything is installed: `python -m tests.benchmarks.demo [TIMES]`.

Promise: at most 60 s on two quiet cores: the planar games of Table 1, a flight of seven processes in real
time, its figures and its report.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from time import monotonic
from typing import NamedTuple

from tests.support import benchmark_record
from tests.support.paths import ROOT

PROMISED_S = 60.0


class Shown(NamedTuple):
    """One demo."""

    wall_s: float
    cpu_s: float
    load: float  # of the machine, when it began
    outcome: str


def demo() -> Shown:
    """Run it. Raises CalledProcessError where it fails."""
    load, begun, before = os.getloadavg()[0], monotonic(), os.times()
    told = subprocess.run(
        ["make", "-o", ".venv/.installed", "demo"], check=True, cwd=ROOT, text=True, capture_output=True
    ).stdout
    after, found = os.times(), re.search(r"^(.*); smallest distance", told, re.MULTILINE)
    cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
    return Shown(monotonic() - begun, cpu_s, load, found[1] if found else "no verdict")


def report(times: int) -> None:
    """Measure, print and write the page."""
    shown = [demo() for _ in range(times)]
    lines = [
        "From `make demo` to its last line, everything installed: Table 1 in the plane, then the scenario",
        "`first` flown in real time by seven processes with networks that learn, its figures and its report,",
        f"the figures of the plane games beside it. Promised: {PROMISED_S:g} s on two quiet cores.",
        "",
        "| wall [s] | CPU [s] | load before | how the game ended |",
        "|---|---|---|---|",
        *(f"| {one.wall_s:.1f} | {one.cpu_s:.1f} | {one.load:.1f} | {one.outcome} |" for one in shown),
    ]
    print("\n".join(lines))
    command = "python -m tests.benchmarks.demo" + (f" {times}" if times != 3 else "")
    benchmark_record.write("demo.md", "What `make demo` takes", command, lines)


if __name__ == "__main__":
    report(int(sys.argv[1]) if len(sys.argv) > 1 else 3)
