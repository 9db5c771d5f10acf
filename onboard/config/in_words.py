"""What a type allows and what a file says, in the words of an error message."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import Enum
from typing import Any

from msgspec import inspect

SHOWN = 60  # characters of a value that a message shows


def shown(value: Any) -> str:
    """A value as a person wrote it in the file, cut where it is long."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, (list, tuple)):
        return f"{len(value)} values" if len(value) > 4 else f"[{', '.join(map(shown, value))}]"
    text = repr(value) if isinstance(value, (str, float, int)) else str(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}…"


def nearest(found: object, known: Iterable[str]) -> str:
    """`; did you mean 'hold'?` where one of the known words is near what was found, else nothing."""
    from difflib import get_close_matches  # for who has mistyped

    near = get_close_matches(str(found).lower(), list(known), n=1, cutoff=0.7)
    return f"; did you mean '{near[0]}'?" if near else ""


def keys_of(kind: Any, steps: Sequence[int | str]) -> tuple[str, ...]:
    """The keys that a table takes at a place inside a type; none where no table is there."""
    node = bare(_at(kind, steps) or inspect.AnyType())
    return tuple(field.encode_name for field in node.fields) if isinstance(node, inspect.StructType) else ()


def choices_of(kind: Any, steps: Sequence[int | str]) -> tuple[str, ...]:
    """The words of an enum at a place inside a type; none where there is no enum."""
    node = bare(_at(kind, steps) or inspect.AnyType())
    return tuple(map(_word, node.cls)) if isinstance(node, inspect.EnumType) else ()


def expected(kind: Any, steps: Sequence[int | str], *, another_type: bool) -> str:
    """What a type allows at a place inside it: the description of the type there, or what its bounds say.

    `steps` are keys of tables and indices of lists, from the outside in. Where a value of another type was
    found, the type comes before its description: "a number: zero or more [m/s]".
    """
    node = _at(kind, steps)
    if node is None:
        return "another value"
    words, plain = _described(node), _described(bare(node)).partition(" in ")[0].partition(" of ")[0]
    return f"{plain}: {words}" if another_type and not words.startswith(plain) else words


def _at(kind: Any, steps: Sequence[int | str]) -> inspect.Type | None:
    node: inspect.Type | None = inspect.type_info(kind)
    for step in steps:
        node = _inside(node, step) if node is not None else None
    return node


def _inside(node: inspect.Type, step: int | str) -> inspect.Type | None:
    node = bare(node)
    if isinstance(node, inspect.StructType):
        return next((field.type for field in node.fields if field.encode_name == step), None)
    if isinstance(node, (inspect.VarTupleType, inspect.ListType)):
        return node.item_type
    if isinstance(node, inspect.TupleType) and isinstance(step, int) and step < len(node.item_types):
        return node.item_types[step]
    return None


def bare(node: inspect.Type) -> inspect.Type:
    """The type itself, without its description and without `| None`."""
    while isinstance(node, (inspect.Metadata, inspect.UnionType)):
        if isinstance(node, inspect.Metadata):
            node = node.type
        else:
            node = next(one for one in node.types if not isinstance(one, inspect.NoneType))
    return node


def _described(node: inspect.Type) -> str:
    if isinstance(node, inspect.Metadata):
        described = (node.extra_json_schema or {}).get("description")
        return str(described) if described else _described(node.type)
    if isinstance(node, inspect.UnionType):
        return _described(next(one for one in node.types if not isinstance(one, inspect.NoneType)))
    if isinstance(node, inspect.FloatType):
        return "a number" + _interval(node)
    if isinstance(node, inspect.IntType):
        return "a whole number" + _interval(node)
    if isinstance(node, inspect.EnumType):
        return "one of: " + ", ".join(map(_word, node.cls))
    if isinstance(node, inspect.TupleType):
        return f"{len(node.item_types)} values"
    if isinstance(node, (inspect.VarTupleType, inspect.ListType)):
        return "a list" + _lengths(node, "values")
    if isinstance(node, inspect.StrType):
        return "text" + _lengths(node, "characters")
    words = {inspect.BoolType: "true or false", inspect.StructType: "a table", inspect.DictType: "a table"}
    return words.get(type(node), "another type")


def _word(member: Enum) -> str:
    return str(member.value)


def _interval(node: inspect.FloatType | inspect.IntType) -> str:
    low, high = (node.ge if node.gt is None else node.gt), (node.le if node.lt is None else node.lt)
    if low is None and high is None:
        return ""
    opening = "(−∞" if low is None else f"{'[' if node.gt is None else '('}{low:g}"
    closing = "∞)" if high is None else f"{high:g}{']' if node.lt is None else ')'}"
    return f" in {opening}, {closing}"


def _lengths(node: inspect.VarTupleType | inspect.ListType | inspect.StrType, unit: str) -> str:
    low, high = node.min_length, node.max_length
    if not low and high is None:
        return ""
    return f" of {low} or more {unit}" if high is None else f" of {low or 0} to {high} {unit}"
