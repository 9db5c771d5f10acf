"""The check that no number of a message is NaN or infinite: decoders let both pass."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from operator import attrgetter
from typing import Any, get_args, get_origin

import msgspec

_WITHOUT = (int, str, bool)  # types that hold no float


def all_finite(items: tuple[Any, ...]) -> bool:
    """Whether no float among `items` is NaN or infinite; tuples and structs are looked into.

    Every message that arrives passes this function, so it is lean.
    """
    for item in items:
        kind = type(item)
        if kind is float:
            if item - item != 0.0:  # NaN for NaN and for infinity
                return False
        elif kind is int or kind is str:
            continue
        elif isinstance(item, tuple):
            if item and not all_finite(item):
                return False
        elif isinstance(item, msgspec.Struct) and not all_finite(msgspec.structs.astuple(item)):
            return False
    return True


def finite_check(kind: type[msgspec.Struct]) -> Callable[[Any], bool]:
    """A test of one kind of message that gives what `all_finite` gives of its fields, sooner.

    What its types say are floats is added up: the sum is finite where each of them is, unless it overflows.
    Then, and for fields of other types, each number is looked at.
    """
    numbers: list[str] = []
    rows: list[str] = []
    others: list[str] = []
    for field in msgspec.structs.fields(kind):
        parts = [part for part in get_args(field.type) if part is not Ellipsis]
        if field.type is float:
            numbers.append(field.name)
        elif get_origin(field.type) is tuple and parts and all(part is float for part in parts):
            rows.append(field.name)
        elif field.type not in _WITHOUT and not _is_enum(field.type):
            others.append(field.name)
    of_numbers, of_rows, of_others = _several(numbers), _several(rows), _several(others)

    def finite(message: Any) -> bool:
        total = sum(of_numbers(message)) if numbers else 0.0
        for row in of_rows(message):
            if row:
                total = sum(row, total)
        if total - total != 0.0:
            return all_finite(msgspec.structs.astuple(message))
        return not others or all_finite(of_others(message))

    return finite


def _is_enum(kind: object) -> bool:
    return isinstance(kind, type) and issubclass(kind, Enum)


def _several(names: list[str]) -> Callable[[Any], tuple[Any, ...]]:
    """Fields by their names, always as a tuple."""
    if len(names) > 1:
        return attrgetter(*names)
    if not names:
        return lambda message: ()
    one = attrgetter(names[0])
    return lambda message: (one(message),)
