"""How a plane passes its team mates: it cannot stop, so it looks ahead and turns, climbs or sinks in time.

A demand is free while the way that it leads on, turn included, stays clear of every mate that flies straight
on, for as long as a way out takes. Else the first way out that is clear is flown, and where none is, the one
that leaves most room. Kernel style.
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.each import each
from onboard.core.math.states import Mate
from onboard.core.math.vectors import TINY, ZERO, Vec, clamp
from onboard.core.safety.envelope import believable
from onboard.core.safety.policy import Envelope, Policy

EARLY = 1.3  # times what a way out takes: so far ahead a plane looks
LONGEST = 60.0  # [s] that it looks ahead at most
STEPS = 8  # into which that time is cut
SLACK = 0.05  # of the distance, kept besides
STRAY = 3.0  # [m/s] by which gusts and a mate's own turning let the distance shrink
CLIMB_LAG = 1.5  # [s] until a plane climbs as told
TURN_AHEAD = 2.0  # [s] of turning by which an ordered course leads the present one: the bank is full then
LATER, LATEST = 1.5, 0.75  # [s] before the last way out closes that the higher id, and the lower, takes it
BESIDE = 0.3  # sine of the angle from its course at which the mate's place counts as beside it
WAYS = 9  # the demand; it climbing or sinking; left and right, each as demanded, climbing, sinking


class Passing(NamedTuple):
    """A mate that may be met."""

    line: Vec  # from the own place to it [m]
    velocity: Vec  # [m/s; ground]
    keep: float  # distance [m]
    time: float  # [s] for which it is looked at; below 0 not at all
    first: bool  # it has the lower id


class Moved(NamedTuple):
    """A plane as it flies now."""

    velocity: Vec  # [m/s; ground]
    rate: float  # that it turns with [rad/s]
    reaction: float  # [s] until it begins to


class Room(NamedTuple):
    """What a way leaves between a plane and its mates."""

    least: float  # of distance less what is to be kept, at the nearest [m]
    mate: int  # with whom


def turning(e: Envelope) -> float:
    """The turn rate of a plane that may be counted on [rad/s]."""
    return clamp(
        min(e.turn_rate if e.turn_rate > 0.0 else pi, e.speed_max / max(e.turn_radius, 1.0)), 1e-3, pi
    )


def ahead(keep: float, policy: Policy) -> float:
    """How far ahead a plane looks [s]: a turn wins ½ a t² across, a = v ω."""
    across = max(policy.envelope.speed_max * turning(policy.envelope), 0.1)
    return min(LONGEST, EARLY * (policy.reaction + sqrt(2.0 * keep / across)))


class _Looking(NamedTuple):
    """Who looks at its mates (for `each`)."""

    position: Vec
    id: int
    policy: Policy


def met(position: Vec, own_id: int, mates: tuple[Mate, ...], policy: Policy) -> tuple[Passing, ...]:
    """The mates as they may be met; of those that are not near enough the time is below 0."""
    return each(_passing, mates, _Looking(position, own_id, policy))


def _passing(mate: Mate, _index: int, looking: _Looking) -> Passing:
    """A mate that may be met (for `each`)."""
    (position, own_id, policy) = looking
    e = policy.envelope
    unmet = Passing(ZERO, ZERO, 0.0, -1.0, False)
    if mate.id == own_id or not mate.age <= policy.mate_forget:
        return unmet
    if not believable(mate.position, mate.velocity):
        return unmet
    quiet = mate.age > policy.mate_age
    keep = policy.separation * (2.0 if quiet else 1.0)
    time = ahead(keep, policy)
    x = mate.position.x - position.x
    y = mate.position.y - position.y
    z = mate.position.z - position.z
    w = mate.velocity
    far = keep * (1.0 + SLACK) + (e.speed_max + STRAY + sqrt(w.x * w.x + w.y * w.y + w.z * w.z)) * time
    if x * x + y * y + z * z < 2.0 * far * far:  # the wind carries both
        return Passing(Vec(x, y, z), w, keep, time, mate.id < own_id)
    return unmet


def anybody(near: tuple[Passing, ...]) -> bool:
    """Whether any mate may be met."""
    for one in near:  # noqa: SIM110 (a loop compiles)
        if one.time >= 0.0:
            return True
    return False


def room(now: Moved, aim: Vec, near: tuple[Passing, ...]) -> Room:
    """The room on the way to a velocity `aim` [m/s; ground], turn and climb as the plane makes them."""
    longest = 0.0
    for one in near:
        longest = max(longest, one.time)
    dt = longest / STEPS
    level = sqrt(aim.x * aim.x + aim.y * aim.y)
    course = atan2(now.velocity.y, now.velocity.x)
    left = wrap(atan2(aim.y, aim.x) - course) if level > TINY else 0.0
    x, y, z = 0.0, 0.0, 0.0
    t = 0.0
    best = Room(1e18, -1)
    held = course  # of the velocity vx, vy
    vx = level * cos(held)
    vy = level * sin(held)
    for _ in range(STEPS):
        most = now.rate * clamp(t + dt - now.reaction, 0.0, dt)
        turned = clamp(left, -most, most)
        if course + 0.5 * turned != held:
            held = course + 0.5 * turned
            vx = level * cos(held)
            vy = level * sin(held)
        late = clamp(CLIMB_LAG + now.reaction - t, 0.0, dt)
        vz = (now.velocity.z * late + aim.z * (dt - late)) / dt
        for k in range(len(near)):
            one = near[k]
            if t > one.time:
                continue
            ax = one.line.x + one.velocity.x * t - x
            ay = one.line.y + one.velocity.y * t - y
            az = one.line.z + one.velocity.z * t - z
            wx, wy, wz = one.velocity.x - vx, one.velocity.y - vy, one.velocity.z - vz
            inside = t <= 0.0 and ax * ax + ay * ay + az * az <= one.keep * one.keep
            square = wx * wx + wy * wy + wz * wz
            closing = -(ax * wx + ay * wy + az * wz)
            u = 0.0
            if inside or closing >= dt * max(square, TINY):
                u = dt  # inside, how fast it comes out counts
            elif closing > 0.0:
                u = closing / max(square, TINY)
            ax, ay, az = ax + wx * u, ay + wy * u, az + wz * u
            gone = one.keep * (1.0 + SLACK) + STRAY * (t + u)
            distance = ax * ax + ay * ay + az * az
            if best.least + gone > 0.0 and distance < (best.least + gone) * (best.least + gone):
                best = Room(sqrt(distance) - gone, k)
        x, y, z = x + vx * dt, y + vy * dt, z + vz * dt
        left -= turned
        course += turned
        t += dt
    return best


def pass_clear(v: Vec, now: Moved, position: Vec, near: tuple[Passing, ...], policy: Policy) -> Vec:
    """The velocity with which a plane passes its mates: `v` [m/s; ground] while it leaves a way out.

    It is free where its own way is clear, and where it can be flown for a while longer and a way out is clear
    still. The lower id waits longer, so that the higher gives way first.
    """
    free = room(now, v, near)
    if free.least >= 0.0:
        return v
    one = near[free.mate]
    wait = LATER if one.first else LATEST
    later = Moved(now.velocity, now.rate, now.reaction + wait)
    if best_way(v, later, position, near, one, policy).room.least >= 0.0:
        return v
    found = best_way(v, now, position, near, one, policy)
    return found.aim if found.room.least > free.least else v


class Found(NamedTuple):
    """A way out."""

    aim: Vec  # velocity [m/s; ground]
    room: Room


def best_way(
    v: Vec, now: Moved, position: Vec, near: tuple[Passing, ...], one: Passing, policy: Policy
) -> Found:
    """The first way out that is clear, else that with most room; `one` is the mate in the way."""
    side = side_of(v, one)
    up = rises(one)
    best = Found(v, Room(-1e18, -1))
    for way in range(1, WAYS):
        aim = way_out(way, v, now, side, up)
        aim = Vec(aim.x, aim.y, climb_within(aim.z, position, policy))
        here = room(now, aim, near)
        if here.least > best.room.least:
            best = Found(aim, here)
        if here.least >= 0.0:
            break
    return best


def way_out(way: int, v: Vec, now: Moved, side: float, up: bool) -> Vec:
    """Way out number `way` (1…8) as a velocity: climbs first, then turns to the `side`, then to the other.

    The climbs are as steep as any plane's; `climb_within` cuts them.
    """
    turn = (way - 1) // 2 if way <= 2 else 1 + (way - 3) // 3
    lift = (way - 1) % 2 + 1 if way <= 2 else (way - 3) % 3
    z = v.z
    if lift != 0:
        z = -1e3 if up == (lift == 1) else 1e3
    if turn == 0:
        return Vec(v.x, v.y, z)
    level = sqrt(v.x * v.x + v.y * v.y)
    lead = min(now.rate * (TURN_AHEAD + now.reaction), 0.5 * pi)
    course = atan2(now.velocity.y, now.velocity.x) + (side if turn == 1 else -side) * lead
    return Vec(level * cos(course), level * sin(course), z)


def climb_within(z: float, position: Vec, policy: Policy) -> float:
    """A vertical velocity [m/s; down] as the plane can fly it, level where floor or ceiling leave no room."""
    e = policy.envelope
    z = clamp(z, -e.climb_max, e.sink_max)
    for fence in policy.fences:
        if z < 0.0 and -position.z > fence.high - policy.separation:
            z = 0.0
        if z > 0.0 and -position.z < fence.low + policy.separation:
            z = 0.0
    return z


def side_of(v: Vec, one: Passing) -> float:
    """To which side a plane turns: 1 right, −1 left.

    Away from where the mate will be when both are nearest; where that is ahead or behind, away from where it
    is; head on to the right.
    """
    wx, wy = one.velocity.x - v.x, one.velocity.y - v.y
    square = max(wx * wx + wy * wy, TINY)
    time = clamp(-(one.line.x * wx + one.line.y * wy) / square, 0.0, one.time)
    level = max(sqrt(v.x * v.x + v.y * v.y), TINY)
    nx, ny = -v.y / level, v.x / level  # to the right
    cx, cy = one.line.x + wx * time, one.line.y + wy * time
    miss = sqrt(cx * cx + cy * cy)
    beside = (cx * nx + cy * ny) / max(miss, TINY) if miss > 1e-3 * one.keep else 0.0
    if abs(beside) < BESIDE:
        far = max(sqrt(one.line.x * one.line.x + one.line.y * one.line.y), TINY)
        beside = (one.line.x * nx + one.line.y * ny) / far
    return 1.0 if beside <= 1e-3 else -1.0


def rises(one: Passing) -> bool:
    """Whether a plane climbs rather than sinks: the higher one, and of two that are level the lower id."""
    if abs(one.line.z) > 0.05 * one.keep:
        return one.line.z > 0.0
    return not one.first
