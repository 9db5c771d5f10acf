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
from onboard.wire.mavlink.dialect import Layout, MavMessage, dialect, layout_of
from onboard.wire.mavlink.values import AdsbVehicle, Timesync

VELOCITY_ONLY = 0x0DC7  # ArduPilot: ignore position, acceleration, yaw and yaw rate
VELOCITY_AND_YAW = 0x09C7  # PX4, as MAVSDK sends it: ignore position, acceleration and yaw rate
PLACE_ONLY = 0x0DF8  # PX4: ignore velocity, acceleration, yaw and yaw rate
ROLL_ONLY = 198  # ArduPlane reads: roll alone, keep altitude and speed (ignore the rest and throttle)


def written(message: Outgoing) -> tuple[Layout, bytes]:
    """Return the kind of message for what the agent sends, and its whole payload."""
    plain = _STREAMED.get(type(message))
    if plain is not None:
        layout, values = plain
        return layout, layout.unpacker.pack(*values(message))
    sent = _WRITERS[type(message)](message)
    layout = _layout(sent.get_msgId())
    return layout, layout.payload(sent)


def _layout(number: int) -> Layout:
    layout = layout_of(number)
    assert layout is not None, number
    return layout


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


def _velocity_target(m: VelocityTarget) -> tuple[float, ...]:
    assert is_finite(m.velocity), m
    mask, yaw = (VELOCITY_ONLY, 0.0) if m.yaw is None else (VELOCITY_AND_YAW, m.yaw)
    to = (m.to.system, m.to.component, dialect.MAV_FRAME_LOCAL_NED)
    return (_boot_ms(m.time_boot_s), 0.0, 0.0, 0.0, *m.velocity, 0.0, 0.0, 0.0, yaw, 0.0, mask, *to)


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


def _place_target(m: PlaceTarget) -> tuple[float, ...]:
    assert all(map(isfinite, (m.latitude_deg, m.longitude_deg, m.altitude_m))), m
    place = (round(m.latitude_deg * 1e7), round(m.longitude_deg * 1e7), m.altitude_m)
    to = (m.to.system, m.to.component, dialect.MAV_FRAME_GLOBAL_INT)
    return (_boot_ms(m.time_boot_s), *place, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, PLACE_ONLY, *to)


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
    RollTarget: _roll_target,
    ParamRead: _param_read,
    Timesync: _timesync,
    SetupSigning: _setup_signing,
    AdsbHeartbeat: _heartbeat,
    AdsbVehicle: _adsb_vehicle,
}

# What goes out with every control step: its values in the wire's order.
_STREAMED: dict[type, tuple[Layout, Callable[[Any], tuple[float, ...]]]] = {
    VelocityTarget: (_layout(dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED), _velocity_target),
    PlaceTarget: (_layout(dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT), _place_target),
}

_names = {name for writer in _WRITERS.values() for name in writer.__code__.co_names}
WRITTEN = frozenset(number for number, kind in dialect.mavlink_map.items() if kind.__name__ in _names)
"""Numbers of the messages that are written by their class."""
