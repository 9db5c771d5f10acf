"""The bridge on the bus: tracks for those who need them, one master, a game from staging to recovery."""

from __future__ import annotations

import asyncio
from collections import Counter

import pytest
from msgspec.structs import replace

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Flight, Kind, Parameters, Scenario, SensorSpec, VehicleSpec
from onboard.game.staging import setup_of
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.protocols import Bus
from onboard.wire.bus.messages import Outcome, OutcomeResult, Phase, Role
from onboard.wire.bus.topics import (
    EVADER_BRIEF,
    MASTER,
    OUTCOME,
    SETUP,
    TOPICS,
    TRACK,
    everything,
)
from sim_bridge.world.bridge import Bridge, Options
from tests.support.bus_stages import Heard
from tests.support.real_time import until
from tests.support.scripted_agents import ScriptedAgent, for_a_while
from tests.support.virtual_time import virtual

GAME = "range"


def scenario(**changes: object) -> Scenario:
    """A hovering evader and two hovering pursuers, 30 m and 60 m away."""
    fields: dict[str, object] = dict(
        name="hover",
        evader=VehicleSpec(position=(0.0, 0.0), speed=4.0, target=(80.0, 0.0)),
        pursuers=(VehicleSpec(position=(30.0, 0.0), speed=5.0), VehicleSpec(position=(0.0, 60.0), speed=5.0)),
        parameters=Parameters(horizon=6.0),
        flight=Flight(autopilot=Kind.ARDUCOPTER, ready_s=2.0, sensor=SensorSpec(rate_hz=10, sigma=0.5)),
        seed=11,
    )
    return Scenario(**(fields | changes))  # type: ignore[arg-type]


class Stage:
    """Broker, bridge and agents in one process."""

    def __init__(self, played: Scenario, *, nonce: int = 5) -> None:
        self.clock = virtual_clock()
        self.broker = MemoryBroker()
        self.news: list[str] = []
        self.observer: Bus = self.broker.connect("observer")
        self.heard = Heard(self.observer, everything(GAME))
        self.scenario = played
        self.bridge = self.another(nonce)
        self.agents = {
            id: ScriptedAgent(self.broker.connect(str(id)), self.clock, GAME, id) for id in played.ids
        }

    def another(self, nonce: int) -> Bridge:
        bus = self.broker.connect("bridge")
        return Bridge(self.scenario, self.clock, bus, {}, Options(nonce, GAME), self.news.append)

    async def play(self, seconds: float) -> None:
        await for_a_while(seconds, self.bridge.run(), *(agent.run() for agent in self.agents.values()))

    def payloads(self, wanted: str) -> list[bytes]:
        return [sample.payload for sample in self.heard.samples if sample.key == wanted]


@virtual
async def test_a_whole_game_from_staging_to_recovery() -> None:
    stage = Stage(scenario())
    await stage.play(20.0)
    assert [p.phase for p in stage.agents[2].phases] == [
        Phase.STAGING, Phase.READY, Phase.RUNNING, Phase.ENDED, Phase.RECOVERY,
    ]  # fmt: skip
    outcome = OUTCOME.decode(stage.payloads(OUTCOME.key(GAME))[0], Counter())
    assert isinstance(outcome, Outcome)
    assert (outcome.verdict, outcome.time, outcome.captor) == (OutcomeResult.DENIED, 6.0, 0)
    assert outcome.smallest_distance == pytest.approx(30.0, abs=0.1)
    assert stage.bridge.master is not None
    assert stage.bridge.master.rules.nearest == pytest.approx({2: 30.0, 3: 60.0}, abs=0.1)
    assert stage.news[-2:] == ["ended: denied", "recovery"]
    assert not stage.bridge.master.drops


@virtual
async def test_the_setup_says_everything_but_the_target() -> None:
    stage = Stage(scenario())
    await stage.play(2.0)
    late = stage.broker.connect("late")
    setups, briefs = Heard(late, SETUP.key(GAME)), Heard(late, EVADER_BRIEF.key(GAME))
    await until(lambda: setups.samples and briefs.samples)
    setup = SETUP.decode(setups.payloads[0], Counter())
    assert setup is not None
    assert setup == replace(setup_of(scenario(), GAME, "sim-bridge"), nonce=setup.nonce)
    assert [(m.id, m.role, m.speed) for m in setup.roster] == [
        (1, Role.EVADER, 4.0), (2, Role.PURSUER, 5.0), (3, Role.PURSUER, 5.0),
    ]  # fmt: skip
    assert setup.roster[1].start == (30.0, 0.0, -50.0)  # a plane game is flown at its height
    brief = EVADER_BRIEF.decode(briefs.payloads[0], Counter())
    assert brief is not None
    assert brief.target == (80.0, 0.0, -50.0)
    assert [TOPICS.find(sample.key).topic for sample in stage.heard.samples].count(EVADER_BRIEF) == 1


@virtual
async def test_tracks_of_everybody_come_at_the_sensors_rate() -> None:
    stage = Stage(scenario())
    await stage.play(5.0)
    for id in stage.scenario.ids:
        tracks = [TRACK.decode(payload, Counter()) for payload in stage.payloads(TRACK.key(GAME, id))]
        assert 49 <= len(tracks) <= 51
        truth = stage.bridge.world.motions[id].position
        last = tracks[-1]
        assert last is not None
        assert last.id == id
        assert 0.0 < abs(last.position[0] - truth.x) < 3.0
    tracked = {
        TOPICS.find(sample.key).id for sample in stage.heard.samples if TOPICS.find(sample.key).topic is TRACK
    }
    assert tracked == {1, 2, 3}


@virtual
async def test_a_second_bridge_yields_and_its_world_goes_on() -> None:
    stage = Stage(scenario())
    await stage.play(2.0)
    second = stage.another(nonce=1)
    await for_a_while(4.0, second.run(), stage.bridge.run())
    assert "another master is at work: sim-bridge; this one yields and publishes no game" in stage.news
    masters = [MASTER.decode(payload, Counter()) for payload in stage.payloads(MASTER.key(GAME))]
    assert {m.nonce for m in masters if m} == {5}
    assert second.world.elapsed_ns >= 3 * NS_PER_S


@virtual
async def test_an_agent_started_again_mid_game_gets_the_masters_word() -> None:
    stage = Stage(scenario(parameters=Parameters(horizon=60.0)))
    await stage.play(6.0)
    del stage.agents[3]
    await stage.play(3.0)
    reborn = ScriptedAgent(stage.broker.connect("3 again"), stage.clock, GAME, 3, nonce=77)
    stage.agents[3] = reborn
    await asyncio.sleep(0.01)
    assert [(p.phase, p.resume) for p in reborn.phases] == [(Phase.RUNNING, ())]
    before = reborn.acting
    await stage.play(3.0)
    assert (before, reborn.acting) == (False, True)  # not by the phase it found, but by the master's word
    assert [p.resume for p in reborn.phases] == [(), (3,), ()]


@virtual
async def test_a_broker_that_dies_and_returns_does_not_end_the_game() -> None:
    stage = Stage(scenario(parameters=Parameters(horizon=60.0)))
    await stage.play(6.0)
    stage.broker.kill()
    await stage.play(4.0)
    stage.broker.restore()
    await stage.play(4.0)
    assert "agent 2 is silent" in stage.news
    assert "agent 2 is back" in stage.news
    assert stage.bridge.master is not None
    assert stage.bridge.master.rules.phase is Phase.RUNNING
    late = Heard(stage.broker.connect("late"), SETUP.key(GAME))
    await until(lambda: late.samples)


@virtual
async def test_payloads_that_are_no_messages_are_counted_and_change_nothing() -> None:
    stage = Stage(scenario())
    for payload in (b"", b"\xc1", b"\x92\x02\x90", b"\x92\x01\x90"):
        stage.observer.publish(f"apollonius/{GAME}/vehicles/2/health", payload, TRACK.delivery)
        stage.observer.publish(f"apollonius/{GAME}/game/master", payload, TRACK.delivery)
        await stage.play(0.1)
    await stage.play(20.0)
    assert stage.bridge.master is not None
    assert stage.bridge.master.drops == {"undecodable": 6, "schema": 2}
    assert stage.news[-1] == "recovery"


def test_the_same_seed_publishes_the_same_bytes() -> None:
    async def run(seed: int) -> list[tuple[str, bytes]]:
        stage = Stage(scenario(seed=seed))
        await stage.play(8.0)
        return [(sample.key, sample.payload) for sample in stage.heard.samples]

    first = run_virtual(run(1))
    assert first == run_virtual(run(1))
    assert first != run_virtual(run(2))
    assert len(first) > 200


@virtual
async def test_ground_positions_decide_not_what_tracks_say() -> None:
    stage = Stage(scenario(flight=Flight(ready_s=1.0, sensor=SensorSpec(sigma=40.0))))
    await stage.play(12.0)
    outcome = OUTCOME.decode(stage.payloads(OUTCOME.key(GAME))[0], Counter())
    assert outcome is not None
    assert outcome.verdict == OutcomeResult.DENIED
    assert stage.bridge.world.motions[1].position == pytest.approx(Vec(0.0, 0.0, -50.0), abs=0.5)
