"""What it saves that messages of a stream wake an event loop together: a ground station and agents, in turn.

`python -m tests.benchmarks.wake_ups [--rounds N]` writes benchmarks/results/wake-ups.md, in four minutes. In one
run each message of the bus wakes the loop by itself (unless it is on its way already), in the next those of a
stream together, as the product does it (`onboard/runtime/inbox.py`).
"""

from __future__ import annotations

import argparse
import asyncio
import os
from collections.abc import Callable
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING
from unittest.mock import patch

from onboard.runtime import inbox
from tests.benchmarks import bench_agent, bench_station
from tests.support import benchmark_record

if TYPE_CHECKING:
    from collections.abc import Iterator

LOOK_S = 10.0
NEVER = -1.0  # seconds after which nothing counts as a stream
AGENTS = "from onboard.runtime import inbox\ninbox.STREAM_S = -1.0\n"
WAYS = ("each", "together")


@contextmanager
def way(name: str) -> Iterator[list[inbox.Inbox]]:
    """Inboxes of this process and of agents it starts work that way; gives those of this process."""
    made: list[inbox.Inbox] = []
    begin: Callable[..., None] = inbox.Inbox.__init__

    def counted(self: inbox.Inbox, loop: asyncio.AbstractEventLoop) -> None:
        begin(self, loop)
        made.append(self)

    with ExitStack() as stack:
        stack.enter_context(patch.object(inbox.Inbox, "__init__", counted))
        if name == "each":
            folder = stack.enter_context(TemporaryDirectory())
            Path(folder, "sitecustomize.py").write_text(AGENTS, encoding="utf-8")
            paths = os.pathsep.join((folder, os.environ.get("PYTHONPATH", os.getcwd())))
            stack.enter_context(patch.object(inbox, "STREAM_S", NEVER))
            stack.enter_context(patch.dict(bench_agent.ENV, PYTHONPATH=paths))
        yield made


def station(name: str) -> tuple[float, float]:
    """A station that hears 200 × 20 Hz, with recorder and console: share of a core, wake-ups a message."""
    with way(name) as made:
        found = asyncio.run(bench_station.measure(bench_station.Load(200, False)))
    assert found.received == found.recorded == found.sent, found
    return found.core, made[0].wakes / found.received


def agents(name: str) -> dict[str, float]:
    """Shares of a core of a pursuer and of the evader among six, at 20 Hz."""
    with way(name), patch.object(bench_agent, "LOOK_S", LOOK_S):
        return {one.role: one.core for one in bench_agent.resources()}


def main() -> None:
    """Measure in turn, print, write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=3)
    rounds = parser.parse_args().rounds
    found: dict[str, dict[str, list[float]]] = {}
    for _ in range(rounds):
        for name in WAYS:
            core, wakes = station(name)
            row = {"station, 200 vehicles at 20 Hz, of a core [%]": 100.0 * core}
            row["station, wake-ups a hundred messages"] = 100.0 * wakes
            row |= {
                f"{role} among six at 20 Hz, of a core [%]": 100.0 * c for role, c in agents(name).items()
            }
            print(name, row, flush=True)
            for what, value in row.items():
                found.setdefault(what, {}).setdefault(name, []).append(value)
    lines = [
        f"Medians of {rounds} runs in turn (all in brackets); CPU of whole processes, Zenoh's threads included.",
        f"Together: in a stream the loop looks every {1e3 * inbox.TOGETHER_S:g} ms; a lone message and an order",
        "wake it at once in both.",
        "",
        "| what | each by itself | together | ratio |",
        "|---|---|---|---|",
    ]
    for what, each in found.items():
        cells = [f"{median(each[n]):.2f} ({', '.join(f'{v:.2f}' for v in each[n])})" for n in WAYS]
        ratio = median(each["together"]) / median(each["each"])
        lines.append(f"| {what} | {cells[0]} | {cells[1]} | {ratio:.2f} |")
    print("\n".join(lines))
    benchmark_record.write(
        "wake-ups.md", "Wake-ups of the event loop", "python -m tests.benchmarks.wake_ups", lines
    )


if __name__ == "__main__":
    main()
