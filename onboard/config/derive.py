"""Structs for files and for the bus, derived from the core's value types: a field is told once, in the core.

A file may say a field in degrees, under another name, with bounds or with a default of its own; the table of
`Key`s says which. The bus carries the core's fields as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from math import degrees, radians
from typing import Any, NamedTuple, TypeVar, get_type_hints

import msgspec

T = TypeVar("T", bound=tuple[Any, ...])
CORE = object()  # stands for the core's own default


class Key(NamedTuple):
    """How a file writes one field."""

    kind: Any = None  # type with its range (`onboard.config.bounds`); None = the core's
    default: Any = CORE  # None: may be left out, and then follows from other keys
    degrees: bool = False  # written in degrees, with `_deg` behind its name
    seconds: bool = False  # a time in seconds, with `_s` behind its name
    name: str = ""  # in the file, where that is no name in Python


def struct_from(
    core: type[tuple[Any, ...]],
    base: type[msgspec.Struct],
    keys: Mapping[str, Key] | None = None,
    leave_out: Collection[str] = (),
) -> Any:
    """A subclass of the struct `base` with the fields of the NamedTuple `core`.

    `keys` says what a file writes otherwise, in the file's order; a key that the core does not have is the
    file's alone. Fields of the core that are not in `keys` follow as the core has them, less those
    to `leave_out`. Encoding, strictness and order are those of `base`.
    """
    keys = keys or {}
    types, defaults = get_type_hints(core), core._field_defaults  # type: ignore[attr-defined]
    fields: list[Any] = []
    rename = {}
    for field in (*keys, *(one for one in core._fields if one not in keys)):  # type: ignore[attr-defined]
        if field in leave_out:
            continue
        key = keys.get(field, Key())
        kind = types[field] if key.kind is None else key.kind
        default = defaults.get(field, msgspec.NODEFAULT) if key.default is CORE else key.default
        if key.default is CORE and key.degrees:
            default = degrees(default)
        name = written(field, key)
        fields.append((name, kind if default is not None else kind | None, default))
        if key.name:
            rename[name] = key.name
    return msgspec.defstruct(f"{core.__name__}Fields", fields, bases=(base,), rename=rename or None)


def written(field: str, key: Key) -> str:
    """The name of a core's field in a file's struct."""
    return f"{field}_deg" if key.degrees else f"{field}_s" if key.seconds else field


def core_from(
    struct: msgspec.Struct, core: type[T], keys: Mapping[str, Key] | None = None, **given: Any
) -> T:
    """The core's value of a derived struct: angles in radians again. `given` are fields that the file leaves
    out or that follow from other keys."""
    keys = keys or {}
    values = []
    for field in core._fields:  # type: ignore[attr-defined]
        key = keys.get(field, Key())
        value = given[field] if field in given else getattr(struct, written(field, key))
        values.append(radians(value) if key.degrees and field not in given else value)
    make: Callable[..., T] = core
    return make(*values)
