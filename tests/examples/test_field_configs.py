"""The files for a field trial load as they are."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from gcs.settings import Settings
from onboard.agent.config import load as load_agent
from onboard.config import strict as config
from onboard.game.field_roster import load as load_roster
from onboard.game.scenario import load as load_scenario
from onboard.runtime.resources import configs

FIELD = configs() / "field"


@pytest.mark.parametrize("number", [1, 2])
def test_a_vehicle_of_the_field_never_takes_control_or_arms_by_itself(number: int) -> None:
    found = load_agent(FIELD / f"vehicle-{number}.toml", {})
    assert found.id == number
    assert found.field
    assert not found.take_control
    assert not found.may_arm


@pytest.mark.parametrize("name", ["ground.toml", "second-laptop.toml"])
def test_both_laptops_settings_load(name: str) -> None:
    assert config.read(FIELD / name, Settings).game == "field"


def test_the_field_scenario_keeps_altitude_layers_and_a_fence() -> None:
    scenario = load_scenario(FIELD / "field.toml")
    assert scenario.flight.field_profile
    assert scenario.flight.fence is not None
    heights = sorted(vehicle.position[2] for vehicle in scenario.vehicles)
    assert all(b - a >= 20.0 for a, b in itertools.pairwise(heights))


def test_every_shipped_configuration_is_a_file_of_this_kind() -> None:
    assert {p.suffix for p in Path(FIELD).iterdir()} == {".toml"}


def test_the_roster_of_the_field_names_who_the_other_files_configure() -> None:
    roster = load_roster(FIELD / "roster.toml")
    agents = [load_agent(FIELD / f"vehicle-{number}.toml", {}) for number in (1, 2)]
    assert {(v.id, v.role, f"{v.name}/zenoh.json5") for v in roster.vehicles} == {
        (agent.id, agent.role, agent.zenoh) for agent in agents
    }
    assert {station.name for station in roster.stations} == {"ground", "second-laptop"}
    assert {roster.game} == {agent.game for agent in agents}
