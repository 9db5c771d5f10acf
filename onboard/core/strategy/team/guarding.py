"""Who guards a known target while the evader's band is open.

A pursuer can be at a place before the evader where |p − x| / v_p ≤ |e − x| / v_e. Kernel style but for local
lists.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.math.each import each
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import TINY, Vec, along, distance, sub, unit, yaw_of
from onboard.core.strategy.denial import GUARD, LATE, kept_at, spare, stands
from onboard.core.strategy.team.assignment import FORBIDDEN, assigned
from onboard.core.strategy.team.parts import chasing, lost
from onboard.core.strategy.team.plan_types import Assignment, Member, Plan, Reason, Role, Situation

POSTS = 2  # at the target at most: one to keep the goal, one that blocks beside it
CHANGE = 3.0  # [s] that a change of parts costs
SECOND = 3.0 * CHANGE  # [s] that the second post costs: nobody stays there while the goal stands empty
EMPTY = 1e4  # [s] that a post costs that nobody takes though somebody could be there in time


def place_stands(s: Situation, limits: VehicleLimits) -> bool:
    """Whether who has these limits keeps the target by standing on it."""
    return stands(limits) and s.rules.epsilon_min <= s.rules.R


def post(s: Situation, limits: VehicleLimits, number: int) -> Vec:
    """Where who has these limits guards the target [m; NED]: as a goalkeeper does, the second beside the
    first."""
    e, goal = s.evader.position, s.target.position
    place = kept_at(goal, e, limits, s.rules)
    if number == 0:
        return place
    towards = unit(sub(e, goal), Vec(1.0, 0.0, 0.0))
    across = unit(Vec(-towards.y, towards.x, 0.0), Vec(0.0, 1.0, 0.0))
    beside = max(2.0 * s.rules.separation, s.rules.rho)
    # On the side to which the evader flies: there it comes round.
    side = across.x * s.evader.velocity.x + across.y * s.evader.velocity.y
    return along(place, across, beside if side >= 0.0 else -beside)


class _Parts(NamedTuple):
    """Who has which post (for `each`)."""

    situation: Situation
    posts: list[int]  # by member; −1 = none


def _part(member: Member, index: int, shared: _Parts) -> Assignment:
    """A part while the band is open (for `each`)."""
    s = shared.situation
    number = shared.posts[index]
    if not member.fit:
        return lost(member, s.now)
    if number < 0:
        return chasing(member, s, Reason.NO_GAP_IN_REACH)
    place = post(s, member.limits, number)
    out = sub(s.evader.position, place)
    due = s.now + distance(s.evader.position, place) / max(s.evader.speed, TINY)
    if number == 0:
        return Assignment(Role.GOALKEEPER, place, yaw_of(out), due, Reason.FIRST_AT_TARGET)
    return Assignment(Role.BLOCKER, place, yaw_of(out), due, Reason.CLOSES_CORRIDOR)


def guarded(s: Situation, previous: Plan) -> tuple[Assignment, ...]:
    """Everybody's part: posts to those who are there before the evader, as little way as possible in all."""
    n = len(s.team)
    tasks = POSTS + n
    costs = [0.0] * (n * tasks)
    for i in range(n):
        member = s.team[i]
        was = previous.assignments[i].role
        for number in range(POSTS):
            place = post(s, member.limits, number)
            mine = Role.GOALKEEPER if number == 0 else Role.BLOCKER
            held = was == mine
            cost = distance(member.vehicle.position, place) / max(member.vehicle.speed, TINY)
            late = LATE * distance(s.evader.position, place) / max(s.evader.speed, TINY)
            near = distance(member.vehicle.position, s.evader.position) < GUARD * s.rules.rho
            if not member.fit or spare(member.vehicle, s.evader, place) < -late:
                cost = FORBIDDEN
            elif near and not stands(member.limits):
                cost = FORBIDDEN  # it engages
            elif number > 0 and place_stands(s, member.limits):
                cost = FORBIDDEN  # one on the target is enough
            costs[i * tasks + number] = (cost if held else cost + CHANGE) + SECOND * number
        for number in range(POSTS, tasks):
            costs[i * tasks + number] = EMPTY
    found = assigned(costs, n, tasks)
    posts = [-1 for _ in range(n)]
    for i in range(n):
        if found[i] < POSTS:
            posts[i] = found[i]
    return each(_part, s.team, _Parts(s, posts))
