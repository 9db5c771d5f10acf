"""What a game leaves: the same bytes from the same seed, and a folder that others can read."""

from __future__ import annotations

import json
import os
import re
import tomllib
from pathlib import Path

import msgspec
import numpy as np
import pytest

import gcs
from onboard.config import strict
from onboard.config.strict import ConfigError
from onboard.game.scenario import Scenario, load
from onboard.runtime.run_folder import new_run
from onboard.wire.mavlink.tlog import read_tlog
from sim_bridge.programs import run_folder
from tests.support.paths import ROOT
from tests.support.sim_bridge_process import bridge, short

pytestmark = pytest.mark.game
SEEDED = (
    "summary.json", "vehicle-1.tlog", "vehicle-2.tlog", "recording.mcap", "foxglove-layout.json", "truth.csv",
    "configuration.json",
)  # fmt: skip


def flown(folder: Path, scenario: Path, *options: object) -> tuple[Path, str]:
    """The run folder of a game on virtual time, played in a process of its own, and what was said."""
    run = bridge("fly", "--fast", scenario, "--no-report", "--runs", folder, *options)
    assert run.returncode == 0, run.stderr
    (made,) = folder.iterdir()
    return made, run.stdout


@pytest.fixture(scope="module")
def twice(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Path, str]]:
    """One game, flown twice, in two processes; datagrams and bus are impaired."""
    home = tmp_path_factory.mktemp("fly")
    scenario = short(home, loss=0.1, bus=True)
    return [flown(home / name, scenario) for name in ("first", "second")]


def test_the_same_seed_gives_the_same_bytes_in_two_processes(twice: list[tuple[Path, str]]) -> None:
    (first, _), (second, _) = twice
    for name in SEEDED:
        assert (first / name).read_bytes() == (second / name).read_bytes(), name
    assert (first / "vehicle-1.tlog").stat().st_size > 20_000
    assert (first / "recording.mcap").stat().st_size > 20_000


def test_another_seed_gives_another_game(twice: list[tuple[Path, str]], tmp_path: Path) -> None:
    (first, _), _ = twice
    other, _ = flown(tmp_path / "runs", first / "scenario.toml", "--seed", "4", "--quiet")
    assert json.loads((other / "summary.json").read_bytes())["seed"] == 4
    assert load(other / "scenario.toml").seed == 4  # what was flown, not what the file said
    for name in ("summary.json", "vehicle-2.tlog", "recording.mcap"):
        assert (first / name).read_bytes() != (other / name).read_bytes(), name


def test_the_folder_holds_what_was_played_with_what_and_how_it_ended(twice: list[tuple[Path, str]]) -> None:
    (folder, said), _ = twice
    assert sorted(path.name for path in folder.iterdir()) == [
        "configuration.json", "foxglove-layout.json", "recording.mcap", "scenario.toml", "summary.json",
        "timing.json", "truth.csv", "vehicle-1.events", "vehicle-1.tlog",
        "vehicle-2.events", "vehicle-2.tlog", "versions.json",
    ]  # fmt: skip
    versions = json.loads((folder / "versions.json").read_bytes())
    assert {"python", "apollonius", "numpy", "pymavlink"} <= set(versions)
    configuration = json.loads((folder / "configuration.json").read_bytes())
    assert [configuration[id]["role"] for id in ("1", "2")] == ["evader", "pursuer"]
    assert re.fullmatch(r"\d{8}T\d{6}Z-short", folder.name)
    assert f"run folder: {folder}" in said
    assert "the target was denied: neither arrived nor captured within 3 s" in said


def nothing_empty(value: object) -> bool:
    """Whether no answer in plain data is an empty string."""
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return value != "" and all(map(nothing_empty, inner))


def test_the_scenario_in_the_folder_holds_every_value_that_was_used(twice: list[tuple[Path, str]]) -> None:
    (folder, _), _ = twice
    asked, used = load(folder.parent.parent / "short.toml"), load(folder / "scenario.toml")
    assert used.rules == asked.rules
    assert [spec.limits() for spec in used.vehicles] == [spec.limits() for spec in asked.vehicles]
    assert (used.ids, used.flight, used.seed) == (asked.ids, asked.flight, asked.seed)
    assert [spec.strategy for spec in used.vehicles] == ["paper", "parallel-pursuit"]
    written = tomllib.loads((folder / "scenario.toml").read_text(encoding="utf-8"))
    assert written["parameters"]["rho"] == asked.rules.rho  # 2R, which the file left out
    assert written["flight"]["impairment"]["loss"] == 0.1
    assert nothing_empty(written)
    for name in ("summary.json", "configuration.json", "versions.json"):
        assert nothing_empty(json.loads((folder / name).read_bytes())), name


SHIPPED = sorted((ROOT / "configs/scenarios").rglob("*.toml"))


@pytest.mark.parametrize("shipped", SHIPPED, ids=lambda path: path.stem)
def test_the_scenario_of_a_run_is_a_scenario(shipped: Path) -> None:
    scenario = load(shipped, several=True)
    used = run_folder.scenario_used(scenario, 7, shipped.parent)
    again = strict.parse(used.decode(), Scenario, "again")
    assert (again.rules, again.seed, again.flight) == (scenario.rules, 7, scenario.flight)
    assert (again.ids, again.evader_ids) == (scenario.ids, scenario.evader_ids)
    assert run_folder.scenario_used(again, None, shipped.parent) == used


def test_a_recorded_wind_is_found_from_the_run_folder_too(tmp_path: Path) -> None:
    scenario = load(ROOT / "configs/scenarios/flight/demo.toml")
    wind = msgspec.structs.replace(scenario.flight.wind, recorded="winds/monday.csv")
    flight = msgspec.structs.replace(scenario.flight, wind=wind)
    used = run_folder.scenario_used(msgspec.structs.replace(scenario, flight=flight), None, tmp_path)
    assert tomllib.loads(used.decode())["flight"]["wind"]["recorded"] == str(tmp_path / "winds/monday.csv")


def test_the_truth_is_what_the_vehicles_flew(twice: list[tuple[Path, str]]) -> None:
    """Against the vehicle's own states: the noise of its estimate apart, they are the same motion."""
    (folder, _), _ = twice
    data = gcs.load(folder)
    for id in (1, 2):
        true, own = data.truth.of(id), data.states.of(id)
        assert np.diff(true["stamp_ns"]).min() >= 45_000_000
        for axis in ("north_m", "east_m", "down_m"):
            there = np.interp(own["stamp_ns"], true["stamp_ns"], true[axis])
            assert np.abs(there - own[axis]).max() < 1.0, (id, axis)
        speed = np.gradient(true["north_m"], true["t_s"])
        assert np.median(np.abs(speed - true["v_north_m_s"])) < 0.2


def test_the_summary_knows_neither_the_wall_clock_nor_a_path(twice: list[tuple[Path, str]]) -> None:
    (folder, _), _ = twice
    text = (folder / "summary.json").read_text(encoding="utf-8")
    summary, timing = json.loads(text), json.loads((folder / "timing.json").read_bytes())
    assert (summary["verdict"], summary["time"], summary["mode"]) == ("denied", 3.0, "fast")
    evader, pursuer = summary["vehicles"]
    assert pursuer["smallest_distance"] == pytest.approx(84.0, abs=10.0)
    assert evader["smallest_distance"] is None
    assert 15.0 < pursuer["telemetry_rate_hz"] < 22.0  # a tenth of the datagrams is lost
    assert 15.0 < pursuer["setpoint_rate_hz"] < 22.0
    assert pursuer["link"]["in_lost"] > 10
    for word in ("wall", "real_time", str(folder.parent), "/", "latency", "worst", "overrun"):
        assert word not in text, word
    assert {"wall_s", "virtual_s", "times_real_time"} <= set(timing)


def test_every_tlog_is_read_whole_by_pymavlinks_own_reader(twice: list[tuple[Path, str]]) -> None:
    from pymavlink import mavutil

    (folder, _), _ = twice
    for id in (1, 2):
        path = folder / f"vehicle-{id}.tlog"
        ours = list(read_tlog(path.read_bytes()))
        reader = mavutil.mavlink_connection(str(path), dialect="ardupilotmega")
        kinds: dict[str, int] = {}
        systems = set()
        while (message := reader.recv_msg()) is not None:
            kinds[message.get_type()] = kinds.get(message.get_type(), 0) + 1
            systems.add((message.get_srcSystem(), message.get_srcComponent()))
        assert sum(kinds.values()) == len(ours)
        assert "BAD_DATA" not in kinds
        assert systems == {(id, 1), (id, 191)}
        assert kinds["GLOBAL_POSITION_INT"] > 80
        assert kinds["SET_POSITION_TARGET_LOCAL_NED"] > 50


def test_folders_never_meet_and_a_file_is_whole_or_not_there(tmp_path: Path) -> None:
    made = [new_run(tmp_path, "a/../b: c", 1_800_000_000 * 10**9) for _ in range(3)]
    assert [path.name for path in made] == [f"20270115T080000Z-a-b-c{end}" for end in ("", "-2", "-3")]
    run_folder.write(made[0] / "x.json", {"a": 1})
    assert json.loads((made[0] / "x.json").read_bytes()) == {"a": 1}
    assert os.listdir(made[0]) == ["x.json"]
    with pytest.raises(ConfigError, match=r"nowhere/x\.json: no such file"):
        run_folder.write(made[0] / "nowhere" / "x.json", {})


def test_a_folder_in_which_nothing_was_flown_goes_unless_a_log_tells_why(tmp_path: Path) -> None:
    empty, telling = (new_run(tmp_path, name, 0) for name in ("empty", "telling"))
    for folder in (empty, telling):
        (folder / "scenario.toml").write_text("")
        (folder / "vehicle-1.tlog").write_bytes(b"")
    (telling / "agent-1.log").write_text("port in use\n")
    for folder in (empty, telling):
        run_folder.discard(folder)
    assert [empty.exists(), telling.exists()] == [False, True]


def test_settings_become_toml_that_reads_back() -> None:
    settings = {"id": 2, "link": ["udpin://127.0.0.1:1"], "take_control": True, "rate": 20.0, "log": 'a"b\\c',
                "safety": {"separation": 3.0, "fence": {"polygon": [[0.0, 1.0]]}},
                "players": [{"id": 1}, {"id": 2}], "odd key": {"a.b": 1}}  # fmt: skip
    assert tomllib.loads(run_folder.toml_of(settings)) == settings
