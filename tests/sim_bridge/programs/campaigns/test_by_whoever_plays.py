"""Equal bytes whoever plays a campaign: any number of workers, a Dask cluster, kills and interrupts.

And games of all kinds: aircraft in wind, whole flights, strategies of other distributions.
"""

from __future__ import annotations

import os
import random
import re
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import psutil
import pytest

from onboard.runtime.resources import configs
from sim_bridge.campaign.spatial_campaign import play_seed
from sim_bridge.campaign.spatial_draw import spatial
from sim_bridge.campaign.spatial_game import Evasion
from sim_bridge.plane_game.program import play
from sim_bridge.programs.campaigns import shards
from sim_bridge.programs.campaigns.command import Options, all_of, plan_of
from sim_bridge.programs.campaigns.play import drawn, rows
from sim_bridge.programs.campaigns.pool import _through
from tests.support.campaign_runs import begin, contents, duel, environment, ran, wait_for_shard
from tests.support.dask_cluster import cluster
from tests.support.real_time import patience

pytestmark = [pytest.mark.real, pytest.mark.timeout(1200)]
WORDS = ("--evader", "paper", "--evader", "straight", "--games", 200, "--shard-games", 20)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    home = tmp_path_factory.mktemp("undisturbed")
    scenario = duel(home)
    ran(scenario, *WORDS, "--workers", 1, "--out", home / "folder")
    return scenario, contents(home / "folder")


@pytest.mark.long
@pytest.mark.parametrize("workers", [2, 4])
def test_any_number_of_workers_gives_the_same_bytes(
    undisturbed: tuple[Path, dict[str, str]], tmp_path: Path, workers: int
) -> None:
    scenario, wanted = undisturbed
    ran(scenario, *WORDS, "--workers", workers, "--out", tmp_path / "folder")
    assert contents(tmp_path / "folder") == wanted


@pytest.mark.long
@pytest.mark.parametrize("seed", range(8))
def test_killed_at_any_moment_it_goes_on_to_the_same_bytes(
    undisturbed: tuple[Path, dict[str, str]], tmp_path: Path, seed: int
) -> None:
    scenario, wanted = undisturbed
    folder, chance = tmp_path / "folder", random.Random(seed)
    for _ in range(3):
        begun = begin(scenario, *WORDS, "--workers", 2, "--out", folder)
        if chance.random() < 0.7:
            wait_for_shard(folder, begun)
        time.sleep(chance.uniform(0.0, 1.0))
        if chance.random() < 0.5:
            os.kill(begun.pid, signal.SIGKILL)
        else:
            os.killpg(begun.pid, signal.SIGKILL)
        begun.wait()
    ran(scenario, *WORDS, "--workers", 2, "--out", folder)
    assert contents(folder) == wanted


@pytest.mark.long
def test_a_killed_worker_costs_its_shards_time_alone_and_orphans_end(
    undisturbed: tuple[Path, dict[str, str]], tmp_path: Path
) -> None:
    scenario, wanted = undisturbed
    begun = begin(scenario, *WORDS, "--workers", 2, "--out", tmp_path / "a")
    workers = workers_of(begun)
    workers[0].kill()
    assert begun.wait(patience(60.0)) == 0
    assert contents(tmp_path / "a") == wanted
    begun = begin(scenario, *WORDS, "--workers", 2, "--out", tmp_path / "b")
    workers = workers_of(begun)
    begun.kill()
    _gone, alive = psutil.wait_procs(workers, timeout=patience(10.0))
    assert alive == []


def workers_of(process: subprocess.Popen[bytes]) -> list[psutil.Process]:
    """The worker processes of a campaign, once there are two."""
    end = time.monotonic() + patience(30.0)
    while True:
        found = [
            child
            for child in psutil.Process(process.pid).children()
            if "spawn_main" in " ".join(child.cmdline())
        ]
        if len(found) >= 2:
            return found
        assert time.monotonic() < end, "no workers came"
        time.sleep(0.02)


@pytest.mark.long
def test_ctrl_c_leaves_whole_shards_and_says_how_it_goes_on(
    undisturbed: tuple[Path, dict[str, str]], tmp_path: Path
) -> None:
    scenario, wanted = undisturbed
    folder = tmp_path / "folder"
    words = [sys.executable, "-m", "sim_bridge.cli", "campaign", str(scenario), *map(str, WORDS)]
    begun = subprocess.Popen(
        [*words, "--games", "20000", "--workers", "2", "--out", str(folder)], env=environment(),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    end = time.monotonic() + patience(60.0)
    while not list(folder.glob("*.parquet")) and time.monotonic() < end:
        time.sleep(0.02)
    os.killpg(begun.pid, signal.SIGINT)  # as a terminal sends it: to the workers too
    out, said = begun.communicate(timeout=patience(30.0))
    lines = [line for line in said.splitlines() if "%" not in line]
    assert (begun.returncode, out) == (130, "")
    assert len(lines) == 1, said
    assert f"shards are whole in {folder}; the same command goes on" in lines[0]
    assert all(path.suffix in (".parquet", ".json") for path in folder.iterdir())
    assert wanted.items() - contents(folder).items() or len(contents(folder)) > 2


class Interrupted:
    """A pool in which ctrl-C comes while a shard is handed out."""

    def __init__(self, by_a_thread: bool, broken: bool) -> None:
        self._by_a_thread = by_a_thread
        self._broken = broken

    def submit(self, *_given: object) -> Future[bytes]:
        if self._by_a_thread:  # the system gives it to any thread that takes it
            taker = threading.Thread(target=self._take)
            taker.start()
            taker.join()
        else:
            signal.raise_signal(signal.SIGINT)
        if self._broken:
            raise BrokenProcessPool
        self.handed_out = Future[bytes]()
        self.handed_out.set_result(b"")
        return self.handed_out

    def _take(self) -> None:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))  # as of a thread from before
        signal.raise_signal(signal.SIGINT)


@pytest.mark.parametrize(("by_a_thread", "broken"), [(False, False), (True, False), (False, True)])
def test_ctrl_c_while_a_shard_is_handed_out_is_not_lost(
    by_a_thread: bool, broken: bool, tmp_path: Path
) -> None:
    plan = plan_of(Options((duel(tmp_path),), games=4), until=False)
    pool: Any = Interrupted(by_a_thread, broken)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a program run in here leaves another
    try:
        with pytest.raises(KeyboardInterrupt):
            list(_through(pool, plan, plan.shards(), 1))
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert broken or pool.handed_out.done()  # nothing was broken off
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


@pytest.mark.long
def test_a_dask_cluster_that_loses_a_worker_gives_the_same_bytes(
    undisturbed: tuple[Path, dict[str, str]], tmp_path: Path
) -> None:
    scenario, wanted = undisturbed
    folder = tmp_path / "folder"
    with cluster(tmp_path) as (address, workers):
        begun = begin(scenario, *WORDS, "--dask", address, "--out", folder)
        wait_for_shard(folder, begun)
        early = begun.poll() is None
        workers[0].kill()
        assert begun.wait(patience(120.0)) == 0
    assert early, "the campaign was over before the worker was killed"
    assert contents(folder) == wanted


@pytest.mark.parametrize("address", ["nonsense", "tcp://host", "smoke://host:1"])
def test_nobody_at_the_schedulers_address_is_told(address: str, tmp_path: Path) -> None:
    told = ran(duel(tmp_path), "--games", 2, "--dask", address, "--out", tmp_path / "folder", code=2)
    assert told.stderr.count("\n") == 1, told.stderr  # nothing of a client that goes
    assert re.search(f"--dask: {address}: found .* expected a scheduler of Dask", told.stderr)


@pytest.mark.long
def test_aircraft_in_wind_are_those_of_the_spatial_game(tmp_path: Path) -> None:
    options = Options((Path("two"),), evaders=("paper", "straight"), games=3)
    plan = plan_of(options, until=False)
    found = list(rows(plan, plan.shards()[0]))
    for row in found:
        game = play_seed(spatial("two"), row.seed, Evasion.STRAIGHT if row.cell else Evasion.STRATEGY)
        assert (row.verdict, row.time, row.smallest) == (game.verdict.name.lower(), game.time, game.smallest)
        assert row.reversals == game.reversals
    assert len(found) == 6


@pytest.mark.game
@pytest.mark.long
def test_a_campaign_of_flights_flies_each_game_as_fly_does(tmp_path: Path) -> None:
    scenario = configs() / "scenarios/flight/one-on-one.toml"
    ran(scenario, "--flown", "--games", 2, "--workers", 1, "--out", tmp_path / "f", within_s=120.0)
    ran(scenario, "--flown", "--games", 2, "--workers", 2, "--out", tmp_path / "g", within_s=120.0)
    assert contents(tmp_path / "f") == contents(tmp_path / "g")
    [path] = (tmp_path / "f").glob("*.parquet")
    kept = shards.row_of(path, 0, 2)
    assert kept is not None
    told = ran("fly", tmp_path / "f", "0:2", "--runs", tmp_path / "runs", "--no-report", within_s=120.0)
    assert f"smallest distance {kept.smallest:.2f} m" in told.stdout
    assert {"arrived": "reached its target", "captured": "captured by"}[kept.verdict] in told.stdout


FOREIGN = """
from types import SimpleNamespace
from onboard.core.strategy.pursuit import pursuer_pure

def unlike_a_kernel(view):
    return {"decision": pursuer_pure(view)}.get("decision", [])

mine = SimpleNamespace(role="pursuer", decide=unlike_a_kernel)
"""


def foreign(folder: Path) -> None:
    """A distribution with a strategy that is not in kernel style."""
    (folder / "foreign_strategy.py").write_text(FOREIGN, "utf-8")
    info = folder / "foreign_strategy-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: foreign-strategy\nVersion: 1.0\n", "utf-8")
    (info / "entry_points.txt").write_text("[apollonius.strategies]\nmine = foreign_strategy:mine\n", "utf-8")


def test_strategies_of_other_distributions_are_among_all_and_known_by_their_sources(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    foreign(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    assert "mine" in all_of("pursuer")
    assert "mine" not in all_of("evader")
    plan = plan_of(Options((duel(tmp_path),), pursuers=("mine",), games=3), until=False)
    assert plan.fingerprint.plugins["mine"].startswith("foreign-strategy 1.0 ")


@pytest.mark.long
def test_a_strategy_that_does_not_compile_is_played_interpreted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    foreign(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    plan = plan_of(Options((duel(tmp_path),), pursuers=("mine",), games=3), until=False)
    for row in rows(plan, plan.shards()[0]):
        score = play(drawn(plan.cell(0), row.seed), "pure-pursuit", keep=False).final.score
        assert (row.time, row.smallest) == (score.time, score.smallest)
