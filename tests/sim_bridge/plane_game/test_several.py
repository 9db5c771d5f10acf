"""`sim-bridge planar` with several evaders as a person uses it: a line for each, JSON, pictures, mistakes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image

from onboard.game.scenario import load
from onboard.runtime.resources import SCENARIOS, shipped_file
from sim_bridge.plane_game.several import alone, play
from sim_bridge.programs.fly import demand_strategies
from sim_bridge.programs.scenario_tools import check
from tests.sim_bridge.plane_game.test_command import command

TWO, THREE = (shipped_file(Path(name), SCENARIOS) for name in ("two-on-three", "three-on-ten"))
FAST = ("--dt", "0.2")


def test_each_evader_has_a_line_and_a_verdict() -> None:
    ended = command("two-on-three", *FAST)
    assert (ended.code, ended.err) == (0, "")
    first, *others = ended.out.splitlines()
    assert first.startswith("two on three, pursuers by parallel-pursuit: of 2 evaders ")
    assert [line.split(":")[0].split() for line in others] == [["evader", "1"], ["evader", "5"]]


def test_json_tells_of_each_evader_and_adds_up() -> None:
    ended = command("two-on-three", "--strategy", "paper", "--strategy", "goalkeeper", "--json", *FAST)
    assert (ended.code, ended.err) == (0, "")
    games = [json.loads(line) for line in ended.out.splitlines()]
    assert [game["strategy"] for game in games] == ["paper", "goalkeeper"]
    targets = {1: [(90.0, 20.0), (0.0, 110.0)], 5: [(110.0, -60.0)]}
    for game in games:
        assert sum(game["counts"].values()) == len(game["evaders"]) == 2
        assert set(game["final_positions"]) == {"2", "3", "4"}
        for one in game["evaders"]:
            assert one["verdict"] == "arrived" or one["target"] == 0
            if (
                one["verdict"] == "arrived"
            ):  # at the edge of the target that is named, at the instant of the verdict
                (n, e), (north, east) = one["final_position"], targets[one["id"]][one["target"] - 1]
                assert ((n - north) ** 2 + (e - east) ** 2) ** 0.5 == pytest.approx(2.0, abs=1e-3)
    assert any(one["verdict"] == "arrived" for game in games for one in game["evaders"])


def test_pictures_and_a_film_are_written(tmp_path: Path) -> None:
    short = ("--dt", "0.5", "--horizon", "4")
    ended = command("two-on-three", *short, "--figures", tmp_path, "--animate", tmp_path / "two.gif")
    assert (ended.code, ended.err) == (0, "")
    stem = tmp_path / "two-on-three-parallel-pursuit"
    with Image.open(stem.with_suffix(".png")) as picture:
        assert picture.size[0] > 1000
    assert stem.with_suffix(".svg").stat().st_size > 10_000
    with Image.open(tmp_path / "two.gif") as film:
        assert getattr(film, "n_frames", 1) > 6


def test_the_shipped_game_of_three_on_ten_ends_for_everybody() -> None:
    scenario = load(THREE, several=True)
    demand_strategies(scenario, "three-on-ten")
    played = play(scenario, "team", dt=0.25, keep=False)
    assert len(played.verdicts) == 3
    assert "running" not in played.verdicts
    assert len(set(played.final.quarries)) > 1 or len({*played.verdicts}) > 1


def test_who_is_checked_alone_meets_its_first_pursuers_and_its_own_target() -> None:
    scenario = load(THREE, several=True)
    games = [alone(scenario, number) for number in range(3)]
    assert sorted(id for game in games for id in game.pursuer_ids) == list(scenario.pursuer_ids)
    assert [game.ids[0] for game in games] == list(scenario.evader_ids)
    assert [game.evader.target for game in games[1:]] == [spec.target for spec in scenario.evaders]
    assert games[0].evader.target in scenario.evader.targets
    said = check(scenario)
    assert [f"\nevader {id}: {len(game.pursuers)} pursuers, plane" in said for id, game in
            zip(scenario.evader_ids, games, strict=True)] == [True] * 3  # fmt: skip


def test_a_strategy_that_nobody_has_names_its_evader(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(
        TWO.read_text(encoding="utf-8") + '[[evaders]]\nposition = [0, 9]\nspeed = 1\nstrategy = "x"\n'
    )
    ended = command(path, *FAST)
    assert ended.code == 2
    assert "'x'" in ended.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--compile",), "--compile: found with a game of several evaders or targets"),
        (("--strategy", "no-such"), "no-such"),
    ],
)
def test_a_mistake_costs_one_line(words: tuple[str, ...], said: str) -> None:
    ended = command("two-on-three", *words)
    assert (ended.code, ended.out, len(ended.err.splitlines())) == (2, "", 1)
    assert said in ended.err
