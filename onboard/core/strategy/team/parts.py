"""Single parts of a plan, and the heading on which a chase begins. Kernel style."""

from __future__ import annotations

from math import atan2

from onboard.core.game.views import heading_at
from onboard.core.geometry.lead import lead
from onboard.core.math.vectors import TINY, Vec, distance, scale, sub, unit, yaw_of
from onboard.core.strategy.team.plan_types import Assignment, Member, Reason, Role, Situation


def setting_out(s: Situation) -> Vec:
    """The velocity with which the evader is expected to set out: to its target where that is known [m/s]."""
    ahead = heading_at(s.evader)
    if s.target.exists:
        line = sub(s.target.position, s.expected)
        ahead = unit(Vec(line.x, line.y, 0.0), ahead)
    return scale(ahead, s.evader.speed)


def front_line(s: Situation) -> float:
    """The bearing from the evader's place at t₀ on which one pursuer should stand [rad, north to east]."""
    v = setting_out(s)
    return atan2(v.y, v.x)


def lost(member: Member, now: float) -> Assignment:
    """The part of who is lost."""
    return Assignment(Role.RESERVE, member.vehicle.position, 0.0, now, Reason.LOST)


def chasing(member: Member, s: Situation, reason: Reason) -> Assignment:
    """The chase as a part: the aim is the evader, due when a head-on meeting would be."""
    own, e = member.vehicle, s.evader
    far = distance(own.position, e.position)
    heading = yaw_of(lead(own.position, own.speed, e.position, e.velocity))
    due = s.now + far / max(own.speed + e.speed, TINY)
    return Assignment(Role.CHASER, e.position, heading, due, reason)
