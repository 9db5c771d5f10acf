"""What a team's planner knows, in the picture: which word counts, and what of it people are told. Pure."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, sin
from typing import NamedTuple

from gcs.picture.values import FateView, GameView
from onboard.core.math.constants import NS_PER_S
from onboard.game.knowledge_words import goal_in_words
from onboard.wire.bus.knowledge_messages import Knowledge, KnowledgeEdge, KnowledgeNode, NodeKind, PlannedGoal
from onboard.wire.bus.messages import Triple
from onboard.wire.bus.team_messages import TeamPlan

OLD_S = 4.0  # a word that is older than this counts no more: it comes once a second
HEARD_MOST = 64  # words that are remembered
ONCE = ("suffices", "lost", "confines", "threatens", "denies", "covers", "blocks", "holds", "flanks")
"""Relations that are told, in order: of each node that they lead to the strongest one."""
EACH = ("lost", "flanks")  # of which everybody's is told
UNTOLD = ("free", "encloses", "slower", "faster", "reaches", "inside")
"""Relations that the page says otherwise, or that would say the same of everybody; a user's own are told."""
LINES_MOST = 12  # of one evader
REACH_M = 30.0  # how far before the evader its way out is drawn

Heard = dict[tuple[int, int], tuple[Knowledge, int]]  # by planner and evader, with when it came [ns]


def counting(
    heard: Heard, plan: TeamPlan | None, now_ns: int, known: tuple[FateView, ...]
) -> tuple[Knowledge, ...]:
    """What the planner whose plan is flown knows, by evader; nothing of those who are `known` to be out."""
    over = {fate.id for fate in known if fate.out}
    if plan is None:
        return ()
    fresh = [word for word, at in heard.values() if now_ns - at <= OLD_S * NS_PER_S]
    found = [word for word in fresh if word.id == plan.id and word.quarry not in over]
    return tuple(sorted(found, key=lambda word: word.quarry))


def keep(heard: Heard, word: Knowledge, now_ns: int) -> None:
    """Remember a word; the oldest is forgotten where there are too many."""
    heard.pop((word.id, word.quarry), None)
    heard[(word.id, word.quarry)] = (word, now_ns)
    while len(heard) > HEARD_MOST:
        heard.pop(next(iter(heard)))


def goals_of(game: GameView) -> dict[int, PlannedGoal]:
    """What the team is after, by evader: as the plan says, else as its planner's last word does."""
    found = {word.quarry: word.goal for word in game.knowledge}
    if game.plan is not None:
        found |= {goal.quarry: goal for goal in game.plan.goals}
    over = {fate.id for fate in game.fates if fate.out}
    return {id: goal for id, goal in sorted(found.items()) if id not in over and goal_in_words(goal)}


def goal_lines(game: GameView) -> list[str]:
    """A line for each goal, for people: `goal E12: deny target 2, as …`; of one evader without its id."""
    found = goals_of(game)
    several = len(game.evaders) > 1
    return [f"goal{f' E{id}' if several else ''}: {goal_in_words(goal)}" for id, goal in found.items()]


def told(word: Knowledge, quarries: Mapping[int, int]) -> list[KnowledgeEdge]:
    """What of a network people are told: the strongest of each kind, then a user's own. By `quarries` a
    pursuer that is after another evader takes no part here, which is no loss."""
    best: dict[tuple[int, int, int], KnowledgeEdge] = {}
    own = [edge for edge in word.edges if edge.relation not in (*ONCE, *UNTOLD)]
    for edge in word.edges:
        source = word.nodes[edge.source].number
        elsewhere = quarries.get(source, word.quarry) != word.quarry
        if edge.relation not in ONCE or (edge.relation == "lost" and elsewhere):
            continue
        each = edge.source if edge.relation in EACH else -1
        key = (ONCE.index(edge.relation), edge.sink, each)
        if key not in best or best[key].strength < edge.strength:
            best[key] = edge
    return [*(best[key] for key in sorted(best)), *own][:LINES_MOST]


class Arc(NamedTuple):
    """What holds between two places."""

    source: int  # id of the vehicle that it comes from; 0 = none
    ends: tuple[Triple, Triple]  # [m; NED]
    words: str  # `covers 0.80, blocks 1.00`
    strength: float  # of the strongest


def arcs(word: Knowledge, quarries: Mapping[int, int]) -> list[Arc]:
    """Those that are told of which both nodes have a place: one arc for all that leads from one to the other.
    A region stands where its pursuer is."""
    found: dict[tuple[int, Triple, Triple], list[KnowledgeEdge]] = {}
    at = {node.number: node.place for node in word.nodes if node.kind is NodeKind.PURSUER}
    for edge in told(word, quarries):
        a, b = word.nodes[edge.source], word.nodes[edge.sink]
        ends = _place(a, at), _place(b, at)
        if {NodeKind.TEAM, NodeKind.FENCE} & {a.kind, b.kind} or ends[0] == ends[1]:
            continue
        source = a.number if a.kind in (NodeKind.PURSUER, NodeKind.APOLLONIUS, NodeKind.EVADER) else 0
        found.setdefault((source, *ends), []).append(edge)
    return [
        Arc(source, (begin, end), ", ".join(f"{edge.relation} {edge.strength:.2f}" for edge in edges),
            max(edge.strength for edge in edges))
        for (source, begin, end), edges in found.items()
    ]  # fmt: skip


def _place(node: KnowledgeNode, pursuers: dict[int, Triple]) -> Triple:
    north, east, down = node.place
    if node.kind is NodeKind.BAND:
        return north + REACH_M * cos(node.bearing), east + REACH_M * sin(node.bearing), down
    return pursuers.get(node.number, node.place) if node.kind is NodeKind.APOLLONIUS else node.place
