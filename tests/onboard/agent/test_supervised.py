"""The supervisor in flight: faults of vehicle, links and strategy, as a person would see them."""

from __future__ import annotations

import asyncio
from itertools import pairwise

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.shell import Agent, Equipment
from onboard.core.math.vectors import distance
from onboard.core.safety.policy import Cause
from onboard.game.scenario import Kind, SensorSpec
from onboard.runtime.impairment import CLEAR, CUT, Impaired
from onboard.runtime.links import memory_pair
from sim_bridge.vehicle.autopilot.health import Fault
from sim_bridge.world.staging import generator
from tests.support.small_scenarios import EVADER, MATE, PURSUER, chase, lossy
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    autopilot,
    flies,
    game_of,
    mode,
    place,
    setpoints_heard,
    speed,
    under_way,
)


def cause(agent: Agent) -> Cause:
    """Why the supervisor does what it does."""
    assert agent.core.flight.output is not None
    return agent.core.flight.output.cause


@virtual
async def test_a_low_battery_sends_the_vehicle_home_for_good() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 2.0)
        autopilot(game, PURSUER).set_battery(0.15)
        await game.forward(4.0, until=lambda: mode(game, PURSUER) == "RTL")
        autopilot(game, PURSUER).set_battery(0.9)
        await game.forward(5.0)
        assert cause(game.agents[PURSUER]) is Cause.BATTERY
        assert mode(game, PURSUER) == "RTL"


@pytest.mark.parametrize(("fault", "expected"), [(Fault.GPS, Cause.GPS), (Fault.EKF, Cause.EKF)])
@virtual
async def test_without_gps_or_a_healthy_estimate_the_stream_ends(fault: Fault, expected: Cause) -> None:
    async with game_of(chase()) as game:
        game.expects(PURSUER, "supervisor_end")
        await under_way(game, 2.0)
        autopilot(game, PURSUER).fail(fault)
        await game.forward(3.0, until=lambda: not flies(game.agents[PURSUER]))
        assert cause(game.agents[PURSUER]) in (expected, Cause.GPS, Cause.EKF, Cause.PILOT)
        assert "supervisor_end" in game.kinds(PURSUER)


@virtual
async def test_who_loses_the_tracks_holds_and_goes_on_when_they_are_back() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 3.0)
        game.bridge.sensor.blind = True
        agent = game.agents[PURSUER]
        await game.forward(60.0, until=lambda: cause(agent) is Cause.TRACKS)
        await game.forward(3.0)
        assert speed(game, PURSUER) < 0.3
        game.bridge.sensor.blind = False
        await game.forward(5.0, until=lambda: flies(agent))


@virtual
async def test_a_strategy_that_fails_ends_the_stream_within_200_ms_and_the_autopilot_stops() -> None:
    async with game_of(chase()) as game:
        game.expects(PURSUER, "strategy", "supervisor_end")
        await under_way(game, 3.0)
        agent = game.agents[PURSUER]

        def fail(view: object) -> None:
            raise ZeroDivisionError("a plug-in of somebody's")

        assert agent.thinker.strategies
        agent.thinker.strategies = dict.fromkeys(agent.thinker.strategies, fail)  # type: ignore[arg-type]
        begun = agent.now
        await game.forward(1.0, until=lambda: not flies(agent))
        assert agent.core.vehicle.sent_at - begun <= 0.2 + 1e-6
        assert cause(agent) is Cause.STRATEGY
        await game.forward(5.0)
        assert speed(game, PURSUER) < 0.3
        assert {"strategy", "supervisor_end"} <= set(game.kinds(PURSUER))
        assert game.health[PURSUER].counters["strategy_failures"] > 10


@virtual
async def test_a_plane_whose_strategy_fails_is_told_to_loiter() -> None:
    async with game_of(chase(Kind.ARDUPLANE)) as game:
        game.expects(PURSUER, "strategy", "supervisor_end")
        await under_way(game, 3.0)
        game.agents[PURSUER].thinker.strategies.clear()
        await game.forward(3.0, until=lambda: mode(game, PURSUER) == "LOITER")


@virtual
async def test_pursuers_that_close_in_on_one_place_keep_apart() -> None:
    async with game_of(chase(pursuers=3, separation=12.0)) as game:
        least = 1e9
        await under_way(game, 1.0)
        for _ in range(150):
            await game.forward(0.2)
            least = min(least, distance(place(game, PURSUER), place(game, MATE)))
        assert least > 9.0


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
        await game.forward(3.0)
        assert flies(agent)
        assert agent.core.radio.active == "second/b"
        assert agent.core.journal.kinds["link"] == 1
        second.change(CUT)
        await game.forward(1.0)
        assert not flies(agent)
        task.cancel()


@virtual
async def test_at_20_percent_loss_no_gap_in_the_stream_reaches_half_a_second() -> None:
    scenario = chase(Kind.ARDUCOPTER, impairment=lossy(0.2), sensor=SensorSpec(rate_hz=5.0))
    async with game_of(scenario) as game:
        heard = setpoints_heard(game, PURSUER)
        await under_way(game, 1.0)
        heard.clear()
        await game.forward(60.0)
        gaps = [(b - a) / 1e9 for a, b in pairwise(heard)]
        assert len(heard) > 0.6 * 20 * 60
        assert max(gaps) < 0.5


