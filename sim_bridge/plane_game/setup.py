"""From a scenario file to a game of the core."""

from __future__ import annotations

from onboard.core.game.advance import Conditions, Game, begin
from onboard.core.game.rules import NO_TARGET, Control, Target
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec, scale
from onboard.game.scenario import Scenario, vec
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
