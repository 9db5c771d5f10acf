"""Who goes for whom where there are several evaders: each pursuer has one quarry.

An evader first gets as many pursuers as close its band, while there are so many; where there are not, each
gets one before any gets a second, and who reaches its target soonest is served first. Who gets which is the
assignment of least time (`assignment`). Kernel style but for local lists.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import NamedTuple

from onboard.core.game.rules import Rules, Target
from onboard.core.geometry.apollonius import closest_approach, intercept
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, TINY, distance, sub, unit
from onboard.core.strategy.team.assignment import assigned
from onboard.core.strategy.team.closure import least_number
from onboard.core.strategy.team.plan_types import NOBODY, Member

KEEP = 0.8  # another quarry is taken where that costs less than this share of the time
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
    """What a pursuer needs for an evader that flies straight on, to its target where that is known [s].

    That is the time of the intercept (12), or where there is none that of the closest approach (19) and of
    what is left then.
    """
    e = quarry.vehicle
    heading = unit(e.velocity, NORTH)
    if quarry.target.exists:
        heading = unit(sub(quarry.target.position, e.position), heading)
    meeting = intercept(e.position, heading, e.speed, own.position, own.speed)
    if meeting.exists:
        return meeting.time
    near = closest_approach(e.position, heading, e.speed, own.position, own.speed)
    if near.exists:
        return near.time + MISS * near.miss / max(own.speed, TINY)
    return AWAY * distance(own.position, e.position) / max(own.speed, TINY)


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
    """How many pursuers close an evader's band, ⌈π / asin γ⌉ in the plane; all where none suffice."""
    pace = 0.0
    fit = 0
    for member in team:
        if member.fit:
            pace += member.vehicle.speed
            fit += 1
    if fit == 0:
        return 0
    steepest = 0.0 if rules.planar else max(abs(quarry.limits.pitch_min), abs(quarry.limits.pitch_max))
    found = least_number(pace / fit / max(quarry.vehicle.speed, TINY), steepest)
    return fit if found == 0 else min(found, fit)


def shares(team: tuple[Member, ...], quarries: tuple[Quarry, ...], rules: Rules) -> list[int]:
    """How many pursuers each evader gets before any gets more than it needs: in all at most the fit ones."""
    left = 0
    for member in team:
        if member.fit:
            left += 1
    found = [0 for _ in range(len(quarries))]
    order = by_threat(quarries)
    for j in order:
        if left > 0:
            found[j] = 1
            left -= 1
    for j in order:
        more = min(left, max(0, needed(team, quarries[j], rules) - found[j]))
        found[j] += more
        left -= more
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
    """Everybody's quarry (for `each`)."""

    quarry: list[int]


def _quarry_of(_member: Member, index: int, shared: _Given) -> int:
    """One's quarry (for `each`)."""
    return shared.quarry[index]


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
    only = NOBODY
    for j in range(len(quarries)):
        if quarries[j].live:
            live += 1
            only = j
    if live == 1:
        for i in range(len(team)):
            if team[i].fit:
                given[i] = only
    elif live > 1:
        spread(given, team, quarries, previous, rules, left)
    return each(_quarry_of, team, _Given(given))


def spread(
    given: list[int],
    team: tuple[Member, ...],
    quarries: tuple[Quarry, ...],
    previous: tuple[int, ...],
    rules: Rules,
    left: float,
) -> None:
    """Write everybody's quarry into `given`: the assignment of least time to places at the evaders.

    Beyond what evaders need there is room for all, so that one's best place there stands for all of them.
    """
    who = [i for i in range(len(team)) if team[i].fit]
    share = shares(team, quarries, rules)
    places = [0 for _ in range(0)]
    for j in range(len(quarries)):
        for _ in range(share[j]):
            places.append(j)
    wanted = len(places)
    n = wanted + len(who)
    costs = [0.0] * (len(who) * n)
    others = [0 for _ in range(len(who))]
    for i in range(len(who)):
        times = times_to(team[who[i]].vehicle, quarries, previous[who[i]], left)
        least = 1e300
        for j in range(len(quarries)):
            beyond = times[j] if times[j] >= LATE else times[j] + BEYOND
            if quarries[j].live and beyond < least:
                least = beyond
                others[i] = j
        for p in range(n):
            costs[i * n + p] = times[places[p]] if p < wanted else least
    found = assigned(costs, len(who), n)
    for i in range(len(who)):
        given[who[i]] = places[found[i]] if found[i] < wanted else others[i]


def times_to(own: Vehicle, quarries: tuple[Quarry, ...], before: int, left: float) -> list[float]:
    """What a pursuer whose quarry is `before` needs for each evader [s], LATE added where it is too late."""
    times = [0.0 for _ in range(len(quarries))]
    for j in range(len(quarries)):
        times[j] = time_to_catch(own, quarries[j]) * (KEEP if j == before else 1.0)
        if late(own, quarries[j], left):
            times[j] += LATE
    return times
