"""A started agent takes nothing by itself: what it finds guided it may fly on, the rest needs a person."""

from __future__ import annotations

import pytest

from onboard.autopilot.base import Stage
from onboard.game.scenario import Kind, SimulatedSpec
from onboard.runtime.impairment import CLEAR, CUT
from onboard.wire.bus.messages import Command, CommandKind, CommandState, Severity
from onboard.wire.mavlink.dialect import DialectSender, dialect
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
        await restarted_after(game, "BRAKE")
        await game.forward(3.0)
        await order(game, PURSUER, command(CommandKind.RESUME))
        await game.forward(5.0, until=lambda: flies(game.agents[PURSUER]))


@pytest.mark.parametrize(
    ("kind", "flown"),
    [
        (Kind.ARDUCOPTER, "LOITER"),
        pytest.param(Kind.ARDUCOPTER, "ALT_HOLD", marks=pytest.mark.long),
        pytest.param(Kind.ARDUPLANE, "FBWA", marks=pytest.mark.long),
        (Kind.PX4, "POSCTL"),
    ],
    ids=lambda one: getattr(one, "value", one),
)
@pytest.mark.parametrize(
    "restarted", [False, pytest.param(True, marks=pytest.mark.long)], ids=["same process", "restarted"]
)
@virtual
async def test_from_a_pilot_with_live_sticks_nobody_on_the_ground_takes_it(
    kind: Kind, flown: str, restarted: bool
) -> None:
    """Named and with the mode that was shown: refused all the same. He gives it over himself."""
    async with game_of(chase(kind), any_error=True) as game:
        if restarted:
            await restarted_after(game, flown)
        else:
            await under_way(game, 3.0)
            choose_mode(game, PURSUER, flown)
        await game.forward(3.0)
        heard = setpoints_heard(game, PURSUER)
        for number, what in enumerate((CommandKind.RESUME, CommandKind.START)):
            reply = await order(game, PURSUER, Command(f"c-{number}", what, "tower", 0, flown))
            assert reply.state is CommandState.REFUSED
            assert f"a pilot with live sticks flies it, in {flown}" in reply.reason
        await game.forward(6.0)
        assert (mode(game, PURSUER), heard) == (flown, [])
        if kind is Kind.PX4:
            choose_mode(game, PURSUER, "HOLD")
            await game.forward(2.0)
            await order(game, PURSUER, Command("c-9", CommandKind.RESUME, "tower", 0, "HOLD"))
        else:
            choose_mode(game, PURSUER, "GUIDED")
        await game.forward(6.0, until=lambda: flies(game.agents[PURSUER]))


def choose_as_station(game: WholeGame, name: str) -> None:
    """A person at another ground station (system 255) chooses a mode."""
    vehicle = autopilot(game, PURSUER)
    number, px4 = vehicle.modes[name], "POSCTL" in vehicle.modes
    parts = (number >> 16 & 255, number >> 24) if px4 else (number, 0)
    order = dialect.MAVLink_command_long_message(PURSUER, 1, 176, 0, 1, *parts, 0, 0, 0, 0)
    vehicle.receive(game.bridge.world.elapsed_ns, DialectSender(255, 190).pack(order), "station")


@pytest.mark.parametrize("kind", [Kind.ARDUCOPTER, Kind.ARDUPLANE], ids=lambda kind: kind.value)
@pytest.mark.parametrize(
    "when",
    [
        pytest.param("in a game, without control", marks=pytest.mark.long),
        "after a take-over",
        pytest.param("after a hold", marks=pytest.mark.long),
    ],
)
@virtual
async def test_a_guided_mode_that_a_ground_station_chose_is_not_flown(kind: Kind, when: str) -> None:
    """Its user flies to a point of his own in it; another companion may stream targets."""
    configure = {PURSUER: {"take_control": False}} if when.startswith("in a game") else {}
    async with game_of(chase(kind), configure=configure, any_error=True) as game:
        await under_way(game, 3.0)
        if when == "after a take-over":
            choose_as_station(game, "CIRCLE" if kind is Kind.ARDUPLANE else "BRAKE")
        elif when == "after a hold":
            await order(game, PURSUER, command(CommandKind.HOLD))
        await game.forward(4.0)
        heard = setpoints_heard(game, PURSUER)
        choose_as_station(game, "GUIDED")
        await game.forward(8.0)
        assert (mode(game, PURSUER), heard) == ("GUIDED", [])
        assert not flies(game.agents[PURSUER])
        assert "foreign_guided" in game.kinds(PURSUER)
        await order(game, PURSUER, command(CommandKind.RESUME, "c-2"))  # by a person's word it is
        await game.forward(5.0, until=lambda: flies(game.agents[PURSUER]))


@virtual
async def test_what_is_found_guided_before_a_game_is_not_flown_without_leave() -> None:
    """An agent started beside a companion that flies already, and without `take_control`."""
    quiet = {PURSUER: {"take_control": False}}
    async with game_of(chase(), configure=quiet, any_error=True) as game:
        game.kill_agent(PURSUER)
        choose_as_station(game, "GUIDED")
        await game.forward(0.5)
        game.start_agent(PURSUER)
        heard = setpoints_heard(game, PURSUER)
        await game.forward(10.0)
        assert (mode(game, PURSUER), heard) == ("GUIDED", [])
        lacks = game.health[PURSUER].lacks  # and the game waits, for a reason that a person can act on
        assert any("a person's resume: found in GUIDED" in lack for lack in lacks)
        await order(game, PURSUER, command(CommandKind.RESUME))
        await under_way(game, 1.0)
        assert flies(game.agents[PURSUER])


@virtual
async def test_a_plane_that_was_left_to_loiter_for_want_of_tracks_is_not_taken_from_its_pilot() -> None:
    """When the tracks return the agent may enter again, unless a person has moved the vehicle meanwhile."""
    async with game_of(chase(Kind.ARDUPLANE), any_error=True) as game:
        await under_way(game, 3.0)
        game.bridge.sensor.blind = True
        await game.forward(60.0, until=lambda: mode(game, PURSUER) == "LOITER")
        choose_mode(game, PURSUER, "FBWA")
        await game.forward(2.0)
        game.bridge.sensor.blind = False
        await game.forward(10.0)
        assert mode(game, PURSUER) == "FBWA"
        assert game.agents[PURSUER].core.vehicle.stage is Stage.TAKEN


@virtual
async def test_a_failsafe_of_our_own_silence_is_not_blamed_on_a_person() -> None:
    """ArduCopter's GCS failsafe flies home while the link is cut; when it is back all is calm."""
    watched = SimulatedSpec(parameters={"FS_GCS_ENABLE": 1.0, "SYSID_MYGCS": float(PURSUER)})
    async with game_of(chase(simulated=watched), any_error=True) as game:
        await under_way(game, 3.0)
        game.impair(PURSUER, CUT)
        await game.forward(7.0)
        game.impair(PURSUER, CLEAR)
        await game.forward(3.0)
        assert mode(game, PURSUER) == "RTL"
        assert {"failsafe"} <= set(game.kinds(PURSUER))
        assert "take_over" not in game.kinds(PURSUER)
        assert game.health[PURSUER].failsafe
        to_all = await order(game, PURSUER, command(CommandKind.RESUME))
        assert "it is in RTL, by a failsafe: resume this vehicle alone" in to_all.reason
        stop = await order(game, PURSUER, command(CommandKind.HOLD, "c-2"))
        assert stop.reason == "its own failsafe flies it, in RTL"


@pytest.mark.parametrize(
    "kind", [Kind.ARDUCOPTER, pytest.param(Kind.PX4, marks=pytest.mark.long)], ids=lambda kind: kind.value
)
@virtual
async def test_a_restarted_agent_raises_no_false_alarm(kind: Kind) -> None:
    """The autopilot's first heartbeat has not come yet: it is not missing."""
    async with game_of(chase(kind)) as game:
        await under_way(game, 3.0)
        game.kill_agent(PURSUER)
        await game.forward(2.0)
        game.start_agent(PURSUER)
        await game.forward(5.0)
        again = [event for event in game.events if event.id == PURSUER]
        started = max(n for n, event in enumerate(again) if event.kind == "started")
        assert not [event.text for event in again[started:] if event.severity is Severity.ERROR]


@virtual
async def test_a_resume_on_the_ground_is_refused_with_the_reason() -> None:
    on_foot = {PURSUER: {"may_arm": False}}
    async with game_of(chase(ground_start=True), configure=on_foot, any_error=True) as game:
        await game.forward(8.0)
        for what in (CommandKind.RESUME, CommandKind.START):
            reply = await order(game, PURSUER, command(what, what.value))
            assert reply.state is CommandState.REFUSED
            assert "it stands on the ground, disarmed" in reply.reason


@virtual
async def test_a_resume_with_an_empty_battery_is_refused_with_the_reason() -> None:
    async with game_of(chase(), any_error=True) as game:
        await under_way(game, 3.0)
        autopilot(game, PURSUER).set_battery(0.15)
        await game.forward(5.0, until=lambda: mode(game, PURSUER) == "RTL")
        reply = await order(game, PURSUER, Command("c-2", CommandKind.RESUME, "tower", 0, "RTL"))
        assert reply.state is CommandState.REFUSED
        assert "the battery is low" in reply.reason


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
