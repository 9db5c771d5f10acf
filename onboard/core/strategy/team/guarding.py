"""Who guards known targets while the evader's band is open.

A pursuer can be at a place before the evader where |p − x| / v_p ≤ |e − x| / v_e. Kernel style but for local
lists.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.game.rules import Target
from onboard.core.math.each import each
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import TINY, Vec, along, clamp, distance, sub, unit, yaw_of
from onboard.core.strategy.denial import GUARD, LATE, kept_at, spare, stands
from onboard.core.strategy.team.assignment import FORBIDDEN, assigned
from onboard.core.strategy.team.parts import chasing, lost
from onboard.core.strategy.team.plan_types import (
    Assignment,
    Member,
    Plan,
    Reason,
    Role,
    Situation,
    target_at,
    target_count,
)

POSTS = 2  # at the target at most: one to keep the goal, one that blocks beside it
CHANGE = 3.0  # [s] that a change of parts costs
SECOND = 3.0 * CHANGE  # [s] that the second post costs: nobody stays there while the goal stands empty
LATER = 100.0  # [s] that the posts at a target cost that the evader reaches later than another
LIGHT = 0.01  # share that the way of a second who is only at hand counts: it does not choose the keeper
EMPTY = 1e4  # [s] that a post costs that nobody takes though somebody could be there in time


def place_stands(s: Situation, limits: VehicleLimits) -> bool:
    """Whether who has these limits keeps the target by standing on it."""
    return stands(limits) and s.rules.epsilon_min <= s.rules.R


def post(s: Situation, limits: VehicleLimits, number: int, goal: Vec) -> Vec:
    """Where who has these limits guards a target [m; NED]: as a goalkeeper does, the second beside the
    first."""
    e = s.evader.position
    place = kept_at(goal, e, limits, s.rules)
    if number == 0:
        return place
    towards = unit(sub(e, goal), Vec(1.0, 0.0, 0.0))
    across = unit(Vec(-towards.y, towards.x, 0.0), Vec(0.0, 1.0, 0.0))
    beside = max(2.0 * s.rules.separation, s.rules.rho)
    # On the side to which the evader flies: there it comes round.
    side = across.x * s.evader.velocity.x + across.y * s.evader.velocity.y
    return along(place, across, beside if side >= 0.0 else -beside)


class Duty(NamedTuple):
    """What is to be guarded."""

    every: bool  # all targets that are known; else the one named
    target: Target  # that one
    second: bool  # one more stays at hand, though who stands on a target needs no help there


class _Parts(NamedTuple):
    """Who has which post (for `each`)."""

    situation: Situation
    posts: list[int]  # by member: target · POSTS + its number there; −1 = none
    places: list[Vec]  # by member, of those who have one [m; NED]
    reasons: list[Reason]


def _part(member: Member, index: int, shared: _Parts) -> Assignment:
    """A part while the band is open (for `each`)."""
    s = shared.situation
    number = shared.posts[index]
    if not member.fit:
        return lost(member, s.now)
    if number < 0:
        return chasing(member, s, Reason.NO_GAP_IN_REACH)
    place = shared.places[index]
    out = sub(s.evader.position, place)
    due = s.now + distance(s.evader.position, place) / max(s.evader.speed, TINY)
    role = Role.GOALKEEPER if number % POSTS == 0 else Role.BLOCKER
    return Assignment(role, place, yaw_of(out), due, shared.reasons[index])


def _targets(s: Situation, duty: Duty) -> list[Vec]:
    """The places that are to be guarded, the one that the evader has soonest first."""
    if not duty.every:
        return [duty.target.position]
    found = [target_at(s, 0).position]
    for k in range(1, target_count(s)):
        place = target_at(s, k).position
        if distance(s.evader.position, place) < distance(s.evader.position, found[0]):
            found.insert(0, place)
        else:
            found.append(place)
    return found


def guarded(s: Situation, previous: Plan, duty: Duty) -> tuple[Assignment, ...]:
    """Everybody's part: posts to those who are there before the evader, as little way as possible in all."""
    n = len(s.team)
    goals = _targets(s, duty)
    count = POSTS * len(goals)
    tasks = count + n
    costs = [0.0] * (n * tasks)
    for i in range(n):
        for number in range(count):
            costs[i * tasks + number] = _cost(s, previous, duty, (i, number), goals)
        for number in range(count, tasks):
            costs[i * tasks + number] = EMPTY
    found = assigned(costs, n, tasks)
    posts = [-1 for _ in range(n)]
    places = [s.evader.position for _ in range(n)]
    reasons = [Reason.NONE for _ in range(n)]
    for i in range(n):
        if found[i] < count:
            k = found[i] % POSTS
            posts[i] = found[i]
            places[i] = post(s, s.team[i].limits, k, goals[found[i] // POSTS])
            reasons[i] = Reason.FIRST_AT_TARGET if k == 0 else Reason.CLOSES_CORRIDOR
            if k > 0 and place_stands(s, s.team[i].limits):
                reasons[i] = Reason.SECOND
    parts = _Parts(s, posts, places, reasons)
    if len(goals) > 1:
        _kept_between(parts, goals)
    return each(_part, s.team, parts)


def _its_way(s: Situation, goals: list[Vec], number: int, place: Vec) -> float:
    """How far the evader has to a place [m]: to a later target by way of the first, which is kept."""
    if number == 0:
        return distance(s.evader.position, place)
    return distance(s.evader.position, goals[0]) + distance(goals[0], place)


def _cost(s: Situation, previous: Plan, duty: Duty, task: tuple[int, int], goals: list[Vec]) -> float:
    """What it costs [s] that a member takes a post, `task` being its number and the post's."""
    i, number = task[0], task[1] % POSTS
    goal = goals[task[1] // POSTS]
    member = s.team[i]
    mine = Role.GOALKEEPER if number == 0 else Role.BLOCKER
    place = post(s, member.limits, number, goal)
    held = previous.assignments[i].role == mine
    if duty.every:  # of which target it is the part is told by its place
        held = held and distance(previous.assignments[i].aim, place) <= s.rules.rho
    cost = distance(member.vehicle.position, place) / max(member.vehicle.speed, TINY)
    its = _its_way(s, goals, task[1] // POSTS, place) / max(s.evader.speed, TINY)
    late = LATE * its
    near = distance(member.vehicle.position, s.evader.position) < GUARD * s.rules.rho
    over = its - cost
    second = number > 0 and duty.second and place_stands(s, member.limits)
    if not member.fit or (over < -late and not second):
        cost = FORBIDDEN
    elif near and not stands(member.limits):
        cost = FORBIDDEN  # it engages
    elif number > 0 and place_stands(s, member.limits) and not second:
        cost = FORBIDDEN  # one on the target is enough
    cost = cost if held else cost + CHANGE
    if second and cost < FORBIDDEN:
        cost *= LIGHT
    return cost + SECOND * number + LATER * (task[1] // POSTS)


def _kept_between(parts: _Parts, goals: list[Vec]) -> None:
    """Who keeps a target while nobody keeps another that it reaches too keeps both, from between them."""
    s = parts.situation
    n = len(s.team)
    for j in range(len(goals)):
        kept = False
        for i in range(n):
            kept = kept or parts.posts[i] == POSTS * j
        if kept:
            continue
        best = -1
        most = 0.0
        for i in range(n):
            number = parts.posts[i]
            if number >= 0 and number % POSTS == 0 and place_stands(s, s.team[i].limits):
                over = spare(s.team[i].vehicle, s.evader, goals[j])
                if over >= most and parts.reasons[i] != Reason.BETWEEN:
                    most = over
                    best = i
        if best >= 0:
            parts.places[best] = halfway(s, s.team[best], goals[parts.posts[best] // POSTS], goals[j])
            parts.reasons[best] = Reason.BETWEEN


def halfway(s: Situation, member: Member, one: Vec, other: Vec) -> Vec:
    """Where on the line between two targets a member has as much time over for the one as for the other.

    That is (L + γ (d₁ − d₂)) / 2 from the first, L their distance and d the evader's; it keeps both from
    there while d₁ + d₂ ≥ L / γ, and the place moves no faster than the member can.
    """
    long = distance(one, other)
    gamma = member.vehicle.speed / max(s.evader.speed, TINY)
    nearer = distance(s.evader.position, one) - distance(s.evader.position, other)
    a = clamp(0.5 * (long + gamma * nearer), 0.0, long)
    return along(one, sub(other, one), a / max(long, TINY))
