"""The evader beyond the paper: it counts the cost of a turn, and does not wait when every ray is blocked.

`hysteresis` chooses between free rays with what it costs to turn. Where no ray is free, `two-leg` flies a
first leg after which one is free whatever the pursuers do, `dodge` turns across the nearest pursuer's line of
sight while that can still be passed, and `evasive` plays a fixed number of turns (`foresight`).
"""

from __future__ import annotations

from math import acos, pi, sqrt
from typing import NamedTuple

from onboard.core.game.views import EvaderView, heading_at
from onboard.core.geometry.cones import Cone, Ray, Seen, blocked_cone
from onboard.core.geometry.free_ray import free_ray_limited, within
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import (
    NORTH,
    TINY,
    Vec,
    along,
    angle_between,
    clamp,
    direction,
    distance,
    dot,
    scale,
    sub,
    unit,
    yaw_of,
)
from onboard.core.strategy.evasion import EVADER, resultant_force, target_direction
from onboard.core.strategy.foresight import STEPS, Foreseen, Wish, foreseen, turning
from onboard.core.strategy.knowledge import Decision, Module, Rule, RuleId, fold, silent

TURNING = 0.25  # an angle to the present heading costs so much of one to the goal
LEGS = (0.0, 0.7, -0.7, 1.4, -1.4, 2.1, -2.1, 3.1)  # first legs, from the present heading [rad]
SHARES = (0.45, 0.9)  # of the time for which a first leg is safe
QUICK = 0.1  # two legs are for craft whose turning radius is at most so much of the nearest distance
LEVEL = (0.0, 0.5, -0.5, 1.1, -1.1, 1.9, -1.9, 3.1)  # ways to turn [rad]
STEEP = (1.1, -1.1)  # ways to turn while climbing or sinking as steeply as allowed [rad]
DODGE_SAFETY = 1.5  # a dodge begins so much earlier than it must
TURNED = 0.3  # sine of the angle to the line of sight from which on a side is chosen
AHEAD = 1.3  # of the time until a head-on meeting is played


def goal_of(view: EvaderView) -> Vec:
    """Where the evader would fly if nobody were in the way: to its target, or along F_res (21)."""
    if view.target.exists:
        return target_direction(view)
    return unit(resultant_force(view), heading_at(view.own))


def steady_ray(view: EvaderView) -> Ray:
    """The free ray that costs least: its angle to the goal, and a share of that to the present heading.

    Two candidates: the free ray nearest to the goal, and the nearest one on the other side of it.
    """
    goal = goal_of(view)
    best = free_ray_limited(goal, view.cones, view.limits, view.rules.planar)
    flat = sqrt(goal.x * goal.x + goal.y * goal.y)
    if not best.exists or best.closeness >= 1.0 - TINY or flat <= 1e-9:
        return best
    side = Vec(-goal.y / flat, goal.x / flat, 0.0)
    if dot(best.direction, side) < 0.0:
        side = scale(side, -1.0)
    beside = (*view.cones, Cone(side, 0.0, 1.0))
    other = free_ray_limited(goal, beside, view.limits, view.rules.planar)
    if not other.exists:
        return best
    heading = heading_at(view.own)
    if cost(other, heading) < cost(best, heading):
        return other
    return best


def cost(ray: Ray, heading: Vec) -> float:
    """What a ray costs [rad]: its angle to the goal, and a share of its angle to the present heading."""
    return acos(clamp(ray.closeness, -1.0, 1.0)) + TURNING * angle_between(ray.direction, heading)


def _flown(view: EvaderView, ahead: Vec, rule: RuleId, time: float, miss: float) -> Decision:
    own = view.own
    course = within(ahead, view.limits, view.rules.planar)
    return Decision(True, course, own.speed, rule, along(own.position, course, own.speed * time), time, miss)


def steady_ray_to_target(view: EvaderView) -> Decision:
    """Rules 1–2 of 3.4.1 with the cost of turning."""
    if not view.target.exists:
        return silent(NORTH, view.target.position)
    ray = steady_ray(view)
    if not ray.exists:
        return silent(ray.direction, view.target.position)
    own = view.own
    time = distance(own.position, view.target.position) / own.speed if own.speed > TINY else 0.0
    return _flown(view, ray.direction, RuleId.STEADY_RAY_TO_TARGET, time, 0.0)


def steady_ray_from_pursuers(view: EvaderView) -> Decision:
    """Rules 1–2 without a target, with the cost of turning."""
    if view.target.exists:
        return silent(NORTH, view.target.position)
    ray = steady_ray(view)
    if not ray.exists:
        return silent(ray.direction, view.target.position)
    return _flown(view, ray.direction, RuleId.STEADY_RAY_FROM_PURSUERS, 1.0, 0.0)


def safe_for(view: EvaderView, ahead: Vec) -> float:
    """For how long [s] no pursuer can come within ρ on the ray `ahead`, whatever they do; 1e9 = ever."""
    e, v_e = view.own.position, view.own.speed
    rho = view.rules.rho
    least = 1e9
    for pursuer in view.pursuers:
        r = sub(pursuer.position, e)
        v_p = pursuer.speed
        # The first t with |v_e t u − r| = ρ + v_p t.
        a = v_e * v_e - v_p * v_p
        b = v_e * dot(ahead, r) + rho * v_p
        c = dot(r, r) - rho * rho
        if c <= 0.0:
            return 0.0
        inside = b * b - a * c
        if inside >= 0.0:
            bottom = b + sqrt(inside)
            if bottom > TINY:
                least = min(least, c / bottom)
    return least


class Later(NamedTuple):
    """The evader after its first leg."""

    place: Vec  # [m; NED]
    speed: float  # [m/s]
    rho: float  # [m]
    time: float  # flown until then [s]


def grown_cone(pursuer: Vehicle, index: int, later: Later) -> Cone:
    """What a pursuer that may be anywhere it can reach by then blocks (for `each`):
    half-angle asin γ + asin((ρ + v_p τ) / |e₁ − p|)."""
    return blocked_cone(
        pursuer, index, Seen(later.place, later.speed, later.rho + pursuer.speed * later.time)
    )


def two_legs(view: EvaderView) -> Decision:
    """Every ray is blocked, but after a first leg one is free, whatever the pursuers do: that first leg.

    For craft that turn within a small share of the nearest distance: the turns count for nothing.
    """
    own, rules = view.own, view.rules
    best = silent(NORTH, own.position)
    near = 1e300
    for pursuer in view.pursuers:
        near = min(near, distance(pursuer.position, own.position))
    if own.speed / turning(view.limits.turn_rate) > QUICK * near:
        return best
    goal = goal_of(view)
    yaw = yaw_of(own.velocity)
    most = -1e300
    for leg in LEGS:
        ahead = within(direction(0.0, yaw + leg), view.limits, rules.planar)
        safe = safe_for(view, ahead)
        for share in SHARES:
            time = share * safe
            if time <= TINY or time >= 1e8:
                continue
            place = along(own.position, ahead, own.speed * time)
            cones = each(grown_cone, view.pursuers, Later(place, own.speed, rules.rho, time))
            ray = free_ray_limited(goal, cones, view.limits, rules.planar)
            worth = ray.closeness - TURNING * abs(leg) / pi
            if ray.exists and worth > most:
                most = worth
                best = _flown(view, ahead, RuleId.TWO_LEGS, time, 0.0)
    return best


def dodge_distance(view: EvaderView, pursuer: Vehicle, turn_rate: float) -> float:
    """At what distance [m] a turn across the line of sight of an oncoming pursuer still passes it.

    Both turn as hard as they can: the evader gains ½ (ω_e v_e − ω_p v_p) t² across, which must be R before
    they meet at (v_e + v_p) t. 0 where the pursuer gains as much, or may turn at once.
    """
    own = view.own
    gained = turning(view.limits.turn_rate) * own.speed - turning(turn_rate) * pursuer.speed
    if gained <= TINY or view.limits.turn_rate <= 0.0:
        return 0.0
    return DODGE_SAFETY * (own.speed + pursuer.speed) * sqrt(2.0 * view.rules.R / gained)


def dodge(view: EvaderView) -> Decision:
    """Every ray is blocked and a pursuer comes near: across its line of sight, away from the others."""
    own = view.own
    heading = heading_at(own)
    found = -1
    near = 1e300
    for k in range(len(view.pursuers)):
        pursuer = view.pursuers[k]
        r = sub(pursuer.position, own.position)
        far = sqrt(dot(r, r))
        if far < near and dot(r, heading) > 0.0 and far <= dodge_distance(view, pursuer, view.turn_rates[k]):
            found = k
            near = far
    if found < 0 or near <= TINY:
        return silent(heading, own.position)
    at = sub(view.pursuers[found].position, own.position)
    line = unit(Vec(at.x, at.y, 0.0), NORTH)
    across = Vec(-line.y, line.x, 0.0)
    turned = dot(heading, across)
    if abs(turned) < TURNED:  # not yet committed to a side: to that with fewer and farther pursuers
        turned = 0.0
        for k in range(len(view.pursuers)):
            r = sub(view.pursuers[k].position, own.position)
            square = dot(r, r)
            if k != found and square > TINY:
                turned -= dot(r, across) / square
    side = 1.0 if turned >= 0.0 else -1.0
    return _flown(view, scale(across, side), RuleId.DODGE, near / own.speed, 0.0)


def played(view: EvaderView) -> Decision:
    """Every ray is blocked: the best of a fixed number of ways to turn, each played against the pursuers."""
    own, limits = view.own, view.limits
    near = 1e300
    fast = 0.0
    for pursuer in view.pursuers:
        near = min(near, distance(pursuer.position, own.position))
        fast = max(fast, pursuer.speed)
    heading = heading_at(own)
    if own.speed <= TINY or near >= 1e300:
        return silent(heading, own.position)
    ahead = AHEAD * near / (own.speed + fast) + 4.0 * view.rules.rho / own.speed
    step = ahead / (len(STEPS) - 1)
    rate = turning(limits.turn_rate)
    yaw = yaw_of(own.velocity)
    most = -1e300
    chosen = Wish(own.position, own.speed, yaw, 0.0, 0.0, rate, step)
    miss = 0.0
    for turn in LEVEL:
        wish = Wish(own.position, own.speed, yaw, turn, 0.0, rate, step)
        end = foreseen(view, wish)
        value = worth(view, end, turn)
        if value > most:
            most, chosen, miss = value, wish, end.smallest
    if not view.rules.planar:
        for turn in STEEP:
            for pitch in (limits.pitch_min, limits.pitch_max):
                wish = Wish(own.position, own.speed, yaw, turn, clamp(pitch, -0.6, 0.6), rate, step)
                end = foreseen(view, wish)
                value = worth(view, end, turn)
                if value > most:
                    most, chosen, miss = value, wish, end.smallest
    return _flown(view, direction(chosen.pitch, yaw + chosen.turn), RuleId.PLAYED, ahead, miss)


def worth(view: EvaderView, end: Foreseen, turn: float) -> float:
    """What a way to fly is worth: nobody within ρ, then a free ray near the goal; little turning."""
    rules = view.rules
    room = rules.rho - rules.R
    safety = clamp((end.smallest - rules.R) / room, 0.0, 1.0) if room > TINY else 1.0
    if end.smallest <= rules.R:
        safety = 0.0
    outlook = 1.0 + 0.3 * end.closeness if end.free else 0.5 * end.left / (end.left + 10.0 * rules.rho)
    return safety * outlook + 0.01 * end.smallest / (end.smallest + rules.rho) - 0.002 * abs(turn)


STEADY_RAYS: tuple[Rule[EvaderView], ...] = (
    Rule(
        RuleId.STEADY_RAY_TO_TARGET,
        "there is a target, and a ray that meets no Apollonius sphere",
        "the free ray that costs least, by its angle to F_g and a share of the turn",
        "3.4.1, rules 1–2, with the cost of turning",
        Module.GEOMETRIC,
        steady_ray_to_target,
    ),
    Rule(
        RuleId.STEADY_RAY_FROM_PURSUERS,
        "there is no target, but a ray that meets no Apollonius sphere",
        "the free ray that costs least, by its angle to F_res (21) and a share of the turn",
        "3.4.1, rules 1–2, with the cost of turning",
        Module.GEOMETRIC,
        steady_ray_from_pursuers,
    ),
)
_TWO_LEGS: Rule[EvaderView] = Rule(
    RuleId.TWO_LEGS,
    "every ray is blocked, but none after a first leg, whatever the pursuers do",
    "along that first leg",
    "cones of half-angle asin γ + asin((ρ + v_p τ) / |e₁ − p|)",
    Module.GEOMETRIC,
    two_legs,
)
_DODGE: Rule[EvaderView] = Rule(
    RuleId.DODGE,
    "every ray is blocked, and a pursuer ahead is just far enough to be passed",
    "across its line of sight, away from the others",
    "½ (ω_e v_e − ω_p v_p) t² = R",
    Module.INTELLIGENT,
    dodge,
)
_PLAYED: Rule[EvaderView] = Rule(
    RuleId.PLAYED,
    "every ray is blocked",
    "the best of a fixed number of turns, played against the pursuers",
    "nobody within ρ, a free ray afterwards",
    Module.INTELLIGENT,
    played,
)
_RESULTANT = EVADER[-1]

HYSTERESIS = (*STEADY_RAYS, _RESULTANT)
TWO_LEG = (*STEADY_RAYS, _TWO_LEGS, _RESULTANT)
DODGING = (*STEADY_RAYS, _DODGE, _RESULTANT)
EVASIVE = (*STEADY_RAYS, _TWO_LEGS, _PLAYED, _RESULTANT)

hysteresis = fold(HYSTERESIS)
two_leg = fold(TWO_LEG)
dodging = fold(DODGING)
evasive = fold(EVASIVE)
