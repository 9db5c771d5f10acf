"""What agents and stations send (`commands.Outgoing`) → messages of the dialect, in the wire's units.

Fields out of the wire's range wrap or are clamped, so that packing never fails. A target that is not finite
is a fault of the caller (adapters send none): it is stopped here by an AssertionError.
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, degrees, isfinite, sin, sqrt
from typing import Any

from onboard.core.math.vectors import is_finite
from onboard.wire.mavlink.commands import (
    AdsbHeartbeat,
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
from onboard.wire.mavlink.values import AdsbVehicle, Timesync

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


def _heartbeat(m: OwnHeartbeat | AdsbHeartbeat) -> MavMessage:
    aboard = isinstance(m, OwnHeartbeat)
    return _new(
        dialect.MAVLink_heartbeat_message,
        type=dialect.MAV_TYPE_ONBOARD_CONTROLLER if aboard else dialect.MAV_TYPE_ADSB,
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


def _adsb_vehicle(m: AdsbVehicle) -> MavMessage:
    """Course and speeds over ground; a height above mean sea level is what displays take as geometric."""
    assert all(map(isfinite, (m.latitude_deg, m.longitude_deg, m.altitude_m))), m
    assert is_finite(m.velocity), m
    flags = dialect.ADSB_FLAGS_VALID_CALLSIGN
    if m.position_valid:
        flags |= dialect.ADSB_FLAGS_VALID_COORDS | dialect.ADSB_FLAGS_VALID_ALTITUDE
    if m.velocity_valid:
        flags |= dialect.ADSB_FLAGS_VALID_HEADING | dialect.ADSB_FLAGS_VALID_VELOCITY
        flags |= dialect.ADSB_FLAGS_VERTICAL_VELOCITY_VALID
    north, east, down = m.velocity
    geometric = dialect.ADSB_ALTITUDE_TYPE_GEOMETRIC
    return _new(
        dialect.MAVLink_adsb_vehicle_message,
        ICAO_address=m.icao & 0xFFFFFF,
        lat=round(m.latitude_deg * 1e7),
        lon=round(m.longitude_deg * 1e7),
        altitude_type=geometric if m.geometric else dialect.ADSB_ALTITUDE_TYPE_PRESSURE_QNH,
        altitude=_within(round(m.altitude_m * 1e3), -(1 << 31), (1 << 31) - 1),
        heading=round(degrees(atan2(east, north)) * 100.0) % 36000,
        hor_velocity=_within(round(100.0 * sqrt(north * north + east * east)), 0, 65535),
        ver_velocity=_within(round(-100.0 * down), -32768, 32767),
        callsign=m.callsign.encode("ascii", "replace")[:8],
        emitter_type=dialect.ADSB_EMITTER_TYPE_UAV,
        tslc=_within(round(m.age_s), 0, 255),
        flags=flags,
        squawk=0,
    )


def _within(value: int, low: int, high: int) -> int:
    return max(low, min(high, value))


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
    AdsbHeartbeat: _heartbeat,
    AdsbVehicle: _adsb_vehicle,
}
