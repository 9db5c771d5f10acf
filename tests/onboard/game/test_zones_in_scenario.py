"""`[[zones]]` of a scenario: what is accepted, how a mistake is told, and that the bus carries them."""

from __future__ import annotations

import re
from collections import Counter
from math import cos, pi, sin

import pytest

from onboard.config.strict import ConfigError, parse
from onboard.core.geometry.zones import ENDLESS
from onboard.core.safety.fence import inside
from onboard.game.scenario import Scenario
from onboard.game.staging import setup_of
from onboard.wire.bus.messages import Zone
from onboard.wire.bus.topics import SETUP
from onboard.wire.bus.zone_messages import no_zone

PLANE = """
name = "zones"
[evader]
position = [0, 0]
speed = 10
target = [300, 0]
[[pursuers]]
position = [200, 100]
speed = 8
"""
SPACE = PLANE.replace("[0, 0]", "[0, 0, 50]").replace("[300, 0]", "[300, 0, 50]").replace("100]", "100, 50]")
TRIANGLE = "polygon = [[100, -20], [140, 0], [100, 20]]"


def zone(words: str, name: str = "wall") -> str:
    """One `[[zones]]` table."""
    return f'[[zones]]\nname = "{name}"\n{words}\n'


def test_polygon_and_disc_are_read_either_way_round() -> None:
    turned = "polygon = [[100, 20], [140, 0], [100, -20]]"
    one = parse(PLANE + zone(TRIANGLE), Scenario, "a").rules.zones
    other = parse(PLANE + zone(turned), Scenario, "a").rules.zones
    key = [(w.x, w.y, w.nx, w.ny) for w in one.walls]
    assert sorted(key) == sorted((w.x, w.y, w.nx, w.ny) for w in other.walls)
    disc = parse(PLANE + zone("centre = [150, 40]\nradius = 30"), Scenario, "a").rules.zones
    ring = tuple((wall.x, wall.y) for wall in disc.walls)
    edge = [(150 + 30 * cos(t), 40 + 30 * sin(t)) for t in (2 * pi * k / 1000 for k in range(1000))]
    assert all(inside(x, y, ring) for x, y in edge), "the polygon about a disc holds it"
    assert all(max(abs(x - 150), abs(y - 40)) < 30 * 1.02 for x, y in ring), "and little more"


def test_a_scenario_without_zones_keeps_its_fingerprint() -> None:
    assert "zones" not in parse(PLANE, Scenario, "a").contents()
    assert parse(PLANE, Scenario, "a").hash() != parse(PLANE + zone(TRIANGLE), Scenario, "a").hash()


def test_the_setup_carries_them_over_the_bus() -> None:
    scenario = parse(SPACE + zone(TRIANGLE + "\nhigh = 80") + zone("centre = [0, 90]\nradius = 9", "mast"),
                     Scenario, "a")  # fmt: skip
    heard = SETUP.decode(SETUP.encode(setup_of(scenario, "g", "m")), Counter())
    assert heard is not None
    assert [z.name for z in heard.zones] == ["wall", "mast"]
    assert (heard.zones[0].low, heard.zones[0].high) == (-ENDLESS, 80.0)
    assert heard.core_rules() == scenario.rules
    assert scenario.rules.zones.areas[1].sides == 16


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (PLANE + zone("polygon = [[100, -20], [140, 0]]"), r"zones\[0\].polygon: .*3 to 12 corners"),
        (PLANE + zone("polygon = [[100, -20], [110, 0], [100, 20], [140, 0]]"), r"corner 1 at .*110.* bends"),
        (PLANE + zone("polygon = [[100, -20], [100, 0], [100, 20]]"), "bends"),
        (
            PLANE + zone("polygon = [[100, 0], [160, 40], [100, 40], [160, 0], [130, 60]]"),
            "corner . at .* bends inwards",
        ),
        (PLANE + zone("polygon = [[-9, -9], [9, -9], [9, 9], [-9, 9]]"), r"evader.position.*outside"),
        (PLANE + zone("centre = [300, 5]\nradius = 9"), r"evader.target.*outside the zone wall"),
        (PLANE + zone("centre = [200, 100]\nradius = 9"), r"pursuers\[0\].position"),
        (PLANE + zone("centre = [100, 5]"), "both of a disc"),
        (PLANE + zone(TRIANGLE + "\ncentre = [100, 5]\nradius = 3"), "both of polygon and disc"),
        (PLANE + zone(""), "neither of polygon and disc"),
        (PLANE + zone(TRIANGLE + "\nhigh = 60"), r"zones\[0\].high: found 60.* in the plane"),
        (SPACE + zone(TRIANGLE + "\nlow = 60\nhigh = 40"), r"zones\[0\].low"),
        (PLANE + zone(TRIANGLE) + zone("centre = [140, 10]\nradius = 20", "mast"), "mast overlaps wall"),
        (PLANE + zone(TRIANGLE) + zone("centre = [240, 10]\nradius = 20"), "names that differ"),
        (PLANE + "".join(zone(f"centre = [{60 * k}, 400]\nradius = 9", f"z{k}") for k in range(9)), "most 8"),
    ],
)  # fmt: skip
def test_what_is_no_zone_is_told(text: str, found: str) -> None:
    with pytest.raises(ConfigError) as told:
        parse(text, Scenario, "game.toml")
    assert re.search(found, str(told.value)), told.value


def test_a_start_may_lie_below_a_zone() -> None:
    scenario = parse(SPACE + zone("polygon = [[-9, -9], [9, -9], [9, 9], [-9, 9]]\nlow = 70"), Scenario, "a")
    assert len(scenario.rules.zones.areas) == 1


def test_a_foreign_setup_with_a_bent_zone_is_refused() -> None:
    bent = Zone("bent", ((0.0, 0.0), (5.0, 1.0), (10.0, 0.0), (5.0, 9.0)))
    assert "bent" in no_zone((bent,))
    assert "height" in no_zone((Zone("flat", ((0.0, 0.0), (9.0, 0.0), (0.0, 9.0)), 5.0, 5.0),))
