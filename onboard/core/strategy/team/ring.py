"""The ring of the plan: slots before t₀, and who would close the band of an evader that stood still.

Kernel style but for local lists.
"""

from __future__ import annotations

from math import asin, atan2, cos, inf, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.each import each
from onboard.core.math.vectors import TINY, Vec, clamp, distance, yaw_of
from onboard.core.strategy.team.assignment import FORBIDDEN, assigned
from onboard.core.strategy.team.closure import SIGMAS, WayOut, past, pitch_band, sight_cone
from onboard.core.strategy.team.parts import front_line, lost, setting_out
from onboard.core.strategy.team.plan_types import (
    NOBODY,
    Assignment,
    Band,
    Member,
    Plan,
    Reason,
    Role,
    Situation,
)
from onboard.core.strategy.team.staging import Ring, least_gap, radius_at, ring_of, slots_of, stacked, swing
from onboard.core.strategy.team.timed import out_in_time, timed_swing

TURNED = 0.63  # [rad] that a pursuer turns on its way to a slot, more or less: 8 s at 4.5 deg/s
EASE = 1.0  # [rad] of overlap with a neighbour beyond which more is worth nothing
TURNED_AWAY = 0.1  # [rad] by which the line to the target may turn before the slots are laid anew
LONGEST = 1000.0  # [s] that a standing evader is waited for when asking who would close the band
HALVINGS = 10
CHANGE = 0.05  # share of its way by which another slot has to be nearer before it is taken instead


class Order(NamedTuple):
    """The fit members as they stand around a place, north to east from a line."""

    who: list[int]  # member
    bearings: list[float]  # [rad, −π…π] from the line
    far: list[float]  # [m] level distance
    halves: list[float]  # [rad] half the heading that each closes
    reach: list[float]  # [m] that each can fly until then


def in_order(s: Situation, centre: Vec, line: float, time: float) -> Order:
    """The fit members around `centre`, with `time` [s] to fly."""
    order = Order([0][:0], [0.0][:0], [0.0][:0], [0.0][:0], [0.0][:0])
    steepest = 0.0
    if not s.rules.planar:
        band = pitch_band(s.evader, s.evader_limits, s.heights, past(s))
        steepest = max(band.pitch_max, -band.pitch_min)
    for i in range(len(s.team)):
        member = s.team[i]
        if not member.fit:
            continue
        own = member.vehicle
        x = own.position.x - centre.x
        y = own.position.y - centre.y
        bearing = wrap(atan2(y, x) - line)
        far = sqrt(x * x + y * y)
        sure = s.rules.R - own.speed * s.margin.delay - SIGMAS * s.margin.sigma
        half = sight_cone(own.speed / max(s.evader.speed, TINY), steepest)
        half = clamp(half + asin(clamp(sure / max(far, s.nearest, TINY), -1.0, 1.0)), 0.0, pi)
        turning = TURNED / member.limits.turn_rate if member.limits.turn_rate > 0.0 else 0.0
        k = 0
        while k < len(order.who) and order.bearings[k] <= bearing:
            k += 1
        order.who.insert(k, i)
        order.bearings.insert(k, bearing)
        order.far.insert(k, far)
        order.halves.insert(k, half)
        order.reach.insert(k, own.speed * max(0.0, time - turning))
    return order


class Swings(NamedTuple):
    """Between which bearings everybody can be, in order [rad]; and who is on time nowhere."""

    lows: list[float]
    highs: list[float]
    late: list[bool]


def timely(member: Member) -> bool:
    """Whether a member has to arrive on time: it cannot stand, and turns no faster than is said."""
    return member.limits.speed_min > 0.0 and member.limits.turn_rate > 0.0


def swings_of(s: Situation, order: Order, line: float) -> Swings:
    """How far each can change its bearing until t₀."""
    n = len(order.who)
    found = Swings([0.0] * n, [0.0] * n, [False] * n)
    for i in range(n):
        member = s.team[order.who[i]]
        own = order.bearings[i]
        if timely(member):
            swung = timed_swing(member, s, line + own)
            found.lows[i] = own + swung.low
            found.highs[i] = own + swung.high
            found.late[i] = swung.late
        else:
            most = swing(order.far[i], order.reach[i], s.nearest)
            found.lows[i] = own - most
            found.highs[i] = own + most
            found.late[i] = order.far[i] + order.reach[i] < s.nearest
    return found


def closing(s: Situation, way: WayOut) -> Band:
    """The band with who would close it and when, while the evader stands where it is."""
    if way.closed:
        return Band(True, way.gap, way.bearing, way.pitch, NOBODY, s.now)
    order = in_order(s, s.evader.position, 0.0, LONGEST)
    n = len(order.who)
    if n == 0 or sum_of(order.halves) < pi:
        return Band(False, way.gap, way.bearing, way.pitch, NOBODY, inf)
    late = LONGEST
    early = 0.0
    for _ in range(HALVINGS):
        middle = sqrt(max(early, 0.1) * late)
        swings = _swings_in(s, order, middle)
        low = [order.bearings[i] - swings[i] for i in range(n)]
        high = [order.bearings[i] + swings[i] for i in range(n)]
        if least_gap(low, high, order.halves) <= 0.0:
            late = middle
        else:
            early = middle
    swings = _swings_in(s, order, late)
    low = [order.bearings[i] - swings[i] for i in range(n)]
    high = [order.bearings[i] + swings[i] for i in range(n)]
    gap = least_gap(low, high, order.halves)
    if gap > 0.0:
        return Band(False, way.gap, way.bearing, way.pitch, NOBODY, inf)
    slots = slots_of(Ring(max(gap, 0.0), -1, 0.0), order.bearings, low, high, order.halves)
    closer = NOBODY
    farthest = -1.0
    for i in range(n):
        way_there = abs(slots[i] - order.bearings[i]) * order.far[i]
        if way_there > farthest:
            farthest = way_there
            closer = order.who[i]
    return Band(False, way.gap, way.bearing, way.pitch, closer, s.now + late)


def sum_of(items: list[float]) -> float:
    """The sum of a list."""
    found = 0.0
    for item in items:
        found += item
    return found


def _swings_in(s: Situation, order: Order, time: float) -> list[float]:
    """How far each changes its bearing in a `time` [s], keeping ρ of the evader."""
    found = [0.0] * len(order.who)
    for k in range(len(order.who)):
        speed = s.team[order.who[k]].vehicle.speed
        far = order.far[k]
        found[k] = swing(far, speed * time, min(far, s.rules.rho))
    return found


class Slots(NamedTuple):
    """Where the ring's members go."""

    aims: list[Vec]  # by member; the own place of who has none
    late: list[bool]  # by member: not reached until t0


def laid(s: Situation) -> Slots:
    """The slots of the best ring that can stand at t₀, each given to the member that has the shortest way."""
    line = front_line(s)
    time = max(0.0, s.t0 - s.now)
    order = in_order(s, s.expected, line, time)
    n = len(order.who)
    aims = [member.vehicle.position for member in s.team]
    late = [False for member in s.team]
    if n == 0:
        return Slots(aims, late)
    swings = swings_of(s, order, line)
    ring = ring_of(swings.lows, swings.highs, order.halves, EASE, True)
    eased = Ring(max(ring.gap, -EASE), ring.front, ring.off)
    bearings = slots_of(eased, order.bearings, swings.lows, swings.highs, order.halves)
    places = [s.expected for _ in range(n)]
    stand = True
    for i in range(n):
        member = s.team[order.who[i]]
        out = radius_at(order.far[i], bearings[i] - order.bearings[i], s.nearest)
        if timely(member):
            stand = False
            out = out_in_time(member, s, line + bearings[i], out)
        a = line + bearings[i]
        places[i] = Vec(s.expected.x + out * cos(a), s.expected.y + out * sin(a), s.expected.z)
    found = [i for i in range(n)]
    if stand:
        found = _nearest_slots(s, order, places)
    if s.rules.separation > 0.0 and not s.rules.planar:
        places = stacked(places, s.rules.separation, s.heights)
    for i in range(n):
        aims[order.who[i]] = places[found[i]]
        late[order.who[i]] = swings.late[i]
    return Slots(aims, late)


def _nearest_slots(s: Situation, order: Order, places: list[Vec]) -> list[int]:
    """The slot of everybody in order, so that the squares of the ways are least and all are in time."""
    n = len(places)
    costs = [0.0] * (n * n)
    for i in range(n):
        own = s.team[order.who[i]].vehicle.position
        for j in range(n):
            away = _level(own, places[j])
            costs[i * n + j] = away * away
            if i == j:
                costs[i * n + j] *= (1.0 - CHANGE) * (1.0 - CHANGE)
            elif away > order.reach[i]:
                costs[i * n + j] += FORBIDDEN
    return assigned(costs, n, n)


def _level(a: Vec, b: Vec) -> float:
    return sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y))


class _Staging(NamedTuple):
    """What a slot is given with (for `each`)."""

    situation: Situation
    slots: Slots


def _slot(member: Member, index: int, shared: _Staging) -> Assignment:
    """A slot as a part (for `each`)."""
    s = shared.situation
    if not member.fit:
        return lost(member, s.now)
    return slot_at(member, s, shared.slots.aims[index], shared.slots.late[index])


def slot_at(member: Member, s: Situation, aim: Vec, late: bool) -> Assignment:
    """A slot as a part: there at t₀, the nose on the heading of parallel pursuit."""
    heading = yaw_of(lead(aim, member.vehicle.speed, s.expected, setting_out(s)))
    return Assignment(Role.RING, aim, heading, s.t0, Reason.SLOT_LATE if late else Reason.SLOT)


class _Kept(NamedTuple):
    """What is kept of a plan (for `each`)."""

    situation: Situation
    plan: Plan


def _same(member: Member, index: int, shared: _Kept) -> Assignment:
    """The slot of the plan before (for `each`)."""
    if not member.fit:
        return lost(member, shared.situation.now)
    return shared.plan.assignments[index]


def staged(s: Situation, previous: Plan) -> tuple[Assignment, ...]:
    """Everybody's slot. Slots once laid are kept while the team and the evader's place are what they were."""
    if _holds(s, previous):
        return each(_same, s.team, _Kept(s, previous))
    return each(_slot, s.team, _Staging(s, laid(s)))


def _holds(s: Situation, previous: Plan) -> bool:
    """Whether the slots of the plan before are still good."""
    for i in range(len(s.team)):
        part = previous.assignments[i]
        if s.team[i].fit != (part.role == Role.RING):
            return False
        if s.team[i].fit:
            if part.due != s.t0:
                return False
            meant = lead(part.aim, s.team[i].vehicle.speed, s.expected, setting_out(s))
            if abs(wrap(yaw_of(meant) - part.heading)) > TURNED_AWAY:
                return False
            if distance(part.aim, s.expected) < s.nearest - 2.0 * s.rules.rho:
                return False
    return True
