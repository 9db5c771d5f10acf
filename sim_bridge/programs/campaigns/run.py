"""Runs a campaign: plays what its folder lacks, writes each shard whole, and knows when it is enough."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.clock import RealClock
from onboard.runtime.progress import Progress
from onboard.runtime.whole_files import write_whole
from sim_bridge.programs.campaigns import pool, shards
from sim_bridge.programs.campaigns.plan import Plan, Shard
from sim_bridge.programs.campaigns.until import Until, enough

Say = Callable[[str], None]


class Ways(NamedTuple):
    """By whom a campaign is played, and how long."""

    workers: int = 1
    dask: str = ""  # address of a scheduler, "" = here
    part: tuple[int, int] = (1, 1)  # i of n: every n-th shard, for array jobs
    until: Until | None = None


def run(folder: Path, plan: Plan, ways: Ways, say: Say) -> Plan:
    """Play what the folder lacks; the plan as the folder has it at the end, which a rule may have shortened.

    Raises ConfigError for a folder of another campaign; KeyboardInterrupt says how to go on.
    """
    plan = shards.settle(folder, plan)
    found = shards.find(folder, plan)
    for path in found.broken:
        say(f"{path}: broken; it is played again")
    for path in found.strange:
        say(f"{path}: no shard of this campaign; left alone")
    work = _Work(folder, plan, ways, found.whole)
    missing = work.missing()
    if work.stop is None and missing:
        with Progress("sim-bridge") as progress:
            try:
                work.play(missing, progress)
            except KeyboardInterrupt:
                raise KeyboardInterrupt(
                    f"{len(work.whole)} of {len(work.all)} shards are whole in {folder}; the same command"
                    " goes on"
                ) from None
    return work.settled()


class _Work:
    """A campaign while it is played."""

    def __init__(self, folder: Path, plan: Plan, ways: Ways, whole: dict[int, Path]) -> None:
        self.folder, self.plan, self.ways = folder, plan, ways
        self.all = plan.shards()
        self.whole = dict(whole)
        self.stop: int | None = None  # first seed after the block that was enough
        self._judged = 0  # shards, in order
        self._seen: dict[int, Counter[str]] = defaultdict(Counter)
        self._judge()

    def missing(self) -> list[Shard]:
        """Shards of this part that are not there."""
        part, parts = self.ways.part
        return [s for s in self.all if s.number not in self.whole and s.number % parts == part - 1]

    def play(self, missing: list[Shard], progress: Progress) -> None:
        """Play shards and write each as it comes, until all are there or it is enough."""
        clock = RealClock()
        begun, games, total = clock.monotonic_ns(), 0, sum(shard.games for shard in missing)

        def rate(done: int) -> str:
            seconds = max((clock.monotonic_ns() - begun) / NS_PER_S, 1e-9)
            return f"{done} of {total} games, {done / seconds:.0f} a second"

        def within(share: float, what: str) -> None:
            done = games + round(share * missing[0].games)
            progress.show(done / total, f"{rate(done)}, {what}")

        played = self._players(missing, within)
        progress.show(0.0, f"{total} games")
        for shard, data in played:
            path = self.folder / shards.file_name(self.plan, shard)
            write_whole(path, data, durable=True)
            self.whole[shard.number] = path
            games += shard.games
            progress.show(games / total, rate(games))
            self._judge()
            if self.stop is not None:
                played.close()  # type: ignore[attr-defined]
                break

    def _players(self, missing: list[Shard], tell: Callable[[float, str], None]) -> pool.Played:
        if self.ways.dask:
            return pool.play_on_dask(self.plan, missing, self.ways.dask)
        if self.ways.workers > 1 and len(missing) > 1:
            return pool.play_in_processes(self.plan, missing, min(self.ways.workers, len(missing)))
        return pool.play_here(self.plan, missing, tell)

    def _judge(self) -> None:
        """Judge the rule after every whole block of seeds that is there, in order."""
        rule = self.ways.until
        while rule is not None and self.stop is None and self._judged in self.whole:
            shard = self.all[self._judged]
            for (cell, verdict), count in shards.counts(self.whole[self._judged]).items():
                self._seen[cell][verdict] += count
            self._judged += 1
            if shard.cells.stop == self.plan.cell_count and enough(rule, self._seen):
                self.stop = shard.seeds.stop

    def settled(self) -> Plan:
        """The plan at the end; what was played beyond the rule's stop is taken away."""
        if self.stop is None or self.stop == self.all[-1].seeds.stop:
            return self.plan
        for shard in self.all:
            if shard.seeds.start >= self.stop and shard.number in self.whole:
                self.whole.pop(shard.number).unlink(missing_ok=True)
        shorter = msgspec.structs.replace(self.plan, games=self.stop - self.plan.first_seed)
        write_whole(self.folder / shards.MANIFEST, shards.manifest(shorter), durable=True)
        return shorter


def part_of(text: str) -> tuple[int, int]:
    """`2/8`: the second of eight parts. Raises ConfigError."""
    first, slash, last = text.partition("/")
    if slash and first.isdecimal() and last.isdecimal() and 1 <= int(first) <= int(last) <= 100_000:
        return int(first), int(last)
    raise ConfigError(f"--shard: found {text!r}, expected I/N with 1 ≤ I ≤ N, such as 2/8")
