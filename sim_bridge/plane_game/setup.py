"""From a scenario file to a game of the core."""

from __future__ import annotations

from math import radians

from onboard.core.game.advance import Game, Params, begin
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec, direction, scale, sub, unit
from onboard.game.scenario import Scenario, VehicleSpec, vec


def params_of(scenario: Scenario, dt: float | None = None) -> Params:
    """The core's parameters; `dt` [s] overrides the scenario's."""
    p = scenario.parameters
    target = scenario.evader.target
    return Params(
        p.R,
        scenario.rho,
        p.lambda_,
        p.beta,
        p.epsilon_min,
        p.dt if dt is None else dt,
        p.horizon,
        p.separation,
        scenario.planar,
        target is not None,
        ZERO if target is None else vec(target),
    )


def heading_of(spec: VehicleSpec, towards: Vec) -> Vec:
    """Heading at the start (unit): as declared, else level towards a point, else north."""
    if spec.heading_deg is not None:
        return direction(0.0, radians(spec.heading_deg))
    line = sub(towards, spec.start())
    return unit(Vec(line.x, line.y, 0.0), NORTH)


def start_headings(scenario: Scenario) -> tuple[Vec, ...]:
    """Headings of all vehicles at the start: the evader towards its target, the pursuers towards it."""
    e = scenario.evader
    goal = e.start() if e.target is None else vec(e.target)
    return (heading_of(e, goal), *(heading_of(p, e.start()) for p in scenario.pursuers))


def vehicles_of(scenario: Scenario) -> tuple[Vehicle, ...]:
    """All vehicles at the start, the evader first."""
    return tuple(
        Vehicle(spec.start(), scale(heading, spec.speed), spec.speed)
        for spec, heading in zip(scenario.vehicles, start_headings(scenario), strict=True)
    )


def game_of(scenario: Scenario) -> Game:
    """The game before its first step."""
    evader, *pursuers = vehicles_of(scenario)
    return begin(
        evader, tuple(pursuers), scenario.evader.limits(), tuple(p.limits() for p in scenario.pursuers)
    )
