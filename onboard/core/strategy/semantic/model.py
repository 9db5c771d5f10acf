"""Relations and rules together, and how users add their own."""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.strategy.semantic.goals import CUSTOM as RULES_FROM
from onboard.core.strategy.semantic.goals import GOALS, GoalRule
from onboard.core.strategy.semantic.graph import Relation
from onboard.core.strategy.semantic.relations import CUSTOM as RELATIONS_FROM
from onboard.core.strategy.semantic.relations import RELATIONS


class Model(NamedTuple):
    """What a team knows, and what it makes of that."""

    relations: tuple[Relation, ...]
    goals: tuple[GoalRule, ...]  # asked from the top


MODEL = Model(RELATIONS, GOALS)


def extended(
    relations: tuple[Relation, ...] = (), goals: tuple[GoalRule, ...] = (), base: Model = MODEL
) -> Model:
    """A model with more relations, and with more rules that are asked before its own.

    Raises ValueError where a number is below 100 or given twice.
    """
    for what, known, added, least in (
        ("relation", base.relations, relations, RELATIONS_FROM),
        ("rule", base.goals, goals, RULES_FROM),
    ):
        ids = [row.id for row in known]
        for row in added:
            if row.id < least or row.id in ids:
                raise ValueError(
                    f"{what} {row.name}: found number {row.id}, expected a free one from {least}"
                )
            ids.append(row.id)
    return Model((*base.relations, *relations), (*goals, *base.goals))

