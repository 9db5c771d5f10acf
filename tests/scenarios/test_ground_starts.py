"""From the ground: every kind takes off; who may not arm flies to no height that nobody gave it."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from onboard.game.scenario import WINGED, Kind
from onboard.wire.bus.messages import Phase
from tests.support.small_scenarios import EVADER, PURSUER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import at_phase, game_of, place, under_way

pytestmark = pytest.mark.game


@pytest.mark.parametrize("kind", list(Kind), ids=lambda kind: kind.value)
@virtual
async def test_every_kind_takes_off_and_is_ready(kind: Kind) -> None:
    """ArduCopter by NAV_TAKEOFF in GUIDED, ArduPlane in TAKEOFF, PX4 by NAV_TAKEOFF without a place."""
    scenario = chase(kind, ground_start=True)
    scenario = replace(scenario, flight=replace(scenario.flight, timeout_s=120.0))
    async with game_of(scenario, any_error=True) as game:
        await at_phase(game, Phase.READY)
        heights = [-place(game, id).z for id in (EVADER, PURSUER)]
        assert all(22.0 < height < (80.0 if kind in WINGED else 34.0) for height in heights), heights


@virtual
async def test_who_may_not_arm_keeps_the_height_it_has() -> None:
    """The setup of a ground start says 0 m: that is where it stood, not where it is to fly."""
    told: dict[int, dict[str, bool]] = {}
    async with game_of(chase(ground_start=True), any_error=True, configure=told) as game:
        await under_way(game, 2.0)
        game.kill_agent(PURSUER)
        before = -place(game, PURSUER).z
        told[PURSUER] = {"may_arm": False}
        game.start_agent(PURSUER)
        lowest = before
        for _ in range(40):
            await game.forward(0.2)
            lowest = min(lowest, -place(game, PURSUER).z)
        assert game.agents[PURSUER].core.flight.playing, "or it flies nowhere"
        assert lowest > before - 2.0
