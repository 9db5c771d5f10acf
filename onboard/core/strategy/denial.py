"""Denying a known target: who keeps the goal, who blocks the corridor, and where they stand.

A pursuer can be at a place before the evader where |p − x| / v_p ≤ |e − x| / v_e (`spare`). A target counts
as kept while somebody can be there first; nobody leaves the chase for that while the evader has no free ray.
Each pursuer decides alone, all by the same view, and so they agree who goes. Kernel style.
"""

from __future__ import annotations

from math import asin, atan, atan2, cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.game.rules import Rules
from onboard.core.game.views import PursuerView, level
from onboard.core.geometry.cones import blocked_cones
from onboard.core.geometry.free_ray import free_ray_limited, within
from onboard.core.math.angles import wrap
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, TINY, Vec, along, clamp, distance, dot, norm, scale, sub, unit
from onboard.core.strategy.knowledge import Decision, RuleId, silent

LATE = 0.25  # share of the evader's time to a post by which a pursuer may be late and still goes
GUARD = 3.5  # safety distances ρ from the target at which it is guarded by who cannot stand on it
OVERLAP = 0.8  # share of the widest spacing that closes a corridor which a blocking line uses
AT_IT = 1.0  # [s] by which who flies to a post already goes before who does not
APPROACH = 0.5  # [s] a post is approached no faster than this much time away
WIDER = 1.3  # times its smallest turn a craft orbits a post


class Post(NamedTuple):
    """Where a pursuer is to stand, and whether there is one for it."""

    exists: bool
    place: Vec  # [m; NED]


def spare(own: Vehicle, evader: Vehicle, place: Vec) -> float:
    """How long before the evader a pursuer is at a place [s]; negative: after it."""
    its = distance(evader.position, place) / max(evader.speed, TINY)
    return its - distance(own.position, place) / max(own.speed, TINY)


def stands(limits: VehicleLimits) -> bool:
    """Whether a vehicle can stand still."""
    return limits.speed_min <= 0.0


def way_out(view: PursuerView) -> bool:
    """Whether the evader has a free ray at its safety distance ρ, as far as its pursuers know.

    Its limits of pitch are not known: they are taken to be the own ones.
    """
    quarry = Vehicle(view.evader.position, scale(view.heading, view.evader.speed), view.evader.speed)
    cones = blocked_cones(quarry, view.members, view.rules.rho)
    return free_ray_limited(view.heading, cones, view.limits, view.rules.planar).exists


def goal_post(view: PursuerView) -> Vec:
    """Where the target is kept [m; NED].

    Who can stand, and captures farther off than the evader has to come, stands on the target: nobody arrives
    there without being captured. Who cannot orbits a place before it, on the line to the evader.
    """
    return kept_at(view.target.position, view.evader.position, view.limits, view.rules)


def kept_at(goal: Vec, e: Vec, limits: VehicleLimits, rules: Rules) -> Vec:
    """`goal_post` of a target from an evader at `e`, for a vehicle of these limits."""
    if stands(limits) and rules.epsilon_min <= rules.R:
        return goal
    out = min(GUARD * rules.rho, 0.5 * distance(e, goal))
    return along(goal, unit(sub(e, goal), NORTH), out)


def keeper(view: PursuerView, place: Vec) -> int:
    """Who keeps a place: the member that is there first, if it is in time; −1 where nobody is.

    Of two that are as fast there the one goes that flies there already.
    """
    best = -1
    most = -1e300
    least = -LATE * distance(view.evader.position, place) / max(view.evader.speed, TINY)
    for index in range(len(view.members)):
        member = view.members[index]
        left = spare(member, view.evader, place)
        line = unit(sub(place, member.position), NORTH)
        worth = left + AT_IT * dot(member.velocity, line) / max(member.speed, TINY)
        if left >= least and worth > most:
            most = worth
            best = index
    return best


def line_post(view: PursuerView, first: int) -> Post:
    """The own place in the blocking line: on an arc about the target, across the corridor to the evader.

    `first` keeps its middle. Who is in time for the target stands beside it, in the order of bearings, as far
    apart as the cones of neighbours still overlap as the evader sees them.
    """
    goal, e = view.target.position, view.evader.position
    own = view.members[view.own_index]
    long = distance(e, goal)
    reach = min(GUARD * view.rules.rho, 0.5 * long)
    if long <= TINY or spare(own, view.evader, goal) < -LATE * long / max(view.evader.speed, TINY):
        return Post(False, goal)
    corridor = atan2(e.y - goal.y, e.x - goal.x)
    middle = view.members[first].position
    mine = wrap(atan2(own.position.y - goal.y, own.position.x - goal.x) - corridor)
    centre = wrap(atan2(middle.y - goal.y, middle.x - goal.x) - corridor)
    place = 1
    for index in range(len(view.members)):
        other = view.members[index]
        if index == first or index == view.own_index:
            continue
        if spare(other, view.evader, goal) < -LATE * long / max(view.evader.speed, TINY):
            continue
        its = wrap(atan2(other.position.y - goal.y, other.position.x - goal.x) - corridor)
        same = (its >= centre) == (mine >= centre)
        if same and (abs(its - centre) < abs(mine - centre) or (its == mine and index < view.own_index)):
            place += 1
    half = asin(clamp(own.speed / max(view.evader.speed, TINY), 0.0, 1.0))
    half += asin(clamp(view.rules.rho / max(long - reach, view.rules.rho), 0.0, 1.0))
    apart = 2.0 * OVERLAP * min(half, 0.25 * pi)  # as the evader sees it
    step = min(apart, 2.0 * atan(0.5 * apart * (long - reach) / max(reach, TINY)))
    angle = corridor + (place if mine >= centre else -place) * step
    return Post(True, Vec(goal.x + reach * cos(angle), goal.y + reach * sin(angle), goal.z))


def at_post(view: PursuerView, place: Vec, rule: RuleId) -> Decision:
    """To a place [m; NED], and there: standing, or in a circle about it where the vehicle cannot stand."""
    own, limits = view.own, view.limits
    line = level(sub(place, own.position), view.rules.planar)
    far = norm(line)
    time = far / max(own.speed, TINY)
    if stands(limits):
        ahead = within(unit(line, view.heading), limits, view.rules.planar)
        return Decision(True, ahead, min(own.speed, far / APPROACH), rule, place, time, 0.0)
    radius = WIDER * own.speed / limits.turn_rate if limits.turn_rate > 0.0 else view.rules.rho
    course = atan2(line.y, line.x)
    course -= 0.5 * pi * clamp(2.0 - far / radius, 0.0, 2.0)  # on the circle along it, inside out to it
    climb = clamp(line.z / max(far, radius), -1.0, 1.0)
    flat = sqrt(max(0.0, 1.0 - climb * climb))
    ahead = within(Vec(flat * cos(course), flat * sin(course), climb), limits, view.rules.planar)
    return Decision(True, ahead, own.speed, rule, place, time, 0.0)


def _on_guard(view: PursuerView) -> bool:
    """Whether there is a target to guard, a way to it, and the evader is not at hand for who cannot stand."""
    if not view.target.exists or len(view.members) == 0:
        return False
    near = distance(view.own.position, view.evader.position) < GUARD * view.rules.rho
    if near and not stands(view.limits):
        return False
    return way_out(view)


def keep_goal(view: PursuerView) -> Decision:
    """The goalkeeper: it can be at the target first, and the evader has a free ray; the others chase."""
    if not _on_guard(view):
        return silent(view.heading, view.evader.position)
    place = goal_post(view)
    if keeper(view, place) != view.own_index:
        return silent(view.heading, view.evader.position)
    return at_post(view, place, RuleId.KEEP_GOAL)


def hold_line(view: PursuerView) -> Decision:
    """A blocker: beside the goalkeeper across the corridor between evader and target."""
    if not _on_guard(view):
        return silent(view.heading, view.evader.position)
    first = keeper(view, goal_post(view))
    if first < 0 or first == view.own_index:
        return silent(view.heading, view.evader.position)
    post = line_post(view, first)
    if not post.exists:
        return silent(view.heading, view.evader.position)
    return at_post(view, post.place, RuleId.HOLD_LINE)
