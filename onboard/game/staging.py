"""From a scenario to the game's setup, as every master publishes it."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians

from onboard.core.math.vectors import NORTH, Vec, direction, distance, sub, unit, yaw_of
from onboard.game.scenario import Scenario, VehicleSpec, targets_of
from onboard.wire.bus.messages import (
    EvaderTargets,
    Fence,
    LimitsMessage,
    Member,
    Origin,
    RulesMessage,
    Setup,
    Zone,
)


def places_of(scenario: Scenario) -> tuple[Vec, ...]:
    """Where all vehicles start [m; NED], in the order of `Scenario.vehicles`."""
    return tuple(spec.start() for spec in scenario.vehicles)


def heading_of(spec: VehicleSpec, place: Vec, towards: Vec) -> Vec:
    """Heading at the start (unit): as declared, else level from `place` towards a point, else north."""
    if spec.heading_deg is not None:
        return direction(0.0, radians(spec.heading_deg))
    line = sub(towards, place)
    return unit(Vec(line.x, line.y, 0.0), NORTH)


def start_headings(scenario: Scenario, places: tuple[Vec, ...] | None = None) -> tuple[Vec, ...]:
    """Headings of all vehicles at the start: an evader's towards its nearest target, a pursuer's towards the
    nearest evader.

    `places` are where they start where that is not the scenario's [m; NED].
    """
    places = places_of(scenario) if places is None else places
    pairs = list(zip(scenario.vehicles, places, strict=True))
    pursuing = range(1, 1 + len(scenario.pursuers))
    evaders = [place for index, place in enumerate(places) if index not in pursuing]
    return tuple(
        heading_of(spec, place, nearest(place, evaders if index in pursuing else targets_of(spec)))
        for index, (spec, place) in enumerate(pairs)
    )


def nearest(place: Vec, others: Sequence[Vec]) -> Vec:
    """Of other places the nearest, the first of equally near ones; `place` itself where there are none."""
    return min(others, key=lambda other: distance(place, other), default=place)


def flown(scenario: Scenario, point: Vec) -> Vec:
    """A place as it is flown: plane games at `flight.height`."""
    return Vec(point.x, point.y, -scenario.flight.height) if scenario.planar else point


def staging_place(scenario: Scenario, spec: VehicleSpec) -> Vec:
    """Where a vehicle starts [m; NED]: on the ground where the scenario has a ground start."""
    place = flown(scenario, spec.start())
    return Vec(place.x, place.y, 0.0) if scenario.flight.ground_start else place


def flown_targets(scenario: Scenario) -> dict[int, tuple[Vec, ...]]:
    """The evaders' targets as they are flown [m; NED], by vehicle; () for one without."""
    evaders = zip(scenario.evader_ids, scenario.evading, strict=True)
    return {id: tuple(flown(scenario, place) for place in targets_of(spec)) for id, spec in evaders}


def target_of(scenario: Scenario) -> Vec | None:
    """The first evader's first target as it is flown."""
    return next(iter(flown_targets(scenario)[scenario.evader_ids[0]]), None)


def told_targets(scenario: Scenario) -> tuple[EvaderTargets, ...]:
    """The targets as pursuers know them: none, unless the rules say so; nor where `Setup.target` says all."""
    if not scenario.rules.target_known:
        return ()
    targets = flown_targets(scenario)
    if len(targets) == 1 and max(map(len, targets.values())) <= 1:
        return ()
    told = ((id, tuple((place.x, place.y, place.z) for place in places)) for id, places in targets.items())
    return tuple(EvaderTargets(id, places) for id, places in told if places)


def setup_of(scenario: Scenario, game: str, master: str) -> Setup:
    """`game/setup`: everything but the evaders' targets, unless the rules say that the pursuers know them."""
    flight = scenario.flight
    target = target_of(scenario) if scenario.rules.target_known else None
    roster = []
    everybody = zip(scenario.ids, scenario.vehicles, start_headings(scenario), strict=True)
    for id, spec, heading in everybody:
        place = staging_place(scenario, spec)
        roster.append(
            Member(
                id=id,
                role=scenario.role_of(id),
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
        rules=RulesMessage.of(scenario.rules),
        fence=None if fence is None else Fence(fence.polygon, fence.height_min, fence.height_max),
        track_sigma=flight.sensor.sigma,
        seed=scenario.seed,
        field_profile=flight.field_profile,
        target=None if target is None else (target.x, target.y, target.z),
        targets=told_targets(scenario),
        zones=tuple(Zone(zone.name, *zone.prism()) for zone in scenario.zones),
    )
