"""A campaign's folder: the same bytes by whoever plays it, however often it is broken off, and read back."""

from __future__ import annotations

import os
import shutil
import signal
from collections import Counter
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from msgspec.structs import replace

from onboard.config.strict import ConfigError
from onboard.core.game.referee import GameResult
from onboard.game.scenario import Scenario, load
from sim_bridge.campaign.spatial_draw import drawn_scenario
from sim_bridge.plane_game.program import play
from sim_bridge.programs.campaigns import again, cli, shards
from sim_bridge.programs.campaigns.command import Options, plan_of
from sim_bridge.programs.campaigns.plan import spread_of
from sim_bridge.programs.campaigns.play import rows, simple_games
from sim_bridge.programs.campaigns.run import Ways, run
from sim_bridge.programs.campaigns.show import paired, pairs_text, results
from sim_bridge.programs.campaigns.until import parse
from tests.support.campaign_runs import begin, contents, duel, wait_for_shard

pytestmark = pytest.mark.timeout(240)
WORDS = ("--evader", "paper", "--evader", "straight", "--games", 60, "--shard-games", 20)


class Reference:
    """A campaign that nobody disturbed."""

    def __init__(self, home: Path) -> None:
        self.scenario = duel(home)
        self.options = Options((self.scenario,), evaders=("paper", "straight"), games=60, shard_games=20)
        self.plan = plan_of(self.options, until=False)
        self.folder = home / "undisturbed"
        self.said: list[str] = []
        run(self.folder, self.plan, Ways(), self.said.append)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Reference:
    return Reference(tmp_path_factory.mktemp("campaign"))


def test_the_folder_holds_every_game_once_with_its_verdict(reference: Reference) -> None:
    table = shards.table_of(sorted(reference.folder.glob("*.parquet")))
    assert reference.said == []
    assert table.num_rows == 120
    games = {(row["cell"], row["seed"]): row for row in table.to_pylist()}
    assert games.keys() == {(cell, seed) for cell in (0, 1) for seed in range(1, 61)}
    verdicts = Counter((row["evader"], row["verdict"]) for row in games.values())
    assert verdicts["straight", "captured"] > verdicts["paper", "captured"]
    assert all(row["time"] <= 20.0 and row["scenario"] == "duel" for row in games.values())
    captured = [row for row in games.values() if row["verdict"] == "captured"]
    assert all(row["captor"] == 1 and row["smallest"] <= 4.0 + 1e-9 for row in captured)


def test_a_game_is_its_seed_alone_and_the_plane_game_plays_the_same(reference: Reference) -> None:
    cell = reference.plan.cell(0)
    alone = [simple_games(cell, range(seed, seed + 1))[0] for seed in (1, 7, 60)]
    together = {(row.cell, row.seed): row for row in rows(reference.plan, reference.plan.shards()[0])}
    assert alone[:2] == [together[0, 1], together[0, 7]]
    for row in alone:
        scenario = drawn_scenario(cell.scenario, row.seed, spread_of(cell.scenario))
        game = play(scenario, "paper", keep=False).final.score
        assert row.verdict == GameResult(game.verdict).name.lower()
        assert row.time == pytest.approx(game.time, abs=1e-9)
        assert row.smallest == pytest.approx(game.smallest, abs=1e-9)


def test_what_is_missing_truncated_or_damaged_is_played_again_and_strangers_stay(
    reference: Reference, tmp_path: Path
) -> None:
    folder = tmp_path / "resumed"
    shutil.copytree(reference.folder, folder)
    files = sorted(folder.glob("*.parquet"))
    assert len(files) == 6
    files[0].unlink()
    files[1].write_bytes(files[1].read_bytes()[:-200])
    whole = files[2].read_bytes()
    shard = reference.plan.shards()[2]
    for place in range(0, len(whole), 97):  # wherever a bit turns over
        files[2].write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
        assert not shards.sound(files[2], reference.plan, shard), place
    files[3].write_bytes(files[4].read_bytes())  # a whole shard under another's name
    stranger = folder / "shard-000009-0123456789abcdef.parquet"
    shutil.copy(files[5], stranger)
    said: list[str] = []
    run(folder, reference.plan, Ways(), said.append)
    assert sum("broken" in line for line in said) == 3
    assert [line for line in said if "left alone" in line] == [
        f"{stranger}: no shard of this campaign; left alone"
    ]
    stranger.unlink()
    assert contents(folder) == contents(reference.folder)


def test_parts_of_an_array_job_and_of_two_machines_merge_by_copying(
    reference: Reference, tmp_path: Path
) -> None:
    for part in (1, 2):
        run(tmp_path / str(part), reference.plan, Ways(part=(part, 2)), print)
    assert len(list((tmp_path / "1").glob("*.parquet"))) == 3
    assert results(tmp_path / "1").missing == 3
    for file in (tmp_path / "2").glob("*.parquet"):
        shutil.copy(file, tmp_path / "1")
    assert contents(tmp_path / "1") == contents(reference.folder)


def test_more_games_go_on_with_the_folder_and_another_campaign_does_not(
    reference: Reference, tmp_path: Path
) -> None:
    folder = tmp_path / "grown"
    fewer = plan_of(reference.options._replace(games=33), until=False)
    run(folder, fewer, Ways(), print)
    run(folder, reference.plan, Ways(), print)
    assert contents(folder) == contents(reference.folder)
    assert run(folder, fewer, Ways(), print).games == 60  # the folder knows more by now
    for change, said in (({"seed": 2}, "first_seed 1"), ({"evaders": ("paper",)}, "other pairs")):
        other = plan_of(reference.options._replace(**change), until=False)  # type: ignore[arg-type]
        with pytest.raises(ConfigError, match=said):
            run(folder, other, Ways(), print)
    versions = {**reference.plan.fingerprint.versions, "numpy": "9.9"}
    newer = replace(reference.plan, fingerprint=replace(reference.plan.fingerprint, versions=versions))
    with pytest.raises(ConfigError, match=r"other versions \(numpy [^,]*, here 9\.9\), expected"):
        run(folder, newer, Ways(), print)
    (folder / "manifest.json").unlink()
    with pytest.raises(ConfigError, match=r"shards without manifest\.json"):
        run(folder, reference.plan, Ways(), print)


def test_a_rule_ends_it_after_whole_shards_in_order_whatever_was_there(
    reference: Reference, tmp_path: Path
) -> None:
    rule = 0.14
    ways = Ways(until=parse(f"ci<{rule}"))
    stopped = run(tmp_path / "a", reference.plan, ways, print)
    assert stopped.games in (20, 30, 40, 50)

    def widest(name: str) -> float:
        shares = [one.share("captured") for one in results(tmp_path / name).cells]
        return max(0.5 * (high - low) for _count, low, high in shares)

    assert widest("a") < rule
    shorter = plan_of(reference.options._replace(games=stopped.games - 10), until=False)
    run(tmp_path / "b", shorter, Ways(), print)
    assert widest("b") >= rule
    shutil.copytree(reference.folder, tmp_path / "c")  # all games are there: the rule takes as many
    run(tmp_path / "c", reference.plan, ways, print)
    run(tmp_path / "a", reference.plan, ways, print)
    assert contents(tmp_path / "a") == contents(tmp_path / "c")


def test_the_table_and_the_paired_test_are_those_of_a_count_by_hand(reference: Reference) -> None:
    found = results(reference.folder)
    table = shards.table_of(sorted(reference.folder.glob("*.parquet"))).to_pylist()
    captured = {(row["cell"], row["seed"]) for row in table if row["verdict"] == "captured"}
    [test] = paired(found)
    assert test.only_first == sum((0, s) in captured and (1, s) not in captured for s in range(1, 61))
    assert test.only_second == sum((1, s) in captured and (0, s) not in captured for s in range(1, 61))
    assert test.games == 60
    assert f"{test.only_second} in 1 only" in pairs_text(found)
    assert found.cells[1].share("captured")[0] == sum(cell == 1 for cell, _seed in captured)


def test_what_show_and_replay_tell_and_draw(
    reference: Reference, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cli.show(reference.folder, tmp_path)
    said = capsys.readouterr().out
    assert "McNemar" in said
    assert said.splitlines()[0].split()[:4] == ["cell", "scenario", "evader", "pursuers"]
    assert {path.name for path in tmp_path.iterdir()} == {"wins.png", "survival.png", "distance.png"}
    cli.replay(reference.folder, "1:7", tmp_path / "game")
    kept = again.game_of(reference.folder, "1:7").kept
    assert kept is not None
    assert capsys.readouterr().out.startswith(f"{kept.verdict} ")
    cli.replay(reference.folder, "0:7", tmp_path / "game")  # every game's picture has a name of its own
    names = {f"duel-{game}{ending}" for game in ("0-7", "1-7") for ending in (".png", ".svg")}
    found = {path.name for path in (tmp_path / "game").iterdir()}
    assert {name for name in found if "-why-not" not in name} == names
    for cell in (0, 1):  # and who was not captured has a picture of why not
        drawn = f"duel-{cell}-7-why-not.png" in found
        row = again.game_of(reference.folder, f"{cell}:7").kept
        assert row is not None
        assert drawn == (row.verdict != "captured")
    for wrong in ("2:7", "0:61", "0:0", "7", "x:y", ""):
        with pytest.raises(ConfigError, match=r"CELL:SEED, a cell from 0 to 1 .* a seed from 1 to 60"):
            again.game_of(reference.folder, wrong)


@pytest.mark.long
def test_a_game_of_simple_motion_in_space_is_drawn_as_it_was_played(tmp_path: Path) -> None:
    scenario = duel(tmp_path)
    text = scenario.read_text("utf-8").replace("0]", "0, 50]")
    scenario.write_text(text, "utf-8")
    plan = plan_of(Options((scenario,), games=3), until=False)
    run(tmp_path / "folder", plan, Ways(), print)
    game = again.game_of(tmp_path / "folder", "0:2")
    row, pictures, why = again.replay(game, tmp_path / "pictures")
    assert again.agrees(game, row)
    assert [path.suffix for path in pictures] == [".png", ".svg", *[".png"] * bool(why)]
    assert bool(why) == (row.verdict != "captured")


def test_a_game_that_its_folder_has_otherwise_is_told(reference: Reference) -> None:
    game = again.game_of(reference.folder, "0:3")
    assert game.kept is not None
    [row] = simple_games(game.cell, range(3, 4))
    assert again.agrees(game, row)
    assert not again.agrees(game, row._replace(time=row.time + 1e-9))


def test_a_game_as_a_scenario_file_is_the_game(reference: Reference, tmp_path: Path) -> None:
    game = again.game_of(reference.folder, "1:9")
    path = tmp_path / "one.toml"
    path.write_text(again.scenario_file(game), "utf-8")
    flown: Scenario = load(path)
    assert flown.pursuers[0].position != load(reference.scenario).pursuers[0].position
    score = play(flown, "paper", keep=False).final.score
    assert game.kept is not None
    assert GameResult(score.verdict).name.lower() == game.kept.verdict


@pytest.mark.real
def test_killed_with_its_workers_it_leaves_whole_shards_and_is_resumed_to_the_same_bytes(
    reference: Reference, tmp_path: Path
) -> None:
    folder = tmp_path / "two"
    begun = begin(reference.scenario, *WORDS, "--workers", 2, "--out", folder)
    wait_for_shard(folder, begun)
    os.kill(begun.pid, signal.SIGKILL)
    begun.wait()
    plan = reference.plan
    for shard in plan.shards():
        path = folder / shards.file_name(plan, shard)
        assert not path.exists() or shards.sound(path, plan, shard)
    run(folder, plan, Ways(), print)
    assert contents(folder) == contents(reference.folder)


def test_a_shards_columns_are_what_other_programs_read(reference: Reference) -> None:
    table = pq.read_table(sorted(reference.folder.glob("*.parquet"))[0])
    assert table.column_names == [
        "cell", "seed", "scenario", "evader", "pursuers", "verdict", "time", "smallest", "captor", "unsafe",
        "reversals",
    ]  # fmt: skip
    assert table.schema.field("time").type == "double"
