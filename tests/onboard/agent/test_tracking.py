"""A tracker flies its route, with no game and no master."""

from __future__ import annotations

import asyncio

import pytest

from onboard.agent.config import AgentConfig, load
from onboard.agent.shell import Agent, Equipment
from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec, distance
from onboard.game.route_file import load_route
from onboard.game.scenario import Kind
from onboard.wire.bus.messages import Role
from tests.support.small_scenarios import EVADER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import choose_mode, flies, game_of, mode, place

ROUTE = """
name = "round"
nominal = {v}
speed_min = {low}
speed_max = {high}
waypoints = [
  {{ position = [0.0, 0.0, 120.0], time = 0.0 }},
  {{ position = [{a}, 0.0, 120.0], time = 30.0 }},
  {{ position = [{a}, {a}, 120.0], time = 60.0 }},
]
"""
COPTER = ROUTE.format(v=4.0, low=1.0, high=6.0, a=120.0)
PLANE = ROUTE.format(v=40.0, low=30.0, high=50.0, a=1200.0)


@pytest.mark.parametrize(
    ("kind", "text", "near"), [(Kind.ARDUCOPTER, COPTER, 15.0), (Kind.ARDUPLANE, PLANE, 150.0)]
)
@virtual
async def test_a_route_is_flown_in_time_and_the_vehicle_holds_at_its_end(
    tmp_path_factory: pytest.TempPathFactory, kind: Kind, text: str, near: float
) -> None:
    file = tmp_path_factory.mktemp("route") / "route.toml"
    file.write_text(text, encoding="utf-8")
    async with game_of(chase(kind), agents=False) as game:
        config = AgentConfig(id=EVADER, role=Role.TRACKER, route=str(file), take_control=True, game=game.game)
        equipment = Equipment(nonce=3, log=lambda line: None, route=load_route(file))
        agent = Agent(config, game.clock, [game.links[EVADER]], game.broker.connect("t"), equipment)
        task = asyncio.create_task(agent.run())
        scale = 1.0 if kind is Kind.ARDUCOPTER else 10.0
        await game.forward(5.0, until=lambda: flies(agent))
        await game.forward(40.0, until=lambda: "waypoint" in agent.core.journal.kinds)
        assert distance(place(game, EVADER), Vec(120.0 * scale, 0.0, -120.0)) < near
        assert agent.core.flight.decision is not None
        assert agent.core.flight.decision.level == "tactical"
        await game.forward(45.0, until=lambda: agent.core.part.state(0).over)
        assert distance(place(game, EVADER), Vec(120.0 * scale, 120.0 * scale, -120.0)) < near
        await game.forward(3.0, until=lambda: mode(game, EVADER) == "LOITER")
        task.cancel()


@virtual
async def test_a_pilot_takes_the_tracker_over_and_gives_it_back(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    file = tmp_path_factory.mktemp("route") / "route.toml"
    file.write_text(COPTER, encoding="utf-8")
    async with game_of(chase(), agents=False) as game:
        game.expects(EVADER, "supervisor_end")
        config = AgentConfig(
            id=EVADER, role=Role.TRACKER, route=str(file), take_control=True, game=game.game
        )
        equipment = Equipment(nonce=3, log=lambda line: None, route=load_route(file))
        agent = Agent(config, game.clock, [game.links[EVADER]], game.broker.connect("t"), equipment)
        task = asyncio.create_task(agent.run())
        await game.forward(5.0, until=lambda: flies(agent))
        choose_mode(game, EVADER, "LOITER")
        await game.forward(3.0)
        assert not flies(agent)
        choose_mode(game, EVADER, "GUIDED")
        await game.forward(5.0, until=lambda: flies(agent))
        task.cancel()


def test_a_tracker_without_a_route_is_refused() -> None:
    with pytest.raises(ConfigError, match="route: found none, expected a tracker's route file"):
        load(None, {"role": "tracker"})
