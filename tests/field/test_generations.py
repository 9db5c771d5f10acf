"""One vehicle under three generations of names: the agent reads the same limits, whatever they are called."""

from __future__ import annotations

import pytest

from onboard.autopilot.flight_limits import FlightLimits
from onboard.game.scenario import Firmware, Kind, SimulatedSpec
from onboard.wire.bus.messages import Phase
from tests.support.small_scenarios import PURSUER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import at_phase, game_of

pytestmark = pytest.mark.game


@pytest.mark.parametrize("kind", list(Kind), ids=lambda kind: kind.value)
@virtual
async def test_every_generation_gives_the_same_limits(kind: Kind) -> None:
    """ArduPilot 4.4, 4.5 and 4.7, PX4 1.16 and 1.18: MAV_GCS_SYSID, WP_SPD, RTL_ALT_M and others."""
    found: dict[Firmware, FlightLimits] = {}
    for firmware in Firmware:
        async with game_of(chase(kind, simulated=SimulatedSpec(firmware=firmware))) as game:
            await at_phase(game, Phase.READY)
            await game.forward(1.5)
            vehicle = game.agents[PURSUER].core.vehicle
            assert vehicle.unread == ()
            found[firmware] = vehicle.limits
    recorded = found[Firmware.RECORDED]
    assert recorded.return_height, "or nothing is compared"
    for firmware, limits in found.items():
        for name, value, expected in zip(recorded._fields, limits, recorded, strict=True):
            same = None if expected is None else pytest.approx(expected, rel=1e-3)
            assert value == same, (firmware, name)
