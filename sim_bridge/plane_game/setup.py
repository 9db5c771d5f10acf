"""From a scenario file to a game of the core."""

from __future__ import annotations

from math import radians

from onboard.core.game.advance import Conditions, Game, begin
from onboard.core.game.rules import NO_TARGET, Control, Target
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec, scale
from onboard.core.strategy.team.plan_types import Heights, Margin, nearest_staged
from onboard.game.scenario import AirframeKind, Scenario, vec
from onboard.game.staging import places_of, start_headings


def conditions_of(scenario: Scenario, dt: float | None = None) -> Conditions:
    """What a simulated game of the scenario is played under; `dt` [s] overrides its time step."""
    target = scenario.evader.target
    return Conditions(
        scenario.rules,
        NO_TARGET if target is None else Target(True, vec(target)),
        Control(scenario.parameters.dt if dt is None else dt),
    )


def vehicles_of(scenario: Scenario, places: tuple[Vec, ...] | None = None) -> tuple[Vehicle, ...]:
    """All vehicles at the start, the evader first; `places` as for `start_headings`."""
    places = places_of(scenario) if places is None else places
    return tuple(
        Vehicle(place, scale(heading, spec.speed), spec.speed)
        for spec, place, heading in zip(
            scenario.vehicles, places, start_headings(scenario, places), strict=True
        )
    )


def game_of(scenario: Scenario, places: tuple[Vec, ...] | None = None) -> Game:
    """The game before its first step; `places` as for `start_headings`."""
    evader, *pursuers = vehicles_of(scenario, places)
    return begin(
        evader, tuple(pursuers), scenario.evader.limits(), tuple(p.limits() for p in scenario.pursuers)
    )


def turn_rate_of(scenario: Scenario, index: int) -> float:
    """The turn that a vehicle can hold [rad/s]: as declared, and no more than its airframe's."""
    from sim_bridge.vehicle.flight.aircraft import named
    from sim_bridge.vehicle.flight.plane import PathModel

    spec = scenario.vehicles[index]
    declared = radians(spec.turn_rate_deg)
    frame = spec.airframe or scenario.flight.airframe
    if frame is AirframeKind.KINEMATIC:
        return declared
    model = named(frame.value).model
    return declared if model.path == PathModel.COORDINATED else min(declared, model.yaw_law.rate_limit)


def heights_of(scenario: Scenario) -> Heights:
    """Between which heights the scenario may be flown."""
    fence = scenario.flight.fence
    return Heights() if fence is None else Heights(fence.height_min, fence.height_max)


def margin_of(scenario: Scenario) -> Margin:
    """What a planner does not trust: the sensor's noise and delay, and a control step."""
    sensor, flight = scenario.flight.sensor, scenario.flight
    if scenario.planar:
        return Margin(scenario.parameters.dt, 0.0)
    return Margin(sensor.delay_s + 1.0 / flight.control_rate_hz, sensor.sigma)


def nearest_of(scenario: Scenario) -> float:
    """How near to the evader pursuers may be when it sets out [m]."""
    return nearest_staged(scenario.rules)
