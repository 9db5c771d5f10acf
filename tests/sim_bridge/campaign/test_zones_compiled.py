"""Compiled games of aircraft in wind keep out of zones, and zones change where they fly."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from onboard.core.geometry.zones import least_clearance
from onboard.core.math.vectors import Vec
from onboard.game.zone_spec import ZoneSpec
from sim_bridge.campaign.spatial_campaign import play_seed
from sim_bridge.campaign.spatial_draw import spatial
from sim_bridge.campaign.spatial_game import Evasion


@pytest.mark.long
def test_no_aircraft_of_a_compiled_game_enters_a_zone() -> None:
    scenario = spatial("two")  # 1 flies north from the origin to 3 km
    tower = ZoneSpec(name="tower", centre=(1500.0, 100.0), radius=250.0)
    hill = ZoneSpec(name="hill", polygon=((2400.0, -400.0), (2800.0, -300.0), (2700.0, 300.0)), high=1450.0)
    among = replace(scenario, zones=(tower, hill))
    for seed in range(3):
        flown = play_seed(among, seed, Evasion.STRATEGY).log[:, :, :3]
        places = [Vec(*map(float, place)) for moment in flown for place in moment]
        assert min(least_clearance(among.rules.zones, place, False) for place in places) > 0.0
        free = play_seed(scenario, seed, Evasion.STRATEGY).log[:, :, :3]
        paths = [Vec(*map(float, place)) for moment in free for place in moment]
        assert min(least_clearance(among.rules.zones, place, False) for place in paths) < 0.0
