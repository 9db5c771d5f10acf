"""Out of zones: what becomes of a decision that leads into one. Kernel style.

The one place where strategies meet zones, for every strategy alike: who plays asks it after the strategy. A
decision whose way over ground enters no zone stands as it is. A free ray of an evader's is else replaced by
the ray nearest to the way round that neither pursuers nor zones block, any other decision by the way round.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.game.rules import Rules
from onboard.core.game.views import EvaderView, PursuerView, heading_at
from onboard.core.geometry.cones import NOTHING, is_free
from onboard.core.geometry.zone_rays import (
    Look,
    Stand,
    first_entered,
    free_ray_beside,
    held_course,
    looking,
    over_ground,
)
from onboard.core.geometry.zone_ways import first_met, way_round
from onboard.core.geometry.zones import Area, in_any, way_out_of
from onboard.core.math.each import some_or_none
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, TINY, Vec, add, along, distance, norm, sub, unit
from onboard.core.strategy.evasion import resultant_force
from onboard.core.strategy.knowledge import Decision, Module, RuleId

CLEARANCE = 6.0  # [m] kept to zones: one more than a supervisor keeps by default
ANSWER = 0.5  # [s] until a craft that cannot stop answers
TURNS = 1.05  # times its circle that such a craft keeps
AT_LEAST = 0.25  # [s] of flight that are looked at, however near the aim is


def turn_of(limits: VehicleLimits, speed: float, wind: Vec) -> float:
    """The radius of a vehicle's turns over ground [m]; 0 for who can stop, and who declares no rate."""
    if limits.speed_min <= 0.0 or limits.turn_rate <= 0.0 or speed <= TINY:
        return 0.0
    wide = 1.0 + norm(wind) / speed
    return speed / limits.turn_rate * wide * wide


def margin_of(limits: VehicleLimits, speed: float, wind: Vec) -> float:
    """What a vehicle keeps to zones [m]: who cannot stop keeps its turning circle over ground besides."""
    radius = turn_of(limits, speed, wind)
    return CLEARANCE + (TURNS * radius + ANSWER * speed if radius > 0.0 else 0.0)


def stand_of(own: Vehicle, limits: VehicleLimits, aim: Vec, wind: Vec, rules: Rules) -> Stand:
    """Where a vehicle stands among the zones of a game."""
    over = add(own.velocity, wind)
    course = unit(Vec(over.x, over.y, 0.0), NORTH)
    margin = margin_of(limits, own.speed, wind)
    turning = max(turn_of(limits, own.speed, wind), 1.0)
    return Stand(rules.zones, own.position, aim, margin, rules.planar, course, turning)


def evader_keeps_out(view: EvaderView, decision: Decision) -> Decision:
    """An evader's decision, changed where it leads into a zone."""
    return some_or_none(_evader_beside, _as_decided, view.rules.zones.areas, (view, decision))


def pursuer_keeps_out(view: PursuerView, decision: Decision) -> Decision:
    """A pursuer's decision, changed where it leads into a zone."""
    return some_or_none(_pursuer_beside, _pursuer_as_decided, view.rules.zones.areas, (view, decision))


def _as_decided(_areas: tuple[Area, ...], asked: tuple[EvaderView, Decision]) -> Decision:
    return asked[1]


def _pursuer_as_decided(_areas: tuple[Area, ...], asked: tuple[PursuerView, Decision]) -> Decision:
    return asked[1]


def _evader_beside(_areas: tuple[Area, ...], asked: tuple[EvaderView, Decision]) -> Decision:
    view, decision = asked
    own, rules, limits = view.own, view.rules, view.limits
    aim = along(decision.aim, view.wind, decision.time)
    if view.target.exists:
        arrival = distance(view.target.position, own.position) / max(own.speed, TINY)
        aim = along(view.target.position, view.wind, arrival)
    stand = stand_of(own, limits, aim, view.wind, rules)
    reach = max(distance(aim, own.position), AT_LEAST * own.speed)
    look = looking(stand, decision.speed, view.wind, reach)
    if decision.speed <= TINY or not blocked(decision.direction, look):
        return decision
    if in_any(rules.zones, own.position, rules.planar):
        return leaving(decision, look)
    if is_free(decision.direction, view.cones):
        ray = free_ray_beside(towards(aim, decision, look), view.cones, limits, look)
        if ray.exists:
            return turned_to(decision, ray.direction, own.position, reach)
        goal = unit(resultant_force(view), heading_at(own))  # rule 3: no ray is free
    else:
        goal = towards(along(decision.aim, view.wind, decision.time), decision, look)
    ray = free_ray_beside(goal, (NOTHING,), limits, look)
    return turned_to(decision, ray.direction if ray.exists else goal, own.position, reach)


def _pursuer_beside(_areas: tuple[Area, ...], asked: tuple[PursuerView, Decision]) -> Decision:
    view, decision = asked
    own, rules, limits = view.own, view.rules, view.limits
    aim = along(decision.aim, view.wind, decision.time)
    if in_any(rules.zones, aim, rules.planar):
        aim = view.evader.position
    stand = stand_of(own, limits, aim, view.wind, rules)
    reach = max(distance(aim, own.position), AT_LEAST * own.speed)
    look = looking(stand, decision.speed, view.wind, reach)
    if decision.speed <= TINY or not blocked(decision.direction, look):
        return decision
    if in_any(rules.zones, own.position, rules.planar):
        return leaving(decision, look)
    goal = towards(aim, decision, look)
    ray = free_ray_beside(goal, (NOTHING,), limits, look)
    return turned_to(decision, ray.direction if ray.exists else goal, own.position, reach)


def blocked(direction: Vec, look: Look) -> bool:
    """Whether a direction through the air leads into a zone within reach, or one is in it already."""
    if in_any(look.zones, look.position, look.planar):
        return True
    if not look.planar:
        return first_entered(direction, look) >= 0
    end = along(look.position, unit(over_ground(direction, look), direction), look.reach)
    return first_met(look, look.position, end, True) >= 0


def towards(aim: Vec, decision: Decision, look: Look) -> Vec:
    """The direction through the air of the first leg round the zones to an aim [m; NED]; as decided where no
    zone is in the way there, or the aim lies in one."""
    if in_any(look.zones, aim, look.planar):
        return decision.direction
    way = way_round(look, aim)
    if not way.round:
        return decision.direction
    line = sub(way.to, look.position)
    level = sqrt(line.x * line.x + line.y * line.y)
    if level <= TINY:
        return unit(line, decision.direction)
    course = held_course(Vec(line.x / level, line.y / level, 0.0), look.speed, look.wind)
    if look.planar:
        return course
    long = norm(line)
    return Vec(course.x * level / long, course.y * level / long, line.z / long)


def leaving(decision: Decision, look: Look) -> Decision:
    """The shortest way out of the zone that one is in."""
    out = decision.direction
    deepest = 0.0
    for area in look.zones.areas:
        found = way_out_of(look.zones, area, look.position, look.planar)
        if found.clearance < deepest:
            deepest = found.clearance
            out = found.outward
    aim = along(look.position, out, -deepest)
    if out.z == 0.0:
        out = held_course(out, look.speed, look.wind)
    time = -deepest / max(norm(over_ground(out, look)), TINY)
    return Decision(True, out, decision.speed, RuleId.LEAVE_ZONE, aim, time, decision.miss)


def turned_to(decision: Decision, direction: Vec, place: Vec, reach: float) -> Decision:
    """The decision on another direction."""
    aim = along(place, direction, reach)
    time = reach / decision.speed
    return Decision(True, direction, decision.speed, RuleId.ROUND_ZONE, aim, time, decision.miss)


class Before(NamedTuple):
    """A row of the knowledge base that stands before every strategy's table."""

    id: RuleId
    when: str  # the condition, in words
    then: str  # the action, in words
    source: str
    module: Module


KEEPS_OUT: tuple[Before, ...] = (
    Before(
        RuleId.LEAVE_ZONE,
        "it is in a zone",
        "the shortest way out of it",
        "whatever the strategy decides",
        Module.GEOMETRIC,
    ),
    Before(
        RuleId.ROUND_ZONE,
        "the way decided leads into a zone",
        "the free ray nearest to the way round it, by its tangents",
        "whatever the strategy decides",
        Module.GEOMETRIC,
    ),
)
