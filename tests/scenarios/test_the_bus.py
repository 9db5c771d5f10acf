"""Whole games on a bus that is not there, dies and returns, and with masters and agents that are too many."""

from __future__ import annotations

import asyncio

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.shell import Agent, Equipment
from onboard.core.math.vectors import Vec
from onboard.runtime.links import memory_pair
from onboard.wire.bus.messages import Phase, Role
from sim_bridge.world.bridge import Bridge
from tests.support.duels import STORY, at_phase, duel, phases
from tests.support.flights import EVADER, PURSUER, chase, flies, game_of, mode, passes, place, under_way
from tests.support.virtual import virtual


@pytest.mark.game
@virtual
async def test_the_game_ends_while_the_bus_is_dead_and_all_learn_of_it_when_it_is_back() -> None:
    async with game_of(duel()) as game:
        await under_way(game, 1.0)
        game.broker.kill()
        await at_phase(game, Phase.ENDED, 20.0)
        assert game.outcome is not None
        assert game.outcome.verdict == "captured"
        await passes(game, 1.0)
        assert flies(game.agents[EVADER]), "nobody has told it: it flies on"
        assert "running" in phases(game, EVADER)[-1]
        game.broker.restore()
        assert await game.until(lambda: phases(game, PURSUER)[-1:] == ["recovery"], 6.0)
        await passes(game, 2.0)
        assert [mode(game, id) for id in (EVADER, PURSUER)] == ["LOITER", "LOITER"]
        assert game.kinds(EVADER).count("bus") == 2


@virtual
async def test_a_bus_that_comes_ten_seconds_late_delays_the_game_and_no_more() -> None:
    async with game_of(duel(horizon=1.0)) as game:
        game.broker.kill()
        await passes(game, 10.0)
        for agent in game.agents.values():
            assert agent.core.stage == "waiting"
            assert {"the bus", "a game's setup", "a master"} <= set(agent.core.lacks)
        assert game.phase is Phase.STAGING
        game.broker.restore()
        await under_way(game, 0.5)
        assert phases(game, PURSUER) == STORY[:3]
        assert all(flies(agent) for agent in game.agents.values())


@virtual
async def test_with_two_agents_of_one_id_no_game_begins_until_one_of_them_is_stopped() -> None:
    async with game_of(chase()) as game:
        near, _ = memory_pair("another aircraft")
        config = AgentConfig(id=PURSUER, game=game.game, role=Role.PURSUER)
        twin = Agent(config, game.clock, [near], game.broker.connect("twin"),
                     Equipment(nonce=99, log=game.told.append))  # fmt: skip
        task = asyncio.create_task(twin.run())
        await passes(game, 15.0)
        assert game.phase is Phase.STAGING
        assert game.master.lacking(game.clock.monotonic_ns()) == {PURSUER: "two agents with this id"}
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
        second = Bridge(chase(), game.clock, bus, {}, nonce=1, game=game.game, say=said.append)
        task = asyncio.create_task(second.run())
        before = place(game, EVADER)
        await passes(game, 6.0)
        assert said == ["another master is at work: sim-bridge; this one yields and publishes no game"]
        assert all(flies(agent) for agent in game.agents.values())
        assert phases(game, EVADER) == STORY[:3]
        assert place(game, EVADER).x > before.x + 20.0
        task.cancel()


@virtual
async def test_a_game_that_one_agent_cannot_play_is_given_up_with_the_reason() -> None:
    scenario = chase(timeout_s=6.0)
    async with game_of(scenario, configure={PURSUER: {"role": Role.EVADER}}) as game:
        await at_phase(game, Phase.ENDED, 12.0)
        assert game.outcome is not None
        assert game.outcome.verdict == "aborted"
        assert "vehicle 2: waiting: a setup that fits: the setup says pursuer" in game.outcome.reason
        assert "setup_refused" in game.kinds(PURSUER)
        assert [mode(game, id) for id in (EVADER, PURSUER)] == ["LOITER", "LOITER"]
        assert place(game, EVADER) == Vec(0.0, 0.0, -120.0)
