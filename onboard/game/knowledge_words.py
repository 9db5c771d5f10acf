"""A team's knowledge and goals for people, and as they go over the bus.

Nodes are named by the ids of vehicles and the numbers of targets from 1.
"""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from onboard.core.geometry.apollonius import apollonius_sphere
from onboard.core.math.vectors import TINY, ZERO, Vec, distance
from onboard.core.strategy.semantic.goals import SETS_OUT, fold_goals
from onboard.core.strategy.semantic.graph import Edge, Node, Relation, Scene, how_many, knowing
from onboard.core.strategy.semantic.model import Model
from onboard.core.strategy.semantic.relations import CUSTOM
from onboard.core.strategy.team.plan_types import Choice, Plan, Situation, target_at, target_count
from onboard.core.strategy.team.planner import no_plan, scene_of
from onboard.wire.bus.knowledge_messages import (
    Knowledge,
    KnowledgeEdge,
    KnowledgeNode,
    NodeKind,
    PlannedGoal,
    TeamGoal,
)

EDGES_MOST = 200  # that go over the bus: the strongest
OWN_MOST = 8  # of a user's own relations that are told
NODES = tuple(NodeKind[kind.name] for kind in Node)
BEFORE = "the evader has not set out"  # why a team completes its ring


class Known(NamedTuple):
    """A network with everything that names its nodes."""

    scene: Scene
    edges: list[Edge]
    choice: Choice
    model: Model
    evader: int  # id
    team: tuple[int, ...]  # ids of the members, in their order


def known_of(s: Situation, previous: Plan | None, model: Model, evader: int, team: tuple[int, ...]) -> Known:
    """What a team knows of a situation, and its goal then; `previous` is its plan, None where it has none."""
    scene = scene_of(s, no_plan(s.team, s.now) if previous is None else previous)
    edges = knowing(model.relations)(scene)
    choice = fold_goals(model.goals)(scene, edges)
    return Known(scene, edges, choice, model, evader, team)


def number_of(known: Known, kind: Node, index: int) -> int:
    """The number by which people know a node."""
    if kind in (Node.PURSUER, Node.APOLLONIUS):
        return known.team[index]
    if kind in (Node.TARGET, Node.SAFE_SIDE):
        return index + 1
    return known.evader if kind == Node.EVADER else 0


def name_of(known: Known, kind: Node, index: int) -> str:
    """A node for people."""
    number = number_of(known, kind, index)
    if kind == Node.APOLLONIUS:
        return f"the region of pursuer {number}"
    if kind == Node.SAFE_SIDE:
        return f"the safe side of target {number}"
    if kind in (Node.PURSUER, Node.TARGET, Node.EVADER):
        return f"{NODES[kind].value} {number}"
    return f"the {NODES[kind].value}"


def relation_of(model: Model, number: int) -> Relation:
    """The row of a relation by its number."""
    return next(row for row in model.relations if row.id == number)


def edge_in_words(known: Known, edge: Edge) -> str:
    """What holds, for people."""
    row = relation_of(known.model, edge.relation)
    a, b = name_of(known, row.source, edge.source), name_of(known, row.sink, edge.sink)
    return row.words.format(a=a, b=b, value=edge.value)


def goal_of(model: Model, choice: Choice, evader: int) -> PlannedGoal:
    """A goal as it goes over the bus."""
    row = next((row for row in model.goals if row.id == choice.rule), None)
    goal = TeamGoal[choice.goal.name]
    about = choice.about + 1 if goal.name.startswith("DENY") else 0
    why = BEFORE if choice.rule == SETS_OUT else "" if row is None else row.when
    return PlannedGoal(evader, goal, about, "" if row is None else row.name, why)


def goal_in_words(goal: PlannedGoal) -> str:
    """A goal and its reason, for people; "" where there is none."""
    if goal.goal is TeamGoal.NONE:
        return ""
    what: str = goal.goal.value
    if goal.goal is TeamGoal.DENY and goal.target:
        what = f"deny target {goal.target}"
    return what + (f", as {goal.why}" if goal.why else "")


def _place(scene: Scene, kind: Node, index: int) -> tuple[Vec, float, float]:
    """Middle [m], size and bearing of a node, as `KnowledgeNode` has them."""
    s, way = scene.situation, scene.way
    e = s.evader
    if kind == Node.PURSUER:
        return s.team[index].vehicle.position, 0.0, 0.0
    if kind == Node.TARGET:
        return target_at(s, index).position, s.rules.epsilon_min, 0.0
    if kind == Node.SAFE_SIDE:
        place = target_at(s, index).position
        fastest = max((m.vehicle.speed for m in s.team if m.fit), default=0.0)
        return place, fastest / max(e.speed, TINY) * distance(e.position, place), 0.0
    if kind == Node.APOLLONIUS:
        own = s.team[index].vehicle
        sphere = apollonius_sphere(e.position, e.speed, own.position, own.speed)
        return (sphere.centre, sphere.radius, 0.0) if sphere.exists else (own.position, 0.0, 0.0)
    if kind == Node.BAND:
        return e.position, max(0.0, way.gap), way.bearing
    return (ZERO if kind == Node.FENCE else e.position), 0.0, 0.0


def message(known: Known, planner: int, stamp_ns: int, nonce: int) -> Knowledge:
    """A network as it goes over the bus: the nodes that something holds of, and the strongest edges."""
    rows = {row.id: row for row in known.model.relations}
    strongest = sorted(known.edges, key=lambda edge: -edge.strength)[:EDGES_MOST]
    named: dict[tuple[Node, int], int] = {}
    for kind in (Node.EVADER, Node.PURSUER, Node.TARGET):
        named |= {(kind, i): len(named) + i for i in range(how_many(known.scene, kind))}
    edges = []
    for edge in strongest:
        row = rows[edge.relation]
        a, b = (named.setdefault(key, len(named))
                for key in ((row.source, edge.source), (row.sink, edge.sink)))  # fmt: skip
        value = edge.value if isfinite(edge.value) else 0.0
        edges.append(KnowledgeEdge(row.name, a, b, edge.strength, value, edge_in_words(known, edge)))
    nodes = []
    for kind, index in named:
        place, size, bearing = _place(known.scene, kind, index)
        nodes.append(
            KnowledgeNode(
                NODES[kind], number_of(known, kind, index), name_of(known, kind, index),
                (place.x, place.y, place.z), size, bearing,
            )
        )  # fmt: skip
    goal = goal_of(known.model, known.choice, known.evader)
    t = known.scene.situation.now
    return Knowledge(planner, stamp_ns, t, known.evader, tuple(nodes), tuple(edges), goal, nonce)


def worth_saying(known: Known) -> list[str]:
    """What holds, for people, shortest: of each target who threatens, denies and covers it best, and who is
    lost; the team's goal last."""
    s = known.scene.situation
    said = []
    by_name = {row.name: row.id for row in known.model.relations}
    for name in ("suffices", "lost", "confines"):
        said += [edge_in_words(known, e) for e in known.edges if e.relation == by_name.get(name)]
    for target in range(target_count(s)):
        for name in ("threatens", "denies", "covers", "blocks", "holds"):
            held = [e for e in known.edges if e.relation == by_name.get(name) and e.sink == target]
            best = max(held, key=lambda edge: edge.strength, default=None)
            if best is not None:
                said.append(edge_in_words(known, best))
            elif name == "denies":
                said.append(f"nobody alone is first at target {target + 1}")
    said += [edge_in_words(known, e) for e in known.edges if e.relation >= CUSTOM][:OWN_MOST]
    goal = goal_of(known.model, known.choice, known.evader)
    return [*said, f"goal: {goal_in_words(goal)}"]
