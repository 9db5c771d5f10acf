"""Who goes for whom where there are several evaders: each pursuer has one quarry.

Everybody goes for the nearest evader, but for three things. Who holds a closed band stays, and who is not
needed there is free. An evader that nobody holds gets one at least, and one whose target is known as many as
close its band, while there are so many; who reaches its target soonest is served first. Who of the free ones
goes is the assignment of least time (`assignment`). Kernel style but for local lists.

That numbers alone close no band, and that a quarry should be left at once for a nearer one, is measured:
benchmarks/results/several-evaders.md.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import NamedTuple

from onboard.core.game.rules import Rules, Target
from onboard.core.game.views import NO_MEMBER
from onboard.core.geometry.apollonius import closest_approach, intercept
from onboard.core.geometry.cones import blocked_cones
from onboard.core.geometry.free_ray import free_ray_limited
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, TINY, distance, sub, unit
from onboard.core.strategy.team.assignment import assigned
from onboard.core.strategy.team.closure import least_number
from onboard.core.strategy.team.plan_types import NOBODY, Member

KEEP = 0.98  # another quarry is taken where that costs less than this share of the time
AWAY = 2.0  # an evader that flies away from a pursuer costs so many times the way to where it is
MISS = 2.0  # what is left at the closest approach counts so many times
BEYOND = 1e4  # [s] on top of a place beyond what an evader needs: filled after the others
LATE = 1e6  # [s] on top where a pursuer can be at an evader only when that one's game is over


class Quarry(NamedTuple):
    """An evader as its pursuers know it."""

    vehicle: Vehicle
    limits: VehicleLimits
    live: bool  # still in the game
    target: Target  # where it goes [m; NED]; does not exist where that is not known


Assign = Callable[
    [tuple[Member, ...], tuple[Quarry, ...], tuple[int, ...], Rules, float], tuple[int, ...]
]
"""Who goes for whom: what `quarries_of` is told and gives."""


def time_to_catch(own: Vehicle, quarry: Quarry) -> float:
    """What a pursuer needs for an evader [s].

    Where its target is known it is the time of the intercept (12) on the straight way there, or where that is
    none, of the closest approach (19) and of what is left then; else that of the way to where it is now, as
    nobody knows where it will turn.
    """
    e = quarry.vehicle
    speed = max(own.speed, TINY)
    if not quarry.target.exists:
        return distance(own.position, e.position) / speed
    heading = unit(sub(quarry.target.position, e.position), unit(e.velocity, NORTH))
    meeting = intercept(e.position, heading, e.speed, own.position, own.speed)
    if meeting.exists:
        return meeting.time
    near = closest_approach(e.position, heading, e.speed, own.position, own.speed)
    if near.exists:
        return near.time + MISS * near.miss / speed
    return AWAY * distance(own.position, e.position) / speed


def threat(quarry: Quarry) -> float:
    """When an evader is at its target if nobody is in its way [s]; inf where no target is known."""
    if not quarry.target.exists:
        return inf
    return distance(quarry.vehicle.position, quarry.target.position) / max(quarry.vehicle.speed, TINY)


def late(own: Vehicle, quarry: Quarry, left: float) -> bool:
    """Whether a pursuer cannot meet an evader, even head on, before that is at its target or time is up."""
    speeds = max(own.speed + quarry.vehicle.speed, TINY)
    return distance(own.position, quarry.vehicle.position) / speeds > min(threat(quarry), left)


def needed(team: tuple[Member, ...], quarry: Quarry, rules: Rules) -> int:
    """How many pursuers an evader should have at least.

    Where its target is known as many as close its band, ⌈π / asin γ⌉ in the plane, all where none suffice;
    else one.
    """
    pace = 0.0
    fit = 0
    for member in team:
        if member.fit:
            pace += member.vehicle.speed
            fit += 1
    if fit == 0 or not quarry.target.exists:
        return min(1, fit)
    steepest = 0.0 if rules.planar else max(abs(quarry.limits.pitch_min), abs(quarry.limits.pitch_max))
    found = least_number(pace / fit / max(quarry.vehicle.speed, TINY), steepest)
    return fit if found == 0 else min(found, fit)


def shares(
    team: tuple[Member, ...], quarries: tuple[Quarry, ...], held: list[int], free: int, rules: Rules
) -> list[int]:
    """How many of the `free` pursuers each evader gets, beside those who hold its closed band."""
    found = [0 for _ in range(len(quarries))]
    order = by_threat(quarries)
    for j in order:
        if free > 0 and held[j] == 0:
            found[j] = 1
            free -= 1
    for j in order:
        if quarries[j].target.exists:
            more = min(free, max(0, needed(team, quarries[j], rules) - held[j] - found[j]))
            found[j] += more
            free -= more
    return found


def by_threat(quarries: tuple[Quarry, ...]) -> list[int]:
    """The evaders still in the game, who reaches its target soonest first."""
    order = [0 for _ in range(0)]
    for j in range(len(quarries)):
        if quarries[j].live:
            place = len(order)
            while place > 0 and threat(quarries[order[place - 1]]) > threat(quarries[j]):
                place -= 1
            order.insert(place, j)
    return order


class _Given(NamedTuple):
    """Everybody's quarry, and one of the evaders (for `each`)."""

    quarry: list[int]
    number: int


def _quarry_of(_member: Member, index: int, shared: _Given) -> int:
    """One's quarry (for `each`)."""
    return shared.quarry[index]


def _of_group(member: Member, index: int, shared: _Given) -> Vehicle:
    """A pursuer of that evader, or what counts for nothing (for `each`)."""
    if shared.quarry[index] == shared.number:
        return member.vehicle
    return NO_MEMBER


def quarries_of(
    team: tuple[Member, ...],
    quarries: tuple[Quarry, ...],
    previous: tuple[int, ...],
    rules: Rules,
    left: float,
) -> tuple[int, ...]:
    """The number of each pursuer's quarry; NOBODY for who is lost, and where no evader is in the game.

    `previous` is what they have now (NOBODY: none), which they keep where another is not clearly better;
    `left` is how long the game still lasts [s].
    """
    given = [NOBODY for _ in range(len(team))]
    live = 0
    for j in range(len(quarries)):
        if quarries[j].live:
            live += 1
    if live > 0:
        for i in range(len(team)):
            if team[i].fit:
                given[i] = nearest(team[i].vehicle, quarries, previous[i])
    if live > 1:
        spread(given, team, quarries, previous, rules, left)
    return each(_quarry_of, team, _Given(given, NOBODY))


def nearest(own: Vehicle, quarries: tuple[Quarry, ...], before: int) -> int:
    """The evader in the game that is nearest to a pursuer whose quarry is `before`; NOBODY: none is left."""
    found = NOBODY
    least = inf
    for j in range(len(quarries)):
        if quarries[j].live:
            away = distance(own.position, quarries[j].vehicle.position) * (KEEP if j == before else 1.0)
            if away < least:
                least = away
                found = j
    return found


def holds(team: tuple[Member, ...], quarry: Quarry, given: _Given, rules: Rules) -> bool:
    """Whether the pursuers of an evader close its band: it has no free ray among their cones alone."""
    e = quarry.vehicle
    cones = blocked_cones(e, each(_of_group, team, given), rules.rho)
    return not free_ray_limited(unit(e.velocity, NORTH), cones, quarry.limits, rules.planar).exists


def needed_there(
    given: list[int], team: tuple[Member, ...], quarries: tuple[Quarry, ...], rules: Rules
) -> list[bool]:
    """Who may not leave the evader that it is `given`, as a closed band would open. Others are tried, the
    farthest first, to find who is needed."""
    stays = [False for _ in range(len(team))]
    for j in range(len(quarries)):
        group = _Given(given, j)
        if not quarries[j].live or not holds(team, quarries[j], group, rules):
            continue
        tried = [False for _ in range(len(team))]
        who = farthest(group, team, quarries[j], tried)
        while who != NOBODY:
            tried[who] = True
            given[who] = NOBODY
            stays[who] = not holds(team, quarries[j], group, rules)
            if stays[who]:
                given[who] = j
            who = farthest(group, team, quarries[j], tried)
        for i in range(len(team)):
            if tried[i]:
                given[i] = j
    return stays


def farthest(group: _Given, team: tuple[Member, ...], quarry: Quarry, tried: list[bool]) -> int:
    """Who of an evader's pursuers is farthest from it and was not tried yet; NOBODY: none is left."""
    found = NOBODY
    most = -1.0
    for i in range(len(team)):
        if group.quarry[i] == group.number and not tried[i]:
            away = distance(team[i].vehicle.position, quarry.vehicle.position)
            if away > most:
                most = away
                found = i
    return found


def spread(
    given: list[int],
    team: tuple[Member, ...],
    quarries: tuple[Quarry, ...],
    previous: tuple[int, ...],
    rules: Rules,
    left: float,
) -> None:
    """Give those who hold no band, in `given` the nearest evader's, places where evaders need them.

    Beyond what evaders need there is room for all: there everybody goes for the nearest that it can reach.
    """
    stays = needed_there(given, team, quarries, rules)
    held = [0 for _ in range(len(quarries))]
    for i in range(len(team)):
        if stays[i]:
            held[given[i]] += 1
    who = [i for i in range(len(team)) if team[i].fit and not stays[i]]
    share = shares(team, quarries, held, len(who), rules)
    places = [0 for _ in range(0)]
    for j in range(len(quarries)):
        for _ in range(share[j]):
            places.append(j)
    wanted = len(places)
    n = wanted + len(who)
    costs = [0.0] * (len(who) * n)
    others = [0 for _ in range(len(who))]
    for i in range(len(who)):
        own = team[who[i]].vehicle
        least = inf
        for j in range(len(quarries)):
            if quarries[j].live:
                kept = KEEP if j == previous[who[i]] else 1.0
                tardy = LATE if late(own, quarries[j], left) else 0.0
                away = distance(own.position, quarries[j].vehicle.position) / max(own.speed, TINY)
                beyond = away * kept + max(tardy, BEYOND)
                if beyond < least:
                    least = beyond
                    others[i] = j
                time = time_to_catch(own, quarries[j]) * kept + tardy if share[j] > 0 else 0.0
                for p in range(wanted):
                    if places[p] == j:
                        costs[i * n + p] = time
        for p in range(wanted, n):
            costs[i * n + p] = least
    found = assigned(costs, len(who), n)
    for i in range(len(who)):
        given[who[i]] = places[found[i]] if found[i] < wanted else others[i]
