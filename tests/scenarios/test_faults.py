"""Faults in the middle of a game: who is struck stops and comes back, the others play on."""

from __future__ import annotations

from pathlib import Path

import pytest

from onboard.autopilot.base import Stage
from onboard.runtime.impairment import CLEAR, CUT, Impairment
from onboard.wire.bus import messages
from onboard.wire.bus.messages import AgentStage, OutcomeResult, Phase
from onboard.wire.bus.topics import PHASE, SETUP, STATE, TRACK, Delivery
from onboard.wire.mavlink.dialect import DialectSender, dialect, dialect_packet
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.small_scenarios import EVADER, MATE, PURSUER, chase, duel
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    autopilot,
    choose_mode,
    flies,
    game_of,
    mode,
    place,
    setpoints_heard,
    under_way,
)

STATION, STATION_COMPONENT = 255, 190


@pytest.mark.game
@virtual
async def test_a_pursuer_cut_off_for_three_seconds_holds_comes_back_and_still_wins() -> None:
    async with game_of(duel(gap=90.0)) as game:
        await under_way(game, 1.0)
        game.expects(PURSUER, "supervisor_end")
        game.impair(PURSUER, CUT)
        await game.forward(3.0)
        assert "supervisor_hold" in game.kinds(PURSUER)
        assert game.health[PURSUER].stage == AgentStage.HELD
        assert flies(game.agents[EVADER])
        game.impair(PURSUER, CLEAR)
        outcome = await game.until_ended()
        assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, PURSUER)
        kinds = game.kinds(PURSUER)
        back = kinds[kinds.index("supervisor_hold") :]
        assert {"supervisor_ok", "supervisor_clip"} & set(back)
        assert game.links[PURSUER].counters()["in_cut"] > 50


@virtual
async def test_in_the_log_of_a_reboot_sequence_and_boot_time_begin_anew_and_the_game_goes_on(
    tmp_path: Path,
) -> None:
    async with game_of(chase(pursuers=2), folder=tmp_path) as game:
        await under_way(game, 8.0)
        before = game.agents[PURSUER].core.vehicle.telemetry.link_quality
        game.expects(PURSUER, "reboot", "supervisor_end")
        autopilot(game, PURSUER).reboot(game.bridge.world.elapsed_ns)
        await game.forward(5.0, until=lambda: "reboot" in game.kinds(PURSUER))
        await game.forward(30.0, until=lambda: flies(game.agents[PURSUER]))
        assert game.agents[PURSUER].core.vehicle.telemetry.link_quality > before - 0.2
        assert flies(game.agents[MATE])
        assert "reboot" not in game.kinds(MATE)
        assert game.phase is Phase.RUNNING
    packets = [entry.packet for entry in read_tlog((tmp_path / "vehicle-2.tlog").read_bytes())]
    boots = [p for p in packets if p.name == "GLOBAL_POSITION_INT"]
    times = [dialect_packet(p.raw).message.time_boot_ms for p in boots]
    (again,) = [n for n in range(1, len(times)) if times[n] < times[n - 1]]
    assert times[again - 1] > 8000
    assert times[again] < 1500
    assert boots[again].sequence < 40


@virtual
async def test_a_second_ground_station_on_the_same_links_changes_nothing() -> None:
    """The same game twice, once with a stranger who talks to everybody: both fly the same path."""
    paths = []
    for stranger in (False, True):
        async with game_of(chase(pursuers=1)) as game:
            paths.append(await flown(game, stranger))
    quiet, disturbed = paths
    assert len(quiet) == 40
    assert quiet == disturbed


async def flown(game, stranger: bool) -> list[tuple[float, ...]]:  # type: ignore[no-untyped-def]
    """The pursuer's way, a place each quarter of a second from t₀ on; what the stranger says is for others,
    or is asked of the autopilot without touching who flies it."""
    station = DialectSender(STATION, STATION_COMPONENT)
    await under_way(game, 0.0)
    way = []
    for _ in range(40):
        if stranger:
            for message in (*words(PURSUER, 191), *words(PURSUER + 1, 1)):
                to_agent, to_autopilot = station.pack(message), station.pack(message)
                game.bridge.world.vehicles[PURSUER].links[0].send(to_agent)
                game.links[PURSUER].link.send(to_autopilot)
        await game.forward(0.25)
        way.append(tuple(place(game, PURSUER)))
    agent = game.agents[PURSUER]
    assert flies(agent)
    assert "take_over" not in game.kinds(PURSUER)
    if stranger:
        assert agent.core.vehicle.foreign["foreign_system"] >= 200
        assert autopilot(game, PURSUER).counters["for_others"] >= 200
        assert game.health[PURSUER].counters["foreign_system"] > 100
    return way


def words(system: int, component: int) -> list[object]:
    """A heartbeat, and orders for somebody: another mode, disarm, a place to go to, fewer positions."""
    long = dialect.MAVLink_command_long_message
    return [
        dialect.MAVLink_heartbeat_message(dialect.MAV_TYPE_GCS, dialect.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3),
        long(system, component, dialect.MAV_CMD_DO_SET_MODE, 0, 1, 6, 0, 0, 0, 0, 0),
        long(system, component, dialect.MAV_CMD_COMPONENT_ARM_DISARM, 0, 0, 21196, 0, 0, 0, 0, 0),
        long(system, component, dialect.MAV_CMD_SET_MESSAGE_INTERVAL, 0, 33, 5e6, 0, 0, 0, 0, 0),
        dialect.MAVLink_set_position_target_local_ned_message(
            0, system, component, 1, 0x0DC7, 0, 0, 0, 9.0, 9.0, 9.0, 0, 0, 0, 0, 0
        ),
    ]


@virtual
async def test_an_agent_killed_and_started_again_is_let_in_by_the_master_and_nobody_else_stops() -> None:
    async with game_of(chase(pursuers=2)) as game:
        await under_way(game, 3.0)
        game.expects(PURSUER, "supervisor_end")
        game.kill_agent(PURSUER)
        connections = len(game.broker.buses)
        await game.forward(4.0)
        assert len(game.broker.buses) == connections - 1, "its connection went with it"
        assert "agent 2 is silent" in game.told
        held = [place(game, PURSUER)]
        again = game.start_agent(PURSUER)
        await game.forward(
            10.0, until=lambda: flies(again) and game.health[PURSUER].stage == AgentStage.ACTING
        )
        assert {"agent 2 was started again and may act again", "agent 2 is back"} <= set(game.told)
        kinds = game.kinds(PURSUER)
        second = kinds[kinds.index("started", 1) :]
        assert second.count("resumed") == 1
        assert "stage" in second[second.index("resumed") :]  # it acts only then
        await game.forward(3.0)
        assert abs(place(game, PURSUER).x - held[0].x) > 5.0
        assert "supervisor_hold" not in game.kinds(MATE)
        assert flies(game.agents[MATE])


@virtual
async def test_a_pilot_takes_one_vehicle_out_of_the_game_and_its_setpoints_cease_at_once() -> None:
    async with game_of(chase(pursuers=2)) as game:
        await under_way(game, 3.0)
        heard = setpoints_heard(game, PURSUER)
        taken_ns = game.bridge.world.elapsed_ns
        game.expects(PURSUER, "supervisor_end")
        choose_mode(game, PURSUER, "ALT_HOLD")
        await game.forward(8.0)
        assert heard == [] or heard[-1] - taken_ns <= 100_000_000
        assert game.agents[PURSUER].core.vehicle.stage is Stage.TAKEN
        assert game.health[PURSUER].stage == AgentStage.HANDED_OVER
        assert [event.text for event in game.events if event.id == PURSUER and event.kind == "take_over"]
        assert mode(game, PURSUER) == "ALT_HOLD"
        assert flies(game.agents[MATE])
        assert flies(game.agents[EVADER])


@virtual
async def test_on_a_noisy_field_everything_bad_is_counted_by_cause_and_shown_in_health_and_summary() -> None:
    noisy = Impairment(loss=0.05, delay_s=0.01, jitter_s=0.02, duplication=0.1, reordering=0.1, bit_error=0.1)
    async with game_of(chase(pursuers=2)) as game:
        await under_way(game, 1.0)
        game.impair(PURSUER, noisy)
        foreign = DialectSender(77, 1)
        vehicle = game.bridge.world.vehicles[PURSUER]
        heartbeat = words(1, 1)[0]
        wrong_schema = b"\x92\x09" + TRACK.encode(_track(game))[2:]
        for n in range(60):
            vehicle.links[0].send(bytes([n, 0, 255 - n, 7] * 5))
            vehicle.links[0].send(foreign.pack(heartbeat)[:9])
            vehicle.links[0].send(foreign.pack(heartbeat))
            game.bus.publish(f"apollonius/{game.game}/tracks/1", wrong_schema, Delivery.LATEST)
            game.bus.publish(STATE.key(game.game, MATE), b"\xc1nonsense", Delivery.LATEST)
            game.bus.publish(PHASE.key(game.game), b"\x92\x09\x90", Delivery.LATEST)
            game.bus.publish(SETUP.key(game.game), b"", Delivery.LATEST)
            await game.forward(0.1)
        await game.forward(1.0)
        counters = game.health[PURSUER].counters
        for cause in ("garbage_bytes", "bad_crc", "truncated", "foreign_system", "schema", "undecodable"):
            assert counters.get(cause, 0) >= 20, (cause, counters)
        assert flies(game.agents[MATE])
        assert game.phase is Phase.RUNNING
        summary = game.summary()
        link = summary.vehicles[1].link
        assert min(link[f"in_{what}"] for what in ("lost", "duplicated", "reordered", "bit_error")) > 10
        assert summary.vehicles[1].counters["bad_crc"] >= 20
        assert autopilot(game, PURSUER).counters["bad_crc"] > 0


def _track(game) -> messages.Track:  # type: ignore[no-untyped-def]
    zero = (0.0, 0.0, 0.0)
    return messages.Track(EVADER, game.clock.wall_ns(), zero, zero, (1.0,) * 6)  # type: ignore[arg-type]
