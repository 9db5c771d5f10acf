"""However a flight of the agent ends, the vehicle is left held, returning or landing; it does not sink."""

from __future__ import annotations

import pytest

from onboard.game.scenario import Kind, SimulatedSpec, Transmitter
from onboard.wire.bus.messages import CommandKind, CommandState
from tests.support.small_scenarios import PURSUER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    WholeGame,
    autopilot,
    choose_mode,
    command,
    game_of,
    mode,
    order,
    place,
    under_way,
)

STICK, LOW, NONE = Transmitter.CENTRED, Transmitter.LOW, Transmitter.NONE


async def end(game: WholeGame, how: str) -> None:
    """One of the ways in which the agent's flight ends."""
    if how == "game end":
        game.expects_abort()
        game.bridge.master.abort("the day is over")  # type: ignore[union-attr]
    elif how == "leaving":
        game.agents[PURSUER].stop()
    else:
        await order(game, PURSUER, command(CommandKind(how)))


@pytest.mark.parametrize(
    ("kind", "transmitter", "how", "left"),
    [
        (Kind.ARDUCOPTER, STICK, "hold", "LOITER"),
        (Kind.ARDUCOPTER, LOW, "hold", "BRAKE"),
        (Kind.ARDUCOPTER, NONE, "hold", "BRAKE"),
        (Kind.ARDUCOPTER, LOW, "abort", "BRAKE"),
        (Kind.ARDUCOPTER, NONE, "game end", "BRAKE"),
        (Kind.ARDUCOPTER, STICK, "leaving", "LOITER"),
        (Kind.ARDUCOPTER, LOW, "leaving", "RTL"),
        (Kind.ARDUCOPTER, NONE, "leaving", "RTL"),
        (Kind.ARDUPLANE, NONE, "hold", "LOITER"),
        (Kind.ARDUPLANE, NONE, "leaving", "RTL"),
        (Kind.PX4, NONE, "abort", "HOLD"),
        (Kind.PX4, NONE, "leaving", "HOLD"),
    ],
    ids=lambda one: getattr(one, "value", one),
)
@virtual
async def test_the_vehicle_is_left_in_its_rows_mode_and_keeps_its_height(
    kind: Kind, transmitter: Transmitter, how: str, left: str
) -> None:
    async with game_of(chase(kind, simulated=SimulatedSpec(transmitter=transmitter))) as game:
        await under_way(game, 3.0)
        await end(game, how)
        await game.forward(2.0, until=lambda: mode(game, PURSUER) == left)
        if left == "RTL":
            return
        await game.forward(3.0)
        height = -place(game, PURSUER).z
        await game.forward(10.0)
        assert mode(game, PURSUER) == left
        assert -place(game, PURSUER).z == pytest.approx(height, abs=2.0)


@virtual
async def test_where_the_mode_to_hold_is_blocked_the_next_one_is_taken_and_confirmed() -> None:
    blocked = SimulatedSpec(transmitter=NONE, parameters={"FLTMODE_GCSBLOCK": float(1 << 12)})  # BRAKE
    async with game_of(chase(simulated=blocked)) as game:
        await under_way(game, 3.0)
        await order(game, PURSUER, command(CommandKind.HOLD))
        await game.forward(1.0, until=lambda: mode(game, PURSUER) == "RTL")
        await game.forward(1.2)
        reply = await order(game, PURSUER, command(CommandKind.HOLD))
        assert (reply.state, reply.mode) == (CommandState.CONFIRMED, "RTL")
        assert "mode_chain" in game.kinds(PURSUER)


@virtual
async def test_a_hold_is_told_when_it_is_one_and_its_loss_is_an_alert() -> None:
    async with game_of(chase(simulated=SimulatedSpec(transmitter=STICK))) as game:
        await under_way(game, 3.0)
        await order(game, PURSUER, command(CommandKind.HOLD))
        await game.forward(10.0, until=lambda: "held" in game.kinds(PURSUER))
        assert mode(game, PURSUER) == "LOITER"
        game.expects(PURSUER, "hold_lost", "supervisor_end")
        autopilot(game, PURSUER).set_throttle(game.bridge.world.elapsed_ns, 0.0)  # the stick falls
        await game.forward(6.0, until=lambda: "hold_lost" in game.kinds(PURSUER))
        told = game.kinds(PURSUER).count("hold_lost")
        await game.forward(5.0)
        assert game.kinds(PURSUER).count("hold_lost") == told  # once
        assert "LOITER does not hold" in game.health[PURSUER].hold_lost  # … and it stands
        choose_mode(game, PURSUER, "ALT_HOLD")
        await game.forward(2.0)
        assert game.health[PURSUER].hold_lost == ""
