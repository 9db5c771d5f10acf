"""What the agent sends to an autopilot: one builder a message, SI and NED in, the wire's units inside.

Arguments out of the wire's range are clamped, so that packing what these build never fails; arguments
that are not finite are the caller's error (the supervisor lets none pass).
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, degrees, sin
from typing import Any, NamedTuple

from onboard.core.math.vectors import Vec, clamp
from onboard.wire.mavlink.frames import MavMessage, dialect

VELOCITY_ONLY = 0x0DC7  # ArduPilot: ignore position, acceleration, yaw and yaw rate
VELOCITY_AND_YAW = 0x09C7  # PX4, as MAVSDK sends it: ignore position, acceleration and yaw rate
ROLL_ONLY = 198  # ArduPlane reads: roll alone, keep altitude and speed (ignore the rest and throttle)
NAN = float("nan")  # "not given" in a command's parameter


class Target(NamedTuple):
    """Whom a message is for."""

    system: int
    component: int = dialect.MAV_COMP_ID_AUTOPILOT1


def _new(kind: Callable[..., MavMessage], *fields: Any, **named: Any) -> MavMessage:
    return kind(*fields, **named)


def _i32(value: float) -> int:
    return int(clamp(round(value), -(2**31), 2**31 - 1))


def heartbeat(*, active: bool = True) -> MavMessage:
    """Ours, as an onboard controller (no autopilot)."""
    return _new(
        dialect.MAVLink_heartbeat_message,
        type=dialect.MAV_TYPE_ONBOARD_CONTROLLER,
        autopilot=dialect.MAV_AUTOPILOT_INVALID,
        base_mode=0,
        custom_mode=0,
        system_status=dialect.MAV_STATE_ACTIVE if active else dialect.MAV_STATE_STANDBY,
        mavlink_version=3,
    )


def command_long(to: Target, command: int, *params: float, confirmation: int = 0) -> MavMessage:
    """COMMAND_LONG with up to seven parameters, the rest 0."""
    p = (*params, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)[:7]
    kind = dialect.MAVLink_command_long_message
    return _new(kind, to.system, to.component, command, confirmation & 0xFF, *p)


def command_int(
    to: Target,
    command: int,
    frame: int,
    *params: float,
    x: int = 0,
    y: int = 0,
    z: float = 0.0,
) -> MavMessage:
    """COMMAND_INT with up to four parameters, x and y in the frame's integers (degE7), z in metres."""
    p = (*params, 0.0, 0.0, 0.0, 0.0)[:4]
    kind = dialect.MAVLink_command_int_message
    return _new(kind, to.system, to.component, frame, command, 0, 0, *p, x, y, z)


def set_message_interval(to: Target, message: int, rate_hz: float) -> MavMessage:
    """Ask for a message at a rate; 0 stops it."""
    interval_us = round(1e6 / rate_hz) if rate_hz > 0.0 else -1
    return command_long(to, dialect.MAV_CMD_SET_MESSAGE_INTERVAL, message, interval_us)


def request_message(to: Target, message: int) -> MavMessage:
    """Ask for a message once."""
    return command_long(to, dialect.MAV_CMD_REQUEST_MESSAGE, message)


def velocity_target(
    to: Target, time_boot_s: float, velocity: Vec, *, yaw: float | None = None
) -> MavMessage:
    """A velocity [m/s; ground, NED] for a multicopter; with `yaw` [rad] also where it looks.

    Never for a plane: it takes such a message for an altitude of 0.
    """
    return _new(
        dialect.MAVLink_set_position_target_local_ned_message,
        time_boot_ms=int(time_boot_s * 1e3) & 0xFFFFFFFF,
        target_system=to.system,
        target_component=to.component,
        coordinate_frame=dialect.MAV_FRAME_LOCAL_NED,
        type_mask=VELOCITY_ONLY if yaw is None else VELOCITY_AND_YAW,
        x=0.0,
        y=0.0,
        z=0.0,
        vx=velocity.x,
        vy=velocity.y,
        vz=velocity.z,
        afx=0.0,
        afy=0.0,
        afz=0.0,
        yaw=0.0 if yaw is None else yaw,
        yaw_rate=0.0,
    )


def roll_target(to: Target, time_boot_s: float, roll: float) -> MavMessage:
    """A roll angle [rad] for an ArduPlane in GUIDED, which keeps altitude and speed; lapses after 3 s."""
    return _new(
        dialect.MAVLink_set_attitude_target_message,
        time_boot_ms=int(time_boot_s * 1e3) & 0xFFFFFFFF,
        target_system=to.system,
        target_component=to.component,
        type_mask=ROLL_ONLY,
        q=[cos(roll / 2), sin(roll / 2), 0.0, 0.0],
        body_roll_rate=0.0,
        body_pitch_rate=0.0,
        body_yaw_rate=0.0,
        thrust=0.0,
    )


def change_heading(to: Target, course: float, acceleration: float) -> MavMessage:
    """43002: fly a course [rad] over ground, with lateral acceleration [m/s²]. It has no timeout."""
    wanted = round(degrees(course) % 360.0, 2)
    return command_int(
        to,
        dialect.MAV_CMD_GUIDED_CHANGE_HEADING,
        dialect.MAV_FRAME_GLOBAL,
        dialect.HEADING_TYPE_COURSE_OVER_GROUND,
        wanted if wanted < 360.0 else 0.0,  # 360 itself is denied
        acceleration,
    )


def change_altitude(to: Target, altitude_m: float, climb_rate: float = 0.0) -> MavMessage:
    """43001: fly to an altitude above mean sea level [m] at |rate| [m/s], 0 = as fast as it may."""
    return command_int(
        to,
        dialect.MAV_CMD_GUIDED_CHANGE_ALTITUDE,
        dialect.MAV_FRAME_GLOBAL,
        0.0,
        0.0,
        abs(climb_rate),
        z=altitude_m if abs(altitude_m) > 0.01 else 0.01,  # 0 is denied
    )


def change_speed(to: Target, airspeed: float, acceleration: float = 0.0) -> MavMessage:
    """43000: fly an airspeed [m/s], reached with an acceleration [m/s²], 0 = as fast as it may."""
    return command_int(
        to,
        dialect.MAV_CMD_GUIDED_CHANGE_SPEED,
        dialect.MAV_FRAME_GLOBAL,
        dialect.SPEED_TYPE_AIRSPEED,
        airspeed,
        acceleration,
    )


def reposition(
    to: Target, latitude_deg: float, longitude_deg: float, altitude_m: float, *, radius_m: float = 0.0
) -> MavMessage:
    """192: go to a place (altitude above mean sea level) and stay; a plane circles it."""
    return command_int(
        to,
        dialect.MAV_CMD_DO_REPOSITION,
        dialect.MAV_FRAME_GLOBAL,
        -1.0,  # speed as it is
        dialect.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE,
        radius_m,
        x=_i32(latitude_deg * 1e7),
        y=_i32(longitude_deg * 1e7),
        z=altitude_m,
    )


def set_mode(to: Target, mode: int, *, px4: bool) -> MavMessage:
    """176 with a custom mode; PX4 wants main and sub mode apart."""
    custom = dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
    if px4:
        return command_long(to, dialect.MAV_CMD_DO_SET_MODE, custom, mode >> 16 & 0xFF, mode >> 24 & 0xFF)
    return command_long(to, dialect.MAV_CMD_DO_SET_MODE, custom, mode)


def arm(to: Target, *, armed: bool = True) -> MavMessage:
    """400: arm or disarm, never by force."""
    return command_long(to, dialect.MAV_CMD_COMPONENT_ARM_DISARM, 1.0 if armed else 0.0, 0.0)


def takeoff(to: Target, height_m: float) -> MavMessage:
    """22: take off to a height above home (ArduCopter in GUIDED)."""
    return command_long(to, dialect.MAV_CMD_NAV_TAKEOFF, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height_m)


def param_read(to: Target, name: str) -> MavMessage:
    """PARAM_REQUEST_READ by name."""
    kind = dialect.MAVLink_param_request_read_message
    return _new(kind, to.system, to.component, name.encode("ascii")[:16], -1)


def param_list(to: Target) -> MavMessage:
    """PARAM_REQUEST_LIST."""
    return _new(dialect.MAVLink_param_request_list_message, to.system, to.component)


def timesync(asked_ns: int, answered_ns: int = 0) -> MavMessage:
    """TIMESYNC: a request, or with `answered_ns` the answer to one."""
    return _new(dialect.MAVLink_timesync_message, answered_ns, asked_ns)


def status_text(severity: int, text: str) -> MavMessage:
    """STATUSTEXT, cut to 50 bytes."""
    return _new(dialect.MAVLink_statustext_message, severity, text.encode("ascii", errors="replace")[:50])
