"""Trajectory tracking (3.6): a timed route, its pseudo-target, and the two strategies that follow it.

Kernel style. The pseudo-target c flies the route ideally: straight legs, each at the constant
groundspeed that its times demand. Strategy 1 (30) corrects point by point: to the next waypoint, at the
speed that meets its time. Strategy 2 (31) pursues the pseudo-target: to the point where the Apollonius
sphere (in wind an ellipsoid) says that the vehicle meets it.
"""

from __future__ import annotations

from enum import IntEnum
from math import sqrt
from typing import NamedTuple

from onboard.core.geometry.apollonius import intercept
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import (
    NORTH,
    TINY,
    Vec,
    along,
    clamp,
    direction,
    distance,
    dot,
    norm,
    pitch_of,
    scale,
    sub,
    unit,
    yaw_of,
)

SOONEST = 0.3  # [s] no waypoint is approached as if it were nearer in time
MOST_WAITS = 12  # times Strategy 2 puts off the meeting while it is ahead
NEAR = 30.0  # [m] a waypoint this near counts as passed once it recedes


class Waypoint(NamedTuple):
    """E_j of the route and its instant t_j^(e)."""

    position: Vec  # [m; NED]
    time: float  # [s since the route's start]


class Strategy(IntEnum):
    """How the route is followed."""

    CHOOSE = 0  # whichever the knowledge base chooses
    POINT_BY_POINT = 1  # (30)
    PURSUIT = 2  # (31)
    STRAIGHT = 3  # for comparison: at the next waypoint at the nominal airspeed


class PseudoTarget(NamedTuple):
    """The pseudo-target c at one instant."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    leg: int  # index of the waypoint it flies to


class Setting(NamedTuple):
    """What a vehicle brings to its route."""

    limits: VehicleLimits
    nominal: float  # [m/s; air] of straight flight
    ahead: float  # [s] Strategy 2 meets the pseudo-target no sooner: longer than the path takes to answer
    ordered: Strategy  # flown throughout; CHOOSE lets the knowledge base choose


class Tracker(NamedTuple):
    """A vehicle on its route, as the strategies see it."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    setting: Setting
    wind: Vec  # [m/s; NED] mean, as estimated
    time: float  # [s since the route's start]
    leg: int  # index of the next waypoint
    route: tuple[Waypoint, ...]


class Steering(NamedTuple):
    """What a strategy asks for."""

    velocity: Vec  # [m/s; relative to the air]
    aim: Vec  # the point it heads for [m]
    time: float  # until then [s]


def pseudo_target(route: tuple[Waypoint, ...], time: float) -> PseudoTarget:
    """c at `time` [s]: before the start at the first waypoint, after the end flying on."""
    leg = 1
    while leg < len(route) - 1 and time >= route[leg].time:
        leg += 1
    start = route[leg - 1]
    end = route[leg]
    velocity = scale(sub(end.position, start.position), 1.0 / max(end.time - start.time, TINY))
    since = time - start.time
    if since < 0.0:
        since = 0.0
    return PseudoTarget(along(start.position, velocity, since), velocity, leg)


def passed(route: tuple[Waypoint, ...], leg: int, position: Vec, velocity: Vec) -> bool:
    """Whether waypoint `leg` lies behind: beyond its plane across the leg, or near and receding."""
    here = route[leg].position
    before = route[leg - 1].position
    behind = sub(position, here)
    if dot(behind, sub(here, before)) >= 0.0:
        return True
    return dot(behind, velocity) >= 0.0 and dot(behind, behind) < NEAR * NEAR


def air_velocity(ground: Vec, speed: float, wind: Vec, limits: VehicleLimits) -> Vec:
    """The velocity through the air that follows the unit vector `ground` at groundspeed `speed`.

    Wind triangle; where the airspeed or the pitch it needs is beyond the limits, the course over ground
    is kept as well as it can be and the speed gives way.
    """
    ahead = dot(wind, ground)
    cross = Vec(wind.x - ahead * ground.x, wind.y - ahead * ground.y, wind.z - ahead * ground.z)
    side = dot(cross, cross)
    wanted = speed - ahead
    airspeed = sqrt(side + wanted * wanted) if wanted > 0.0 else 0.0
    airspeed = clamp(airspeed, limits.speed_min, limits.speed_max)
    forward = sqrt(max(0.0, airspeed * airspeed - side))
    air = Vec(ground.x * forward - cross.x, ground.y * forward - cross.y, ground.z * forward - cross.z)
    heading = unit(air, ground)
    pitch = pitch_of(heading)
    held = clamp(pitch, limits.pitch_min, limits.pitch_max)
    if held != pitch:
        heading = direction(held, yaw_of(heading))
    return scale(heading, airspeed)


def point_by_point(t: Tracker) -> Steering:
    """Strategy 1 (30): straight to the next waypoint, at the groundspeed that meets its time."""
    goal = t.route[t.leg]
    left = max(goal.time - t.time, SOONEST)
    far = distance(goal.position, t.position)
    ground = unit(sub(goal.position, t.position), unit(t.velocity, NORTH))
    return Steering(air_velocity(ground, far / left, t.wind, t.setting.limits), goal.position, left)


def pursue(t: Tracker) -> Steering:
    """Strategy 2 (31): to where the vehicle meets its pseudo-target, d(e(T), c(T)) → min, T → min.

    T is the intercept by the Apollonius sphere in the moving air (on the ground an ellipsoid), at full
    speed, but no less than the setting's `ahead`; the aim is c's place at T on its route, corners included.
    """
    c = pseudo_target(t.route, t.time)
    seen = sub(c.velocity, t.wind)
    meeting = intercept(c.position, unit(seen, NORTH), norm(seen), t.position, t.setting.limits.speed_max)
    reach = t.setting.ahead
    if meeting.exists and meeting.time > reach:
        reach = meeting.time
    elif not meeting.exists:
        reach = max(reach, distance(c.position, t.position) / max(t.setting.limits.speed_max, TINY))
    there = pseudo_target(t.route, t.time + reach)
    for _ in range(MOST_WAITS):  # ahead of c: no turning back, but a later meeting, at the least speed
        way = sub(there.position, along(t.position, t.wind, reach))
        slowest = t.setting.limits.speed_min * reach
        if dot(way, there.velocity) > 0.0 and dot(way, way) >= slowest * slowest:
            break
        reach *= 1.3
        there = pseudo_target(t.route, t.time + reach)
    aim = there.position
    line = sub(aim, t.position)
    ground = unit(line, unit(c.velocity, NORTH))
    return Steering(air_velocity(ground, norm(line) / reach, t.wind, t.setting.limits), aim, reach)


def straight(t: Tracker) -> Steering:
    """For comparison: at the next waypoint, nose on it, at the nominal airspeed, whatever the time."""
    goal = t.route[t.leg].position
    heading = unit(sub(goal, t.position), unit(t.velocity, NORTH))
    far = distance(goal, t.position)
    return Steering(scale(heading, t.setting.nominal), goal, far / max(t.setting.nominal, TINY))


def steer(strategy: Strategy, t: Tracker) -> Steering:
    """The named strategy's steering."""
    if strategy == Strategy.POINT_BY_POINT:
        return point_by_point(t)
    if strategy == Strategy.PURSUIT:
        return pursue(t)
    return straight(t)
