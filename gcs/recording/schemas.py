"""What each channel of a recording holds: names and JSON schemas of all messages.

Bus messages are recorded as they came: MessagePack of `[schema version, [fields…]]`; their schemas are
JSON schemas of that pair, with the fields' names as titles. Channels for viewers hold JSON.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, NamedTuple

import msgspec
from msgspec import inspect

from onboard.wire.bus.messages import Message
from onboard.wire.bus.topics import Topic


class Layout(NamedTuple):
    """The schema of one kind of message."""

    name: str  # e.g. apollonius.State
    encoding: str  # of the messages: msgpack | json
    schema: bytes  # JSON schema


_LAYOUTS: dict[type[Message], Layout] = {}


def layout_of(topic: Topic[Any]) -> Layout:
    """The layout of what travels on a topic."""
    kind = topic.message
    found = _LAYOUTS.get(kind)
    if found is None:
        schema = inlined(msgspec.json.schema(tuple[int, kind]), _fields(kind))  # type: ignore[valid-type]
        found = _LAYOUTS[kind] = Layout(f"apollonius.{kind.__name__}", "msgpack", as_bytes(schema))
    return found


def _fields(kind: type[Message]) -> dict[str, tuple[str, ...]]:
    """The fields of a message and of all that it holds, by the names of their types."""
    found: dict[str, tuple[str, ...]] = {}

    def walk(node: Any) -> None:
        if isinstance(node, (inspect.StructType, inspect.NamedTupleType)):
            found[node.cls.__name__] = tuple(field.name for field in node.fields)
        for part in ("fields", "types", "item_types", "item_type", "key_type", "value_type", "type"):
            inner = getattr(node, part, ())
            for child in inner if isinstance(inner, tuple) else (inner,):
                walk(child)

    walk(inspect.type_info(kind))
    return found


def as_bytes(schema: dict[str, Any]) -> bytes:
    """A schema's text, the same for the same schema."""
    return json.dumps(schema, sort_keys=True, separators=(",", ":")).encode()


def inlined(schema: dict[str, Any], fields: Mapping[str, tuple[str, ...]]) -> dict[str, Any]:
    """The schema with every `$ref` replaced by what it names (viewers do not follow them), and
    the items of structs that travel as arrays titled by their `fields`."""
    definitions = schema.get("$defs", {})

    def walk(node: Any) -> Any:
        if isinstance(node, list):
            return [walk(item) for item in node]
        if not isinstance(node, dict):
            return node
        if "$ref" in node:
            name = node["$ref"].rsplit("/", 1)[-1]
            return walk(_titled(definitions[name], fields.get(name, ())))
        return {key: walk(value) for key, value in node.items() if key != "$defs"}

    result: dict[str, Any] = walk(schema)
    return result


def _titled(definition: dict[str, Any], fields: tuple[str, ...]) -> dict[str, Any]:
    items = definition.get("prefixItems")
    if items is None or len(fields) != len(items):
        return definition
    titled = [
        {"title": field, "allOf": [item]} if "$ref" in item else {**item, "title": field}
        for field, item in zip(fields, items, strict=True)
    ]
    return {**definition, "prefixItems": titled}
