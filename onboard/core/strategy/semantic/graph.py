"""The semantic network of a situation: nodes by kind and number, and what holds between them.

Nodes are not stored: a kind has as many as the situation says (`how_many`), numbered from 0 as the team's
members and the targets are. What holds is a list of edges. Kernel style but for that list.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple

from onboard.core.strategy.team.closure import WayOut
from onboard.core.strategy.team.plan_types import Plan, Situation, target_count


class Node(IntEnum):
    """A kind of node."""

    TEAM = 0  # all pursuers that are fit
    EVADER = 1
    PURSUER = 2  # by its place in the team
    TARGET = 3
    BAND = 4  # the widest way out that the evader has
    APOLLONIUS = 5  # what the pursuer of this number reaches before the evader
    SAFE_SIDE = 6  # of the target of this number: from where a pursuer is there before the evader
    FENCE = 7  # floor and ceiling


class Scene(NamedTuple):
    """What relations and rules are asked of."""

    situation: Situation
    way: WayOut  # the widest way out, with the margin
    free: bool  # whether the evader has a free ray at its safety distance ρ
    closed: bool  # whether the band counts as closed: it is, or was and is open by very little
    previous: Plan


class Held(NamedTuple):
    """How strongly a relation holds."""

    strength: float  # 0 (it does not hold) … 1
    value: float  # in the relation's own unit, for people


class Edge(NamedTuple):
    """Something that holds."""

    relation: int
    source: int  # number of the node it holds from, among its kind
    sink: int  # and of the one it holds to
    strength: float  # above 0 … 1
    value: float


Apply = Callable[[Scene, int, int], Held]


class Relation(NamedTuple):
    """One row of the table of relations: from every node of a kind to every node of another."""

    id: int
    name: str  # in one word
    words: str  # with {a}, {b} for the nodes and {value} for the value, as `{value:.1f}`
    source: Node
    sink: Node
    apply: Apply


NONE = Held(0.0, 0.0)


def how_many(scene: Scene, kind: int) -> int:
    """How many nodes of a kind there are."""
    if kind == Node.PURSUER or kind == Node.APOLLONIUS:
        return len(scene.situation.team)
    if kind == Node.TARGET or kind == Node.SAFE_SIDE:
        return target_count(scene.situation)
    return 1


def between(relation: Relation) -> Callable[[Scene, list[Edge]], None]:
    """The function that adds what holds by one relation."""
    number, source, sink, apply = relation.id, int(relation.source), int(relation.sink), relation.apply

    def added(scene: Scene, edges: list[Edge]) -> None:
        for i in range(how_many(scene, source)):
            for j in range(how_many(scene, sink)):
                held = apply(scene, i, j)
                if held.strength > 0.0:
                    edges.append(Edge(number, i, j, min(1.0, held.strength), held.value))

    return added


def both(
    one: Callable[[Scene, list[Edge]], None], rest: Callable[[Scene, list[Edge]], None]
) -> Callable[[Scene, list[Edge]], None]:
    """Two such functions as one."""

    def added(scene: Scene, edges: list[Edge]) -> None:
        one(scene, edges)
        rest(scene, edges)

    return added


def knowing(table: tuple[Relation, ...]) -> Callable[[Scene], list[Edge]]:
    """A whole table as the function from a scene to everything that holds, in the table's order."""
    add = between(table[-1])
    for relation in table[-2::-1]:
        add = both(between(relation), add)

    def known(scene: Scene) -> list[Edge]:
        edges = [Edge(0, 0, 0, 0.0, 0.0)][:0]
        add(scene, edges)
        return edges

    return known


def strength_of(edges: list[Edge], relation: int, source: int, sink: int) -> float:
    """How strongly a relation holds from one node to another; 0 where it does not."""
    for edge in edges:
        if edge.relation == relation and edge.source == source and edge.sink == sink:
            return edge.strength
    return 0.0


def strongest(edges: list[Edge], relation: int) -> Edge:
    """The strongest edge of a relation; of strength 0, from and to −1, where there is none."""
    best = Edge(relation, -1, -1, 0.0, 0.0)
    for edge in edges:
        if edge.relation == relation and edge.strength > best.strength:
            best = edge
    return best


def count_to(edges: list[Edge], relation: int, sink: int) -> int:
    """From how many nodes a relation holds to the node of this number."""
    count = 0
    for edge in edges:
        if edge.relation == relation and edge.sink == sink:
            count += 1
    return count
