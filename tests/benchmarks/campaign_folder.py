"""A campaign's folder by whoever plays it: `python -m tests.benchmarks.campaign_folder [ROUNDS]`.

Many workers, a Dask cluster that loses a worker, kills of the campaign and of all its processes at random
moments: each time the folder is compared with that of an undisturbed run, file by file.
"""

from __future__ import annotations

import os
import random
import signal
import sys
import tempfile
import time
from pathlib import Path

from tests.support import benchmark_record
from tests.support.campaign_runs import begin, contents, duel, ran, wait_for_shard
from tests.support.dask_cluster import cluster

WORDS = ("--evader", "paper", "--evader", "straight", "--games", 2000, "--shard-games", 100)


def killed_and_resumed(scenario: Path, folder: Path, seed: int) -> tuple[int, int]:
    """Kill a campaign at random moments; how often, and how many shards the last kill left."""
    chance, kills, left = random.Random(seed), 0, 0
    for _ in range(6):
        begun = begin(scenario, *WORDS, "--workers", 2, "--out", folder)
        if chance.random() < 0.7:
            wait_for_shard(folder, begun)
        time.sleep(chance.uniform(0.0, 1.5))
        if begun.poll() is not None:
            break
        (os.kill if chance.random() < 0.5 else os.killpg)(begun.pid, signal.SIGKILL)
        begun.wait()
        kills += 1
        left = len(list(folder.glob("*.parquet")))
    ran(scenario, *WORDS, "--workers", 2, "--out", folder)
    return kills, left


def main(rounds: int) -> None:
    """Measure and write the page."""
    rows = ["| played by | equal to the undisturbed folder |", "|---|---|"]
    with tempfile.TemporaryDirectory() as place:
        home = Path(place)
        scenario = duel(home)
        ran(scenario, *WORDS, "--workers", 1, "--out", home / "one", within_s=120.0)
        wanted = contents(home / "one")

        def row(name: str, folder: Path) -> None:
            same = sum(contents(folder).get(file) == hashed for file, hashed in wanted.items())
            extra = len(contents(folder).keys() - wanted.keys())
            rows.append(f"| {name} | {same} of {len(wanted)} files, {extra} others |")
            print(rows[-1], flush=True)

        for workers in (2, 4):
            ran(scenario, *WORDS, "--workers", workers, "--out", home / str(workers), within_s=120.0)
            row(f"{workers} workers", home / str(workers))
        with cluster(home) as (address, workers_of_dask):
            begun = begin(scenario, *WORDS, "--dask", address, "--out", home / "dask")
            wait_for_shard(home / "dask", begun)
            early = begun.poll() is None
            workers_of_dask[0].kill()
            begun.wait()
            row(f"Dask, two workers, one killed {'mid-run' if early else 'too late'}", home / "dask")
        total = 0
        for number in range(rounds):
            kills, left = killed_and_resumed(scenario, home / f"killed-{number}", number)
            total += kills
            row(f"two workers, kill −9 {kills} times, the last with {left} shards", home / f"killed-{number}")
    rows += ["", f"{len(wanted) - 1} shards of 100 games; {total} kills in {rounds} campaigns."]
    benchmark_record.write(
        "campaign-folder.md",
        "A campaign's folder, whoever plays it",
        f"python -m tests.benchmarks.campaign_folder {rounds}",
        rows,
    )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10)
