"""From a scenario to the game's setup, as every master publishes it."""

from __future__ import annotations

from onboard.core.math.vectors import Vec
from onboard.game.scenario import Scenario, VehicleSpec, vec
from onboard.wire.bus.messages import Fence, LimitsMessage, Member, Origin, Role, RulesMessage, Setup


def flown(scenario: Scenario, point: Vec) -> Vec:
    """A place as it is flown: plane games at `flight.height`."""
    return Vec(point.x, point.y, -scenario.flight.height) if scenario.planar else point


def staging_place(scenario: Scenario, spec: VehicleSpec) -> Vec:
    """Where a vehicle starts [m; NED]: on the ground where the scenario has a ground start."""
    place = flown(scenario, spec.start())
    return Vec(place.x, place.y, 0.0) if scenario.flight.ground_start else place


def target_of(scenario: Scenario) -> Vec | None:
    """The evader's target as it is flown."""
    target = scenario.evader.target
    return None if target is None else flown(scenario, vec(target))


def setup_of(scenario: Scenario, game: str, master: str) -> Setup:
    """`game/setup`: everything but the evader's target."""
    flight = scenario.flight
    roster = []
    for index, (id, spec) in enumerate(zip(scenario.ids, scenario.vehicles, strict=True)):
        place = staging_place(scenario, spec)
        roster.append(
            Member(
                id=id,
                role=Role.PURSUER if index else Role.EVADER,
                speed=spec.speed,
                start=(place.x, place.y, place.z),
                limits=LimitsMessage(*spec.limits()),
                strategy=spec.strategy,
                tracked=spec.tracked,
            )
        )
    fence = flight.fence
    return Setup(
        game=game,
        scenario=scenario.name,
        scenario_hash=scenario.hash(),
        master=master,
        origin=Origin(flight.origin.latitude_deg, flight.origin.longitude_deg, flight.origin.altitude_m),
        roster=tuple(roster),
        rules=RulesMessage(*scenario.rules),
        fence=None if fence is None else Fence(fence.polygon, fence.height_min, fence.height_max),
        track_sigma=flight.sensor.sigma,
        seed=scenario.seed,
        field_profile=flight.field_profile,
    )
