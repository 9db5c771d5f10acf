"""Scenario files: every shipped one loads, and every fault names file, key and what was expected."""

from __future__ import annotations

from math import radians
from pathlib import Path

import pytest

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Scenario, load
from onboard.runtime.resources import configs

SHIPPED = sorted((configs() / "scenarios").rglob("*.toml"))
PLAIN = """
name = "plain"
[evader]
position = [0, 0, 20]
speed = 5
[[pursuers]]
position = [30, 40, 25]
speed = 4
pitch_min_deg = -20
[[pursuers]]
position = [30, -40, 20]
speed = 3.5
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def fault(folder: Path, text: str) -> str:
    path = written(folder, text)
    with pytest.raises(ConfigError) as found:
        load(path)
    said = str(found.value)
    assert "\n" not in said
    assert said.startswith(f"{path}: ")
    return said.removeprefix(f"{path}: ")


@pytest.mark.parametrize("path", SHIPPED, ids=lambda p: f"{p.parent.name}/{p.stem}")
def test_every_shipped_scenario_loads(path: Path) -> None:
    scenario = load(path, several=True)
    assert isinstance(scenario, Scenario)
    assert scenario.name
    assert len(scenario.pursuers) > 0


def test_the_folder_of_scenarios_is_not_empty() -> None:
    assert {p.parent.name for p in SHIPPED} >= {"table1", "flight"}
    assert len([p for p in SHIPPED if p.parent.name == "table1"]) == 10


def test_a_plain_file_becomes_values_with_defaults(tmp_path: Path) -> None:
    scenario = load(written(tmp_path, PLAIN))
    assert scenario.ids == (1, 2, 3)
    assert scenario.rules.rho == 4.0  # 2R
    assert scenario.pursuers[0].start() == Vec(30.0, 40.0, -25.0)  # height 25 m is 25 m up
    assert scenario.pursuers[0].limits().pitch_min == pytest.approx(radians(-20.0))
    assert scenario.pursuers[0].limits().speed_max == 4.0
    assert not scenario.planar
    assert load(written(tmp_path, PLAIN.replace(", 25]", "]").replace(", 20]", "]"))).planar


def test_the_hash_is_of_the_contents_not_of_the_layout(tmp_path: Path) -> None:
    plain = load(written(tmp_path, PLAIN)).hash()
    assert load(written(tmp_path, "# a remark\n" + PLAIN.replace("speed = 5", "speed = 5.0"))).hash() == plain
    assert load(written(tmp_path, PLAIN.replace("speed = 5", "speed = 6"))).hash() != plain


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("speed = 5", "speed = 5\nmass = 2", "evader.mass: unknown key"),
        ("speed = 5", "speed = true", "evader.speed: found true, expected a number: zero or more"),
        ("speed = 5", "speed = -5", "evader.speed: found -5, expected zero or more [m/s]"),
        ("speed = 5", "speed = inf", "evader.speed: found inf, expected a finite number"),
        (
            "speed = 5",
            "speed = 5\nheading_deg = nan",
            "evader.heading_deg: found nan, expected a finite number",
        ),
        ("speed = 5", "speed = 5\nspeed_min = 6", "evader.speed_min: found 6.0, expected 0 to speed = 5 m/s"),
        (
            "speed = 5",
            "speed = 5\nspeed_max = 4",
            "evader.speed_max: found 4.0, expected at least speed = 5 m/s",
        ),
        ("position = [0, 0, 20]\n", "", "evader.position: missing, but required"),
        ("position = [0, 0, 20]", "position = [0, 0, 0, 0]", "evader.position: found [0, 0, 0, 0], expected"),
        (
            "pitch_min_deg = -20",
            "pitch_min_deg = 95",
            "pursuers[0].pitch_min_deg: found 95, expected an angle",
        ),
        (
            "pitch_min_deg = -20",
            "yaw_min_deg = 200",
            "pursuers[0].yaw_min_deg: found 200 with yaw_max_deg 180",
        ),
        (
            "pitch_min_deg = -20",
            "target = [1, 2]",
            "pursuers[0].target: found (1.0, 2.0), expected no target",
        ),
        ("pitch_min_deg = -20", "id = 1", "pursuers.id: found [1, 1, 3], expected ids that differ"),
        ("pitch_min_deg = -20", "id = 300", "pursuers[0].id: found 300, expected a MAVLink system id"),
        ('name = "plain"', "", "name: missing, but required"),
        ('name = "plain"', 'name = "plain"\nseed = 1.5', "seed: found 1.5, expected a whole number"),
        (
            'name = "plain"',
            'name = "plain"\nparameters.R = 0',
            "parameters.R: found 0, expected a positive distance [m]",
        ),
        (
            'name = "plain"',
            'name = "plain"\nparameters.rho = 1',
            "parameters.rho: found 1.0, expected at least R",
        ),
        (
            'name = "plain"',
            'name = "plain"\nparameters.dt = 2',
            "parameters.dt: found 2, expected a time step",
        ),
        (
            'name = "plain"',
            'name = "plain"\nflight.autopilot = "betaflight"',
            "flight.autopilot: found 'betaflight', expected one of: px4, px4-plane, arducopter, arduplane",
        ),
        ('name = "plain"', 'name = "plain"\nflight.sensor.dropout = 1.0', "flight.sensor.dropout: found 1.0"),
        ('"plain"', '"plain"\nflight.height = 80', "flight.height: found 80.0, expected none: this game"),
        (
            '"plain"',
            '"plain"\nflight.simulated.full_streams = true',
            "flight.simulated.full_streams: found true, expected false: it is PX4 that streams so",
        ),
        (
            '"plain"',
            '"plain"\nflight.airframe = "nose"',
            "flight.airframe: found nose under arducopter, expected kinematic",
        ),
        (
            "speed = 4",
            'speed = 4\nautopilot = "arduplane"\nairframe = "slip"\nacceleration = 2',
            "pursuers[0].acceleration: found 2.0, expected none with airframe slip",
        ),
        ("40, 25]", "40]", "pursuers[0].position: found 2 numbers, expected 3 as in evader.position"),
        ("[0, 0, 20]", "[0, 0]", "pursuers[0].position: found 3 numbers, expected 2 as in evader.position"),
        ("speed = 5", "speed = 5\ntarget = [1, 2]", "evader.target: found 2 numbers, expected 3"),
        (
            'name = "plain"',
            'name = "plain"\nflight.wind = {recorded = "w.csv", speed = 3}',
            "flight.wind.recorded: found 'w.csv' beside a modelled wind, expected either",
        ),
        (
            'name = "plain"',
            'name = "plain"\nflight.wind.correlation_m = 30',
            "flight.wind.correlation_m: found 30.0, expected 0: there are no gusts",
        ),
        (
            'name = "plain"',
            'name = "plain"\nflight.wind.shear = true',
            "flight.wind.shear: found true, expected false: there is no mean wind",
        ),
        (
            'name = "plain"',
            'name = "plain"\nflight.impairment.burst_s = 0.5',
            "flight.impairment.burst_rate: found 0 with burst_s 0.5, expected both or neither",
        ),
        (
            'name = "plain"',
            'name = "plain"\nflight.wind.speed = -1',
            "flight.wind.speed: found -1, expected",
        ),
        (
            'name = "plain"',
            'name = "plain"\nflight.fence = {polygon = [[0,0],[1,1]], height_min = 0, height_max = 9}',
            "flight.fence.polygon: found [[0, 0], [1, 1]], expected three or more corners",
        ),
        ("[evader]", "[evader", "not valid TOML: "),
    ],
)
def test_a_fault_names_its_key_and_what_was_expected(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in PLAIN
    assert fault(tmp_path, PLAIN.replace(old, new, 1)).startswith(said)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("speed = 5", "speed = 1e300", "evader.speed: found 1e+300, expected zero or more"),
        ("position = [0, 0, 20]", "position = [1e300, 0]", "evader.position[0]: found 1e+300, expected"),
        ('"plain"', f'"plain"\nseed = {2**63}', f"seed: found {2**63}, expected a whole number from 0"),
        ('"plain"', '"plain"\nflight.origin.latitude_deg = 90', "flight.origin.latitude_deg: found 90, exp"),
        ('"plain"', '"plain"\nflight.origin.longitude_deg = 181', "flight.origin.longitude_deg: found 181"),
        ('"plain"', '"plain"\nflight.timeout_s = 1e300', "flight.timeout_s: found 1e+300, expected"),
        ('"plain"', '"two\\nlines"', "name: found 'two\\nlines', expected one line of text"),
        ('"plain"', f'"plain"\nflight = {"[" * 10_000}', "nested too deeply"),
    ],
)
def test_an_absurd_value_is_refused_wherever_it_stands(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert fault(tmp_path, PLAIN.replace(old, new, 1)).startswith(said)


def test_a_file_that_is_not_there_or_no_text(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"none\.toml: no such file or directory"):
        load(tmp_path / "none.toml")
    with pytest.raises(ConfigError, match="is a directory"):
        load(tmp_path)
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match="not UTF-8 text"):
        load(tmp_path / "bytes.toml")
