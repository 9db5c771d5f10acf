"""What each channel of a recording holds: names and JSON schemas of all messages.

Bus messages are recorded as they came: MessagePack of `[schema version, [fields…]]`; their schemas are
JSON schemas of that pair, with the fields' names as titles. Channels for viewers hold JSON.
"""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import msgspec

from gcs.picture import journal
from onboard.wire.bus import messages as swarm
from onboard.wire.bus import topics
from onboard.wire.bus.topics import ROOT, Topic


class Layout(NamedTuple):
    """The schema of one kind of message."""

    name: str  # e.g. apollonius.State
    encoding: str  # of the messages: msgpack | json
    schema: bytes  # JSON schema


_BUS: dict[Topic, type[swarm.Message]] = {
    topics.SETUP: swarm.Setup,
    topics.PHASE: swarm.PhaseChange,
    topics.OUTCOME: swarm.Outcome,
    topics.MASTER: swarm.Master,
    topics.EVADER_BRIEF: swarm.EvaderBrief,
    topics.STATE: swarm.State,
    topics.DECISION: swarm.DecisionReport,
    topics.HEALTH: swarm.Health,
    topics.EVENTS: swarm.Event,
    topics.COMMAND: swarm.Command,
    topics.TRACK: swarm.Track,
}
_JOURNAL: dict[str, type[swarm.Message]] = {
    "presence": journal.Presence,
    "sent": journal.Sent,
    "replied": journal.Replied,
    "acknowledged": journal.Acknowledged,
    "remark": journal.Remark,
}
_LAYOUTS: dict[type[swarm.Message], Layout] = {}


def layout_of(key: str) -> Layout | None:
    """The layout of what travels on a key; None for a foreign key."""
    kind = _kind(key)
    if kind is None:
        return None
    found = _LAYOUTS.get(kind)
    if found is None:
        schema = inlined(msgspec.json.schema(tuple[int, kind]))  # type: ignore[valid-type]
        found = _LAYOUTS[kind] = Layout(f"apollonius.{kind.__name__}", "msgpack", as_bytes(schema))
    return found


def _kind(key: str) -> type[swarm.Message] | None:
    topic = topics.topic_of(key)
    if topic is not None:
        return _BUS.get(topic)
    parts = key.split("/")
    if len(parts) == 4 and parts[0] == ROOT and parts[2] == "gcs":
        return _JOURNAL.get(parts[3])
    return None


def as_bytes(schema: dict[str, Any]) -> bytes:
    """A schema's text, the same for the same schema."""
    return json.dumps(schema, sort_keys=True, separators=(",", ":")).encode()


def inlined(schema: dict[str, Any]) -> dict[str, Any]:
    """The schema with every `$ref` replaced by what it names (viewers do not follow them), and
    the items of array-like structs titled by their fields."""
    definitions = schema.get("$defs", {})

    def walk(node: Any) -> Any:
        if isinstance(node, list):
            return [walk(item) for item in node]
        if not isinstance(node, dict):
            return node
        if "$ref" in node:
            name = node["$ref"].rsplit("/", 1)[-1]
            return walk(_titled(name, definitions[name]))
        return {key: walk(value) for key, value in node.items() if key != "$defs"}

    result: dict[str, Any] = walk(schema)
    return result


def _titled(name: str, definition: dict[str, Any]) -> dict[str, Any]:
    struct = getattr(swarm, name, None) or getattr(journal, name, None)
    items = definition.get("prefixItems")
    fields = getattr(struct, "__struct_fields__", ())
    if items is None or len(fields) != len(items):
        return definition
    titled = [
        {"title": field, "allOf": [item]} if "$ref" in item else {**item, "title": field}
        for field, item in zip(fields, items, strict=True)
    ]
    return {**definition, "prefixItems": titled}
