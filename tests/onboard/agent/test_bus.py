"""The agent and its bus: what it may know, who is the master, clocks, and a bus that comes and goes."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest
from msgspec.structs import replace

from onboard.agent.config import AgentConfig
from onboard.agent.shell import Agent, Equipment
from onboard.config.strict import convert
from onboard.runtime.clock import SkewedClock
from onboard.runtime.links import memory_pair
from onboard.runtime.patterns import matches
from onboard.wire.autopilot_kind import Kind
from onboard.wire.bus import messages, topics
from onboard.wire.bus.messages import AgentStage, Master, Role, Track
from onboard.wire.bus.topics import DECISION, EVADER_BRIEF, MASTER, SETUP, STATE, TRACK
from tests.support.small_scenarios import EVADER, MATE, PURSUER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import flies, game_of, under_way


@virtual
async def test_no_agent_listens_to_an_opponents_state_or_to_the_evaders_brief() -> None:
    async with game_of(chase(pursuers=2)) as game:
        asked: dict[int, list[str]] = {}
        await under_way(game, 1.0)
        secrets = {
            EVADER: [STATE.key(game.game, PURSUER), STATE.key(game.game, MATE)],
            PURSUER: [STATE.key(game.game, EVADER), EVADER_BRIEF.key(game.game)],
            MATE: [STATE.key(game.game, EVADER), EVADER_BRIEF.key(game.game)],
        }
        for id, agent in game.agents.items():
            asked[id] = [listener.pattern for listener in agent.bus.listeners]  # type: ignore[attr-defined]
            assert sorted(asked[id]) == sorted(agent.core.bus.keys())
            for secret in secrets[id]:
                assert not any(matches(pattern, secret) for pattern in asked[id]), (id, secret)
                for decision in (DECISION.key(game.game, EVADER), DECISION.key(game.game, PURSUER)):
                    assert not any(matches(pattern, decision) for pattern in asked[id])
        assert any(matches(p, STATE.key(game.game, MATE)) for p in asked[PURSUER])
        assert any(matches(p, EVADER_BRIEF.key(game.game)) for p in asked[EVADER])


@virtual
async def test_the_setpoint_leaves_before_anything_is_published() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 2.0)
        agent = game.agents[PURSUER]
        order: list[str] = []
        for kind, do in dict(agent._effects).items():

            def doing(effect: Any, kind: type = kind, do: Any = do) -> None:
                order.append(kind.__name__)
                do(effect)

            agent._effects[kind] = doing
        await game.forward(2.0)
        steps = " ".join(order).split("Beat")[1:-1]
        assert len(steps) > 30
        for step in steps:  # from the end of one control step to the end of the next
            words = step.split()
            assert words.index("Publish") < words.index("Think")
            assert "Send" in words[words.index("Think") :]
            assert "Publish" not in words[words.index("Think") :]


@virtual
async def test_an_agent_with_no_game_waits_visibly_and_names_what_it_lacks() -> None:
    async with game_of(chase(), agents=False) as game:
        game.bridge.master.step = lambda motions: None  # type: ignore[union-attr,method-assign]
        agent = game.start_agent(PURSUER)
        await game.forward(5.0)
        health = game.health[PURSUER]
        assert health.stage == AgentStage.WAITING
        assert "a game's setup" in health.lacks
        assert "a master" in health.lacks
        assert health.autopilot is Kind.ARDUCOPTER
        assert not flies(agent)


@virtual
async def test_without_an_autopilot_of_its_own_number_it_says_which_it_hears() -> None:
    async with game_of(chase(), agents=False) as game:
        game.expects(9, "setup_refused")
        other = Agent(
            AgentConfig(id=9, game=game.game), game.clock, [game.links[EVADER]], game.broker.connect("nine"),
            Equipment(nonce=9, log=lambda line: None),
        )  # fmt: skip
        task = asyncio.create_task(other.run())
        await game.forward(3.0)
        assert any("system 1" in lack for lack in other.core.lacks)
        assert other.core.vehicle.counters()["foreign_system"] > 10
        task.cancel()


CONTRADICTIONS: list[tuple[dict[str, Any], str]] = [
    ({"role": Role.EVADER}, "the setup says pursuer, the configuration says evader"),
    ({"strategy": "no-such"}, "strategy: found 'no-such', expected one of"),
    ({"envelope": {"speed_max": 3.0}}, "the setup wants 4 m/s, this vehicle is configured for 3 m/s"),
]


@pytest.mark.parametrize(("settings", "reason"), CONTRADICTIONS)
@virtual
async def test_a_setup_that_contradicts_the_configuration_is_refused_with_the_reason(
    settings: dict[str, Any], reason: str
) -> None:
    plain = {k: (v.value if isinstance(v, Role) else v) for k, v in settings.items()}
    full = convert({"id": 2, **plain}, AgentConfig, "test")
    given = {k: getattr(full, k) for k in settings}
    async with game_of(chase(), configure={PURSUER: given}) as game:
        game.expects(PURSUER, "setup_refused")
        await game.forward(4.0)
        assert "setup_refused" in game.kinds(PURSUER)
        assert any(reason in event.text for event in game.events)
        assert any(reason in lack for lack in game.health[PURSUER].lacks)
        assert not flies(game.agents[PURSUER])


def skewed(offset_s: float) -> Callable[[Any, Any], Agent]:
    """An agent whose wall clock is off."""

    def make(game: Any, clock: Any) -> Agent:
        config = AgentConfig(id=PURSUER, game=game.game, take_control=True)
        wrong = SkewedClock(clock, round(offset_s * 1e9))
        return Agent(config, wrong, [game.links[PURSUER]], game.broker.connect("skewed"),
                     Equipment(nonce=7, log=lambda line: None))  # fmt: skip

    return make


@pytest.mark.parametrize(
    ("offset", "alert", "ready"),
    [(0.03, False, True), (0.12, True, True), (-0.12, True, True), (0.3, True, False)],
)
@virtual
async def test_a_clock_off_is_an_alert_and_far_off_not_ready(offset: float, alert: bool, ready: bool) -> None:
    async with game_of(chase(), agents=False) as game:
        agent = skewed(offset)(game, game.clock)
        task = asyncio.create_task(agent.run())
        await game.forward(6.0)
        assert agent.core.bus.clock.offset_s == pytest.approx(offset, abs=0.02)
        assert ("clock_offset" in agent.core.journal.kinds) == alert
        assert any("a clock that agrees" in lack for lack in agent.core.lacks) != ready
        task.cancel()


@virtual
async def test_a_jump_of_the_clock_makes_it_hold_and_say_so() -> None:
    async with game_of(chase()) as game:
        game.expects(PURSUER, "clock_jump")
        await under_way(game, 3.0)
        agent = game.agents[PURSUER]
        agent.clock = SkewedClock(game.clock, 700_000_000)  # type: ignore[arg-type]
        await game.forward(0.3)
        assert "clock_jump" in game.kinds(PURSUER)
        assert not flies(agent)


@virtual
async def test_two_agents_with_one_id_are_reported() -> None:
    async with game_of(chase(pursuers=2)) as game:
        game.expects(PURSUER, "double_id")
        await under_way(game, 1.0)
        near, _ = memory_pair("nowhere")
        twin = Agent(
            AgentConfig(id=PURSUER, game=game.game), game.clock, [near], game.broker.connect("twin"),
            Equipment(nonce=99, log=lambda line: None),
        )  # fmt: skip
        task = asyncio.create_task(twin.run())
        await game.forward(2.0)
        assert "double_id" in game.kinds(PURSUER)
        assert twin.core.journal.kinds["double_id"] == 1
        task.cancel()


@virtual
async def test_two_masters_are_reported_and_the_first_ones_clock_counts() -> None:
    async with game_of(chase()) as game:
        for id in game.scenario.ids:
            game.expects(id, "two_masters")
        await under_way(game, 1.0)
        for _ in range(8):
            wrong = Master("usurper", game.clock.wall_ns() - 10**10, 2.0, 1 << 48)
            game.bus.publish(MASTER.key(game.game), topics.MASTER.encode(wrong), MASTER.delivery)
            await game.forward(0.25)
        agent = game.agents[PURSUER]
        assert game.kinds(PURSUER).count("two_masters") == 1
        assert abs(agent.core.bus.clock.offset_s) < 0.05
        assert flies(agent)


@virtual
async def test_a_setup_from_another_than_the_master_is_ignored() -> None:
    async with game_of(chase()) as game:
        for id in game.scenario.ids:
            game.expects(id, "two_masters")
        await under_way(game, 1.0)
        agent = game.agents[PURSUER]
        assert agent.core.bus.setup is not None
        other = replace(agent.core.bus.setup, master="usurper", rules=messages.RulesMessage(99.0, 199.0))
        game.bus.publish(SETUP.key(game.game), topics.SETUP.encode(other), SETUP.delivery)
        await game.forward(1.0)
        assert agent.core.bus.setup.master == "sim-bridge"
        assert "two_masters" in game.kinds(PURSUER)
        assert flies(agent)


@virtual
async def test_a_bus_that_dies_and_returns_in_flight() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 3.0)
        agent = game.agents[PURSUER]
        game.broker.kill()
        await game.forward(4.0)
        assert agent.core.lacks.count("the bus") == 1
        game.broker.restore()
        await game.forward(3.0)
        assert game.kinds(PURSUER).count("bus") == 2
        assert flies(agent)


@virtual
async def test_a_bus_that_comes_after_the_agent() -> None:
    async with game_of(chase(), agents=False) as game:
        game.broker.kill()
        agent = game.start_agent(PURSUER)
        game.start_agent(EVADER)
        await game.forward(3.0)
        assert "the bus" in agent.core.lacks
        game.broker.restore()
        await under_way(game, 2.0)
        assert flies(agent)


@virtual
async def test_garbage_on_the_bus_is_counted_by_cause_and_changes_nothing() -> None:
    async with game_of(chase(pursuers=2)) as game:
        await under_way(game, 1.0)
        agent = game.agents[PURSUER]
        position = (0.0, 0.0, 0.0)
        foreign = Track(MATE, game.clock.wall_ns(), position, position, (1.0,) * 6)  # type: ignore[arg-type]
        nan = Track(EVADER, 0, (float("nan"), 0.0, 0.0), position, (1.0,) * 6)  # type: ignore[arg-type]
        bus = game.bus
        bus.publish(TRACK.key(game.game, EVADER), b"\xff\x00\x01", TRACK.delivery)
        bus.publish(TRACK.key(game.game, EVADER), topics.TRACK.encode(nan), TRACK.delivery)
        bus.publish(TRACK.key(game.game, EVADER), topics.TRACK.encode(foreign), TRACK.delivery)
        bus.publish(SETUP.key(game.game), b"\x92\x63\x90", SETUP.delivery)
        await game.forward(1.0)
        assert agent.core.bus.drops["undecodable"] == 1
        assert agent.core.bus.drops["not_finite"] == 1
        assert agent.core.bus.drops["wrong_id"] == 1
        assert agent.core.bus.drops["schema"] == 1
        assert game.health[PURSUER].counters["wrong_id"] == 1
        assert flies(agent)


@virtual
async def test_garbage_on_the_link_is_counted_and_shown_in_health() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 1.0)
        vehicle = game.bridge.world.vehicles[PURSUER]
        for link in vehicle.links:
            link.send(b"\x00\x01\x02nothing")
            link.send(bytes([0xFD, 9, 0, 0, 1, 9, 1, 0, 0, 0]) + bytes(11))
            link.send(bytes([0xFD, 9, 0, 0]))
        await game.forward(1.0)
        counters = game.health[PURSUER].counters
        assert counters["garbage_bytes"] >= 10
        assert counters["bad_crc"] >= 1
        assert counters["truncated"] >= 1
        assert flies(game.agents[PURSUER])
