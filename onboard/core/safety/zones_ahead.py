"""Zones with the way to stop, or to turn, ahead of them: the fence's rules turned inside out. Kernel style.

A multicopter may approach a zone as fast as it still stops before it: the part of its velocity towards the
zone's nearest place is bounded, which suffices for a convex zone. A plane needs a circle that clears it
(`fence.turn`); over a zone, and below one, it and everybody else levels off in time.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.geometry.zones import Area, after, clearance, way_out_of
from onboard.core.math.each import each, new, some_or_none
from onboard.core.math.vectors import TINY, ZERO, Vec, clamp, norm
from onboard.core.safety.braking import nearest_on, stopping_speed
from onboard.core.safety.policy import Cause, Policy

PASSES = 4  # of projection on the zones' bounds
PLENTY = 3.0  # times its speed that a vehicle cannot fly, in any wind
FAST = 1e9  # [m/s]
SINKING = 0.5  # share of the deceleration that may be counted on up and down


class Held(NamedTuple):
    """The velocity that keeps out of zones, and what changed it."""

    velocity: Vec  # [m/s; ground]
    cause: Cause


class Asked(NamedTuple):
    """A velocity, where, and what is allowed."""

    velocity: Vec  # [m/s; ground]
    position: Vec  # [m; NED]
    policy: Policy


def kept_clear(asked: Asked) -> Held:
    """The velocity with what zones bound of it: of a multicopter's all, of a plane's its climb."""
    return some_or_none(_kept_clear, _as_it_is, asked.policy.zones.areas, asked)


def _kept_clear(_areas: tuple[Area, ...], asked: Asked) -> Held:
    v, position, policy = asked
    return held_off(v, position, policy) if policy.envelope.hovers else levelled(v, position, policy)


def _as_it_is(_areas: tuple[Area, ...], asked: Asked) -> Held:
    return new(Held, (asked.velocity, Cause.NONE))


def slowed_before(asked: Asked) -> Vec:
    """The velocity scaled down until no zone is approached too fast: a last word that no fence contradicts,
    for it keeps a velocity's direction, and standing still keeps every bound."""
    return some_or_none(_slowed, _not_slowed, asked.policy.zones.areas, asked)


def _not_slowed(_areas: tuple[Area, ...], asked: Asked) -> Vec:
    return asked.velocity


def beside(x: float, y: float, position: Vec, policy: Policy) -> float:
    """How far a level place lies outside the zones at a vehicle's height [m]; 1e18 where there are none."""
    place = new(Vec, (x, y, 0.0))
    return some_or_none(_beside, _far, policy.zones.areas, new(Asked, (place, position, policy)))


def _far(_areas: tuple[Area, ...], _asked: Asked) -> float:
    return 1e18


def inside_zone(position: Vec, policy: Policy) -> Vec:
    """The level way out of the zone that a vehicle is in (unit); ZERO where it is in none."""
    return some_or_none(_inside, _in_none, policy.zones.areas, new(Asked, (ZERO, position, policy)))


def _in_none(_areas: tuple[Area, ...], _asked: Asked) -> Vec:
    return new(Vec, (0.0, 0.0, 0.0))


class Ahead(NamedTuple):
    """The place of a zone nearest to a vehicle."""

    distance: float  # [m]; negative inside
    towards: Vec  # unit
    most: float  # speed towards it that still stops in time [m/s]


def ahead(area: Area, _index: int, asked: Asked) -> Ahead:
    """How near a zone is, where, and how fast it may be approached (for `each`)."""
    _velocity, position, policy = asked
    zones, e = policy.zones, policy.envelope
    answers = policy.reaction + policy.coast
    out = way_out_of(zones, area, position, False)
    away = new(Vec, (-out.outward.x, -out.outward.y, -out.outward.z))
    if out.clearance < 0.0:
        return new(Ahead, (out.clearance, away, 0.0))
    # It is at least that far: where any speed stops in time, no nearer look is needed.
    room = out.clearance - max(policy.fence_margin, policy.height_margin)
    if stopping_speed(room, SINKING * e.deceleration, answers) >= PLENTY * e.speed_max:
        return new(Ahead, (out.clearance, away, FAST))
    x, y = position.x, position.y
    near = 1e300
    if clearance(zones, area, position, True) > 0.0:
        for index in range(area.first, area.first + area.sides):
            a, b = zones.walls[index], zones.walls[after(area, index)]
            found = nearest_on(position.x, position.y, a.x, a.y, b.x, b.y)
            if found.distance < near:
                near = found.distance
                x, y = found.x, found.y
    z = -clamp(-position.z, area.low, area.high)
    line = new(Vec, (x - position.x, y - position.y, z - position.z))
    far = norm(line)
    if far <= TINY:
        return new(Ahead, (0.0, away, 0.0))
    towards = new(Vec, (line.x / far, line.y / far, line.z / far))
    level = sqrt(line.x * line.x + line.y * line.y) / far
    margin = policy.fence_margin * level + policy.height_margin * (1.0 - level)
    slow = e.deceleration * (SINKING + (1.0 - SINKING) * level)
    return new(Ahead, (far, towards, stopping_speed(far - margin, slow, answers)))


def held_off(v: Vec, position: Vec, policy: Policy) -> Held:
    """A multicopter's velocity, slowed towards every zone it could not stop before; inside, the way out."""
    every = each(ahead, policy.zones.areas, new(Asked, (v, position, policy)))
    for near in every:
        if near.distance < 0.0:
            speed = clamp(0.5 * (policy.fence_margin - near.distance), 0.5, policy.envelope.speed_max)
            out = new(Vec, (-near.towards.x * speed, -near.towards.y * speed, -near.towards.z * speed))
            if out.z == 0.0:
                out = new(Vec, (out.x, out.y, v.z))
            return new(Held, (out, Cause.INSIDE_ZONE))
    x, y, z = v
    changed = False
    for _ in range(PASSES):
        for near in every:
            excess = x * near.towards.x + y * near.towards.y + z * near.towards.z - near.most
            if excess > 0.0:
                x -= excess * near.towards.x
                y -= excess * near.towards.y
                z -= excess * near.towards.z
                changed = changed or excess > 1e-6
    return new(Held, (slower(new(Vec, (x, y, z)), every), Cause.ZONE_AHEAD if changed else Cause.NONE))


def slower(v: Vec, every: tuple[Ahead, ...]) -> Vec:
    """The velocity scaled down until no zone is approached too fast."""
    k = 1.0
    for near in every:
        towards = v.x * near.towards.x + v.y * near.towards.y + v.z * near.towards.z
        if near.distance >= 0.0 and towards * k > near.most:
            k = near.most / towards
    return new(Vec, (v.x * k, v.y * k, v.z * k))


def _slowed(areas: tuple[Area, ...], asked: Asked) -> Vec:
    return slower(asked.velocity, each(ahead, areas, asked))


def levelled(v: Vec, position: Vec, policy: Policy) -> Held:
    """A plane's velocity with its sinking towards a zone below, and its climb to one above, bounded."""
    e = policy.envelope
    up = -position.z
    climb = -v.z
    cause = Cause.NONE
    answers = policy.reaction + policy.coast
    pace = sqrt(v.x * v.x + v.y * v.y)
    for area in policy.zones.areas:
        if clearance(policy.zones, area, position, True) > pace * answers + policy.fence_margin:
            continue
        if up >= area.high:
            least = -stopping_speed(up - policy.height_margin - area.high, SINKING * e.deceleration, answers)
            if climb < least:
                climb = least
                cause = Cause.ZONE_AHEAD
        elif up <= area.low:
            most = stopping_speed(area.low - policy.height_margin - up, SINKING * e.deceleration, answers)
            if climb > most:
                climb = most
                cause = Cause.ZONE_AHEAD
    return new(Held, (new(Vec, (v.x, v.y, -climb)), cause))


def _beside(areas: tuple[Area, ...], asked: Asked) -> float:
    place, position, policy = asked
    least = 1e18
    up = -position.z
    for area in areas:
        if area.low - policy.height_margin < up < area.high + policy.height_margin:
            least = min(least, clearance(policy.zones, area, place, True))
    return least


def _inside(areas: tuple[Area, ...], asked: Asked) -> Vec:
    _velocity, position, policy = asked
    deepest = 0.0
    out = new(Vec, (0.0, 0.0, 0.0))
    for area in areas:
        if clearance(policy.zones, area, position, False) < 0.0:
            found = way_out_of(policy.zones, area, position, True)
            if found.clearance < deepest:
                deepest = found.clearance
                out = found.outward
    return out
