"""The one place where a tuple of any length is rebuilt.

Interpreted these are comprehensions; the simulation's side replaces them, when it compiles, by
tuples written out in full (see sim_bridge/campaign/compiled.py), because compiled code has no
`tuple(list)`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

A = TypeVar("A")
B = TypeVar("B")
C = TypeVar("C")
S = TypeVar("S")


def each(function: Callable[[A, int, S], B], items: tuple[A, ...], shared: S) -> tuple[B, ...]:
    """(function(items[0], 0, shared), function(items[1], 1, shared), …)."""
    return tuple([function(item, index, shared) for index, item in enumerate(items)])


def each_pair(
    function: Callable[[A, C, S], B], items: tuple[A, ...], others: tuple[C, ...], shared: S
) -> tuple[B, ...]:
    """(function(items[0], others[0], shared), function(items[1], others[1], shared), …)."""
    return tuple([function(item, other, shared) for item, other in zip(items, others, strict=True)])
