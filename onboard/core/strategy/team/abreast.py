"""The answer to an evader that dodges: pursuers that come from one side come abreast, as a wall.

A faster evader that turns as fast as a pursuer passes it from `dodge_bound.dodge_always` on: beside it
another must be. Each keeps its place in the wall, a spacing from the next. Who is nearest to the evader's
course goes for it as early as its turn takes where that leads between two of them, and as late as COMMIT
where the evader turns past all: till then the outermost waits where it would come. The others keep beside.
Kernel style.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.game.views import PursuerView
from onboard.core.geometry.free_ray import within
from onboard.core.geometry.lead import lead
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import NORTH, TINY, Vec, along, distance, dot, scale, sub, unit
from onboard.core.strategy.knowledge import Decision, RuleId, silent
from onboard.core.strategy.pursuit import TURNING, turned

TOGETHER = 0.87  # cosine of the angle between two lines of sight up to which pursuers come from one side
COMMIT = 4.0  # [s] before the meeting at which the nearest goes for the evader at the latest
ANSWER = 1.0  # [s] until a turn that is ordered shows
WIDE = 1.45  # times the separation: the spacing of the wall
LEAST = 2.0  # times R: the spacing where no separation is kept


class Wall(NamedTuple):
    """The pursuers that come from one side, seen by one of them."""

    size: int
    rank: int  # own, from left to right
    first: int  # rank of who is nearest to the evader's course
    leads: bool  # that is oneself
    off: float  # how far that one is from the course [m]
    far: float  # and from the evader [m]
    between: bool  # the evader's course leads between two of them, not past all


def wall_of(view: PursuerView, sight: Vec, right: Vec) -> Wall:
    """The own wall: whoever sees the evader on a line near the own `sight` (unit); `right` is across it."""
    own, e = view.own, view.evader
    lead_index = view.own_index
    off, place = aside(own, view), 0.0
    count, rank = 1, 0
    lowest = highest = side_of(own, view)
    for k in range(len(view.members)):
        mate = view.members[k]
        if k == view.own_index or not beside(mate, view, sight):
            continue
        count += 1
        side = side_of(mate, view)
        lowest, highest = min(lowest, side), max(highest, side)
        offset = dot(sub(mate.position, own.position), right)
        if offset < 0.0 or (offset == 0.0 and k < view.own_index):
            rank += 1
        its = aside(mate, view)
        if its < off or (its == off and k < lead_index):
            lead_index, off, place = k, its, offset
    first = 0
    for k in range(len(view.members)):
        if k == lead_index or not (k == view.own_index or beside(view.members[k], view, sight)):
            continue
        offset = dot(sub(view.members[k].position, own.position), right)
        if offset < place or (offset == place and k < lead_index):
            first += 1
    far = distance(e.position, own.position)
    if lead_index != view.own_index:
        far = distance(e.position, view.members[lead_index].position)
    return Wall(count, rank, first, lead_index == view.own_index, off, far, lowest < 0.0 < highest)


def beside(mate: Vehicle, view: PursuerView, sight: Vec) -> bool:
    """Whether a mate comes from the same side; one without speed counts for nothing."""
    if mate.speed <= 0.0:
        return False
    there = sub(view.evader.position, mate.position)
    return dot(unit(Vec(there.x, there.y, 0.0), NORTH), sight) >= TOGETHER


def abreast(view: PursuerView) -> Decision:
    """Pursuers that come from one side: to the own place in the wall, while another goes for the evader."""
    own, e = view.own, view.evader
    line = sub(e.position, own.position)
    sight = unit(Vec(line.x, line.y, 0.0), NORTH)
    right = Vec(-sight.y, sight.x, 0.0)
    wall = wall_of(view, sight, right)
    speeds = max(own.speed + e.speed, TINY)
    due = max(COMMIT, needed(wall.off, view)) if wall.between else COMMIT
    commits = wall.far / speeds < due
    if wall.size < 2 or (wall.leads and commits):
        return silent(view.heading, e.position)
    spacing = max(WIDE * view.rules.separation, LEAST * view.rules.R)
    middle = 1.0 * wall.first if commits else 0.5 * (wall.size - 1)
    aim = along(e.position, right, (wall.rank - middle) * spacing)
    motion = scale(view.heading, e.speed)
    ahead = within(lead(own.position, own.speed, aim, motion), view.limits, view.rules.planar)
    ahead = turned(own.velocity, ahead, view.limits.turn_rate * TURNING)
    time = distance(own.position, e.position) / speeds
    place = along(own.position, ahead, own.speed * time)
    return Decision(True, ahead, own.speed, RuleId.ABREAST, place, time, 0.0)


def needed(off: float, view: PursuerView) -> float:
    """How long a pursuer takes to come within half of R of a course `off` [m] away [s]: ½ v ω t²."""
    across = view.own.speed * view.limits.turn_rate
    if across <= TINY:
        return 0.0
    return ANSWER + sqrt(2.0 * max(0.0, off - 0.5 * view.rules.R) / across)


def side_of(member: Vehicle, view: PursuerView) -> float:
    """How far a pursuer is to the right of the evader's course [m]."""
    r = sub(member.position, view.evader.position)
    return r.y * view.heading.x - r.x * view.heading.y


def aside(member: Vehicle, view: PursuerView) -> float:
    """How far a pursuer is from the evader's course [m]; from the evader where that leads away."""
    r = sub(member.position, view.evader.position)
    on = max(0.0, dot(r, view.heading))
    return sqrt(max(0.0, dot(r, r) - on * on))
