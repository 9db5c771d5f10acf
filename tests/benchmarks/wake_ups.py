"""What it saves that messages wait for the loop in Zenoh's channels: a ground station and agents.

`python -m tests.benchmarks.wake_ups [--rounds N]` writes benchmarks/results/wake-ups.md, in four minutes.
Before, a thread of Zenoh's entered Python for each message, left it in a queue and woke the loop. Each
state of the project is measured in processes of its own, in turn.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from tests.benchmarks.campaign_speed import unpacked
from tests.benchmarks.speed import State, measure
from tests.support import benchmark_record

BEFORE = "c4482fd"  # a call for each message
STATION = """
from tests.benchmarks import bench_station
async def play():
    return await bench_station.measure(bench_station.Load(200, False))
found = asyncio.run(play())
tell({"station, 200 vehicles at 20 Hz, of a core [%]": 100.0 * found.core,
      "station, messages that came of a hundred": 100.0 * found.recorded / found.sent})
"""
AGENTS = """
from tests.benchmarks import bench_agent
bench_agent.LOOK_S = 10.0
tell({f"{one.role} among six at 20 Hz, of a core [%]": 100.0 * one.core for one in bench_agent.resources()})
"""


def main() -> None:
    """Measure in turn, print, write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    rounds = parser.parse_args().rounds
    found: dict[str, dict[str, list[float]]] = {}
    with TemporaryDirectory() as name:
        states = [
            State(which, unpacked(which, Path(name) / which), sys.executable) for which in (BEFORE, "HEAD")
        ]
        for _ in range(rounds):
            for state in states:
                for script in (STATION, AGENTS):
                    for what, cost in measure(state, script).items():
                        print(state.name, what, f"{cost.value:.2f}", flush=True)
                        found.setdefault(what, {}).setdefault(state.name, []).append(cost.value)
    lines = [
        f"Medians of {rounds} runs in turn (all in brackets); CPU of whole processes, with Zenoh's threads.",
        f"Before is {BEFORE}: a thread of Zenoh's entered Python and woke the loop for each message. Now",
        "messages wait in Zenoh's channels; a station looks every 30 ms, an agent once a control period;",
        "requests are answered at once in both.",
        "",
        "| what | before | now | ratio |",
        "|---|---|---|---|",
    ]
    for what, each in found.items():
        cells = [f"{median(them):.2f} ({', '.join(f'{v:.2f}' for v in them)})" for them in each.values()]
        ratio = median(each["HEAD"]) / median(each[BEFORE])
        lines.append(f"| {what} | {cells[0]} | {cells[1]} | {ratio:.2f} |")
    print("\n".join(lines))
    benchmark_record.write(
        "wake-ups.md", "Wake-ups of the event loop", "python -m tests.benchmarks.wake_ups", lines
    )


if __name__ == "__main__":
    main()
