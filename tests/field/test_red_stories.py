"""Stories that the simulated autopilots tell truthfully and that ended badly with agents of 0.1.0.

Those that today's agent does not yet live through are marked with the reason.
"""

from __future__ import annotations

from collections.abc import Hashable
from itertools import pairwise

import pytest

from onboard.core.math.vectors import ZERO
from onboard.game.scenario import Kind, SimulatedSpec, Transmitter
from onboard.wire.bus.messages import CommandKind, OutcomeResult
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.small_scenarios import EVADER, PURSUER, chase, duel
from tests.support.virtual_time import virtual
from tests.support.whole_games import autopilot, command, game_of, mode, order, place, under_way

pytestmark = pytest.mark.game


@pytest.mark.parametrize("transmitter", [Transmitter.NONE, Transmitter.LOW], ids=lambda it: it.value)
@virtual
async def test_the_end_of_a_game_holds_copters_that_have_no_transmitter(transmitter: Transmitter) -> None:
    """For whoever chooses the mode of holding: BRAKE where no centred stick was measured."""
    around = SimulatedSpec(transmitter=transmitter)
    async with game_of(duel(Kind.ARDUCOPTER, simulated=around), any_error=True) as game:
        await game.until_ended()
        heights = {id: -place(game, id).z for id in (EVADER, PURSUER)}
        await game.forward(12.0)
        for id, height in heights.items():
            assert -place(game, id).z > height - 2.0


@virtual
async def test_an_agent_without_control_never_takes_px4_out_of_its_failsafe() -> None:
    """For whoever decides what is streamed: silence where no control was given."""
    idle = {PURSUER: {"take_control": False}}
    async with game_of(chase(Kind.PX4), configure=idle, any_error=True) as game:
        await game.forward(3.0)
        pilot, vehicle = DialectSender(PURSUER, 195), autopilot(game, PURSUER)
        now = game.bridge.world.elapsed_ns
        target = dialect.MAVLink_set_position_target_local_ned_message(
            0, PURSUER, 1, 1, 0x9C7, 0, 0, 0, *ZERO, 0, 0, 0, 0, 0
        )
        vehicle.receive(now, pilot.pack(target), "another companion")
        mode_order = dialect.MAVLink_command_long_message(PURSUER, 1, 176, 0, 1, 6, 0, 0, 0, 0, 0)
        vehicle.receive(now, pilot.pack(mode_order), "another companion")
        await game.forward(5.0)  # the other companion dies at once
        assert mode(game, PURSUER) == "HOLD"


@virtual
async def test_an_answer_that_comes_late_is_not_a_pilot() -> None:
    """For whoever judges changes of mode: count the delays of the own requests."""
    around = SimulatedSpec(answer_delay_s=0.4, answer_delay_max_s=3.0)
    async with game_of(chase(Kind.ARDUPLANE, simulated=around), any_error=True) as game:
        await under_way(game, 5.0)
        for number in range(4):
            await order(game, PURSUER, command(CommandKind.HOLD, f"h-{number}"))
            await game.forward(1.2)
            await order(game, PURSUER, command(CommandKind.RESUME, f"r-{number}"))
            await game.forward(4.0)
        assert not [e.text for e in game.events if e.kind in ("take_over", "handed_back")]


@virtual
async def test_one_request_for_a_mode_is_on_its_way_to_an_autopilot_that_answers_late() -> None:
    """A second one, obeyed after the first, would undo what a pilot has chosen meanwhile."""
    around = SimulatedSpec(answer_delay_s=1.0, answer_delay_max_s=1.0)
    async with game_of(chase(Kind.ARDUCOPTER, simulated=around), any_error=True) as game:
        await game.forward(0.5)
        vehicle = autopilot(game, PURSUER)
        asked: list[float] = []
        receive = vehicle.receive

        def listening(now_ns: int, data: bytes, peer: Hashable) -> None:
            long = int.from_bytes(data[7:10], "little") == dialect.MAVLINK_MSG_ID_COMMAND_LONG
            if long and int.from_bytes(data[38:40], "little") == dialect.MAV_CMD_DO_SET_MODE:
                asked.append(now_ns / 1e9)
            receive(now_ns, data, peer)

        vehicle.receive = listening  # type: ignore[method-assign]
        await under_way(game, 3.0)
        await order(game, PURSUER, command(CommandKind.HOLD))
        await game.forward(3.0)
        assert len(asked) >= 2  # GUIDED and the mode to hold
        assert min(b - a for a, b in pairwise(asked)) > 1.0


@virtual
async def test_px4_takes_off_from_the_ground() -> None:
    """For whoever sends NAV_TAKEOFF and judges the estimate: NaN for an unknown place; rest is healthy."""
    async with game_of(chase(Kind.PX4, ground_start=True), any_error=True) as game:
        await under_way(game, 5.0)
        assert -place(game, PURSUER).z > 20.0


@virtual
async def test_px4_planes_play_a_game() -> None:
    """For the adapter: a position target 300 m ahead along the wanted course at 20 Hz."""
    async with game_of(duel(Kind.PX4_PLANE), any_error=True) as game:
        await under_way(game, 2.0)
        assert mode(game, PURSUER) == "OFFBOARD"
        outcome = await game.until_ended()
        assert outcome.verdict is OutcomeResult.CAPTURED
        await game.forward(1.0)
        assert mode(game, PURSUER) == "HOLD"
