"""The supervisor in flight: faults of vehicle, links and strategy, as a person would see them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from itertools import pairwise

import pytest
from msgspec.structs import replace

from onboard.agent.config import AgentConfig
from onboard.agent.core.game_player import GamePlayer
from onboard.agent.shell import Agent, Equipment
from onboard.core.math.vectors import distance
from onboard.core.safety.policy import Cause
from onboard.game.scenario import Kind, SensorSpec
from onboard.runtime.impairment import CLEAR, CUT, Impaired
from onboard.runtime.links import memory_pair
from onboard.wire.bus.messages import Setup
from sim_bridge.vehicle.autopilot.health import Fault
from sim_bridge.world.staging import generator
from tests.support.flights import (
    EVADER,
    MATE,
    PURSUER,
    autopilot,
    chase,
    flies,
    game_of,
    lossy,
    mode,
    passes,
    place,
    speed,
    under_way,
)
from tests.support.virtual import virtual


def cause(agent: Agent) -> Cause:
    """Why the supervisor does what it does."""
    assert agent.core.flight.output is not None
    return agent.core.flight.output.cause


@virtual
async def test_a_low_battery_sends_the_vehicle_home_for_good() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 2.0)
        autopilot(game, PURSUER).set_battery(0.15)
        assert await game.until(lambda: mode(game, PURSUER) == "RTL", 4.0)
        autopilot(game, PURSUER).set_battery(0.9)
        await passes(game, 5.0)
        assert cause(game.agents[PURSUER]) is Cause.BATTERY
        assert mode(game, PURSUER) == "RTL"


@pytest.mark.parametrize(("fault", "expected"), [(Fault.GPS, Cause.GPS), (Fault.EKF, Cause.EKF)])
@virtual
async def test_without_gps_or_a_healthy_estimate_the_stream_ends(fault: Fault, expected: Cause) -> None:
    async with game_of(chase()) as game:
        await under_way(game, 2.0)
        autopilot(game, PURSUER).fail(fault)
        assert await game.until(lambda: not flies(game.agents[PURSUER]), 3.0)
        assert cause(game.agents[PURSUER]) in (expected, Cause.GPS, Cause.EKF, Cause.PILOT)
        assert "supervisor_end" in game.kinds(PURSUER)


@virtual
async def test_who_loses_the_tracks_holds_and_goes_on_when_they_are_back() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 3.0)
        sense, game.bridge.sensor.step = game.bridge.sensor.step, lambda wall_ns, motions: []  # type: ignore[method-assign]
        agent = game.agents[PURSUER]
        assert await game.until(lambda: cause(agent) is Cause.TRACKS, 60.0)
        await passes(game, 3.0)
        assert speed(game, PURSUER) < 0.3
        game.bridge.sensor.step = sense  # type: ignore[method-assign]
        assert await game.until(lambda: flies(agent), 5.0)


@virtual
async def test_a_strategy_that_fails_ends_the_stream_within_200_ms_and_the_autopilot_stops() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 3.0)
        agent = game.agents[PURSUER]

        def fail(view: object) -> None:
            raise ZeroDivisionError("a plug-in of somebody's")

        assert agent.thinker.strategies
        agent.thinker.strategies = dict.fromkeys(agent.thinker.strategies, fail)  # type: ignore[arg-type]
        begun = agent.now
        assert await game.until(lambda: not flies(agent), 1.0)
        assert agent.core.vehicle.sent_at - begun <= 0.2 + 1e-6
        assert cause(agent) is Cause.STRATEGY
        await passes(game, 5.0)
        assert speed(game, PURSUER) < 0.3
        assert {"strategy", "supervisor_end"} <= set(game.kinds(PURSUER))
        assert game.health[PURSUER].counters["strategy_failures"] > 10


@virtual
async def test_a_plane_whose_strategy_fails_is_told_to_loiter() -> None:
    async with game_of(chase(Kind.ARDUPLANE)) as game:
        await under_way(game, 3.0)
        game.agents[PURSUER].thinker.strategies.clear()
        assert await game.until(lambda: mode(game, PURSUER) == "LOITER", 3.0)


@virtual
async def test_pursuers_that_close_in_on_one_place_keep_apart() -> None:
    scenario = chase(pursuers=3)
    async with game_of(scenario, configure={2: {}, 3: {}}) as game:
        least = 1e9
        for agent in game.agents.values():
            assert agent.core.game is not None
            agent.core.game._consider = wide(agent.core.game, 12.0)  # type: ignore[method-assign]
        await under_way(game, 1.0)
        for _ in range(150):
            await passes(game, 0.2)
            least = min(least, distance(place(game, PURSUER), place(game, MATE)))
        assert least > 9.0


def wide(player: GamePlayer, separation: float) -> Callable[[Setup, str], None]:
    """The setup with a separation."""
    consider = player._consider
    return lambda setup, error: consider(
        replace(setup, rules=replace(setup.rules, separation=separation)), error
    )


@virtual
async def test_with_two_links_the_second_takes_over_and_no_frame_counts_twice() -> None:
    async with game_of(chase(), agents=False) as game:
        game.start_agent(EVADER)
        near, far = memory_pair("second")
        game.bridge.world.add_link(PURSUER, near)
        second = Impaired(far, CLEAR, generator(1, "second"))
        config = AgentConfig(id=PURSUER, game=game.game, take_control=True)
        agent = Agent(
            config, game.clock, [game.links[PURSUER], second], game.broker.connect("two"),
            Equipment(nonce=5, log=lambda line: None),
        )  # fmt: skip
        task = asyncio.create_task(agent.run())
        await under_way(game, 3.0)
        assert flies(agent)
        assert agent.core.vehicle.position_rate.value == pytest.approx(20.0, abs=1.5)
        game.impair(PURSUER, CUT)
        await passes(game, 3.0)
        assert flies(agent)
        assert agent.core.radio.active == "second/b"
        assert agent.core.journal.kinds["link"] == 1
        second.change(CUT)
        await passes(game, 1.0)
        assert not flies(agent)
        task.cancel()


@virtual
async def test_at_20_percent_loss_no_gap_in_the_stream_reaches_half_a_second() -> None:
    scenario = chase(Kind.ARDUCOPTER, impairment=lossy(0.2), sensor=SensorSpec(rate_hz=5.0))
    async with game_of(scenario) as game:
        heard: list[int] = []
        vehicle = game.bridge.world.vehicles[PURSUER]
        receive = vehicle.autopilot.receive

        def listening(now_ns: int, data: bytes, peer: object) -> None:
            if data[7] == 84:  # SET_POSITION_TARGET_LOCAL_NED
                heard.append(now_ns)
            receive(now_ns, data, peer)  # type: ignore[arg-type]

        vehicle.autopilot.receive = listening  # type: ignore[method-assign]
        await under_way(game, 1.0)
        heard.clear()
        await passes(game, 60.0)
        gaps = [(b - a) / 1e9 for a, b in pairwise(heard)]
        assert len(heard) > 0.6 * 20 * 60
        assert max(gaps) < 0.5


