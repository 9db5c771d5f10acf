"""From a scenario to what is flown."""

from __future__ import annotations

from pathlib import Path

import pytest

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec, norm, yaw_of
from onboard.game.scenario import Flight, Kind, Scenario, VehicleSpec, WindSpec
from onboard.runtime.clock import VirtualClock
from sim_bridge.vehicle.motion import CALM
from sim_bridge.world.staging import calm, generator, starts, wind_of
from sim_bridge.world.world import World


def windy(**wind: object) -> Scenario:
    return Scenario(
        name="windy",
        evader=VehicleSpec(position=(0.0, 0.0, 300.0), speed=20.0, target=(0.0, 900.0, 300.0)),
        pursuers=(VehicleSpec(position=(500.0, 0.0, 300.0), speed=22.0, heading_deg=90.0),),
        flight=Flight(autopilot=Kind.ARDUPLANE, wind=WindSpec(**wind)),  # type: ignore[arg-type]
    )


def test_planes_start_at_their_airspeed_in_the_air_that_is_there() -> None:
    scenario = windy(speed=5.0, from_deg=0.0)
    motions = starts(scenario, wind_of(scenario, 3))
    assert yaw_of(motions[1].velocity._replace(x=0.0)) == motions[1].yaw == yaw_of(Vec(0.0, 1.0, 0.0))
    for id, speed in ((1, 20.0), (2, 22.0)):
        air = Vec(motions[id].velocity.x + 5.0, motions[id].velocity.y, motions[id].velocity.z)
        assert norm(air) == pytest.approx(speed)
        assert motions[id].airspeed == speed


def test_no_wind_asked_for_is_calm() -> None:
    assert wind_of(windy(), 3) is calm
    assert calm(1, starts(windy(), calm)[1], 0.0) is CALM


def test_gusts_come_from_the_seed() -> None:
    def ride(seed: int) -> list[Vec]:
        scenario = windy(speed=5.0, gust_sigma=3.0)
        clock = VirtualClock(0)
        world = World(scenario, clock, {}, wind=wind_of(scenario, seed))
        gusts = []
        for second in range(1, 20):
            clock.advance_to(second * 1_000_000_000)
            for _ in range(2):  # one call makes up for half a second at most
                world.step()
            gusts.append(world.vehicles[1].air.gust)
        return gusts

    assert ride(1) == ride(1)
    assert ride(1) != ride(2)


def test_a_recorded_wind_that_is_not_there_is_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"none\.csv"):
        wind_of(windy(recorded="none.csv"), 3, tmp_path)


def test_concerns_do_not_share_their_luck() -> None:
    first = generator(1, "sensor").random(4).tolist()
    assert first == generator(1, "sensor").random(4).tolist()
    assert first != generator(1, "links").random(4).tolist()
    assert first != generator(2, "sensor").random(4).tolist()
