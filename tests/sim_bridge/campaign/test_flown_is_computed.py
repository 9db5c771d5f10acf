"""A flown spatial game beside the compiled one; of many seeds: `tests.benchmarks.flown_computed`."""

from __future__ import annotations

import pytest

from sim_bridge.campaign.spatial_draw import spatial
from sim_bridge.campaign.spatial_game import Evasion
from tests.benchmarks.flown_computed import compute, fly, ready_for

pytestmark = [pytest.mark.long, pytest.mark.timeout(1200)]


@pytest.mark.parametrize(("seed", "evasion"), [(2, Evasion.STRAIGHT), (3, Evasion.STRATEGY)])
def test_from_the_same_states_a_flown_game_is_the_computed_one(seed: int, evasion: Evasion) -> None:
    scenario = spatial("two")
    flown = fly(ready_for(scenario, seed, evasion))
    computed = compute(scenario, seed, evasion, flown, compiled=False)
    assert computed.verdict.name.lower() == flown.verdict
    assert computed.time == pytest.approx(flown.time, rel=0.02)
    assert computed.smallest == pytest.approx(flown.smallest, rel=0.05, abs=5.0)
