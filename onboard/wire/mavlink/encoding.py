"""What the agent sends (`commands.Outgoing`) → messages of the dialect, in the wire's units.

Fields out of the wire's range wrap or are clamped, so that packing never fails. A target that is not finite
is a fault of the caller (adapters send none): it is stopped here by an AssertionError.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, isfinite, sin
from typing import Any

from onboard.core.math.vectors import is_finite
from onboard.wire.mavlink.commands import (
    CommandInt,
    CommandLong,
    Outgoing,
    OwnHeartbeat,
    ParamRead,
    PlaceTarget,
    RollTarget,
    SetupSigning,
    VelocityTarget,
)
from onboard.wire.mavlink.dialect import MavMessage, dialect
from onboard.wire.mavlink.values import Timesync

VELOCITY_ONLY = 0x0DC7  # ArduPilot: ignore position, acceleration, yaw and yaw rate
VELOCITY_AND_YAW = 0x09C7  # PX4, as MAVSDK sends it: ignore position, acceleration and yaw rate
PLACE_ONLY = 0x0DF8  # PX4: ignore velocity, acceleration, yaw and yaw rate
ROLL_ONLY = 198  # ArduPlane reads: roll alone, keep altitude and speed (ignore the rest and throttle)


def encode(message: Outgoing) -> MavMessage:
    """Return the dialect's message for what the agent sends."""
    return _WRITERS[type(message)](message)


def _new(kind: Callable[..., MavMessage], *fields: Any, **named: Any) -> MavMessage:
    return kind(*fields, **named)


def _boot_ms(time_boot_s: float) -> int:
    return int(time_boot_s * 1e3) & 0xFFFFFFFF


def _heartbeat(_: OwnHeartbeat) -> MavMessage:
    return _new(
        dialect.MAVLink_heartbeat_message,
        type=dialect.MAV_TYPE_ONBOARD_CONTROLLER,
        autopilot=dialect.MAV_AUTOPILOT_INVALID,
        base_mode=0,
        custom_mode=0,
        system_status=dialect.MAV_STATE_ACTIVE,
        mavlink_version=3,
    )


def _command_long(m: CommandLong) -> MavMessage:
    params = (*m.params, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)[:7]
    kind = dialect.MAVLink_command_long_message
    return _new(kind, m.to.system, m.to.component, m.command, min(m.confirmation, 255), *params)


def _command_int(m: CommandInt) -> MavMessage:
    params = (*m.params, 0.0, 0.0, 0.0, 0.0)[:4]
    kind = dialect.MAVLink_command_int_message
    return _new(kind, m.to.system, m.to.component, m.frame, m.command, 0, 0, *params, m.x, m.y, m.z)


def _velocity_target(m: VelocityTarget) -> MavMessage:
    assert is_finite(m.velocity), m
    return _new(
        dialect.MAVLink_set_position_target_local_ned_message,
        time_boot_ms=_boot_ms(m.time_boot_s),
        target_system=m.to.system,
        target_component=m.to.component,
        coordinate_frame=dialect.MAV_FRAME_LOCAL_NED,
        type_mask=VELOCITY_ONLY if m.yaw is None else VELOCITY_AND_YAW,
        x=0.0,
        y=0.0,
        z=0.0,
        vx=m.velocity.x,
        vy=m.velocity.y,
        vz=m.velocity.z,
        afx=0.0,
        afy=0.0,
        afz=0.0,
        yaw=0.0 if m.yaw is None else m.yaw,
        yaw_rate=0.0,
    )


def _roll_target(m: RollTarget) -> MavMessage:
    assert isfinite(m.roll), m
    return _new(
        dialect.MAVLink_set_attitude_target_message,
        time_boot_ms=_boot_ms(m.time_boot_s),
        target_system=m.to.system,
        target_component=m.to.component,
        type_mask=ROLL_ONLY,
        q=[cos(m.roll / 2), sin(m.roll / 2), 0.0, 0.0],
        body_roll_rate=0.0,
        body_pitch_rate=0.0,
        body_yaw_rate=0.0,
        thrust=0.0,
    )


def _place_target(m: PlaceTarget) -> MavMessage:
    assert all(map(isfinite, (m.latitude_deg, m.longitude_deg, m.altitude_m))), m
    return _new(
        dialect.MAVLink_set_position_target_global_int_message,
        time_boot_ms=_boot_ms(m.time_boot_s),
        target_system=m.to.system,
        target_component=m.to.component,
        coordinate_frame=dialect.MAV_FRAME_GLOBAL_INT,
        type_mask=PLACE_ONLY,
        lat_int=round(m.latitude_deg * 1e7),
        lon_int=round(m.longitude_deg * 1e7),
        alt=m.altitude_m,
        vx=0.0,
        vy=0.0,
        vz=0.0,
        afx=0.0,
        afy=0.0,
        afz=0.0,
        yaw=0.0,
        yaw_rate=0.0,
    )


def _param_read(m: ParamRead) -> MavMessage:
    kind = dialect.MAVLink_param_request_read_message
    return _new(kind, m.to.system, m.to.component, m.name.encode("ascii")[:16], -1)


def _timesync(m: Timesync) -> MavMessage:
    return _new(dialect.MAVLink_timesync_message, m.answered_ns, m.asked_ns)


def _setup_signing(m: SetupSigning) -> MavMessage:
    kind = dialect.MAVLink_setup_signing_message
    return _new(kind, m.to.system, m.to.component, list(m.key), m.stamp)


_WRITERS: dict[type, Callable[[Any], MavMessage]] = {
    OwnHeartbeat: _heartbeat,
    CommandLong: _command_long,
    CommandInt: _command_int,
    VelocityTarget: _velocity_target,
    RollTarget: _roll_target,
    PlaceTarget: _place_target,
    ParamRead: _param_read,
    Timesync: _timesync,
    SetupSigning: _setup_signing,
}
