"""Numbers and sizes of MAVLink that other rooms ask for: components, commands and messages.

The values are those of pymavlink's dialect; only this folder imports it.
"""

from __future__ import annotations

from enum import IntEnum

from onboard.wire.mavlink.dialect import HEADER_2, SIGNATURE, dialect

AUTOPILOT: int = dialect.MAV_COMP_ID_AUTOPILOT1
"""Component id of an autopilot (1)."""
COMPANION: int = dialect.MAV_COMP_ID_ONBOARD_COMPUTER
ADSB: int = dialect.MAV_COMP_ID_ADSB
"""Component id of the agent, a companion computer (191)."""


class CommandId(IntEnum):
    """MAV_CMD numbers that the agent sends in COMMAND_LONG or COMMAND_INT."""

    TAKE_OFF = dialect.MAV_CMD_NAV_TAKEOFF
    SET_MODE = dialect.MAV_CMD_DO_SET_MODE
    ARM = dialect.MAV_CMD_COMPONENT_ARM_DISARM
    SET_MESSAGE_INTERVAL = dialect.MAV_CMD_SET_MESSAGE_INTERVAL
    GET_MESSAGE_INTERVAL = dialect.MAV_CMD_GET_MESSAGE_INTERVAL
    REQUEST_MESSAGE = dialect.MAV_CMD_REQUEST_MESSAGE
    CHANGE_SPEED = dialect.MAV_CMD_GUIDED_CHANGE_SPEED
    CHANGE_ALTITUDE = dialect.MAV_CMD_GUIDED_CHANGE_ALTITUDE
    CHANGE_HEADING = dialect.MAV_CMD_GUIDED_CHANGE_HEADING
    REPOSITION = dialect.MAV_CMD_DO_REPOSITION


class MessageId(IntEnum):
    """Numbers of messages that the agent asks for once."""

    HEARTBEAT = dialect.MAVLINK_MSG_ID_HEARTBEAT
    AUTOPILOT_VERSION = dialect.MAVLINK_MSG_ID_AUTOPILOT_VERSION
    HOME_POSITION = dialect.MAVLINK_MSG_ID_HOME_POSITION
    GLOBAL_POSITION_INT = dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT
    EXTENDED_SYS_STATE = dialect.MAVLINK_MSG_ID_EXTENDED_SYS_STATE


_NUMBERS: dict[str, int] = {kind.msgname: number for number, kind in dialect.mavlink_map.items()}


def message_number(name: str) -> int:
    """Return the number of a message by its name in capitals; KeyError for none of the dialect."""
    return _NUMBERS[name]


def frame_size(name: str, signed: bool = False) -> int:
    """Return the most bytes that a frame of this message takes (trailing zeros may save some)."""
    size: int = dialect.mavlink_map[_NUMBERS[name]].unpacker.size
    return HEADER_2 + size + 2 + (SIGNATURE if signed else 0)
