"""The picture as plain data for `gcs status --json`: names for all fields, no infinities."""

from __future__ import annotations

from enum import Enum
from math import isfinite
from typing import Any

import msgspec

from gcs.picture.values import Picture

FORMAT = 3  # of this document; raised when a field changes its meaning or goes
LEFT_OUT = frozenset({"trail", "past_alerts"})


def document(picture: Picture) -> dict[str, Any]:
    """A JSON-ready document; ages of what was never heard are null."""
    found: dict[str, Any] = {"format": FORMAT, **_plain(picture)}
    return found


def to_json(picture: Picture) -> str:
    """The document as one line of JSON."""
    return msgspec.json.encode(document(picture)).decode()


def _plain(value: Any) -> Any:
    if isinstance(value, msgspec.Struct):
        return {
            name.rstrip("_"): _plain(getattr(value, name))
            for name in value.__struct_fields__
            if name not in LEFT_OUT
        }
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, float):
        return value if isfinite(value) else None
    if isinstance(value, dict):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, tuple):
        if hasattr(value, "_asdict"):  # a NamedTuple, such as the rules of a game
            return {name.rstrip("_"): _plain(inner) for name, inner in value._asdict().items()}
        if value and all(map(_is_count, value)):
            return dict(value)
        return [_plain(inner) for inner in value]
    return value


def _is_count(part: Any) -> bool:
    return isinstance(part, tuple) and len(part) == 2 and isinstance(part[0], str)
