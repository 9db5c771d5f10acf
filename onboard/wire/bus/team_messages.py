"""The pursuers' plan on the bus: who is there for what, where, until when and why. See `messages`."""

from __future__ import annotations

from enum import Enum

from onboard.wire.bus.knowledge_messages import PlannedGoal
from onboard.wire.bus.messages import Message, Triple


class TeamRole(Enum):
    """What a pursuer is there for."""

    CHASER = "chaser"
    RING = "ring"
    GOALKEEPER = "goalkeeper"
    BLOCKER = "blocker"
    RESERVE = "reserve"


class PartReason(Enum):
    """Why a pursuer has its role."""

    NONE = ""
    ENCLOSED = "enclosed: nobody leaves the ring"
    SLOT = "reaches its slot in time"
    SLOT_LATE = "no slot is reached in time, this one soonest"
    FIRST_AT_TARGET = "at the target before the evader"
    CLOSES_CORRIDOR = "in time for its place across the corridor"
    NO_GAP_IN_REACH = "the band stays open"
    LOST = "not heard, or cannot fly on"
    SECOND = "at hand should the keeper be lost: the chase forces nothing"
    BETWEEN = "in time for either of two targets"


class PlannedPart(Message, frozen=True):
    """One pursuer's part of the plan."""

    id: int
    role: TeamRole
    aim: Triple  # [m; NED]
    heading: float  # of its nose there [rad, north to east]
    due: float  # [s] since t0; -1 = at no instant
    reason: PartReason


class PlannedBand(Message, frozen=True):
    """The ways out that one of several evaders has, as the planner sees them; see `TeamPlan`."""

    quarry: int  # id of the evader
    closed: bool
    gap: float  # [rad]
    bearing: float  # [rad, north to east]
    pitch: float  # [rad, up]
    closer: int  # id of who goes farthest to close it; 0 = nobody can
    closes: float  # [s] since t0; -1 = never


class TeamPlan(Message, frozen=True):
    """`vehicles/<id>/plan`: what the planner, vehicle <id>, has its team do."""

    id: int  # of the planner
    stamp_ns: int
    t: float  # for which it was made [s] since t0
    parts: tuple[PlannedPart, ...]
    closed: bool  # whether the evader has no free ray
    gap: float  # of its widest way out [rad]; negative: the smallest overlap
    bearing: float  # of the middle of that [rad, north to east]
    pitch: float  # where it is widest [rad, up]
    closer: int = 0  # id of who goes farthest to close it; 0 = nobody can
    closes: float = -1.0  # when it is closed then [s] since t0; -1 = never
    nonce: int = 0  # of the planner's process
    quarries: tuple[int, ...] = ()  # of several evaders: whom each is after, in the order of `parts`
    bands: tuple[PlannedBand, ...] = ()  # of several evaders: each one's; the widest stands above
    goals: tuple[PlannedGoal, ...] = ()  # what the team is after, one for each evader that is planned against
