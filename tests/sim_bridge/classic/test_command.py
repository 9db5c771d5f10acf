"""`sim-bridge classic`: the list, a problem, its picture, and what is refused."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest
from typer.testing import CliRunner

from onboard.config.strict import ConfigError
from onboard.game.scenario import load
from onboard.runtime.resources import CLASSIC, SCENARIOS, named_files, shipped_file
from sim_bridge.classic.problems import PROBLEMS, start_of
from sim_bridge.cli import app
from sim_bridge.programs.campaigns import command
from sim_bridge.programs.classic.command import Options, classic, listed, refuse_without_problem
from sim_bridge.programs.classic.measure import Game, Side, row
from sim_bridge.programs.leaderboard.command import classic_scenarios
from tests.support.paths import ROOT

FOLDER = ROOT / "configs" / "scenarios" / "classic"


def test_every_problem_has_its_file_and_its_line() -> None:
    assert set(named_files(CLASSIC)) == set(PROBLEMS)
    assert len(PROBLEMS) == 10
    told = [msgspec.json.decode(line) for line in listed(json=True).splitlines()]
    assert [one["problem"] for one in told] == list(PROBLEMS)
    for one, line in zip(told, listed(json=False).splitlines(), strict=True):
        assert line.startswith(one["problem"])
        assert one["reference"] in line


def test_a_problem_is_played_told_and_drawn(tmp_path: Path) -> None:
    picture = tmp_path / "disc.svg"
    chosen = Options(strategies=("pure-pursuit", "straight"), starts=3, picture=picture)
    lines = classic("convex-target", chosen).splitlines()
    assert "value, distance from the target at capture: 5.4 m; the game is the pursuers'" in lines
    rows = [line.split()[:2] for line in lines if line.startswith(("both ", "pursuers ", "evader  "))]
    assert rows == [["both", "optimal"], ["pursuers", "pure-pursuit"], ["evader", "straight"]]
    assert any(line.startswith("Where ours fall short: ") for line in lines)
    assert "Apollonius" in picture.read_text()
    assert picture.stat().st_size < 100_000
    rows_told = classic("convex-target", chosen._replace(json=True, picture=None)).splitlines()
    first, chaser, _ = (msgspec.json.decode(line) for line in rows_told)
    assert first["share"] == pytest.approx(1.0, abs=0.08)
    assert chaser["won"] == 0
    assert chaser["difference"] < -3.0


def test_shares_and_intervals_are_those_of_the_games() -> None:
    """By hand: payoffs 10 and 30 of a value of 20 and 30 that pursuers want great."""
    games = [Game(20.0, True, 10.0, True), Game(30.0, True, 30.0, False), Game(-5.0, False, 0.0, False)]
    found = row(PROBLEMS["convex-target"], Side("pursuers", "x", ()), games)
    assert (found.games, found.won) == (2, 1)
    assert (found.value, found.reached) == (pytest.approx(50 / 3), pytest.approx(40 / 3))
    assert found.share == pytest.approx(0.8)
    other = row(PROBLEMS["two-cutters"], Side("pursuers", "x", ()), [Game(20.0, True, 25.0, True)] * 2)
    assert other.share == pytest.approx(0.8)
    assert other.share_low == pytest.approx(0.8)
    evader = row(PROBLEMS["two-cutters"], Side("evader", "x", ()), [Game(20.0, True, 15.0, True)] * 2)
    assert evader.share == pytest.approx(0.75)
    assert evader.games == 0


@pytest.mark.parametrize(
    ("name", "changed", "told"),
    [
        ("two-cutters", ("speed = 10", "speed = 7"), "found a pursuer of 7 m/s, expected more than"),
        ("lion-and-man", ("speed = 10\n\n[[", "speed = 9\n\n[["), "found a pursuer of 10 m/s, expected the"),
        ("convex-target", ("\ntarget = [120, 0]", ""), "found no target of the evader"),
        ("convex-target", ("target = [120, 0]", "target = [10, 0]"), "the value of 'convex-target' is not"),
        ("two-cars", ("heading_deg = 74", "heading_deg = 0"), "the value of 'two-cars' is not known"),
        ("half-space", ("[65, 40, 20]", "[65, 40]"), "position"),
    ],
)  # fmt: skip
def test_a_start_of_another_form_is_refused(
    tmp_path: Path, name: str, changed: tuple[str, str], told: str
) -> None:
    text = (FOLDER / f"{name}.toml").read_text()
    assert changed[0] in text
    mine = tmp_path / "mine.toml"
    changed_text = text.replace(*changed, 1)
    if "\ntarget =" not in changed_text:
        changed_text = changed_text.replace("target_known = true", "")
    mine.write_text(changed_text)
    with pytest.raises(ConfigError, match="(?s)" + told.replace("(", r"\(")):
        start_of(PROBLEMS[name], mine)


@pytest.mark.parametrize(
    ("chosen", "told"),
    [
        (Options(strategies=("parallel",)), "--strategy: found 'parallel', expected one of: paper"),
        (
            Options(picture=Path("x.gif")),
            "--picture: found 'x.gif', expected a name ending in .png",
        ),
        (Options(picture=Path("/nowhere/x.png")), "--picture: found the folder '/nowhere'"),
    ],
)
def test_a_wrong_option_is_told(chosen: Options, told: str) -> None:
    with pytest.raises(ConfigError) as caught:
        classic("two-cutters", chosen)
    assert str(caught.value).startswith(told)


def test_what_needs_a_problem_is_refused_without_one() -> None:
    refuse_without_problem(Options(json=True))
    with pytest.raises(ConfigError, match="--starts: found without a problem, expected one: homicidal"):
        refuse_without_problem(Options(starts=3))
    with pytest.raises(ConfigError, match=r"found 'two-cutter', expected a problem: .*mean 'two-cutters'"):
        classic("two-cutter", Options())


def test_a_feint_costs_optimal_pursuers_nothing_and_pure_pursuit_ground() -> None:
    """The worst of five opponents is no better than the first, and theory's own pursuers keep the value."""
    chosen = Options(strategies=("pure-pursuit", "parallel-pursuit"), starts=2, json=True)
    plain, feinted = (
        {
            (r["side"], r["strategy"]): r
            for r in map(msgspec.json.decode, classic("convex-target", one).splitlines())
        }
        for one in (chosen, chosen._replace(feints=True))
    )
    for key in (("pursuers", "pure-pursuit"), ("pursuers", "parallel-pursuit")):
        assert feinted[key]["opponents"] == 5
        assert feinted[key]["reached"] <= plain[key]["reached"]
    assert feinted["pursuers", "parallel-pursuit"]["difference"] > -0.3
    assert plain["pursuers", "pure-pursuit"]["difference"] < -1.0


def test_the_leaderboard_plans_the_problems_that_it_can_play() -> None:
    """Campaigns take them as plane games of simple motion, and they are what `--classic` stands for."""
    files = tuple(classic_scenarios())
    told = command.Options(files, ("paper",), ("paper",), games=2, seed=1)
    plan = command.plan_of(told, until=False)
    assert [one.label for one in plan.scenarios] == [file.name for file in files]
    for file in files:
        assert load(shipped_file(file, SCENARIOS)).planar
    found = CliRunner().invoke(app, ["bench", "--classic", "--scenario", "five"])
    assert isinstance(found.exception, ConfigError)
    assert str(found.exception) == "--classic: found with --scenario, expected one of the two"
