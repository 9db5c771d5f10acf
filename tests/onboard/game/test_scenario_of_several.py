"""Scenario files with several evaders and several targets: ids, roles, faults, and old files as they were."""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest

from onboard.config.strict import ConfigError, parse
from onboard.core.math.vectors import Vec, yaw_of
from onboard.game.scenario import Scenario, load, targets_of
from onboard.game.staging import setup_of, start_headings
from onboard.runtime.resources import configs
from onboard.wire.bus.messages import Role

SEVERAL = """
name = "several"
[evader]
position = [0, 0]
speed = 5
targets = [[-90, 0], [0, 40]]
[[pursuers]]
position = [30, 0]
speed = 4
[[pursuers]]
position = [0, 500]
speed = 4
[[evaders]]
position = [0, 400]
speed = 5
target = [0, 300]
[[evaders]]
position = [0, -400]
speed = 5
"""


def several(text: str = SEVERAL) -> Scenario:
    return parse(text, Scenario, "several.toml")


def test_pursuers_keep_their_ids_and_further_evaders_come_after_them() -> None:
    found = several()
    assert found.ids == (1, 2, 3, 4, 5)
    assert (found.evader_ids, found.pursuer_ids) == ((1, 4, 5), (2, 3))
    assert [found.role_of(id) for id in found.ids] == [
        Role.EVADER, Role.PURSUER, Role.PURSUER, Role.EVADER, Role.EVADER,
    ]  # fmt: skip
    with pytest.raises(KeyError, match="vehicle 6"):
        found.role_of(6)
    assert [member.role for member in setup_of(found, "g", "m").roster] == [*map(found.role_of, found.ids)]
    assert list(found.keyed()) == ["evader", "pursuers[0]", "pursuers[1]", "evaders[0]", "evaders[1]"]


def test_everybody_has_the_targets_of_its_own_table() -> None:
    found = several()
    assert [targets_of(spec) for spec in found.evading] == [
        (Vec(-90.0, 0.0, 0.0), Vec(0.0, 40.0, 0.0)), (Vec(0.0, 300.0, 0.0),), (),
    ]  # fmt: skip


def test_evaders_start_towards_their_nearest_target_and_pursuers_towards_the_nearest_evader() -> None:
    noses = [yaw_of(heading) for heading in start_headings(several())]
    assert noses == pytest.approx([pi / 2, pi, -pi / 2, -pi / 2, 0.0])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "target = [0, 300]",
            "target = [0, 300]\ntargets = [[1, 1]]",
            "evaders[0].targets: found 1 beside ta",
        ),
        ("[0, 40]]", "[-90, 0]]", "evader.targets: found [(-90.0, 0.0), (-90.0, 0.0)], expected places that"),
        ("[0, 40]]", "[0, 40, 5]]", "evader.targets[1]: found 3 numbers, expected 2 as in evader.position"),
        ("[0, -400]", "[0, -400, 20]", "evaders[1].position: found 3 numbers, expected 2 as in evader.pos"),
        ("[30, 0]", "[30, 0]\ntargets = [[1, 1]]", "pursuers[0].targets: found ((1.0, 1.0),), expected no t"),
        ("[0, -400]", "[0, -400]\nid = 4", "evaders.id: found [1, 2, 3, 4, 4], expected ids that differ"),
        ("[0, -400]\nspeed = 5", "[0, -400]\nspeed = 0", "evaders[1].speed: found 0.0, expected a positive"),
        ('"several"', '"several"\nexpect = {escapes = true, escapes_earlier = true}', "expect: found given"),
    ],
)
def test_a_fault_names_its_key(old: str, new: str, said: str) -> None:
    assert SEVERAL.count(old) == 1
    with pytest.raises(ConfigError) as found:
        several(SEVERAL.replace(old, new))
    assert str(found.value).removeprefix("several.toml: ").startswith(said)


def test_who_plays_one_evader_with_one_target_refuses_more(tmp_path: Path) -> None:
    path = tmp_path / "several.toml"
    path.write_text(SEVERAL, encoding="utf-8")
    with pytest.raises(ConfigError, match=r"several.toml: evaders: found 3 evaders, expected one"):
        load(path)
    path.write_text(SEVERAL.partition("[[evaders]]")[0], encoding="utf-8")
    with pytest.raises(
        ConfigError, match=r"several.toml: evader.targets: found 2 targets, expected `target`"
    ):
        load(path)
    assert load(path, several=True).evader_ids == (1,)


def test_a_scenario_goes_through_its_contents_and_an_old_one_keeps_its_fingerprint() -> None:
    found = several()
    assert parse_contents(found) == found
    old = load(configs() / "scenarios" / "table1" / "row01.toml")
    assert not {"evaders", "targets"} & {*old.contents(), *old.contents()["evader"]}
    assert old.hash() == "99535b6e9614181f"


def parse_contents(scenario: Scenario) -> Scenario:
    from onboard.config.strict import convert
    from sim_bridge.programs.campaigns.plan import without_none

    return convert(without_none(scenario.contents()), Scenario, "again")
