"""What no seed changes of a spatial game: rules, models, sensor, supervisors and strategies of a scenario."""

from __future__ import annotations

from enum import IntEnum
from functools import lru_cache
from math import radians
from typing import Any, NamedTuple, TypeVar, cast

from onboard.config.strict import ConfigError
from onboard.core.game.advance import Conditions, EvaderStrategy, PursuerStrategy
from onboard.core.math.states import VehicleLimits
from onboard.core.safety.policy import Fence, Policy
from onboard.core.strategy.registry import EVADERS, pursuer_named
from onboard.core.strategy.team.planner import EVERY
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import AirframeKind, Kind, Scenario
from onboard.pilot.kalman import Learning
from onboard.pilot.track_filter import FilterSettings
from sim_bridge.campaign.aboard import Autopilot, autopilot_of, policy_of
from sim_bridge.campaign.spatial_game import (
    Chosen,
    Fleet,
)
from sim_bridge.campaign.team_play import Planning
from sim_bridge.campaign.tracks import Eye
from sim_bridge.draws import Purpose, key_of
from sim_bridge.plane_game.setup import (
    conditions_of,
    heights_of,
    margin_of,
    nearest_of,
    turn_rate_of,
)
from sim_bridge.vehicle.flight.aircraft import named, within

PLAN_LATE = 0.05  # [s] until a plan is heard over an undisturbed bus
PLAN_PATIENCE = 5.0  # [s] without a plan after which a pursuer flies alone

T = TypeVar("T")


class Sides(NamedTuple):
    """The strategies of a game: those that its kernel holds, and who flies by which."""

    evaders: tuple[EvaderStrategy, ...]
    pursuers: tuple[PursuerStrategy, ...]
    chosen: Chosen


class _Itself(NamedTuple):
    """A scenario that equals no other: for `_fixed`, as it cannot be hashed."""

    scenario: Scenario

    def __hash__(self) -> int:
        return id(self.scenario)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Itself) and other.scenario is self.scenario


class Fixed(NamedTuple):
    """What no seed changes of a scenario's games; of `eye` and `planning` all but the keys."""

    conditions: Conditions
    fleet: Fleet
    eye: Eye
    control: int  # samples between two decisions
    policies: tuple[Policy, ...]
    autopilots: tuple[Autopilot, ...]
    planning: Planning
    limits: tuple[VehicleLimits, ...]
    steps: int
    sides: Sides


@lru_cache(maxsize=8)
def _fixed(itself: _Itself) -> Fixed:
    scenario = itself.scenario
    conditions = conditions_of(scenario)
    aircraft = named(scenario.flight.airframe.value).model
    specs = scenario.vehicles
    fleet = Fleet(*(within(aircraft, spec.limits()) for spec in specs[:2]))
    dt = fleet.evader.dt
    control = round(1.0 / (scenario.flight.control_rate_hz * dt))
    fence = scenario.flight.fence
    fences = () if fence is None else (Fence(fence.polygon, fence.height_min, fence.height_max),)
    return Fixed(
        plain(conditions._replace(control=conditions.control._replace(dt=control * dt))),
        plain(fleet),
        plain(eye_of(scenario, dt)),
        control,
        plain(
            tuple(
                policy_of(spec.limits(), fences, conditions.rules.separation, conditions.rules.zones)
                for spec in specs
            )
        ),
        tuple(autopilot_of(spec.limits(), spec.speed, radians(spec.turn_rate_deg)) for spec in specs),
        plain(planning_of(scenario, control * dt)),
        tuple(spec.limits() for spec in specs),
        int(conditions.rules.horizon / (control * dt)) + 8,
        sides_of(scenario),
    )


def plain(value: T) -> T:
    """A value of a NamedTuple with whole numbers in place of members of enumerations.

    Numba tells the types of such a value at a glance, where it has to look at every member.
    """
    found: Any = value
    if isinstance(value, tuple):
        parts = [plain(part) for part in value]
        found = type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    elif isinstance(value, IntEnum):
        found = int(value)
    return cast(T, found)


def planning_of(scenario: Scenario, step: float) -> Planning:
    """How the scenario's pursuers plan, as their agents do; `step` [s] is a control step.

    The plan's messages are late and lost as those of the bus, where the scenario says so.
    """
    spec = scenario.flight.impairment
    every = max(2, round(EVERY / step))
    late = PLAN_LATE + (spec.delay_s + 0.5 * spec.jitter_s if spec.bus else 0.0)
    limits = tuple(
        one.limits()._replace(turn_rate=turn_rate_of(scenario, index))
        for index, one in enumerate(scenario.vehicles)
    )
    return Planning(
        every,
        min(every - 1, max(1, round(late / step))),
        spec.loss if spec.bus else 0.0,
        round(PLAN_PATIENCE / step),
        heights_of(scenario),
        margin_of(scenario),
        nearest_of(scenario),
        limits,
        key_of(scenario.seed, 0, Purpose.PLAN),
    )


def sides_of(scenario: Scenario) -> Sides:
    """The scenario's strategies by name, and for the evader flying straight besides (number 1).

    Raises ConfigError for an unknown name.
    """
    names = [pursuer_named(spec.strategy) for spec in scenario.pursuers]
    different = list(dict.fromkeys(names))
    return Sides(
        (evader_strategy(scenario.evader.strategy), EVADERS["straight"].decide),
        tuple(pursuer_strategy(name) for name in different),
        Chosen(0, tuple(different.index(name) for name in names)),
    )


def demand_spatial(scenario: Scenario) -> None:
    """Raise ConfigError for what the compiled game does not play."""
    wind = scenario.flight.wind
    spec = scenario.flight
    faults = (
        (wind.correlation_m > 0.0, "wind.correlation_m", f"{wind.correlation_m:g}", "0"),
        (wind.recorded != "", "wind.recorded", wind.recorded, "a mean wind with gusts"),
        (spec.airframe is AirframeKind.KINEMATIC, "airframe", "kinematic", "nose, slip or coordinated"),
        (spec.autopilot is not Kind.ARDUPLANE, "autopilot", spec.autopilot.value, "arduplane"),
    )
    for wrong, key, found, expected in faults:
        if wrong:
            raise ConfigError(f"{scenario.name}: flight.{key}: found {found}, expected {expected}")


def eye_of(scenario: Scenario, dt: float) -> Eye:
    """The scenario's sensor, and the filters of its agents; `dt` [s] is a sample of the aircraft."""
    spec = scenario.flight.sensor
    f = FilterSettings()
    return Eye(
        max(1, round(1.0 / (spec.rate_hz * dt))),
        round(spec.delay_s / dt),
        spec.sigma,
        spec.sigma_velocity,
        spec.dropout,
        f.sigma_min * f.sigma_min,
        f.density,
        Learning(f.density_min, f.density_max, f.adaptation),
        tuple(key_of(scenario.seed, id, Purpose.SENSOR) for id in scenario.ids),
    )


def fixed_of(scenario: Scenario) -> Fixed:
    """The same for all seeds: reckoned once a scenario."""
    return _fixed(_Itself(scenario))
