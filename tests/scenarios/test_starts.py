"""A flown game begins as the computed one does: everybody at its place at t₀, with the heading asked for."""

from __future__ import annotations

import asyncio
from math import hypot, pi
from typing import NamedTuple

import pytest
from msgspec.structs import replace

from onboard.core.math.angles import wrap
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec, norm, sub
from onboard.game.scenario import AirframeKind, Flight, Kind, Parameters, Scenario, VehicleSpec, WindSpec
from onboard.game.staging import flown
from onboard.wire.bus.messages import Phase
from sim_bridge.campaign.spatial_draw import drawn_scenario, spatial
from sim_bridge.world.staging import starts
from tests.support.virtual_time import virtual
from tests.support.whole_games import WholeGame, at_phase, game_of

pytestmark = pytest.mark.game


class Residual(NamedTuple):
    """How far a vehicle is from how the scenario starts it."""

    away: float  # [m; as seen from above]
    height: float  # [m]
    heading: float  # [rad] of the nose
    airspeed: float  # [m/s]


def planes(airframe: AirframeKind, wind: WindSpec) -> Scenario:
    """Two planes after a third, none of which starts towards where its circle brings it by itself.

    The aircraft of 4.4 are as fast as there, the kinematic ones are small.
    """
    flight = Flight(autopilot=Kind.ARDUPLANE, airframe=airframe, height=120.0, wind=wind)
    k = 1.0 if airframe is AirframeKind.KINEMATIC else 2.3
    band = {"speed_min": 14.0 * k, "turn_rate_deg": 30.0}
    return Scenario(
        name="planes from their places",
        evader=VehicleSpec(position=(0.0, 0.0), speed=20.0 * k, target=(900.0, 300.0), **band),
        pursuers=(
            VehicleSpec(position=(-220.0 * k, 150.0 * k), speed=21.0 * k, heading_deg=200.0, **band),
            VehicleSpec(position=(260.0 * k, -260.0 * k), speed=18.0 * k, heading_deg=-60.0, **band),
        ),
        parameters=Parameters(R=10.0, horizon=5.0),
        flight=flight,
    )


def copters(kind: Kind, wind: WindSpec) -> Scenario:
    """A copter after another one, whose nose is to point away from it."""
    return Scenario(
        name="copters at their places",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0, target=(90.0, 30.0)),
        pursuers=(VehicleSpec(position=(-22.0, 15.0), speed=6.0, heading_deg=200.0),),
        parameters=Parameters(R=2.0, horizon=5.0),
        flight=Flight(autopilot=kind, height=60.0, wind=wind),
    )


async def at_start(game: WholeGame, within_s: float = 90.0) -> dict[int, Residual]:
    """What everybody's start leaves to be wished for, in truth, at t₀."""
    await at_phase(game, Phase.READY, 60.0)
    await game.forward(within_s, until=lambda: game.master.t0_ns - game.clock.wall_ns() < NS_PER_S // 10)
    await asyncio.sleep(max(0.0, -game.now))
    game.bridge.world.step()
    scenario, after = game.scenario, game.now
    wished = starts(scenario, lambda id, motion, t: game.bridge.world.vehicles[id].air)
    found = {}
    for id, spec in zip(scenario.ids, scenario.vehicles, strict=True):
        motion = game.bridge.world.motions[id]
        place = flown(scenario, spec.start())
        off = sub(motion.position, Vec(*(p + after * v for p, v in zip(place, motion.velocity, strict=True))))
        turn = wrap(motion.yaw - wished[id].yaw)
        found[id] = Residual(hypot(off.x, off.y), abs(off.z), abs(turn), motion.airspeed - spec.speed)
    return found


WINDS = [WindSpec(), WindSpec(speed=4.0, from_deg=250.0), WindSpec(speed=6.0, from_deg=20.0, gust_sigma=1.0)]


SKIES = {
    "kinematic in wind": (AirframeKind.KINEMATIC, WINDS[1]),
    "coordinated in gusts": (AirframeKind.COORDINATED, WINDS[2]),
    "kinematic in calm air": (AirframeKind.KINEMATIC, WINDS[0]),
    "kinematic in gusty wind": (AirframeKind.KINEMATIC, WINDS[2]),
    "coordinated in calm air": (AirframeKind.COORDINATED, WINDS[0]),
    "coordinated in wind": (AirframeKind.COORDINATED, WINDS[1]),
}


@pytest.mark.parametrize(
    ("airframe", "wind"),
    [pytest.param(*sky, id=name, marks=[pytest.mark.long] if n > 0 else [])
     for n, (name, sky) in enumerate(SKIES.items())],
)  # fmt: skip
@virtual
async def test_planes_pass_their_places_at_the_start(airframe: AirframeKind, wind: WindSpec) -> None:
    async with game_of(planes(airframe, wind)) as game:
        for id, residual in (await at_start(game)).items():
            airspeed, gust = game.bridge.world.motions[id].airspeed, 2.0 * wind.gust_sigma
            assert residual.away < 0.25 * airspeed + gust, "a quarter of a second, and one of a gust"
            assert residual.height < 5.0
            assert residual.heading < pi / 36 + gust / airspeed, "the nose is turned into the gust"
            assert abs(residual.airspeed) < 1.0 + 2.0 * wind.gust_sigma


@pytest.mark.long
@virtual
async def test_slow_turners_pass_their_places_in_strong_wind() -> None:
    """The paper's aircraft, 4.5°/s, in 13.5 m/s of wind and gusts of 3 m/s rms."""
    scenario = drawn_scenario(spatial("two"), 4)
    async with game_of(scenario) as game:
        for residual in (await at_start(game, 300.0)).values():
            assert residual.away < 15.0, "five seconds of a gust's rms"
            assert residual.height < 6.0
            assert residual.heading < pi / 15
            assert abs(residual.airspeed) < 6.0
        clips = [event for event in game.events if event.kind == "supervisor_clip"]
        assert not clips, "what leads to the places is within the limits"


@virtual
async def test_px4_planes_pass_their_places_a_little_late() -> None:
    """PX4 takes no airspeed: what is lost on the way is not made up for."""
    scenario = planes(AirframeKind.KINEMATIC, WINDS[2])
    scenario = replace(scenario, flight=replace(scenario.flight, autopilot=Kind.PX4_PLANE))
    async with game_of(scenario) as game:
        for id, residual in (await at_start(game)).items():
            assert residual.away < 0.75 * game.bridge.world.motions[id].airspeed
            assert (residual.height, residual.heading) < (3.0, pi / 36)


@pytest.mark.parametrize("kind", [Kind.ARDUCOPTER, Kind.PX4], ids=lambda kind: kind.value)
@virtual
async def test_copters_wait_at_their_places_with_their_noses_as_asked(kind: Kind) -> None:
    async with game_of(copters(kind, WINDS[1])) as game:
        for id, vehicle in game.bridge.world.vehicles.items():  # blown off, and turned
            m = vehicle.airframe.motion
            x, y, z = m.position
            moved = m._replace(position=Vec(x + 12.0, y - 9.0 * id, z), yaw=2.0)
            vehicle.airframe._motion = moved  # type: ignore[attr-defined]
        for residual in (await at_start(game)).values():
            assert residual.away < 1.0
            assert residual.height < 1.0
            assert residual.heading < pi / 36
        assert all(norm(m.velocity) < 0.5 for m in game.bridge.world.motions.values())
