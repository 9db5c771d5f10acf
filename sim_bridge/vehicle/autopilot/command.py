"""A command and the results it can have."""

from __future__ import annotations

from typing import NamedTuple

from onboard.wire.mavlink.dialect import DialectPacket, dialect

ACCEPTED: int = dialect.MAV_RESULT_ACCEPTED
LATER: int = dialect.MAV_RESULT_TEMPORARILY_REJECTED
DENIED: int = dialect.MAV_RESULT_DENIED
UNSUPPORTED: int = dialect.MAV_RESULT_UNSUPPORTED
FAILED: int = dialect.MAV_RESULT_FAILED


class Command(NamedTuple):
    """COMMAND_LONG or COMMAND_INT, place in degrees."""

    number: int
    p1: float
    p2: float
    p3: float
    p4: float
    latitude_deg: float
    longitude_deg: float
    z: float
    frame: int  # MAV_FRAME; of a COMMAND_LONG −1
    system: int  # the sender's
    component: int


def from_long(packet: DialectPacket) -> Command:
    """The command of a COMMAND_LONG; its params 5 and 6 are taken for a place in degrees."""
    m = packet.message
    return Command(
        m.command, m.param1, m.param2, m.param3, m.param4, m.param5, m.param6, m.param7, -1,
        packet.system, packet.component,
    )  # fmt: skip


def from_int(packet: DialectPacket) -> Command:
    """The command of a COMMAND_INT, whose place is in 1e-7 degrees."""
    m = packet.message
    return Command(
        m.command, m.param1, m.param2, m.param3, m.param4, m.x * 1e-7, m.y * 1e-7, m.z, m.frame,
        packet.system, packet.component,
    )  # fmt: skip
