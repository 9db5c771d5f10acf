"""`sim-bridge fly` and `sim-bridge scenario` at the prompt: exit codes, one line for a mistake."""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path

import pytest

from onboard.config.strict import ConfigError
from onboard.game.scenario import load, targets_of
from onboard.runtime.resources import SCENARIOS, configs, shipped_file
from sim_bridge.programs.fly import Options, demand_strategies, fly
from sim_bridge.programs.scenario_tools import TEMPLATE, check, new
from tests.support.sim_bridge_process import bridge, short

EDITS = [  # what is wrong in the file, and what is said of it
    ("speed = 5", "sped = 5", "evader.sped: unknown key"),
    ("speed = 5", "speed = -5", "evader.speed: found -5, expected zero or more [m/s]"),
    ("seed = 3", "seed = -3", "seed: found -3, expected a whole number from 0"),
    ("speed = 4", "speed = 4\nstrategy = 'guess'", "pursuers[0].strategy: found 'guess', expected one of: "),
    ("speed = 5", "speed = 5\nstrategy = 'guess'", "evader.strategy: found 'guess', expected one of: "),
    ("horizon = 3.0", "horizon = nan", "parameters.horizon: found nan, expected a finite number"),
    ("[flight.sensor]", "[flight.sensors]", "flight.sensors: unknown key"),
    ("[flight]", "[flight]\nairframe = 'nose'", "expected kinematic"),
    ("name =", "name ", "not valid TOML"),
]


@pytest.mark.parametrize(("old", "wrong", "said"), EDITS, ids=[edit[1].split("\n")[-1] for edit in EDITS])
def test_a_wrong_scenario_is_one_line_and_leaves_no_folder(
    old: str, wrong: str, said: str, tmp_path: Path
) -> None:
    path = short(tmp_path)
    path.write_text(path.read_text().replace(old, wrong, 1))
    with pytest.raises(ConfigError) as error:
        fly(path, Options(fast=True, runs=tmp_path / "runs", report=False, quiet=True))
    assert said in str(error.value)
    assert len(str(error.value).splitlines()) == 1
    assert not (tmp_path / "runs").exists() or not any((tmp_path / "runs").iterdir())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["fly"], "Missing argument 'scenario'"),
        (["fly", "--fast", "no-such-game"], "no-such-game: no such file; shipped scenarios: "),
        (["fly", "--fast", "--seed", "-1", "one-on-one"], "--seed"),
        (["fly", "--fast", "one-on-one", "--runs", "/dev/null"], "/dev/null/"),
        (["fly", "one-on-one", "--bus", "carrier-pigeon"], "carrier-pigeon"),
        (["serve", "one-on-one", "--game", "a/b"], "game: found 'a/b', expected a name without"),
        (["serve", "one-on-one", "--zenoh", "/no/such/file"], "/no/such/file"),
        (["scenario", "check", "/"], "is a directory"),
        (["scenario", "new", "/no/such/folder/mine.toml"], "/no/such/folder/mine.toml: no such file"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_wrong_option_is_one_line_and_exit_code_2(arguments: list[str], said: str, tmp_path: Path) -> None:
    if arguments[-2:-1] == ["--bus"]:
        arguments = [*arguments, "--runs", str(tmp_path)]
    run = bridge(*arguments)
    assert run.returncode == 2, run.stderr
    assert said in run.stderr
    assert len(run.stderr.strip().splitlines()) == 1
    assert run.stderr.startswith("sim-bridge: ")
    assert not any(tmp_path.iterdir())


def test_a_template_is_written_once_and_is_a_game_that_can_be_flown(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    assert str(path) in new(path)
    assert path.read_text(encoding="utf-8") == TEMPLATE
    with pytest.raises(ConfigError, match=r"mine\.toml: there is a file of this name already"):
        new(path)
    assert "my game: 2 pursuers, plane, R = 2 m, ρ = 4 m" in check(load(path))
    text = TEMPLATE.replace("# strategy", "strategy").replace("# pitch", "pitch").replace("# rho", "rho")
    path.write_text(text.replace("# ground_start", "ground_start"), encoding="utf-8")
    tuned = load(path)  # what is commented out can be used
    demand_strategies(tuned, str(path))
    assert tuned.flight.ground_start
    assert tuned.evader.pitch_max_deg == 20
    more = TEMPLATE.replace("\ntarget =", "\n# target =").replace("# targets =", "targets =")
    for key in ("[[evaders]]", "position = [10", "speed = 4.5", "target = [-90"):
        assert f"# {key}" in more
        more = more.replace(f"# {key}", key)
    path.write_text(more, encoding="utf-8")
    several = load(path, several=True)
    assert [len(targets_of(spec)) for spec in several.evading] == [2, 1]


def test_check_says_who_can_intercept_and_how_long_it_may_last(tmp_path: Path) -> None:
    lines = check(load(short(tmp_path))).splitlines()
    assert lines[0] == "short: 1 pursuers, plane, R = 2 m, ρ = 4 m, horizon 3 s"
    pursuer = next(line for line in lines if " pursuer " in line).split()
    assert pursuer[:7] == ["2", "pursuer", "4.0", "m/s", "3.8", "m", "98.5"]
    assert any(line.startswith("free headings at the start: ") for line in lines)
    assert "straight to the target: 30.0 s; the game lasts at most 3 s" in lines


def test_check_warns_of_a_game_that_is_over_before_it_begins(tmp_path: Path) -> None:
    path = short(tmp_path)
    text = path.read_text().replace("[150, 0]", "[0.5, 0]").replace("[90, 40]", "[1, 0]")
    path.write_text(text)
    said = check(load(path))
    assert "warning: the evader starts at its target" in said
    assert "warning: a pursuer starts within the capture radius" in said


SHIPPED = sorted(
    path
    for path in (configs() / "scenarios").rglob("*.toml")
    if path.parent.name in ("flight", "spatial", "table1")
)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_every_shipped_scenario_loads_and_can_be_told_of(path: Path) -> None:
    scenario = load(path, several=True)
    demand_strategies(scenario, str(path))
    said = check(scenario)
    assert len(said.splitlines()) > len(scenario.vehicles) + 3
    if path.parent.name != "table1":
        assert shipped_file(Path(path.stem), SCENARIOS) == path


def test_the_scenarios_people_are_promised_are_shipped() -> None:
    names = {path.stem for path in SHIPPED}
    assert {"first", "demo", "one-on-one", "slower-evader", "heavy-loss", "five", "six", "row01"} <= names


def test_who_reads_encircled_reads_that_it_is_no_proof_of_capture(tmp_path: Path) -> None:
    ring = "".join(
        f"[[pursuers]]\nposition = [{40 * cos(k * pi / 4):.3f}, {40 * sin(k * pi / 4):.3f}]\nspeed = 4\n"
        for k in range(8)
    )
    path = tmp_path / "ring.toml"
    evader = 'name = "ring"\n[evader]\nposition = [0, 0]\nspeed = 5\n'
    path.write_text(f"{evader}{ring}[parameters]\nR = 2.0\nepsilon_min = 1.0\n")
    said = check(load(path))
    assert "the evader is encircled" in said
    assert "more than a quarter of such evaders are not" in said
    assert "sim-bridge campaign study encircled" in said
