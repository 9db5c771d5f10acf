"""The check that no number of a message is NaN or infinite: decoders let both pass."""

from __future__ import annotations

from typing import Any

import msgspec


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
