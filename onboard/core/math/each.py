"""The one place where a tuple of any length is rebuilt, and where NamedTuples are made that are made often.

Interpreted these are comprehensions; the simulation's side replaces them, when it compiles, by
tuples written out in full (see sim_bridge/campaign/compiled.py), because compiled code has no
`tuple(list)`.
"""

from __future__ import annotations

from collections.abc import Callable, MutableSequence, Sequence
from math import inf, sqrt
from typing import Any, Protocol, TypeVar, cast

A = TypeVar("A")
B = TypeVar("B")
C = TypeVar("C")
S = TypeVar("S")

MANY = 8  # items from which on what suits many is worth it


class New(Protocol):
    """See `new`."""

    def __call__(self, kind: type[A], fields: tuple[Any, ...], /) -> A:
        """A NamedTuple of a kind, of all its fields in their order."""
        ...


new: New = cast(New, tuple.__new__)
"""`new(Vec, (x, y, z))` is `Vec(x, y, z)` in half the time. Its fields are counted, and their types checked,
by mypy alone (tests/support/mypy_new.py)."""


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


def each_at_once(
    function: Callable[[A, int, S], B],
    _at_once: Callable[[tuple[A, ...], S], tuple[B, ...]],
    items: tuple[A, ...],
    shared: S,
) -> tuple[B, ...]:
    """`each(function, items, shared)`; compiled `at_once(items, shared)`, which must give the same.

    Worth it where all items' roots and quotients can be had at once (`roots`, `inverses`).
    """
    return tuple([function(item, index, shared) for index, item in enumerate(items)])


def few_or_many(
    few: Callable[[tuple[A, ...], S], B],
    _few_compiled: Callable[[tuple[A, ...], S], B],
    many: Callable[[tuple[A, ...], S], B],
    items: tuple[A, ...],
    shared: S,
) -> B:
    """`few(items, shared)` of fewer than `MANY` items, else `many(items, shared)`.

    Compiled it is one of them alone, and of one item to `MANY` − 1 `few_compiled(items, shared)`: what gives
    the same as `few`, to the last bit, and costs less only when it is compiled.
    """
    return few(items, shared) if len(items) < MANY else many(items, shared)


def room(value: A, items: tuple[B, ...]) -> MutableSequence[A]:
    """Room for up to len(items)² values like this one, to be written to and read, and not handed on.

    Compiled it is an array on the stack, which knows no length and ends with the function that made it.
    """
    return [value] * (len(items) * len(items))


def some_or_none(
    some: Callable[[tuple[A, ...], S], B],
    none: Callable[[tuple[A, ...], S], B],
    items: tuple[A, ...],
    shared: S,
) -> B:
    """`some(items, shared)` of at least one item, else `none(items, shared)`; compiled, one alone."""
    return some(items, shared) if items else none(items, shared)


def roots(values: tuple[float, ...]) -> tuple[float, ...]:
    """The square roots of all values; compiled by vector instructions."""
    return tuple([sqrt(value) for value in values])


def inverses(values: tuple[float, ...]) -> tuple[float, ...]:
    """1 / value of all values; compiled by vector instructions. 1 / 0 is inf."""
    return tuple([1.0 / value if value else inf for value in values])
