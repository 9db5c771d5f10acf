"""The one place where a tuple of any length is rebuilt.

Interpreted these are comprehensions; the simulation's side replaces them, when it compiles, by
tuples written out in full (see sim_bridge/campaign/compiled.py), because compiled code has no
`tuple(list)`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

A = TypeVar("A")
B = TypeVar("B")
C = TypeVar("C")
S = TypeVar("S")

MANY = 8  # items from which on what suits many is worth it


def each(function: Callable[[A, int, S], B], items: tuple[A, ...], shared: S) -> tuple[B, ...]:
    """(function(items[0], 0, shared), function(items[1], 1, shared), …)."""
    return tuple([function(item, index, shared) for index, item in enumerate(items)])


def each_pair(
    function: Callable[[A, C, S], B], items: tuple[A, ...], others: tuple[C, ...], shared: S
) -> tuple[B, ...]:
    """(function(items[0], others[0], shared), function(items[1], others[1], shared), …)."""
    return tuple([function(item, other, shared) for item, other in zip(items, others, strict=True)])


def table(function: Callable[[A, int, S], B], items: tuple[A, ...], shared: S) -> Sequence[B]:
    """What `each` gives, to be looked up by a running index and not handed on; of at least one item.

    Compiled it is an array on the stack, which knows no length and ends with the function that made it.
    """
    return tuple([function(item, index, shared) for index, item in enumerate(items)])


def few_or_many(
    few: Callable[[tuple[A, ...], S], B],
    many: Callable[[tuple[A, ...], S], B],
    items: tuple[A, ...],
    shared: S,
) -> B:
    """`few(items, shared)` of fewer than `MANY` items, else `many(items, shared)`; compiled, one alone."""
    return few(items, shared) if len(items) < MANY else many(items, shared)


def some_or_none(
    some: Callable[[tuple[A, ...], S], B],
    none: Callable[[tuple[A, ...], S], B],
    items: tuple[A, ...],
    shared: S,
) -> B:
    """`some(items, shared)` of at least one item, else `none(items, shared)`; compiled, one alone."""
    return some(items, shared) if items else none(items, shared)
