"""Flown games with zones: by the true motion of every simulated vehicle nobody enters one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import pytest

from onboard.core.geometry.zones import least_clearance
from onboard.game.scenario import Flight, Kind, Parameters, Scenario, SensorSpec, VehicleSpec, WindSpec, load
from onboard.game.zone_spec import ZoneSpec
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.resources import configs
from onboard.wire.bus import topics
from onboard.wire.bus.messages import OutcomeResult
from sim_bridge.rehearsal import Rehearsal
from sim_bridge.vehicle.motion import Motion

pytestmark = pytest.mark.game
_DROPS: Counter[str] = Counter()


class Flown:
    """A game flown on virtual time: everybody's least clearance, and the rules that spoke."""

    def __init__(self, scenario: Scenario) -> None:
        self.least: dict[int, float] = {}
        self.rules: set[tuple[int, str]] = set()
        zones, planar = scenario.rules.zones, scenario.planar

        def measure(_wall_ns: int, motions: Mapping[int, Motion]) -> None:
            for id, motion in motions.items():
                gap = least_clearance(zones, motion.position, planar)
                self.least[id] = min(self.least.get(id, gap), gap)

        async def whole() -> OutcomeResult:
            async with Rehearsal(scenario, virtual_clock()) as game:
                game.bridge.watch = measure
                game.bus.subscribe(topics.everything(game.game), self._hear)
                outcome = await game.until_ended()
                return outcome.verdict

        self.verdict = run_virtual(whole())

    def _hear(self, sample: tuple[str, bytes]) -> None:
        heard = topics.TOPICS.heard(*sample[:2], _DROPS)
        if heard is not None and heard.topic is topics.DECISION:
            self.rules.add((heard.message.id, heard.message.rule))


def test_copters_fly_round_a_mast() -> None:
    scenario = Scenario(
        name="mast",
        evader=VehicleSpec(position=(0.0, 0.0), speed=8.0, target=(150.0, 4.0)),
        pursuers=tuple(VehicleSpec(position=at, speed=3.0) for at in ((150.0, -60.0), (20.0, 70.0))),
        zones=(ZoneSpec(name="mast", centre=(75.0, 0.0), radius=20.0),),
        parameters=Parameters(R=3.0, rho=6.0, horizon=60.0, epsilon_min=3.0),
        flight=Flight(
            height=80.0, ready_s=1.0, prediction=Predicting.CONSTANT_VELOCITY,
            sensor=SensorSpec(sigma=0.3, sigma_velocity=0.1, delay_s=0.1),
            wind=WindSpec(speed=3.0, from_deg=80.0),
        ),
    )  # fmt: skip
    flown = Flown(scenario)
    assert flown.verdict is OutcomeResult.ARRIVED
    assert min(flown.least.values()) > 0.0, flown.least
    assert flown.least[1] < 12.0, "it went close by"
    assert (1, "round_zone") in flown.rules


@pytest.mark.long
def test_the_shipped_obstacles_are_flown_round() -> None:
    flown = Flown(load(configs() / "scenarios" / "flight" / "two-obstacles.toml"))
    assert flown.verdict is OutcomeResult.ARRIVED
    assert min(flown.least.values()) > 0.0, flown.least
    assert (1, "round_zone") in flown.rules


@pytest.mark.long
@pytest.mark.parametrize("kind", [Kind.ARDUPLANE, Kind.PX4_PLANE])
def test_planes_in_wind_fly_round_and_over(kind: Kind) -> None:
    """A mountain lower than they fly at one end, and a tower that is higher."""
    plane: dict[str, Any] = {
        "speed": 18.0, "speed_min": 15.0, "turn_rate_deg": 25.0, "pitch_min_deg": -12.0, "pitch_max_deg": 12.0
    }  # fmt: skip
    scenario = Scenario(
        name="range",
        evader=VehicleSpec(position=(0.0, 0.0, 120.0), target=(1500.0, 40.0, 120.0), **plane),
        pursuers=(
            VehicleSpec(position=(1300.0, -500.0, 150.0), **plane | {"speed": 16.0}),
            VehicleSpec(position=(300.0, 700.0, 130.0), **plane | {"speed": 16.0}),
        ),
        zones=(
            ZoneSpec(name="tower", centre=(500.0, 20.0), radius=60.0),
            ZoneSpec(name="range", polygon=((900.0, -300.0), (1050.0, -350.0), (1100.0, 300.0)), high=100.0),
        ),
        parameters=Parameters(R=15.0, rho=30.0, horizon=150.0, epsilon_min=25.0),
        flight=Flight(
            autopilot=kind, ready_s=2.0, prediction=Predicting.CONSTANT_VELOCITY,
            sensor=SensorSpec(sigma=1.0, sigma_velocity=0.2, delay_s=0.1),
            wind=WindSpec(speed=4.0, from_deg=300.0, gust_sigma=1.0),
        ),
    )  # fmt: skip
    flown = Flown(scenario)
    assert min(flown.least.values()) > 0.0, flown.least
    assert "round_zone" in {rule for _id, rule in flown.rules}
