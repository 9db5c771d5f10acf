"""What a player sees when it decides: the only place where views are made, for flights and for simulations.

Strategies run in the moving air mass. There a target on the ground moves at −w, so the evader is shown the
place where it will meet it. Kernel style: the same source runs interpreted onboard and compiled.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.geometry.apollonius import intercept
from onboard.core.geometry.cones import Cone, blocked_cones
from onboard.core.math.each import each, new
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, TINY, ZERO, Vec, along, norm, scale, unit
from onboard.core.strategy.team.plan_types import IDLE, Assignment


class EvaderView(NamedTuple):
    """A situation as the evader sees it. Pursuers and target move in the same air mass."""

    own: Vehicle
    limits: VehicleLimits
    pursuers: tuple[Vehicle, ...]
    cones: tuple[Cone, ...]  # directions that the pursuers block, one cone each, from `blocked_cones`
    target: Target  # where it will be met in the moving air
    rules: Rules
    turn_rates: tuple[float, ...]  # of the pursuers, at most, as they declare [rad/s]; 0 = not declared
    wind: Vec = ZERO  # where the air moves to over ground, where the zones stand [m/s]


NO_MEMBER = Vehicle(Vec(1e9, 1e9, 0.0), ZERO, 0.0)
"""In the place of a pursuer that has another quarry: without speed and far away it counts for nothing."""


class Sighting(NamedTuple):
    """The evader as a pursuer sees it, in the moving air mass."""

    evader: Vehicle
    heading: Vec  # ê, unit vector of the evader's velocity
    has_prediction: bool
    prediction: Vec  # the evader's place after the control's `lookahead` [m]


class Nearest(NamedTuple):
    """The nearest team mate."""

    exists: bool
    position: Vec  # [m; NED]


class Held(NamedTuple):
    """The meeting point that a pursuer's last decision headed for, where it lies now in the moving air."""

    exists: bool
    corrected: bool  # whether it was held then, too: strategy (30)
    place: Vec  # [m; NED]
    left: float  # until it is due [s]


NOTHING_HELD = Held(False, False, ZERO, 0.0)


class Team(NamedTuple):
    """What a pursuer knows of its own side."""

    mate: Nearest
    members: tuple[Vehicle, ...]  # all pursuers of its quarry that it knows of, itself among them
    own_index: int  # its own among the members
    target: Target  # the evader's, where the rules let the pursuers know it
    held: Held = NOTHING_HELD
    part: Assignment = IDLE  # its own in the team's plan that it last heard
    nose: Vec = ZERO  # where its own nose points (unit); ZERO: not known, or it flies where it does not point
    wind: Vec = ZERO  # where the air moves to [m/s]


class PursuerView(NamedTuple):
    """A situation as a pursuer sees it, in the moving air mass."""

    own: Vehicle
    limits: VehicleLimits
    evader: Vehicle
    heading: Vec  # ê, unit vector of the evader's velocity
    has_prediction: bool
    prediction: Vec  # the evader's place after the control's `lookahead` [m]
    mate: Nearest
    control: Control
    rules: Rules
    members: tuple[Vehicle, ...] = ()  # all pursuers of its quarry that it knows of, itself among them
    own_index: int = -1  # its own among the members
    target: Target = NO_TARGET  # the evader's, where the pursuers know it
    held: Held = NOTHING_HELD  # nothing where nobody remembers: in the plane game
    part: Assignment = IDLE  # its own in the team's plan that it last heard
    nose: Vec = ZERO  # where its own nose points (unit); ZERO: not known
    wind: Vec = ZERO  # where the air moves to over ground, where the zones stand [m/s]


def level(v: Vec, planar: bool) -> Vec:
    """A place [m] or velocity [m/s] as the game counts it: without its height in a plane game."""
    if planar:
        return new(Vec, (v.x, v.y, 0.0))
    return v


def heading_at(vehicle: Vehicle) -> Vec:
    """Unit vector of a vehicle's velocity through the air; north for a vehicle at rest."""
    return unit(vehicle.velocity, NORTH)


def target_in_air(target: Target, own: Vehicle, wind: Vec) -> Target:
    """The point of the moving air where `own` meets a target on the ground, which moves at −w in the air.

    `wind` is where the air moves to [m/s; NED]. The target itself in still air and where it cannot be met.
    """
    drift = norm(wind)
    if not target.exists or drift <= TINY:
        return target
    meeting = intercept(target.position, scale(wind, -1.0 / drift), drift, own.position, own.speed)
    if meeting.exists:
        return new(Target, (True, meeting.point))
    return target


def evader_view(
    own: Vehicle,
    limits: VehicleLimits,
    pursuers: tuple[Vehicle, ...],
    target: Target,
    wind: Vec,
    rules: Rules,
) -> EvaderView:
    """The situation as the evader sees it.

    `target` lies on the ground [m; NED]; `wind` is where the air moves to [m/s; NED], zero for a vehicle that
    holds its velocity over ground.
    """
    cones = blocked_cones(own, pursuers, rules.rho)
    aim = target_in_air(target, own, wind)
    return new(EvaderView, (own, limits, pursuers, cones, aim, rules, each(undeclared, pursuers, 0.0), wind))


def undeclared(_pursuer: Vehicle, _index: int, _shared: float) -> float:
    """The turn rate of a pursuer that declares none (for `each`)."""
    return 0.0


def turn_rate_of(limits: VehicleLimits, _index: int, _shared: float) -> float:
    """What a vehicle declares [rad/s] (for `each`)."""
    return limits.turn_rate


def with_limits(view: EvaderView, limits: tuple[VehicleLimits, ...]) -> EvaderView:
    """The same view, of pursuers whose limits are known."""
    rates = each(turn_rate_of, limits, 0.0)
    own, own_limits, pursuers, cones, target, rules, _rates, wind = view
    return new(EvaderView, (own, own_limits, pursuers, cones, target, rules, rates, wind))


def sighted(evader: Vehicle, heading: Vec, lookahead: float) -> Sighting:
    """The evader on a `heading` (unit), predicted to fly straight on for `lookahead` [s]."""
    return new(Sighting, (evader, heading, True, along(evader.position, heading, evader.speed * lookahead)))


def nearest_mate(own: Vec, mates: tuple[Vec, ...], but: int) -> Nearest:
    """The place among `mates` [m; NED] nearest to `own`; the one with index `but` is left out."""
    exists = False
    position = own
    smallest = 1e300
    for index in range(len(mates)):
        if index != but:
            place = mates[index]
            x = place.x - own.x
            y = place.y - own.y
            z = place.z - own.z
            square = x * x + y * y + z * z
            if square < smallest:
                smallest = square
                position = place
                exists = True
    return new(Nearest, (exists, position))


def told(target: Target, rules: Rules) -> Target:
    """The evader's target as the pursuers know it: not at all, unless the rules say so."""
    return new(Target, (target.exists and rules.target_known, target.position))


def pursuer_view(
    own: Vehicle, limits: VehicleLimits, sighting: Sighting, team: Team, control: Control, rules: Rules
) -> PursuerView:
    """The situation as a pursuer sees it."""
    return new(PursuerView, (
        own,
        limits,
        sighting.evader,
        sighting.heading,
        sighting.has_prediction,
        sighting.prediction,
        team.mate,
        control,
        rules,
        team.members,
        team.own_index,
        team.target,
        team.held,
        team.part,
        team.nose,
        team.wind,
    ))
