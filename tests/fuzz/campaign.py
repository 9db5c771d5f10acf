"""A long fuzz: seeded, in blocks, resumable. Block k of seed S is the same bytes on any day."""

from __future__ import annotations

import argparse
import json
import resource
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

BLOCK = 10_000  # frames
WARM = 20  # blocks after which memory must be flat
GROWTH = 8 * 1024  # [KiB] allowed after that

Play = Callable[[np.random.Generator, int, Counter[str]], None]


def resident_kib() -> int:
    """Largest resident memory of this process so far [KiB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def run(
    play: Play,
    count: int,
    seed: int,
    resume: Path | None,
    say: Callable[[str], None],
    block: int = BLOCK,
) -> Counter[str]:
    """Play `count` frames in blocks, continuing where the file `resume` says; totals by cause.

    Raises whatever `play` raises, and AssertionError where memory grows."""
    done, totals = 0, Counter[str]()
    if resume is not None and resume.exists():
        state = json.loads(resume.read_text())
        if state["seed"] == seed:
            done, totals = state["done"], Counter(state["totals"])
    settled = 0
    played = 0
    while done < count:
        size = min(block, count - done)
        play(np.random.default_rng((seed, done // block)), size, totals)
        done, played = done + size, played + 1
        if played == WARM:
            settled = resident_kib()
        if settled:
            assert resident_kib() - settled < GROWTH, "memory grows"
        if resume is not None:
            resume.write_text(json.dumps({"seed": seed, "done": done, "totals": totals}))
        if played % 10 == 0 or done == count:
            say(f"{done}/{count} {dict(sorted(totals.items()))} {resident_kib() // 1024} MB")
    return totals


def main(play: Play, what: str) -> None:
    """The command line of one campaign."""
    parser = argparse.ArgumentParser(description=what)
    parser.add_argument("--count", type=int, default=1_000_000, help="frames in all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--resume", type=Path, default=None, help="file that remembers how far it came")
    options = parser.parse_args()
    run(play, options.count, options.seed, options.resume, lambda line: print(line, file=sys.stderr))
