"""The plan of a team: from everybody's place to a part for each pursuer, with its reason.

Before the evader sets out: a ring that closes its band when it does. After that nobody leaves a closed
ring; while the band is open and the target is known, who is there before the evader guards it, and the others
chase. A plan follows from the situation and the plan before, and from nothing else. Kernel style but for
local lists.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.math.each import each
from onboard.core.strategy.team.closure import escapes, way_out
from onboard.core.strategy.team.guarding import guarded
from onboard.core.strategy.team.parts import chasing, lost
from onboard.core.strategy.team.plan_types import (
    NOBODY,
    OPEN,
    Assignment,
    Band,
    Member,
    Plan,
    Reason,
    Situation,
    idle,
)
from onboard.core.strategy.team.ring import closing, staged

EVERY = 0.5  # [s] between two plans
KEEP = 0.09  # [rad] a ring that was closed counts as closed until it is open by this, in space
WIDE = 0.5  # [rad] in space a band open by less may close in the chase: nobody leaves it for the target


def no_plan(team: tuple[Member, ...], now: float) -> Plan:
    """The plan before the first: nobody has a part."""
    return Plan(now, each(idle, team, 0.0), OPEN)


def plan(s: Situation, previous: Plan) -> Plan:
    """What the team does from now on. `previous` is what it does now (`no_plan` where there is none)."""
    if s.now < s.t0:
        return Plan(s.now, staged(s, previous), closing(s, way_out(s)))
    return engaged(s, previous)


def engaged(s: Situation, previous: Plan) -> Plan:
    """What the team does once the evader has set out."""
    way = way_out(s)
    was = previous.band.closed and previous.time >= s.t0
    free = escapes(s)
    if way.closed or (was and way.gap <= KEEP and not (free and s.rules.planar)):
        band = Band(True, way.gap, way.bearing, way.pitch, NOBODY, s.now)
        return Plan(s.now, each(_chase, s.team, _Shared(s, Reason.ENCLOSED)), band)
    band = closing(s, way)
    if s.target.exists and way.gap > (0.0 if s.rules.planar else WIDE) and free:
        return Plan(s.now, guarded(s, previous), band)
    return Plan(s.now, each(_chase, s.team, _Shared(s, Reason.NO_GAP_IN_REACH)), band)


class _Shared(NamedTuple):
    """What a chase is given with (for `each`)."""

    situation: Situation
    reason: Reason


def _chase(member: Member, _index: int, shared: _Shared) -> Assignment:
    """The chase as a part, or none for who is lost (for `each`)."""
    s = shared.situation
    if not member.fit:
        return lost(member, s.now)
    return chasing(member, s, shared.reason)
