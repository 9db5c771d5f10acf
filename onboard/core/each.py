"""The one place where a tuple of any length is rebuilt.

Interpreted it is a comprehension; the simulation's side replaces it, when it compiles, by a
tuple written out in full (see sim_bridge/compiled.py), because compiled code has no
`tuple(list)`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

A = TypeVar("A")
B = TypeVar("B")
S = TypeVar("S")


def each(function: Callable[[A, int, S], B], items: tuple[A, ...], shared: S) -> tuple[B, ...]:
    """(function(items[0], 0, shared), function(items[1], 1, shared), …)."""
    return tuple([function(item, index, shared) for index, item in enumerate(items)])
