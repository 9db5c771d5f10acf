"""A process that reads and writes what an agent does, and no other message, needs less of the dialect.

pymavlink's dialect is 7 MB of objects, most of them of messages that no agent reads: their classes, a method
to send each, and the words of all enums. Of a message that is neither read nor written what frames are
checked by is enough.
"""

from __future__ import annotations

from struct import Struct
from typing import Any

from onboard.wire.mavlink.dialect import KNOWN, dialect
from onboard.wire.mavlink.encoding import WRITTEN
from onboard.wire.mavlink.telemetry import READ

NEEDED = READ | WRITTEN


class _Outline:
    """What frames of a message are checked by. Its fields, which nobody asks for, stand as one."""

    __slots__ = ("crc_extra", "id", "msgname", "unpacker")
    fieldnames = ordered_fieldnames = ("unread",)
    fieldtypes = ("uint8_t",)
    array_lengths = orders = (0,)
    lengths = (1,)

    def __init__(self, kind: Any) -> None:
        self.crc_extra: int = kind.crc_extra
        self.id: int = kind.id
        self.msgname: str = kind.msgname
        self.unpacker: Struct = kind.unpacker


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
