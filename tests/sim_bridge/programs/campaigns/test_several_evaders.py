"""Campaigns of several evaders: a row tells of each, the same from disk, in tables and in pictures."""

from __future__ import annotations

from math import isnan
from pathlib import Path

import pytest
from msgspec.structs import replace

from onboard.config.strict import ConfigError
from onboard.game.scenario import load
from onboard.runtime.resources import SCENARIOS, shipped_file
from sim_bridge.plane_game.several import play
from sim_bridge.programs.campaigns import again, shards
from sim_bridge.programs.campaigns.command import Options, plan_of
from sim_bridge.programs.campaigns.play import drawn, rows
from sim_bridge.programs.campaigns.rows import EvaderRow
from sim_bridge.programs.campaigns.run import Ways, run
from sim_bridge.programs.campaigns.several import RANKS, whole
from sim_bridge.programs.campaigns.show import evaders_table, results, text
from sim_bridge.programs.campaigns.until import wilson
from sim_bridge.programs.run_folder import toml_of

pytestmark = pytest.mark.timeout(480)  # compiling takes a while
TWO = shipped_file(Path("two-on-three"), SCENARIOS)
GAMES = 40


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    home = tmp_path_factory.mktemp("several") / "campaign"
    run(home, plan_of(Options((TWO,), games=GAMES, shard_games=25), until=False), Ways(), print)
    return home


def test_each_row_is_the_plane_game_of_its_seed(folder: Path) -> None:
    plan = shards.read_plan(folder)
    cell = plan.cell(0)
    for seed in (1, 26, GAMES):
        row = again.game_of(folder, f"0:{seed}").kept
        assert row is not None
        game = play(drawn(cell, seed), "parallel-pursuit", keep=False)
        assert [one.verdict for one in row.evaders] == game.verdicts
        for one, score in zip(row.evaders, game.final.scores, strict=True):
            assert one.captor == score.captor + 1
            assert (one.time, one.smallest) == pytest.approx((score.time, score.smallest), abs=1e-9)
        assert row.time == max(one.time for one in row.evaders)


def test_the_tables_count_what_the_rows_say(folder: Path) -> None:
    table = shards.table_of(sorted(folder.glob("*.parquet"))).to_pylist()
    assert len(table) == GAMES
    found = results(folder)
    lines = evaders_table(found).splitlines()
    heads = [line.split()[:3] for line in lines[2:]]
    assert heads == [["0", "1", "40"], ["0", "5", "40"], ["0", "all", "80"]]
    arrived = [sum(row["evaders"][k]["verdict"] == "arrived" for row in table) for k in (0, 1)]
    assert 0 < sum(arrived) < 80
    for line, count, games in zip(lines[2:], (*arrived, sum(arrived)), (40, 40, 80), strict=True):
        low, high = wilson(count, games)
        assert f"{count} = {100 * count / games:.1f} % ({100 * low:.1f}–{100 * high:.1f})" in line
    any_arrived = sum("arrived" in {one["verdict"] for one in row["evaders"]} for row in table)
    assert sum(row["verdict"] == "arrived" for row in table) == any_arrived
    assert evaders_table(found) in text(found)


def test_a_game_again_is_the_one_of_the_folder_with_its_picture(folder: Path, tmp_path: Path) -> None:
    game = again.game_of(folder, "0:7")
    played = again.replay(game, tmp_path)
    assert again.agrees(game, played.row)
    assert [path.suffix for path in played.pictures] == [".png", ".svg"]
    assert b"evader 5" in played.pictures[1].read_bytes() or played.pictures[1].stat().st_size > 20_000
    path = tmp_path / "drawn.toml"
    path.write_text(again.scenario_file(game), encoding="utf-8")
    assert load(path, several=True) == drawn(game.cell, 7)


@pytest.mark.parametrize(
    ("verdicts", "said"),
    [
        (("captured", "captured"), "captured"), (("captured", "denied"), "denied"),
        (("escaped", "denied"), "escaped"), (("arrived", "captured"), "arrived"),
    ],
)  # fmt: skip
def test_the_worst_for_the_pursuers_decides_a_game(verdicts: tuple[str, ...], said: str) -> None:
    row = whole(0, 1, [EvaderRow(one, 3.0 + k, 5.0, k + 1, float("nan")) for k, one in enumerate(verdicts)])
    assert (row.verdict, row.time, row.captor) == (said, 4.0, 2 if said == "captured" else 0)
    assert isnan(row.unsafe)


def test_a_sweep_moves_further_evaders_and_their_strategies_are_options() -> None:
    plan = plan_of(Options((TWO,), evaders=("straight",), games=2), until=False)
    assert [spec.strategy for spec in plan.cell(0).scenario.evading] == ["straight", "straight"]
    faster = replace(plan, points=[{"evaders[0].speed": 6.0}])
    assert [spec.speed for spec in faster.cell(0).scenario.evading] == [5.0, 6.0]


def test_aircraft_of_several_evaders_are_flown_and_not_computed(tmp_path: Path) -> None:
    base = load(shipped_file(Path("spatial/two"), SCENARIOS))
    second = replace(base.evader, position=(300.0, 900.0, 1500.0))
    path = tmp_path / "aircraft.toml"
    path.write_text(toml_of(replace(base, evaders=(second,)).contents()), encoding="utf-8")
    with pytest.raises(ConfigError, match=r"aircraft: evaders: found several in a game of aircraft.*--flown"):
        plan_of(Options((path,), games=2), until=False)
    assert plan_of(Options((path,), games=2, flown=True), until=False).several


@pytest.mark.long
def test_a_flown_game_has_a_row_for_each_evader() -> None:
    plan = plan_of(Options((TWO,), games=1, flown=True), until=False)
    [row] = rows(plan, plan.shards()[0])
    assert len(row.evaders) == 2
    assert {one.verdict for one in row.evaders} <= set(RANKS)
    assert row.verdict == min((one.verdict for one in row.evaders), key=RANKS.index)
    assert all(0 <= one.captor <= 3 and 0.0 < one.time <= 50.0 and one.smallest > 0.0 for one in row.evaders)
