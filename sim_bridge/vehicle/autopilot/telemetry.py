"""The messages an autopilot sends about itself: one builder a message, SI in, the wire's units out."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, degrees, nan, sin, sqrt

from onboard.core.math.vectors import Vec, clamp
from onboard.wire.mavlink.dialect import MavMessage, Said, dialect
from sim_bridge.vehicle.autopilot import health
from sim_bridge.vehicle.autopilot.px4_streams import UNREAD
from sim_bridge.vehicle.autopilot.state import AutopilotState
from sim_bridge.vehicle.autopilot.transmitter import CHANNELS

PX4: int = dialect.MAV_AUTOPILOT_PX4
MAVLINK_VERSION = 3
UNKNOWN_U16 = 65535
NO_ACCURACY = (0, 0, 0, 0, 0, 0)  # of GPS_RAW_INT's extension


def _i16(value: float) -> int:
    whole = round(value)
    return whole if -32768 <= whole <= 32767 else int(clamp(whole, -32768, 32767))


def _u16(value: float) -> int:
    return int(clamp(round(value), 0, 65535))


def _i32(value: float) -> int:
    whole = round(value)
    return whole if -(2**31) <= whole < 2**31 else int(clamp(whole, -(2**31), 2**31 - 1))


def _e7(angle_deg: float) -> int:
    return _i32(angle_deg * 1e7)


def heartbeat(ap: AutopilotState, now_ns: int) -> MavMessage:
    """HEARTBEAT: kind of autopilot and vehicle, mode, whether it is armed, and its condition."""
    mode: int = dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
    if ap.armed:
        mode |= dialect.MAV_MODE_FLAG_SAFETY_ARMED
    if not ap.is_mode("STABILIZED" if ap.autopilot_type == PX4 else "STABILIZE"):
        mode |= dialect.MAV_MODE_FLAG_STABILIZE_ENABLED | dialect.MAV_MODE_FLAG_GUIDED_ENABLED
    if ap.critical:
        status: int = dialect.MAV_STATE_CRITICAL
    else:
        status = dialect.MAV_STATE_ACTIVE if ap.armed else dialect.MAV_STATE_STANDBY
    message: MavMessage = dialect.MAVLink_heartbeat_message(
        ap.vehicle_type, ap.autopilot_type, mode, ap.mode, status, MAVLINK_VERSION
    )
    return message


def attitude(ap: AutopilotState, now_ns: int) -> Said:
    """ATTITUDE: roll, pitch and yaw [rad] with their rates [rad/s]."""
    _, _, _, roll, pitch, yaw, rates = ap.motion
    return Said(dialect.MAVLINK_MSG_ID_ATTITUDE, (ap.boot_ms(now_ns), roll, pitch, yaw, *rates))


def global_position(ap: AutopilotState, now_ns: int) -> Said | None:
    """GLOBAL_POSITION_INT: geodetic position, height above home, ground velocity; None: no position."""
    if not ap.positioned(now_ns):
        return None
    (latitude, longitude, altitude), (x, y, z) = ap.place, ap.motion.velocity
    heading = round(degrees(ap.motion.yaw) * 100.0) % 36000
    above = _i32((altitude - ap.home.altitude_m) * 1e3)
    where = (_i32(latitude * 1e7), _i32(longitude * 1e7), _i32(altitude * 1e3), above)
    told = (ap.boot_ms(now_ns), *where, _i16(x * 1e2), _i16(y * 1e2), _i16(z * 1e2), heading)
    return Said(dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, told)


def local_position(ap: AutopilotState, now_ns: int) -> MavMessage | None:
    """LOCAL_POSITION_NED in the autopilot's own local frame [m, m/s]; None without a position."""
    if not ap.positioned(now_ns):
        return None
    p, v = ap.local.ned_from_geodetic(*ap.place), ap.motion.velocity
    message: MavMessage = dialect.MAVLink_local_position_ned_message(
        ap.boot_ms(now_ns), p.x, p.y, p.z, v.x, v.y, v.z
    )
    return message


def vfr_hud(ap: AutopilotState, now_ns: int) -> Said:
    """VFR_HUD: airspeed, ground speed, heading, altitude and climb rate."""
    m = ap.motion
    ground = sqrt(m.velocity.x * m.velocity.x + m.velocity.y * m.velocity.y)
    throttle = 0 if ap.landed else 50
    told = (m.airspeed, ground, ap.place.altitude_m, -m.velocity.z, round(degrees(m.yaw)) % 360, throttle)
    return Said(dialect.MAVLINK_MSG_ID_VFR_HUD, told)


def sys_status(ap: AutopilotState, now_ns: int) -> MavMessage:
    """SYS_STATUS: sensors present, enabled and healthy; voltage, current and charge of the battery."""
    h = ap.health
    good = h.sensor_health(ap.gps_fixed(now_ns), ap.positioned(now_ns), ap.healthy(now_ns))
    current = health.CURRENT_IDLE if ap.landed else health.CURRENT_FLYING
    message: MavMessage = dialect.MAVLink_sys_status_message(
        health.SENSORS, health.SENSORS, good, 250, _u16(h.voltage * 1e3), _i16(current * 1e2),
        round(h.battery * 100.0), 0, 0, 0, 0, 0, 0,
    )  # fmt: skip
    return message


def battery_status(ap: AutopilotState, now_ns: int) -> MavMessage:
    """BATTERY_STATUS: cell voltages, current, charge used and charge left."""
    h = ap.health
    cells = [_u16(h.voltage / health.CELLS * 1e3)] * health.CELLS + [UNKNOWN_U16] * (10 - health.CELLS)
    current = health.CURRENT_IDLE if ap.landed else health.CURRENT_FLYING
    used = (1.0 - h.battery) * ap.setup.options.battery_s * health.CURRENT_FLYING / 3.6  # [mAh]
    message: MavMessage = dialect.MAVLink_battery_status_message(
        0,
        dialect.MAV_BATTERY_FUNCTION_ALL,
        dialect.MAV_BATTERY_TYPE_LIPO,
        32767,
        cells,
        _i16(current * 1e2),
        _i32(used),
        -1,
        round(h.battery * 100.0),
    )
    return message


def payload_battery(ap: AutopilotState, now_ns: int) -> MavMessage | None:
    """BATTERY_STATUS of the second battery, which feeds a payload; None where there is none."""
    charge = ap.health.payload
    if charge is None:
        return None
    cells = [_u16(health.pack_voltage(charge) / health.CELLS * 1e3)] * health.CELLS
    message: MavMessage = dialect.MAVLink_battery_status_message(
        1, dialect.MAV_BATTERY_FUNCTION_PAYLOAD, dialect.MAV_BATTERY_TYPE_LIPO, 32767,
        cells + [UNKNOWN_U16] * (10 - health.CELLS), _i16(health.CURRENT_IDLE * 1e2), -1, -1,
        round(charge * 100.0),
    )  # fmt: skip
    return message


def rc_channels(ap: AutopilotState, now_ns: int) -> MavMessage | None:
    """RC_CHANNELS: what the receiver hears; None where PX4 hears nothing, which then is silent about it."""
    told = ap.transmitter.channels()
    heard = ap.transmitter.throttle is not None
    if not heard and ap.autopilot_type == PX4:
        return None
    message: MavMessage = dialect.MAVLink_rc_channels_message(
        ap.boot_ms(now_ns), CHANNELS if heard else 0, *told, 255
    )
    return message


def gps_raw(ap: AutopilotState, now_ns: int) -> Said:
    """GPS_RAW_INT: fix, position, speed and course as the receiver has them."""
    place, v = ap.place, ap.motion.velocity
    fixed = ap.gps_fixed(now_ns)
    number, at_us = dialect.MAVLINK_MSG_ID_GPS_RAW_INT, ap.boot_ms(now_ns) * 1000
    if not fixed:
        unknown = (UNKNOWN_U16,) * 4  # of place and height, speed and course
        return Said(number, (at_us, 0, 0, 0, *unknown, dialect.GPS_FIX_TYPE_NO_FIX, 0, *NO_ACCURACY))
    where = (_e7(place.latitude_deg), _e7(place.longitude_deg), _i32(place.altitude_m * 1e3))
    course = round(degrees(atan2(v.y, v.x)) * 100.0) % 36000
    moves = (121, 200, _u16(sqrt(v.x * v.x + v.y * v.y) * 1e2), course)
    return Said(number, (at_us, *where, *moves, dialect.GPS_FIX_TYPE_3D_FIX, 10, *NO_ACCURACY))


def extended_state(ap: AutopilotState, now_ns: int) -> MavMessage:
    """EXTENDED_SYS_STATE: on the ground or in the air."""
    landed = dialect.MAV_LANDED_STATE_ON_GROUND if ap.landed else dialect.MAV_LANDED_STATE_IN_AIR
    message: MavMessage = dialect.MAVLink_extended_sys_state_message(dialect.MAV_VTOL_STATE_UNDEFINED, landed)
    return message


def ekf_status(ap: AutopilotState, now_ns: int) -> Said:
    """EKF_STATUS_REPORT: ArduPilot's estimator, its flags and innovation ratios."""
    positioned = ap.positioned(now_ns)
    ratio = 0.05 if positioned else 1.5
    flags = ap.health.ekf_flags(positioned)
    return Said(dialect.MAVLINK_MSG_ID_EKF_STATUS_REPORT, (ratio, ratio, 0.03, 0.02, 0.0, flags, 0.0))


def estimator_status(ap: AutopilotState, now_ns: int) -> MavMessage:
    """ESTIMATOR_STATUS: PX4's estimator, its flags, innovation ratios and accuracies."""
    positioned = ap.positioned(now_ns)
    ratio = 0.05 if positioned else 1.5
    at_rest = dialect.ESTIMATOR_CONST_POS_MODE if ap.landed else 0  # healthy there: nothing moves
    flags = ap.health.ekf_flags(positioned) | at_rest
    message: MavMessage = dialect.MAVLink_estimator_status_message(
        ap.boot_ms(now_ns) * 1000, flags, ratio, ratio, 0.03, 0.02, 0.0, 0.0, 0.3, 0.4
    )  # fmt: skip
    return message


def wind(ap: AutopilotState, now_ns: int) -> MavMessage:
    """WIND of ArduPilot: the direction that the wind comes from [deg] and its speed [m/s]."""
    w = ap.wind_filter.wind
    message: MavMessage = dialect.MAVLink_wind_message(
        degrees(atan2(-w.y, -w.x)) % 360.0, sqrt(w.x * w.x + w.y * w.y), w.z
    )
    return message


def wind_cov(ap: AutopilotState, now_ns: int) -> MavMessage:
    """WIND_COV of PX4: the velocity with which the air moves [m/s; NED]."""
    w = ap.wind_filter.wind
    message: MavMessage = dialect.MAVLink_wind_cov_message(
        ap.boot_ms(now_ns) * 1000, w.x, w.y, w.z, 0.1, 0.1, ap.place.altitude_m, 0.5, 0.5
    )
    return message


def system_time(ap: AutopilotState, now_ns: int) -> MavMessage:
    """SYSTEM_TIME: wall instant, 0 before the first fix, and time since boot."""
    wall_us = (ap.setup.options.epoch_ns + now_ns) // 1000 if ap.gps_fixed(now_ns) else 0
    message: MavMessage = dialect.MAVLink_system_time_message(wall_us, ap.boot_ms(now_ns))
    return message


def home_position(ap: AutopilotState, now_ns: int) -> MavMessage | None:
    """HOME_POSITION: home, geodetic and in the local frame; None while it is not known."""
    if not ap.home_known:
        return None
    p: Vec = ap.local.ned_from_geodetic(*ap.home)
    q = [nan] * 4 if ap.autopilot_type != PX4 else [1.0, 0.0, 0.0, 0.0]
    message: MavMessage = dialect.MAVLink_home_position_message(
        _e7(ap.home.latitude_deg),
        _e7(ap.home.longitude_deg),
        _i32(ap.home.altitude_m * 1e3),
        p.x, p.y, p.z, q, 0.0, 0.0, 0.0,
        ap.boot_ms(now_ns) * 1000,
    )  # fmt: skip
    return message


def global_origin(ap: AutopilotState, now_ns: int) -> MavMessage | None:
    """GPS_GLOBAL_ORIGIN: the geodetic origin of the local frame; None while it is not known."""
    if not ap.home_known:
        return None
    o = ap.local.origin
    message: MavMessage = dialect.MAVLink_gps_global_origin_message(
        _e7(o.latitude_deg), _e7(o.longitude_deg), _i32(o.altitude_m * 1e3), ap.boot_ms(now_ns) * 1000
    )
    return message


def attitude_quaternion(ap: AutopilotState, now_ns: int) -> MavMessage:
    """ATTITUDE_QUATERNION: the rotation from NED to the body (w, x, y, z) with its rates [rad/s]."""
    m = ap.motion
    cr, sr = cos(0.5 * m.roll), sin(0.5 * m.roll)
    cp, sp = cos(0.5 * m.pitch), sin(0.5 * m.pitch)
    cy, sy = cos(0.5 * m.yaw), sin(0.5 * m.yaw)
    message: MavMessage = dialect.MAVLink_attitude_quaternion_message(
        ap.boot_ms(now_ns),
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        m.rates.x,
        m.rates.y,
        m.rates.z,
    )
    return message


def altitude(ap: AutopilotState, now_ns: int) -> MavMessage:
    """ALTITUDE of PX4: above mean sea level, above the local origin and above home [m]."""
    amsl = ap.place.altitude_m
    local = amsl - ap.local.origin.altitude_m
    message: MavMessage = dialect.MAVLink_altitude_message(
        ap.boot_ms(now_ns) * 1000, amsl, amsl, local, ap.height, nan, nan
    )
    return message


def mission_current(ap: AutopilotState, now_ns: int) -> MavMessage:
    """MISSION_CURRENT: always the first item, for there are no missions."""
    message: MavMessage = dialect.MAVLink_mission_current_message(0)
    return message


def autopilot_version(ap: AutopilotState, now_ns: int) -> MavMessage:
    """AUTOPILOT_VERSION: capabilities truly there (no file transfer, no missions) and firmware."""
    capabilities = (
        dialect.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
        | dialect.MAV_PROTOCOL_CAPABILITY_MAVLINK2
        | dialect.MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED
        | dialect.MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT
        | dialect.MAV_PROTOCOL_CAPABILITY_SET_ATTITUDE_TARGET
        | (
            dialect.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE
            if ap.autopilot_type == PX4
            else dialect.MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT
        )
    )
    message: MavMessage = dialect.MAVLink_autopilot_version_message(
        capabilities, ap.version, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, ap.system
    )
    return message


Builder = Callable[[AutopilotState, int], MavMessage | Said | None]

COMMON: dict[int, Builder] = {
    dialect.MAVLINK_MSG_ID_HEARTBEAT: heartbeat,
    dialect.MAVLINK_MSG_ID_SYS_STATUS: sys_status,
    dialect.MAVLINK_MSG_ID_SYSTEM_TIME: system_time,
    dialect.MAVLINK_MSG_ID_GPS_RAW_INT: gps_raw,
    dialect.MAVLINK_MSG_ID_ATTITUDE: attitude,
    dialect.MAVLINK_MSG_ID_ATTITUDE_QUATERNION: attitude_quaternion,
    dialect.MAVLINK_MSG_ID_LOCAL_POSITION_NED: local_position,
    dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: global_position,
    dialect.MAVLINK_MSG_ID_MISSION_CURRENT: mission_current,
    dialect.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN: global_origin,
    dialect.MAVLINK_MSG_ID_RC_CHANNELS: rc_channels,
    dialect.MAVLINK_MSG_ID_VFR_HUD: vfr_hud,
    dialect.MAVLINK_MSG_ID_BATTERY_STATUS: battery_status,
    dialect.MAVLINK_MSG_ID_AUTOPILOT_VERSION: autopilot_version,
    dialect.MAVLINK_MSG_ID_HOME_POSITION: home_position,
    dialect.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: extended_state,
}
OF_PX4: dict[int, Builder] = {
    **COMMON,
    dialect.MAVLINK_MSG_ID_ALTITUDE: altitude,
    dialect.MAVLINK_MSG_ID_ESTIMATOR_STATUS: estimator_status,
    dialect.MAVLINK_MSG_ID_WIND_COV: wind_cov,
    **UNREAD,
}
OF_ARDUPILOT: dict[int, Builder] = {
    **COMMON,
    dialect.MAVLINK_MSG_ID_WIND: wind,
    dialect.MAVLINK_MSG_ID_EKF_STATUS_REPORT: ekf_status,
}

# REQUEST_DATA_STREAM, as ArduPilot groups what is simulated here.
DATA_STREAMS: dict[int, tuple[int, ...]] = {
    dialect.MAV_DATA_STREAM_EXTENDED_STATUS: (1, 24, 42),  # SYS_STATUS, GPS_RAW_INT, MISSION_CURRENT
    dialect.MAV_DATA_STREAM_RC_CHANNELS: (65,),  # RC_CHANNELS
    dialect.MAV_DATA_STREAM_POSITION: (32, 33),  # LOCAL_POSITION_NED, GLOBAL_POSITION_INT
    dialect.MAV_DATA_STREAM_EXTRA1: (30,),  # ATTITUDE
    dialect.MAV_DATA_STREAM_EXTRA2: (74,),  # VFR_HUD
    dialect.MAV_DATA_STREAM_EXTRA3: (2, 147, 168, 193),  # SYSTEM_TIME, BATTERY_STATUS, WIND, EKF
}
DATA_STREAMS[dialect.MAV_DATA_STREAM_ALL] = tuple(n for group in DATA_STREAMS.values() for n in group)


def _builders(ap: AutopilotState) -> dict[int, Builder]:
    return OF_PX4 if ap.autopilot_type == PX4 else OF_ARDUPILOT


def can_build(ap: AutopilotState, number: int) -> bool:
    """Whether this kind of autopilot sends messages of that number at all."""
    return number in _builders(ap)


def build(ap: AutopilotState, number: int, now_ns: int) -> MavMessage | Said | None:
    """The message of that number as it is now; None where it cannot be told (no position, no home)."""
    return _builders(ap)[number](ap, now_ns)
