"""A process that reads and writes what an agent does, and no other message, needs less of the dialect.

pymavlink's dialect is 7 MB of objects, most of them of messages that no agent reads: their classes, a method
to send each, and the words of all enums. Of a message that is neither read nor written what frames are
checked by is enough.
"""

from __future__ import annotations

from typing import Any

from onboard.wire.mavlink.dialect import KNOWN, dialect
from onboard.wire.mavlink.encoding import WRITTEN
from onboard.wire.mavlink.telemetry import READ

NEEDED = READ | WRITTEN


class _Outline:
    """What `dialect.Layout` asks of a message's class."""

    __slots__ = (
        "array_lengths", "crc_extra", "fieldnames", "fieldtypes", "id", "lengths", "msgname",
        "ordered_fieldnames", "orders", "unpacker",
    )  # fmt: skip

    def __init__(self, kind: Any) -> None:
        for name in self.__slots__:
            setattr(self, name, getattr(kind, name))


def let_go() -> None:
    """Forget what an agent never asks the dialect for, for the rest of this process."""
    kinds = dialect.mavlink_map
    for number, kind in list(kinds.items()):
        if number not in NEEDED and number not in KNOWN and not isinstance(kind, _Outline):
            kinds[number] = _Outline(kind)
            delattr(dialect, kind.__name__)
    for name in ("MAVLink", "enums"):
        if hasattr(dialect, name):
            delattr(dialect, name)
