"""A dead agent's last velocity, and many who are sent home at once: nobody leaves the fence, nobody meets."""

from __future__ import annotations

from itertools import combinations

import pytest

from onboard.core.math.vectors import distance
from onboard.game.scenario import FenceSpec, Flight, Kind, Parameters, Scenario, VehicleSpec
from onboard.wire.bus.messages import CommandKind
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from tests.support.small_scenarios import EVADER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    WholeGame,
    autopilot,
    command,
    game_of,
    mode,
    order,
    place,
    speed,
    under_way,
)

pytestmark = pytest.mark.game
WALL = 120.0  # [m; north]


def towards_a_wall(kind: Kind) -> Scenario:
    """A fast copter whose target lies behind the fence's northern wall."""
    corners = ((-150.0, -150.0), (WALL, -150.0), (WALL, 150.0), (-150.0, 150.0))
    fence = FenceSpec(polygon=corners, height_min=20.0, height_max=100.0)
    return Scenario(
        name="towards a wall",
        evader=VehicleSpec(position=(0.0, 0.0), speed=10.0, target=(400.0, 0.0)),
        pursuers=(VehicleSpec(position=(-100.0, 60.0), speed=5.0),),
        parameters=Parameters(horizon=60.0),
        flight=Flight(autopilot=kind, height=60.0, ready_s=2.0, fence=fence),
    )


@pytest.mark.parametrize(
    ("kind", "killed_at"), [(Kind.ARDUCOPTER, 60.0), (Kind.ARDUCOPTER, 95.0), (Kind.PX4, 95.0)]
)
@virtual
async def test_who_dies_on_its_way_to_the_fence_stays_inside(kind: Kind, killed_at: float) -> None:
    """GUID_TIMEOUT lets ArduCopter fly on for 3 s in every recording, COM_OF_LOSS_T PX4 for 1 s."""
    async with game_of(towards_a_wall(kind), any_error=True) as game:
        await game.forward(60.0, until=lambda: place(game, EVADER).x > killed_at)
        fast = speed(game, EVADER)
        assert fast > (4.0 if killed_at < 90.0 else 1.0), "or there is nothing to be held"
        game.kill_agent(EVADER)
        farthest = 0.0
        for _ in range(60):
            await game.forward(0.1)
            farthest = max(farthest, place(game, EVADER).x)
        assert farthest > killed_at + (0.6 if kind is Kind.PX4 else 2.0) * fast, "it did fly on"
        assert farthest < WALL


def three_abreast(kind: Kind) -> Scenario:
    """Three vehicles 30 m apart at one height."""
    return Scenario(
        name="three abreast",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0, target=(300.0, 0.0)),
        pursuers=tuple(VehicleSpec(position=(0.0, 30.0 * side), speed=4.0) for side in (1, -1)),
        parameters=Parameters(horizon=60.0, separation=8.0),
        flight=Flight(autopilot=kind, height=40.0, ready_s=2.0),
    )


def returning(kind: Kind, pilot: Autopilot, height: float) -> None:
    """Set the height of the way home [m]."""
    name, unit = {Kind.ARDUCOPTER: ("RTL_ALT", 100.0), Kind.PX4: ("RTL_RETURN_ALT", 1.0)}[kind]
    pilot.parameters.put(name, height * unit)


async def nearest_until(game: WholeGame, seconds: float) -> float:
    """The smallest distance of any two within the next `seconds` [m]."""
    nearest = 1e9
    for _ in range(round(5.0 * seconds)):
        await game.forward(0.2)
        gaps = (distance(place(game, a), place(game, b)) for a, b in combinations((1, 2, 3), 2))
        nearest = min(nearest, *gaps)
    return nearest


@pytest.mark.parametrize("kind", [Kind.ARDUCOPTER, Kind.PX4], ids=lambda kind: kind.value)
@virtual
async def test_abort_and_then_return_of_all_at_once_keep_them_apart(kind: Kind) -> None:
    async with game_of(three_abreast(kind), any_error=True) as game:
        game.expects_abort()
        for number, id in enumerate(game.scenario.ids):
            returning(kind, autopilot(game, id), 45.0 + 10.0 * number)
        await under_way(game, 6.0)
        for id in game.scenario.ids:
            await order(game, id, command(CommandKind.ABORT, f"a-{id}"))
        assert await nearest_until(game, 10.0) > 8.0
        for id in game.scenario.ids:
            await order(game, id, command(CommandKind.RETURN, f"r-{id}"))
        await game.forward(1.0)
        assert {mode(game, id) for id in game.scenario.ids} == {"RTL"}
        assert await nearest_until(game, 25.0) > 8.0


@virtual
async def test_in_the_field_a_silent_master_makes_everybody_hold_and_after_a_minute_fly_home() -> None:
    async with game_of(chase(field_profile=True, separation=8.0), any_error=True) as game:
        await under_way(game, 3.0)
        assert game.bridge.master is not None
        game.bridge.master.step = lambda motions: None  # type: ignore[method-assign]
        await game.forward(8.0)
        assert [mode(game, id) for id in game.scenario.ids] == ["GUIDED"] * 2
        assert all(speed(game, id) < 0.5 for id in game.scenario.ids), "after 5 s they hold"
        await game.forward(50.0)
        assert [mode(game, id) for id in game.scenario.ids] == ["GUIDED"] * 2
        await game.forward(5.0)
        assert [mode(game, id) for id in game.scenario.ids] == ["RTL"] * 2
