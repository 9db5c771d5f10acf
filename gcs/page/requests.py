"""What a browser may say, as strict values. Pure."""

from __future__ import annotations

import msgspec

from onboard.config.undecodable import UNDECODABLE
from onboard.wire.bus.messages import CommandKind

IDS_MOST = 1024


class Said(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="do", tag=str.lower):
    """Base: the field `do` tells which."""


class Select(Said, frozen=True):
    """Show this vehicle's detail; none where `id` is null."""

    id: int | None


class Give(Said, frozen=True):
    """An order to vehicles, by buttons or keys."""

    kind: CommandKind
    ids: tuple[int, ...]
    named: bool = False  # a person has named this one vehicle


class Line(Said, frozen=True):
    """A line that was typed: the console's language."""

    text: str


class Abort(Said, frozen=True):
    """Everybody, at once."""


class Yes(Said, frozen=True):
    """To the open question."""


class No(Said, frozen=True):
    """To the open question."""


class Acknowledge(Said, frozen=True):
    """An alert was seen; "" = all."""

    name: str = ""


class Act(Said, frozen=True):
    """A key of the source's own: a replay's pause, steps and speed."""

    action: str


class Seek(Said, frozen=True):
    """A replay: go to this instant [ms since its begin]."""

    at_ms: int


Request = Select | Give | Line | Abort | Yes | No | Acknowledge | Act | Seek
_DECODER: msgspec.json.Decoder[Request] = msgspec.json.Decoder(Request)


def request(text: str) -> Request | str:
    """What was said, or what is wrong with it in one line."""
    try:
        found = _DECODER.decode(text)
    except (*UNDECODABLE, UnicodeEncodeError) as error:
        return f"not understood: {error}"
    if isinstance(found, Give) and (not found.ids or len(found.ids) > IDS_MOST):
        return f"an order: found {len(found.ids)} vehicles, expected 1 to {IDS_MOST}"
    return found
