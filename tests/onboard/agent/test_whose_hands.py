"""A started agent takes nothing by itself: what it finds guided it may fly on, the rest needs a person."""

from __future__ import annotations

import pytest

from onboard.autopilot.base import Stage
from onboard.game.scenario import Kind
from onboard.wire.bus.messages import Command, CommandKind, CommandState
from tests.support.small_scenarios import HOLD, PURSUER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    WholeGame,
    autopilot,
    choose_mode,
    command,
    flies,
    game_of,
    mode,
    order,
    setpoints_heard,
    under_way,
)

ANOTHER = {
    Kind.ARDUCOPTER: ("LOITER", "RTL", "LAND", "ALT_HOLD"),
    Kind.ARDUPLANE: ("LOITER", "RTL", "FBWA"),
    Kind.PX4: ("HOLD", "RTL", "POSCTL", "LAND"),
}


async def restarted_after(game: WholeGame, found: str, dead_s: float = 2.0) -> None:
    """The agent is killed in a running game; another hand chooses a mode; the agent is started again."""
    game.expects(PURSUER, "supervisor_end", "end")
    await under_way(game, 3.0)
    game.kill_agent(PURSUER)
    await game.forward(0.5)
    choose_mode(game, PURSUER, found)
    await game.forward(dead_s)
    game.start_agent(PURSUER)


@pytest.mark.parametrize(
    ("kind", "found"), [(kind, found) for kind, modes in ANOTHER.items() for found in modes],
    ids=lambda one: getattr(one, "value", one),
)  # fmt: skip
@virtual
async def test_a_restarted_agent_leaves_the_vehicle_where_it_finds_it(kind: Kind, found: str) -> None:
    async with game_of(chase(kind)) as game:
        await restarted_after(game, found)
        heard = setpoints_heard(game, PURSUER)
        await game.forward(12.0)
        assert mode(game, PURSUER) == found
        assert heard == []
        assert game.agents[PURSUER].core.vehicle.stage is Stage.IDLE


@virtual
async def test_a_persons_resume_after_the_restart_gives_it_the_vehicle_and_the_game() -> None:
    async with game_of(chase()) as game:
        await restarted_after(game, "LOITER")
        await game.forward(3.0)
        await order(game, PURSUER, command(CommandKind.RESUME))
        await game.forward(5.0, until=lambda: flies(game.agents[PURSUER]))


@virtual
async def test_px4_hears_no_target_that_nobody_asked_for() -> None:
    """PX4 goes back into OFFBOARD by itself as soon as targets return after its signal-loss failsafe."""
    quiet = {PURSUER: {"take_control": False}}
    async with game_of(chase(Kind.PX4), configure=quiet) as game:
        heard = setpoints_heard(game, PURSUER)
        await under_way(game, 5.0)
        assert heard == []
        assert mode(game, PURSUER) == HOLD[Kind.PX4]


@virtual
async def test_an_agent_that_may_take_control_leaves_a_vehicle_on_its_way_home_alone() -> None:
    async with game_of(chase()) as game:
        await game.forward(20.0, until=lambda: mode(game, PURSUER) == "LOITER")
        autopilot(game, PURSUER).pilot_mode(game.bridge.world.elapsed_ns, "RTL")
        await game.forward(8.0)
        assert mode(game, PURSUER) == "RTL"
        assert game.agents[PURSUER].core.vehicle.stage is Stage.IDLE


@pytest.mark.parametrize("found", ["RTL", "LAND"])
@virtual
async def test_out_of_a_way_home_a_resume_must_name_the_vehicle_and_the_mode_shown(
    found: str,
) -> None:
    async with game_of(chase()) as game:
        await restarted_after(game, found)
        await game.forward(3.0)
        to_all = command(CommandKind.RESUME)
        outdated = Command("c-2", CommandKind.RESUME, "tower", 0, "LOITER")
        for given in (to_all, outdated):
            reply = await order(game, PURSUER, given)
            assert reply.state is CommandState.REFUSED
            assert f"it is in {found}" in reply.reason
        await game.forward(2.0)
        assert mode(game, PURSUER) == found
        named = Command("c-3", CommandKind.RESUME, "tower", 0, found)
        assert (await order(game, PURSUER, named)).state is CommandState.PENDING
        await game.forward(5.0, until=lambda: mode(game, PURSUER) == "GUIDED")
