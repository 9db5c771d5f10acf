"""What a team's planner is given, and what it answers.

Places in the game frame [m; NED], velocities through the air [m/s], times in seconds of the game's clock.
A member is known by its place in the tuple, which is the pursuers' order in the roster.
"""

from __future__ import annotations

from enum import IntEnum
from math import inf, pi
from typing import NamedTuple

from onboard.core.game.rules import NO_TARGET, Rules, Target
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec

NEAREST = 10.0  # safety distances ρ that a plane game's pursuers stage away from the evader, and
NEAREST_IN_SPACE = 17.0  # those in space: 1.5 km with the 88 m of the shipped scenarios
NOBODY = -1  # where a member is asked for and there is none


class Goal(IntEnum):
    """What a team is after."""

    NONE = 0
    RING = 1  # complete the ring before the evader sets out
    HOLD = 2  # hold the closed ring
    TIGHTEN = 3  # go on: a band open by little closes in the chase
    DENY_ALL = 4  # keep every target
    DENY_IN_DEPTH = 5  # keep the target, with a second at hand in case the first is lost
    DENY = 6  # keep the target
    CHASE = 7  # pursue, nothing better is known


class Choice(NamedTuple):
    """A goal, and what it follows from."""

    goal: Goal
    rule: int  # number of the rule of goals that spoke; 0 = none
    about: int  # number of the target (or of the member) that it is about; −1 = none
    strength: float  # of the relation that decided, 0 … 1


NO_GOAL = Choice(Goal.NONE, 0, -1, 0.0)


class Role(IntEnum):
    """What a pursuer is there for."""

    CHASER = 1  # pursues by its own strategy
    RING = 2  # takes its slot of the ring that closes the evader's band
    GOALKEEPER = 3  # is at the target before the evader
    BLOCKER = 4  # stands between evader and target, its cone closing the corridor with its neighbour's
    RESERVE = 5  # has no part now


class Reason(IntEnum):
    """Why a pursuer has its role."""

    NONE = 0
    ENCLOSED = 1  # the band is closed: nobody leaves the ring
    SLOT = 2  # it reaches this slot in time
    SLOT_LATE = 3  # no slot is reached in time; this one soonest
    FIRST_AT_TARGET = 4  # it is at the target before the evader
    CLOSES_CORRIDOR = 5  # it is in time for its place across the corridor
    NO_GAP_IN_REACH = 6  # the band stays open, and nothing better than the chase is known
    LOST = 7  # nothing is heard of it, or it cannot fly on
    SECOND = 8  # it comes to the target should the keeper be lost: the chase forces nothing
    BETWEEN = 9  # the one pursuer that keeps two targets: where it is in time for either


class Member(NamedTuple):
    """One pursuer of the team."""

    vehicle: Vehicle
    limits: VehicleLimits
    fit: bool  # False: lost, silent or flown by its pilot; it counts for nothing


class Heights(NamedTuple):
    """Between which heights above the origin the game may be flown [m]."""

    floor: float = -1e9
    ceiling: float = 1e9


class Margin(NamedTuple):
    """What the planner does not trust."""

    delay: float = 0.0  # [s] from a measurement to the pursuer's answer to it
    sigma: float = 0.0  # [m] of the evader's track, one sigma


class Situation(NamedTuple):
    """Everything that a plan follows from."""

    now: float  # [s]
    t0: float  # [s] when the evader sets out (or is expected to notice); in the past once it has
    evader: Vehicle
    evader_limits: VehicleLimits
    team: tuple[Member, ...]
    target: Target  # on the ground; does not exist where the pursuers do not know it
    wind: Vec  # where the air moves to [m/s]
    rules: Rules
    heights: Heights
    margin: Margin
    expected: Vec  # [m; NED] where the evader is at t0; until then it is taken to stay about there
    nearest: float  # [m] no pursuer stages nearer to that place than this
    targets: tuple[Target, ...] = (NO_TARGET,)  # all, where several are known, those that exist first


class Band(NamedTuple):
    """The directions in which the evader can go: all closed, or the largest way out."""

    closed: bool  # no free ray, with the margin
    gap: float  # [rad of heading] of the widest way out; negative: the smallest overlap
    bearing: float  # [rad, north to east] of its middle, as seen from the evader
    pitch: float  # [rad, up] where it is widest
    closer: int  # who goes farthest to close it while the evader stands; NOBODY: none can
    closes: float  # [s] when it is closed then; inf: it cannot be


class Assignment(NamedTuple):
    """One pursuer's part."""

    role: Role
    aim: Vec  # where it goes [m; NED]
    heading: float  # [rad, north to east] of its nose there
    due: float  # [s] when it has to be there
    reason: Reason


class Plan(NamedTuple):
    """What the whole team does."""

    time: float  # [s] for which it was made
    assignments: tuple[Assignment, ...]  # one a member, in the members' order
    band: Band
    choice: Choice = NO_GOAL  # what it is after, and why


OPEN = Band(False, 2.0 * pi, 0.0, 0.0, NOBODY, inf)
IDLE = Assignment(Role.RESERVE, ZERO, 0.0, inf, Reason.NONE)


def idle(_member: Member, _index: int, _shared: float) -> Assignment:
    """A member without a part (for `each`)."""
    return IDLE


def nearest_staged(rules: Rules) -> float:
    """How near to the evader pursuers may be when it sets out [m]."""
    return (NEAREST if rules.planar else NEAREST_IN_SPACE) * rules.rho


def target_count(s: Situation) -> int:
    """How many targets the pursuers know."""
    count = 0
    for k in range(len(s.targets)):
        if s.targets[k].exists:
            count += 1
    if count > 0:
        return count
    return 1 if s.target.exists else 0


def target_at(s: Situation, number: int) -> Target:
    """The target of a number below `target_count`."""
    if s.targets[0].exists:
        return s.targets[number]
    return s.target
