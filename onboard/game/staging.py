"""From a scenario to the game's setup, as every master publishes it."""

from __future__ import annotations

from math import radians

from onboard.core.math.vectors import NORTH, Vec, direction, sub, unit, yaw_of
from onboard.game.scenario import Scenario, VehicleSpec, vec
from onboard.wire.bus.messages import Fence, LimitsMessage, Member, Origin, Role, RulesMessage, Setup


def places_of(scenario: Scenario) -> tuple[Vec, ...]:
    """Where all vehicles start [m; NED], the evader first."""
    return tuple(spec.start() for spec in scenario.vehicles)


def heading_of(spec: VehicleSpec, place: Vec, towards: Vec) -> Vec:
    """Heading at the start (unit): as declared, else level from `place` towards a point, else north."""
    if spec.heading_deg is not None:
        return direction(0.0, radians(spec.heading_deg))
    line = sub(towards, place)
    return unit(Vec(line.x, line.y, 0.0), NORTH)


def start_headings(scenario: Scenario, places: tuple[Vec, ...] | None = None) -> tuple[Vec, ...]:
    """Headings of all vehicles at the start: the evader towards its target, the pursuers towards it.

    `places` are where they start where that is not the scenario's [m; NED].
    """
    e, *others = places_of(scenario) if places is None else places
    target = scenario.evader.target
    goal = e if target is None else vec(target)
    pursuers = zip(scenario.pursuers, others, strict=True)
    return (heading_of(scenario.evader, e, goal), *(heading_of(spec, p, e) for spec, p in pursuers))


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
    """`game/setup`: everything but the evader's target, unless the rules say that the pursuers know it."""
    flight = scenario.flight
    target = target_of(scenario) if scenario.rules.target_known else None
    roster = []
    everybody = zip(scenario.ids, scenario.vehicles, start_headings(scenario), strict=True)
    for index, (id, spec, heading) in enumerate(everybody):
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
                heading=yaw_of(heading),
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
        target=None if target is None else (target.x, target.y, target.z),
    )
