"""Commands that every autopilot obeys alike: which messages it sends, and where home is.

One function per command; it gives the MAV_RESULT.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite

from onboard.wire.geodesy import Geodetic
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, FAILED, Command
from sim_bridge.vehicle.autopilot.state import AutopilotState


def set_interval(ap: AutopilotState, now_ns: int, command: Command) -> int:
    """MAV_CMD_SET_MESSAGE_INTERVAL: send message p1 every p2 [µs]."""
    number = _whole(command.p1)
    if not telemetry.can_build(ap, number) or not isfinite(command.p2):
        return ap.unknown_interval
    ap.streams.set(number, command.p2, now_ns)
    return ACCEPTED


def get_interval(ap: AutopilotState, now_ns: int, command: Command) -> int:
    """MAV_CMD_GET_MESSAGE_INTERVAL: answer with MESSAGE_INTERVAL of message p1."""
    number = _whole(command.p1)
    if not telemetry.can_build(ap, number):
        return ap.unknown_interval
    ap.emit(dialect.MAVLink_message_interval_message(number, ap.streams.interval_us(number)))
    return ACCEPTED


def request_message(ap: AutopilotState, now_ns: int, command: Command) -> int:
    """MAV_CMD_REQUEST_MESSAGE: send message p1 once."""
    number = _whole(command.p1)
    if not telemetry.can_build(ap, number):
        return ap.unknown_message
    ap.emit(telemetry.build(ap, number, now_ns))
    return ACCEPTED


def request_version(ap: AutopilotState, now_ns: int, command: Command) -> int:
    """MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: send AUTOPILOT_VERSION once."""
    ap.emit(telemetry.autopilot_version(ap, now_ns))
    return ACCEPTED


def get_home(ap: AutopilotState, now_ns: int, command: Command) -> int:
    """MAV_CMD_GET_HOME_POSITION: send HOME_POSITION once."""
    if not ap.home_known:
        return FAILED
    ap.emit(telemetry.home_position(ap, now_ns))
    return ACCEPTED


def set_home(ap: AutopilotState, now_ns: int, command: Command) -> int:
    """MAV_CMD_DO_SET_HOME: home becomes the present place (p1 = 1) or the one that the command gives."""
    if command.p1 == 1.0:
        if not ap.positioned(now_ns):
            return FAILED
        ap.home = ap.place
    else:
        home = Geodetic(command.latitude_deg, command.longitude_deg, command.z)
        sane = abs(home.latitude_deg) <= 90.0 and abs(home.longitude_deg) <= 180.0
        if not sane or not isfinite(home.altitude_m):
            return DENIED
        ap.home = home
    ap.home_known = True
    ap.emit(telemetry.home_position(ap, now_ns))
    return ACCEPTED


def _whole(value: float) -> int:
    """A number of a message; −1 for none."""
    return int(value) if isfinite(value) and 0 <= value < 2**24 else -1


CommandHandler = Callable[[AutopilotState, int, Command], int]

COMMANDS: dict[int, CommandHandler] = {
    dialect.MAV_CMD_SET_MESSAGE_INTERVAL: set_interval,
    dialect.MAV_CMD_GET_MESSAGE_INTERVAL: get_interval,
    dialect.MAV_CMD_REQUEST_MESSAGE: request_message,
    dialect.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: request_version,
    dialect.MAV_CMD_GET_HOME_POSITION: get_home,
    dialect.MAV_CMD_DO_SET_HOME: set_home,
}
