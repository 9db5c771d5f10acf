"""Several vehicles at once: the same functions over lanes of an array, eight vehicles a block.

A block holds every number of eight vehicles, one after the other: number k of lane i stands at
`8 k + i`. Written so, a loop over the lanes of a block is one that a compiler runs with vector instructions,
as long as nothing in it is a call: `in_lanes` makes of a function in kernel style its twin in which the
elementary functions are those of `lane_math`. A twin has the very code of its original.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any, NamedTuple, TypeVar, get_args, get_type_hints

from onboard.core.math.angles import wrap
from sim_bridge.campaign.lane_math import (
    lane_asin,
    lane_atan,
    lane_cos,
    lane_exp,
    lane_log,
    lane_power12,
    lane_sin,
    lane_tan,
    lane_wrap,
)
from sim_bridge.draws import CENTRE, central, normal, tail, uniform
from sim_bridge.vehicle.wind.dryden import power12

F = TypeVar("F", bound=Callable[..., Any])

LANES = 8
HOMES = ("onboard.", "sim_bridge.")

_twins: dict[Any, Any] = {
    math.sin: lane_sin,
    math.cos: lane_cos,
    math.tan: lane_tan,
    math.asin: lane_asin,
    math.atan: lane_atan,
    math.exp: lane_exp,
    math.log: lane_log,
    wrap: lane_wrap,
    power12: lane_power12,
}


def in_lanes(function: F) -> F:
    """The twin of a function in kernel style: the same code over the functions of `lane_math`.

    Functions that it calls become twins too. Raises ValueError for one with a closure.
    """
    found: F = _twin(function)
    return found


def twins() -> list[FunctionType]:
    """All twins made so far, which are to be registered with a compiler."""
    return [twin for twin in _twins.values() if isinstance(twin, FunctionType)]


def _twin(value: Any) -> Any:
    if not callable(value):
        return value
    if value in _twins:
        return _twins[value]
    if not isinstance(value, FunctionType) or not value.__module__.startswith(HOMES):
        return value
    if value.__closure__ is not None:
        raise ValueError(f"{value.__qualname__}: found a closure, expected a function of a module")
    names = dict(value.__globals__)
    twin = FunctionType(value.__code__, names, value.__name__, value.__defaults__)
    _twins[value] = twin
    for name in value.__code__.co_names:
        if name in names:
            names[name] = _twin(names[name])
    return twin


lane_tail = in_lanes(tail)


def lane_normal(word: int) -> float:
    """The standard normal number of a word: `sim_bridge.draws.normal`, without its branches."""
    p = uniform(word)
    q = p - 0.5
    middle = central(q)
    outer = lane_tail(p if q < 0.0 else 1.0 - p)
    return float(middle if abs(q) <= CENTRE else (outer if q > 0.0 else -outer))


_twins[normal] = lane_normal


class Packing(NamedTuple):
    """How a value of a NamedTuple lies in a row of an array: its numbers `stride` apart."""

    width: int  # numbers
    leaves: tuple[str, ...]  # their names, of a value `v`
    load: Callable[[Any, int, int], Any]  # of an array, a row of it and the place of the first number there
    store: Callable[[Any, int, int, Any], None]  # into an array, a row of it, from a place on: a value


@cache
def packing(kind: Any, stride: int) -> Packing:
    """The packing of a NamedTuple of floats, ints, and tuples and NamedTuples of these.

    Raises ValueError for another field.
    """
    leaves: list[str] = []
    names: dict[str, Any] = {"__name__": __name__}

    def made(kind: Any, path: str) -> str:
        if kind is float or (isinstance(kind, type) and issubclass(kind, int)):
            leaves.append(path)
            number = f"a[r, o + {(len(leaves) - 1) * stride}]"
            return number if kind is float else f"int({number})"
        if isinstance(kind, type) and hasattr(kind, "_fields"):
            name = f"T{len(names)}_{kind.__name__}"
            names[name] = kind
            hints = get_type_hints(kind)
            return f"{name}({', '.join(made(hints[field], f'{path}.{field}') for field in kind._fields)})"
        if getattr(kind, "__origin__", None) is tuple:
            return f"({''.join(made(part, f'{path}[{k}]') + ', ' for k, part in enumerate(get_args(kind)))})"
        raise ValueError(f"{path}: found {kind}, expected a number or a NamedTuple of numbers")

    text = f"def load(a, r, o):\n    return {made(kind, 'v')}\n\n\ndef store(a, r, o, v):\n"
    text += "".join(f"    a[r, o + {k * stride}] = {leaf}\n" for k, leaf in enumerate(leaves))
    exec(text, names)
    return Packing(len(leaves), tuple(leaves), names["load"], names["store"])
