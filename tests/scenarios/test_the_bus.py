"""Whole games on a bus that is not there, dies and returns, and with masters and agents that are too many."""

from __future__ import annotations

import asyncio

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.shell import Agent, Equipment
from onboard.core.math.vectors import Vec
from onboard.runtime.links import memory_pair
from onboard.wire.bus.messages import AgentStage, OutcomeResult, Phase, Role
from sim_bridge.world.bridge import Bridge, Options
from tests.support.small_scenarios import EVADER, PURSUER, chase, duel
from tests.support.virtual_time import virtual
from tests.support.whole_games import STORY, at_phase, flies, game_of, mode, phases, place, under_way


@pytest.mark.game
@virtual
async def test_the_game_ends_while_the_bus_is_dead_and_all_learn_of_it_when_it_is_back() -> None:
    async with game_of(duel()) as game:
        await under_way(game, 1.0)
        game.broker.kill()
        await at_phase(game, Phase.ENDED, 20.0)
        assert game.outcome is not None
        assert game.outcome.verdict == OutcomeResult.CAPTURED
        await game.forward(1.0)
        assert flies(game.agents[EVADER]), "nobody has told it: it flies on"
        assert "running" in phases(game, EVADER)[-1]
        game.broker.restore()
        await game.forward(6.0, until=lambda: phases(game, PURSUER)[-1:] == ["recovery"])
        await game.forward(2.0)
        assert [mode(game, id) for id in (EVADER, PURSUER)] == ["LOITER", "LOITER"]
        assert game.kinds(EVADER).count("bus") == 2


@virtual
async def test_a_bus_that_comes_ten_seconds_late_delays_the_game_and_no_more() -> None:
    async with game_of(duel(horizon=1.0)) as game:
        game.broker.kill()
        await game.forward(10.0)
        for agent in game.agents.values():
            assert agent.core.stage == AgentStage.WAITING
            assert {"the bus", "a game's setup", "a master"} <= set(agent.core.lacks)
        assert game.phase is Phase.STAGING
        game.broker.restore()
        await under_way(game, 0.5)
        assert phases(game, PURSUER) == STORY[:3]
        assert all(flies(agent) for agent in game.agents.values())


@virtual
async def test_with_two_agents_of_one_id_no_game_begins_until_one_of_them_is_stopped() -> None:
    async with game_of(chase()) as game:
        game.expects(PURSUER, "double_id")
        near, _ = memory_pair("another aircraft")
        config = AgentConfig(id=PURSUER, game=game.game, role=Role.PURSUER)
        twin = Agent(config, game.clock, [near], game.broker.connect("twin"),
                     Equipment(nonce=99, log=game.told.append))  # fmt: skip
        task = asyncio.create_task(twin.run())
        await game.forward(15.0)
        assert game.phase is Phase.STAGING
        assert game.master.lacking(game.clock.wall_ns(), game.clock.monotonic_ns()) == {
            PURSUER: "two agents with this id"
        }
        assert {"double_id"} <= set(game.kinds(PURSUER))
        twin.stop()
        await task
        await under_way(game, 1.0)
        assert all(flies(agent) for agent in game.agents.values())


@virtual
async def test_a_second_bridge_that_joins_a_running_game_yields_and_changes_nothing() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 1.0)
        said: list[str] = []
        bus = game.broker.connect("second bridge")
        second = Bridge(chase(), game.clock, bus, {}, Options(1, game.game), said.append)
        task = asyncio.create_task(second.run())
        before = place(game, EVADER)
        await game.forward(6.0)
        assert said == ["another master is at work: sim-bridge; this one yields and publishes no game"]
        assert all(flies(agent) for agent in game.agents.values())
        assert phases(game, EVADER) == STORY[:3]
        assert place(game, EVADER).x > before.x + 20.0
        task.cancel()


@virtual
async def test_a_game_that_one_agent_cannot_play_is_given_up_with_the_reason() -> None:
    scenario = chase(timeout_s=6.0)
    async with game_of(scenario, configure={PURSUER: {"role": Role.EVADER}}) as game:
        game.expects(PURSUER, "setup_refused")
        game.expects_abort()
        await at_phase(game, Phase.ENDED, 12.0)
        assert game.outcome is not None
        assert game.outcome.verdict == OutcomeResult.ABORTED
        assert "vehicle 2: waiting: a setup that fits: the setup says pursuer" in game.outcome.reason
        assert "setup_refused" in game.kinds(PURSUER)
        assert [mode(game, id) for id in (EVADER, PURSUER)] == ["LOITER", "LOITER"]
        assert place(game, EVADER) == Vec(0.0, 0.0, -120.0)
