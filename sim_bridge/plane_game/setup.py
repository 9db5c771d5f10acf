"""From a scenario file to a game of the core."""

from __future__ import annotations

from math import radians

from onboard.core.game.advance import Conditions, Game, begin
from onboard.core.game.rules import NO_TARGET, Control, Target
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import NORTH, Vec, direction, scale, sub, unit
from onboard.game.scenario import Scenario, VehicleSpec, vec


def conditions_of(scenario: Scenario, dt: float | None = None) -> Conditions:
    """What a simulated game of the scenario is played under; `dt` [s] overrides its time step."""
    target = scenario.evader.target
    return Conditions(
        scenario.rules,
        NO_TARGET if target is None else Target(True, vec(target)),
        Control(scenario.parameters.dt if dt is None else dt),
    )


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
