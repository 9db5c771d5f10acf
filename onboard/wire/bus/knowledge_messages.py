"""What a team's planner knows, on the bus: a small semantic network and the goal that follows. See `base`."""

from __future__ import annotations

from enum import Enum

from onboard.wire.bus.base import Message, Triple


class TeamGoal(Enum):
    """What a team is after."""

    NONE = ""
    RING = "complete the ring"
    HOLD = "hold the ring"
    TIGHTEN = "tighten the ring"
    DENY_ALL = "deny every target"
    DENY_IN_DEPTH = "deny the target in depth"
    DENY = "deny the target"
    CHASE = "chase"


class NodeKind(Enum):
    """What a node of the network stands for."""

    TEAM = "team"
    EVADER = "evader"
    PURSUER = "pursuer"
    TARGET = "target"
    BAND = "way out"
    APOLLONIUS = "Apollonius region"
    SAFE_SIDE = "safe side"
    FENCE = "fence"


class PlannedGoal(Message, frozen=True):
    """What those who share a quarry are after, and why."""

    quarry: int  # id of the evader
    goal: TeamGoal
    target: int  # number of the target it is about, from 1; 0 = none
    rule: str  # name of the rule that spoke; "" = none
    why: str  # in words


class KnowledgeNode(Message, frozen=True):
    """One player, target or region."""

    kind: NodeKind
    number: int  # id of the vehicle, number of the target from 1; 0 where there is only one such
    name: str  # for people
    place: Triple  # its middle [m; NED]
    size: float = 0.0  # radius of a target or region [m]; of the way out its width [rad of heading]
    bearing: float = 0.0  # of the middle of the way out [rad, north to east]


class KnowledgeEdge(Message, frozen=True):
    """Something that holds between two nodes."""

    relation: str  # name
    source: int  # index in the nodes
    sink: int
    strength: float  # above 0 … 1
    value: float  # in the unit that the words say
    words: str  # for people


class Knowledge(Message, frozen=True):
    """`vehicles/<id>/knowledge`: what the planner, vehicle <id>, knows of the game against one evader."""

    id: int  # of the planner
    stamp_ns: int
    t: float  # for which it holds [s] since t0
    quarry: int  # id of the evader
    nodes: tuple[KnowledgeNode, ...]
    edges: tuple[KnowledgeEdge, ...]  # strongest first
    goal: PlannedGoal  # what follows
    nonce: int = 0  # of the planner's process
