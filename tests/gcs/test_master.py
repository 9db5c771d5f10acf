"""The ground station as master: a game in the field, refereed from what the vehicles say."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from contextlib import asynccontextmanager

import msgspec
import pytest

from gcs.master import FieldMaster, Fix, Positions
from gcs.station import Station, StationSetup
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.game.master import Standing
from onboard.game.scenario import Flight, Parameters, Scenario, VehicleSpec
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.loop import virtual_clock
from onboard.runtime.protocols import Bus
from onboard.wire.bus import messages, topics
from onboard.wire.bus.messages import AgentStage, CommandKind, OutcomeResult, Phase
from tests.support.answering_agents import AnsweringAgent
from tests.support.sample_messages import GAME, health, on_bus, state, track
from tests.support.virtual_time import virtual

MEETING = Scenario(
    name="meeting",
    evader=VehicleSpec(position=(0.0, 0.0, 50.0), speed=5.0, target=(300.0, 0.0, 50.0)),
    pursuers=(
        VehicleSpec(position=(100.0, 0.0, 50.0), speed=5.0),
        VehicleSpec(position=(0.0, 200.0, 50.0), speed=5.0),
    ),
    parameters=Parameters(R=2.0, horizon=30.0),
    flight=Flight(ready_s=2.0, timeout_s=20.0),
)


class Flyer:
    """A vehicle on a straight line, whose agent says how it is."""

    def __init__(self, bus: Bus, i: int, start: Vec, velocity: Vec, late_s: float = 0.0) -> None:
        self.bus, self.id, self.start, self.velocity, self.late_s = bus, i, start, velocity, late_s
        self.stage = AgentStage.READY
        self.silent = False
        self.by_track = False
        self.only_track = False  # no agent of ours flies it
        self.t0_ns = 0
        bus.subscribe(topics.PHASE.key(GAME), self._on_phase)

    def _on_phase(self, sample) -> None:
        phase = msgspec.msgpack.Decoder(tuple[int, messages.PhaseChange]).decode(sample.payload)[1]
        self.t0_ns = phase.t0_ns
        if phase.phase is Phase.RUNNING:
            self.stage = AgentStage.ACTING

    async def fly(self) -> None:
        clock = virtual_clock()
        while True:
            now_ns = clock.wall_ns()
            t = max(0, now_ns - self.t0_ns) / NS_PER_S if self.t0_ns else 0.0
            v = self.velocity if t > 0 else Vec(0.0, 0.0, 0.0)
            place = tuple(s + w * t for s, w in zip(self.start, v, strict=True))
            own = state(self.id, now_ns, position=place, velocity=tuple(v))
            await asyncio.sleep(self.late_s)
            if not self.silent:
                if self.by_track or self.only_track:
                    seen = track(self.id, now_ns, position=place, velocity=tuple(v))
                    self.bus.publish(*on_bus(seen), topics.TRACK.delivery)
                else:
                    self.bus.publish(*on_bus(own), topics.STATE.delivery)
                lacks = ("a fix",) if self.stage == AgentStage.WAITING else ()
                well = health(self.id, now_ns, stage=self.stage, lacks=lacks)
                if not self.only_track:
                    self.bus.publish(*on_bus(well), topics.HEALTH.delivery)
            await asyncio.sleep(0.1 - self.late_s)


@asynccontextmanager
async def field(
    scenario: Scenario = MEETING, auto_start: bool = True, late_s: float = 0.02, fourth: Vec | None = None
):
    """A station that is master, and three vehicles: the evader flies north at 5 m/s, pursuer 2 meets it.

    `fourth` is where a further evader of `scenario` stands [m; NED], known by its track."""
    broker = MemoryBroker()
    clock = virtual_clock()
    station = Station(
        broker.connect("gcs"), clock, StationSetup(GAME, "anna"), new_id=iter("abcdefgh").__next__
    )
    master = FieldMaster(station, scenario, auto_start=auto_start, nonce=5)
    flyers = [
        Flyer(broker.connect(), 1, Vec(0.0, 0.0, -50.0), Vec(5.0, 0.0, 0.0), late_s),
        Flyer(broker.connect(), 2, Vec(100.0, 0.0, -50.0), Vec(-5.0, 0.0, 0.0)),
        Flyer(broker.connect(), 3, Vec(0.0, 200.0, -50.0), Vec(0.0, 0.0, 0.0)),
    ]
    if fourth is not None:
        flyers.append(Flyer(broker.connect(), 4, fourth, Vec(0.0, 0.0, 0.0)))
        flyers[-1].only_track = True
    tasks = [asyncio.create_task(coro) for coro in (station.run(), master.run(), *(f.fly() for f in flyers))]
    try:
        yield station, master, flyers, broker
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def until(condition: Callable[[], object], within_s: float) -> None:
    async with asyncio.timeout(within_s):
        while not condition():  # noqa: ASYNC110 - the condition is anybody's, it sets no event
            await asyncio.sleep(0.02)


@virtual
async def test_several_evaders_are_judged_by_their_own_words_and_by_tracks_and_leave_one_by_one():
    standing = VehicleSpec(position=(0.0, 195.0, 50.0), speed=5.0, tracked=True)
    scenario = msgspec.structs.replace(MEETING, evaders=(standing,))
    async with field(scenario, fourth=Vec(0.0, 195.0, -50.0)) as (station, master, flyers, broker):
        told: list[messages.PhaseChange] = []
        broker.connect().subscribe(
            topics.PHASE.key(GAME), lambda sample: told.append(topics.PHASE.decode(sample.payload, Counter()))
        )
        flyers[2].velocity = Vec(0.0, -0.5, 0.0)  # pursuer 3 comes near the standing evader at 6 s
        await until(lambda: any(phase.out for phase in told), 15.0)
        (end,) = told[-1].out
        assert (end.id, end.verdict, end.captor) == (4, OutcomeResult.CAPTURED, 3)
        assert end.time == pytest.approx(6.0, abs=0.3)
        assert told[-1].phase is Phase.RUNNING
        await until(lambda: master.over, 15.0)
        outcome = station.picture().game.outcome
        assert outcome is not None
        assert [(end.id, end.captor) for end in outcome.evaders] == [(1, 2), (4, 3)]
        assert outcome.time == pytest.approx(9.8, abs=0.02)


@virtual
async def test_a_game_is_staged_started_judged_and_ended_without_the_bridge():
    async with field() as (station, master, _, _):
        await until(lambda: station.picture().game.phase is Phase.READY, 3.0)
        assert {v.id for v in station.picture().vehicles} == {1, 2, 3}
        await until(lambda: station.picture().game.phase is Phase.RUNNING, 3.0)
        assert not master.over
        await until(lambda: station.picture().game.phase is Phase.ENDED, 15.0)
        outcome = station.picture().game.outcome
        assert outcome is not None
        # 100 m at 10 m/s, less the capture radius
        assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, 2)
        assert outcome.time == pytest.approx(9.8, abs=0.02)
        assert master.exit_code == 0
        await until(lambda: station.picture().game.phase is Phase.RECOVERY, 5.0)
        assert master.over


@virtual
async def test_what_comes_late_is_judged_where_it_was():
    async with field(late_s=0.09) as (station, _, _, _):
        await until(lambda: station.picture().game.outcome, 20.0)
        outcome = station.picture().game.outcome
        assert outcome is not None
        assert outcome.time == pytest.approx(9.8, abs=0.02)


@virtual
async def test_the_game_waits_for_a_vehicle_that_is_not_ready_and_names_it():
    async with field() as (station, master, flyers, _):
        flyers[2].stage = AgentStage.WAITING
        await asyncio.sleep(5.0)
        assert station.picture().game.phase is Phase.STAGING
        assert master.status() == "master: vehicle 3: waiting: a fix"
        flyers[2].stage = AgentStage.READY
        await until(lambda: station.picture().game.phase is Phase.RUNNING, 5.0)


@virtual
async def test_who_never_becomes_ready_ends_the_game_with_the_reason():
    async with field() as (station, master, flyers, _):
        flyers[1].silent = True
        await until(lambda: master.over, 40.0)
        outcome = station.picture().game.outcome
        assert outcome is not None
        assert outcome.verdict == OutcomeResult.ABORTED
        assert outcome.reason == "not ready in time: vehicle 2: no agent heard"
        assert master.exit_code == 1


@virtual
async def test_a_game_can_wait_for_the_word_start():
    async with field(auto_start=False) as (station, _, _, broker):
        crews = [AnsweringAgent(broker.connect(), virtual_clock(), i) for i in (1, 2, 3)]
        await asyncio.sleep(30.0)
        assert station.picture().game.phase is Phase.STAGING
        station.command(CommandKind.START, (1, 2, 3))
        await until(lambda: station.picture().game.phase is Phase.RUNNING, 5.0)
        assert all(crew.obeyed for crew in crews)


@virtual
async def test_an_abort_of_everybody_ends_the_game():
    async with field() as (station, master, _, _):
        await until(lambda: station.picture().game.phase is Phase.RUNNING, 8.0)
        await asyncio.sleep(2.0)
        station.command(CommandKind.ABORT, (1, 2))
        await asyncio.sleep(0.5)
        assert station.picture().game.phase is Phase.RUNNING  # not everybody
        station.command(CommandKind.ABORT, station.ids())
        await asyncio.sleep(0.5)
        outcome = station.picture().game.outcome
        assert outcome is not None
        assert (outcome.verdict, outcome.reason) == (OutcomeResult.ABORTED, "abort by anna")
        assert master.exit_code == 1


@virtual
async def test_the_evader_is_judged_by_its_track_when_its_own_word_fails():
    async with field() as (station, _, flyers, _):
        flyers[0].by_track = True
        await until(lambda: station.picture().game.outcome, 20.0)
        outcome = station.picture().game.outcome
        assert outcome is not None
        assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, 2)


BY_TRACK = msgspec.structs.replace(MEETING, evader=msgspec.structs.replace(MEETING.evader, tracked=True))


@virtual
async def test_an_evader_that_is_only_a_track_is_staged_started_and_captured():
    async with field(BY_TRACK) as (station, master, flyers, _):
        flyers[0].only_track = flyers[0].silent = True
        await asyncio.sleep(4.0)
        assert master.status() == "master: vehicle 1: no track heard"
        flyers[0].silent = False
        await until(lambda: station.picture().game.outcome, 20.0)
        outcome = station.picture().game.outcome
        assert outcome is not None
        assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, 2)
        assert outcome.time == pytest.approx(9.8, abs=0.05)
        assert "missing" not in {alert.kind for alert in station.picture().past_alerts}
        assert master.exit_code == 0


@virtual
async def test_a_game_of_which_the_track_is_lost_for_good_ends():
    async with field(BY_TRACK) as (station, _, flyers, _):
        flyers[0].only_track = True
        await until(lambda: station.picture().game.phase is Phase.RUNNING, 10.0)
        flyers[0].silent = True
        await until(lambda: station.picture().game.outcome, 13.0)
        outcome = station.picture().game.outcome
        assert outcome is not None
        assert outcome.reason == "nobody has seen vehicle 1 for 10 s"


@virtual
async def test_a_lost_pursuer_neither_stops_the_referee_nor_captures():
    async with field() as (station, _, flyers, _):
        await until(lambda: station.picture().game.phase is Phase.RUNNING, 8.0)
        await asyncio.sleep(3.0)
        flyers[1].silent = True  # it would have met the evader
        await until(lambda: station.picture().game.outcome, 40.0)
        outcome = station.picture().game.outcome
        assert outcome is not None
        assert outcome.verdict == OutcomeResult.ESCAPED
        assert outcome.time == 30.0


@virtual
async def test_where_there_is_a_master_already_this_one_yields():
    async with field() as (station, master, _, broker):
        other = broker.connect()
        for _ in range(20):
            lease = messages.Master("sim-bridge", virtual_clock().wall_ns(), nonce=1)
            other.publish(*on_bus(lease), topics.MASTER.delivery)
            await asyncio.sleep(0.2)
        assert master.rules.standing is Standing.YIELDED
        assert master.over
        assert master.exit_code == 1
        assert any("another master" in line.text for line in station.picture().log)
        assert station.picture().game.setup is None


@virtual
async def test_who_leaves_in_mid_game_ends_it():
    async with field() as (station, _, _, broker):
        listener = Station(broker.connect(), virtual_clock(), StationSetup(GAME))
        listener.open()
        await until(lambda: station.picture().game.phase is Phase.RUNNING, 8.0)
        await asyncio.sleep(1.0)
    await asyncio.sleep(0.1)
    outcome = listener.picture().game.outcome
    assert outcome is not None
    assert outcome.reason == "the ground station left"


def test_positions_are_put_side_by_side_at_one_instant():
    positions = Positions()
    positions.add(1, Fix(1 * NS_PER_S, Vec(0.0, 0.0, 0.0), Vec(10.0, 0.0, 0.0)))
    positions.add(1, Fix(2 * NS_PER_S, Vec(20.0, 0.0, 0.0), Vec(10.0, 0.0, 0.0)))
    positions.add(1, Fix(1 * NS_PER_S + 5, Vec(99.0, 0.0, 0.0), Vec(0.0, 0.0, 0.0)))  # late: no news
    assert positions.at(1 * NS_PER_S + NS_PER_S // 2) == {1: Vec(10.0, 0.0, 0.0)}
    assert positions.at(2 * NS_PER_S + NS_PER_S // 2) == {1: Vec(25.0, 0.0, 0.0)}
    assert positions.at(3 * NS_PER_S + 1) == {}
    assert positions.at(NS_PER_S // 2) == {}
