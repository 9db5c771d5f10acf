"""Commands that every autopilot obeys whatever it flies: what to send, home, reboot.

One function a command; it gives the result.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import TYPE_CHECKING

from onboard.wire.geodesy import Geodetic
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, FAILED, UNSUPPORTED, Command

if TYPE_CHECKING:
    from sim_bridge.vehicle.autopilot.autopilot import Autopilot


def set_interval(ap: Autopilot, now_ns: int, command: Command) -> int:
    number = _whole(command.p1)
    if not telemetry.can_build(ap, number) or not isfinite(command.p2):
        return ap.unknown_interval
    ap.streams.set(number, command.p2, now_ns)
    return ACCEPTED


def get_interval(ap: Autopilot, now_ns: int, command: Command) -> int:
    number = _whole(command.p1)
    if not telemetry.can_build(ap, number):
        return ap.unknown_interval
    ap.emit(dialect.MAVLink_message_interval_message(number, ap.streams.interval_us(number)))
    return ACCEPTED


def request_message(ap: Autopilot, now_ns: int, command: Command) -> int:
    number = _whole(command.p1)
    if not telemetry.can_build(ap, number):
        return ap.unknown_message
    ap.emit(telemetry.build(ap, number, now_ns))
    return ACCEPTED


def request_version(ap: Autopilot, now_ns: int, command: Command) -> int:
    ap.emit(telemetry.autopilot_version(ap, now_ns))
    return ACCEPTED


def get_home(ap: Autopilot, now_ns: int, command: Command) -> int:
    if not ap.home_known:
        return FAILED
    ap.emit(telemetry.home_position(ap, now_ns))
    return ACCEPTED


def set_home(ap: Autopilot, now_ns: int, command: Command) -> int:
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


def reboot(ap: Autopilot, now_ns: int, command: Command) -> int:
    if command.p1 != 1.0:
        return UNSUPPORTED
    if ap.armed:
        return FAILED
    ap.reboot(now_ns)
    return ACCEPTED


def _whole(value: float) -> int:
    """A number of a message; −1 for none."""
    return int(value) if isfinite(value) and 0 <= value < 2**24 else -1


Inquiry = Callable[["Autopilot", int, Command], int]

INQUIRIES: dict[int, Inquiry] = {
    dialect.MAV_CMD_SET_MESSAGE_INTERVAL: set_interval,
    dialect.MAV_CMD_GET_MESSAGE_INTERVAL: get_interval,
    dialect.MAV_CMD_REQUEST_MESSAGE: request_message,
    dialect.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: request_version,
    dialect.MAV_CMD_GET_HOME_POSITION: get_home,
    dialect.MAV_CMD_DO_SET_HOME: set_home,
    dialect.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN: reboot,
}
