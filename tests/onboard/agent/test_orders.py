"""Commands from the ground: once each, retried toward the autopilot, confirmed by what it reports."""

from __future__ import annotations

import pytest

from onboard.agent.core.command_book import Orders
from onboard.autopilot.base import Stage
from onboard.core.safety.policy import Action
from onboard.game.scenario import Kind
from onboard.wire.bus.messages import AgentStage, CommandKind, CommandState, Phase
from tests.support.flown_autopilot import FLOWN
from tests.support.small_scenarios import PURSUER, chase, lossy
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    autopilot,
    choose_mode,
    command,
    flies,
    game_of,
    mode,
    order,
    speed,
    under_way,
)

WORDS = {
    Kind.PX4: {"hold": "HOLD", "return": "RTL", "land": "LAND", "abort": "HOLD"},
    Kind.ARDUCOPTER: {"hold": "LOITER", "return": "RTL", "land": "LAND", "abort": "LOITER"},
    Kind.ARDUPLANE: {"hold": "LOITER", "return": "RTL", "land": "RTL", "abort": "LOITER"},
}


@pytest.mark.parametrize("kind", FLOWN, ids=lambda kind: kind.value)
@pytest.mark.parametrize("what", ["hold", "return", "land", "abort"])
@virtual
async def test_an_order_in_flight_is_pending_then_confirmed_by_the_autopilots_mode(
    kind: Kind, what: str
) -> None:
    async with game_of(chase(kind)) as game:
        await under_way(game, 2.0)
        reply = await order(game, PURSUER, command(CommandKind(what)))
        assert reply.state == CommandState.PENDING
        await game.forward(1.2)
        reply = await order(game, PURSUER, command(CommandKind(what)))
        assert (reply.state, reply.mode, reply.obeyed) == (CommandState.CONFIRMED, WORDS[kind][what], "tower")
        assert mode(game, PURSUER) == WORDS[kind][what]
        assert game.health[PURSUER].stage == AgentStage.HELD
        await game.forward(5.0)
        assert mode(game, PURSUER) == WORDS[kind][what]


@virtual
async def test_an_order_to_land_is_that_for_the_supervisor_too_and_before_the_game_as_well() -> None:
    async with game_of(chase()) as game:
        await game.forward(20.0, until=lambda: mode(game, PURSUER) == "LOITER")
        await game.forward(1.0)
        assert game.phase is Phase.STAGING
        await order(game, PURSUER, command(CommandKind.LAND))
        await game.forward(2.0, until=lambda: mode(game, PURSUER) == "LAND")
        assert "supervisor_land" in game.kinds(PURSUER)
        assert "supervisor_return" not in game.kinds(PURSUER)
        await game.forward(1.2)
        reply = await order(game, PURSUER, command(CommandKind.LAND))
        assert reply.state is CommandState.CONFIRMED


@virtual
async def test_resume_gives_the_game_back_to_the_agent() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 2.0)
        await order(game, PURSUER, command(CommandKind.HOLD, "c-1"))
        await game.forward(3.0)
        assert speed(game, PURSUER) < 0.5
        await order(game, PURSUER, command(CommandKind.RESUME, "c-2"))
        await game.forward(3.0)
        assert (
            await order(game, PURSUER, command(CommandKind.RESUME, "c-2"))
        ).state == CommandState.CONFIRMED
        assert flies(game.agents[PURSUER])
        assert speed(game, PURSUER) > 3.0


@virtual
async def test_start_lets_an_agent_fly_that_may_not_take_control_by_itself() -> None:
    async with game_of(chase(), configure={PURSUER: {"take_control": False}}) as game:
        await under_way(game, 1.0)
        assert not flies(game.agents[PURSUER])
        await order(game, PURSUER, command(CommandKind.START))
        await game.forward(2.5)
        assert (await order(game, PURSUER, command(CommandKind.START))).state == CommandState.CONFIRMED
        assert flies(game.agents[PURSUER])


@virtual
async def test_a_command_repeated_twenty_times_happens_once() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 2.0)
        for _ in range(20):
            await order(game, PURSUER, command(CommandKind.ABORT))
            await game.forward(0.1)
        assert game.kinds(PURSUER).count("command") == 1
        assert game.kinds(PURSUER).count("command_confirmed") == 1


@virtual
async def test_at_30_percent_loss_an_abort_reaches_the_autopilot_all_the_same() -> None:
    async with game_of(chase(impairment=lossy(0.3))) as game:
        await under_way(game, 2.0)
        await order(game, PURSUER, command(CommandKind.ABORT))
        await game.forward(1.5, until=lambda: mode(game, PURSUER) == "LOITER")


@virtual
async def test_under_a_pilots_hands_an_order_is_refused_with_the_reason() -> None:
    async with game_of(chase()) as game:
        game.expects(PURSUER, "supervisor_end")
        await under_way(game, 2.0)
        choose_mode(game, PURSUER, "LOITER")
        await game.forward(2.0)
        reply = await order(game, PURSUER, command(CommandKind.RETURN))
        assert reply.state == CommandState.REFUSED
        assert "a pilot flies it" in reply.reason
        assert mode(game, PURSUER) == "LOITER"
        reply = await order(game, PURSUER, command(CommandKind.RESUME, "c-2"))
        assert "a pilot with live sticks flies it, in LOITER" in reply.reason
        autopilot(game, PURSUER).set_throttle(game.bridge.world.elapsed_ns, None)  # he switches it off
        choose_mode(game, PURSUER, "BRAKE")
        await game.forward(3.0)
        reply = await order(game, PURSUER, command(CommandKind.RESUME, "c-3"))
        await game.forward(4.0, until=lambda: flies(game.agents[PURSUER]))


@virtual
async def test_a_later_order_supersedes_an_open_one_and_bytes_that_are_none_are_refused() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 2.0)
        await order(game, PURSUER, command(CommandKind.HOLD, "c-1"))
        await order(game, PURSUER, command(CommandKind.RETURN, "c-2", "other"))
        first = await order(game, PURSUER, command(CommandKind.HOLD, "c-1"))
        assert (first.state, first.obeyed) == (CommandState.SUPERSEDED, "other")
        await game.forward(1.5)
        assert mode(game, PURSUER) == "RTL"
        agent = game.agents[PURSUER]
        assert b"refused" in agent._request(b"\x00garbage")
        assert agent.core.bus.drops["undecodable"] == 1
    assert autopilot(game, PURSUER) is not None


def test_what_is_not_obeyed_confirms_nothing() -> None:
    orders = Orders(Action.HOLD)
    entry, new = orders.give(command(CommandKind.HOLD), "no autopilot")
    assert (entry.state, new, orders.order) == (CommandState.REFUSED, True, Action.PASS)
    assert orders.review(Stage.LEFT) is None
    for n in range(200):
        orders.give(command(CommandKind.HOLD, f"n-{n}"), "")
    assert len(orders._known) == 64
