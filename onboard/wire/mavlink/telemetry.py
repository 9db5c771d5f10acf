"""Messages of an autopilot → values in SI, radians and NED.

degE7, centimetres, millimetres and the wire's degrees end here. `decode` gives None for a message
that nobody reads, and for one with NaN, infinity or a place that is not on Earth.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, isfinite, pi, radians, sin
from struct import Struct, error
from typing import Any

from onboard.core.math.each import new
from onboard.core.math.vectors import Vec
from onboard.wire.mavlink.dialect import Layout, MavMessage, dialect, layout_of
from onboard.wire.mavlink.modes import kind_of, mode_name
from onboard.wire.mavlink.values import (
    UNKNOWN,
    AdsbVehicle,
    AirData,
    Attitude,
    Battery,
    CommandAck,
    DroneIdentity,
    DroneLocation,
    EkfStatus,
    ExtendedState,
    GlobalPosition,
    GpsFix,
    Heartbeat,
    Home,
    MessageInterval,
    ParamValue,
    RadioStatus,
    RcChannels,
    StatusText,
    SysStatus,
    Timesync,
    Value,
    Version,
    Wind,
)

_NO_HEIGHT = -1000.0  # [m] how Open Drone ID says that a height is unknown
_ACCURACY_M = {5: 926.0, 6: 555.6, 7: 185.2, 8: 92.6, 9: 30.0, 10: 10.0, 11: 3.0, 12: 1.0}
"""MAV_ODID_HOR_ACC: 95 % of the positions lie within so many metres."""
_PLANE_95 = 2.45  # radius of 95 % of a normal distribution in a plane [sigma]


def value_of(layout: Layout, payload: bytes) -> Value | None:
    """Return what a payload says; None for a message that nobody reads and for one that is not sound."""
    plain = _PLAIN.get(layout.number)
    if plain is not None:
        return plain(layout.values(payload))
    reader = _READERS.get(layout.number)
    return reader(layout.message(payload)) if reader is not None else None


def decode(message: MavMessage) -> Value | None:
    """Return the value of a message that somebody reads; None for others and for one that is not sound."""
    number = message.get_msgId()
    layout = layout_of(number)
    plain, reader = _PLAIN.get(number), _READERS.get(number)
    if plain is not None and layout is not None:
        return plain(layout.fields(message))
    return reader(message) if reader is not None else None


def _on_earth(latitude_e7: int, longitude_e7: int) -> bool:
    return -900_000_000 <= latitude_e7 <= 900_000_000 and -1_800_000_000 <= longitude_e7 <= 1_800_000_000


# ---------------------------------------------------------------------- what comes often: `v` are the values
# of the wire, in its order. A sum of numbers of 32 bits is finite where all of them are.

def _heartbeat(v: tuple[Any, ...]) -> Heartbeat:
    custom_mode, type, autopilot, base_mode, system_status, _version = v
    kind = kind_of(autopilot, type)
    armed = bool(base_mode & dialect.MAV_MODE_FLAG_SAFETY_ARMED)
    return Heartbeat(kind, type, autopilot, custom_mode, mode_name(kind, custom_mode), armed, system_status)


def _global_position(v: tuple[Any, ...]) -> GlobalPosition | None:
    boot_ms, lat, lon, alt, relative_alt, vx, vy, vz, _heading = v
    if not _on_earth(lat, lon):
        return None
    velocity = new(Vec, (vx * 0.01, vy * 0.01, vz * 0.01))
    place = (lat * 1e-7, lon * 1e-7, alt * 1e-3, relative_alt * 1e-3)
    return new(GlobalPosition, (boot_ms * 1e-3, *place, velocity))


def _attitude(v: tuple[Any, ...]) -> Attitude | None:
    boot_ms, roll, pitch, yaw, rollspeed, pitchspeed, yawspeed = v
    if not isfinite(roll + pitch + yaw + rollspeed + pitchspeed + yawspeed):
        return None
    if abs(roll) > 2 * pi or abs(pitch) > 2 * pi or abs(yaw) > 4 * pi:
        return None
    return new(Attitude, (boot_ms * 1e-3, roll, pitch, yaw, new(Vec, (rollspeed, pitchspeed, yawspeed))))


def _air_data(v: tuple[Any, ...]) -> AirData | None:
    airspeed, groundspeed, alt, climb, _heading, throttle = v
    if not isfinite(airspeed + groundspeed + climb + alt):
        return None
    return new(AirData, (airspeed, groundspeed, climb, throttle * 0.01, alt))


def _wind(v: tuple[Any, ...]) -> Wind | None:
    """ArduPilot: `direction` is where it comes from [deg], `speed` is in the ground plane, `speed_z` down."""
    direction, speed, speed_z = v
    if not isfinite(direction + speed + speed_z):
        return None
    origin = radians(direction)
    return Wind(Vec(-speed * cos(origin), -speed * sin(origin), speed_z))


def _wind_cov(v: tuple[Any, ...]) -> Wind | None:
    """PX4: the vector itself; it does not know the vertical part (NaN)."""
    _usec, wind_x, wind_y, wind_z, *_ = v
    if not isfinite(wind_x + wind_y):
        return None
    return Wind(Vec(wind_x, wind_y, wind_z if isfinite(wind_z) else 0.0))


def _sys_status(v: tuple[Any, ...]) -> SysStatus:
    present, enabled, health, load, voltage, _current, drop_rate, *_, remaining, _, _, _ = v
    bit = dialect.MAV_SYS_STATUS_PREARM_CHECK
    return SysStatus(
        battery=remaining * 0.01 if 0 <= remaining <= 100 else UNKNOWN,
        voltage=voltage * 1e-3 if 0 < voltage < 65535 else UNKNOWN,
        pre_arm_known=bool(present & bit),
        pre_arm_ok=bool(health & bit),
        unhealthy=enabled & ~health,
        load=load * 1e-3,
        drop_rate=drop_rate * 1e-4,
    )


def _gps_fix(v: tuple[Any, ...]) -> GpsFix:
    _usec, _lat, _lon, _alt, eph, _epv, _vel, _cog, fix_type, satellites, _ellipsoid, h_acc, *_ = v
    return GpsFix(
        fix=fix_type,
        satellites=satellites if satellites != 255 else -1,
        hdop=eph * 0.01 if eph != 65535 else UNKNOWN,
        accuracy_m=h_acc * 1e-3 if h_acc else UNKNOWN,
    )


_NEEDED = (
    dialect.ESTIMATOR_ATTITUDE
    | dialect.ESTIMATOR_VELOCITY_HORIZ
    | dialect.ESTIMATOR_VELOCITY_VERT
    | dialect.ESTIMATOR_POS_HORIZ_ABS
)
# The two reports agree on what is estimated and part ways on what is wrong. PX4 sets CONST_POS_MODE at rest,
# too, where all is well; where it holds a place for want of measurements, it takes the needed flags back.
_FAULTS = dialect.ESTIMATOR_GPS_GLITCH | dialect.ESTIMATOR_ACCEL_ERROR
_EKF_FAULTS = dialect.EKF_CONST_POS_MODE | dialect.EKF_UNINITIALIZED | dialect.EKF_GPS_GLITCHING
# A measurement that disagrees sets these for as long as it does, be it one sample.
_REJECTING = dialect.ESTIMATOR_GPS_GLITCH | dialect.ESTIMATOR_ACCEL_ERROR
_EKF_REJECTING = dialect.EKF_GPS_GLITCHING


def _ekf(flags: int, faults: int, rejecting: int, ratios: tuple[float, ...]) -> EkfStatus:
    """A ratio that is not a number is one that the estimator does not compute."""
    worst = max((abs(ratio) for ratio in ratios if isfinite(ratio)), default=0.0)
    estimated = flags & _NEEDED == _NEEDED and not flags & faults & ~rejecting
    return EkfStatus(flags, estimated and not flags & faults and worst <= 1.0, worst, estimated)


def _ekf_status_report(v: tuple[Any, ...]) -> EkfStatus:
    velocity, horizontal, vertical, compass, _terrain, flags, _airspeed = v
    return _ekf(flags, _EKF_FAULTS, _EKF_REJECTING, (velocity, horizontal, vertical, compass))


def _estimator_status(v: tuple[Any, ...]) -> EkfStatus:
    _usec, velocity, horizontal, vertical, mag, *_, flags = v
    return _ekf(flags, _FAULTS, _REJECTING, (velocity, horizontal, vertical, mag))


def _extended_state(v: tuple[Any, ...]) -> ExtendedState:
    return ExtendedState(*v)


def _command_ack(v: tuple[Any, ...]) -> CommandAck:
    command, result, _progress, _param2, system, component = v
    return CommandAck(command, result, system, component)


def _timesync(v: tuple[Any, ...]) -> Timesync:
    return Timesync(*v)


# ---------------------------------------------------------------------- what comes seldom


def _battery(m: Any) -> Battery:
    cells = [mv for mv in (*m.voltages, *(mv for mv in m.voltages_ext if mv)) if mv != 65535]
    return Battery(
        id=m.id,
        remaining=m.battery_remaining * 0.01 if 0 <= m.battery_remaining <= 100 else UNKNOWN,
        voltage=sum(cells) * 1e-3 if cells else UNKNOWN,
        time_left_s=float(m.time_remaining) if m.time_remaining > 0 else UNKNOWN,
        function=m.battery_function,
    )


def _status_text(m: Any) -> StatusText:
    return StatusText(m.severity, _text(m.text), m.id, m.chunk_seq)


def _home(m: Any) -> Home | None:
    if not _on_earth(m.latitude, m.longitude):
        return None
    return Home(m.latitude * 1e-7, m.longitude * 1e-7, m.altitude * 1e-3)


_FLOAT = Struct("<f")
_INTEGERS = {
    dialect.MAV_PARAM_TYPE_UINT8: Struct("<Bxxx"),
    dialect.MAV_PARAM_TYPE_INT8: Struct("<bxxx"),
    dialect.MAV_PARAM_TYPE_UINT16: Struct("<Hxx"),
    dialect.MAV_PARAM_TYPE_INT16: Struct("<hxx"),
    dialect.MAV_PARAM_TYPE_UINT32: Struct("<I"),
    dialect.MAV_PARAM_TYPE_INT32: Struct("<i"),
}


def _param_value(m: Any) -> ParamValue | None:
    layout = _INTEGERS.get(m.param_type)
    payload = m.get_payload()  # a float that is NaN loses bits of an integer on its way through Python
    try:
        bits = bytes(payload[:4]).ljust(4, b"\0") if payload else _FLOAT.pack(m.param_value)
    except (error, OverflowError):
        return None
    bytewise = float(layout.unpack(bits)[0]) if layout is not None else m.param_value
    value = m.param_value
    if not isfinite(value):
        if layout is None:
            return None
        value = bytewise
    return ParamValue(_text(m.param_id), value, bytewise, m.param_type, m.param_count, m.param_index)


def _version(m: Any) -> Version:
    v = m.flight_sw_version
    flight = (v >> 24 & 0xFF, v >> 16 & 0xFF, v >> 8 & 0xFF, v & 0xFF)
    return Version(m.capabilities, flight, m.board_version, m.uid)


def _adsb_vehicle(m: Any) -> AdsbVehicle | None:
    if not _on_earth(m.lat, m.lon):
        return None
    course, speed = radians(m.heading * 0.01), m.hor_velocity * 0.01
    horizontal = m.flags & dialect.ADSB_FLAGS_VALID_VELOCITY and m.flags & dialect.ADSB_FLAGS_VALID_HEADING
    return AdsbVehicle(
        icao=m.ICAO_address,
        callsign=_text(m.callsign).strip(),
        latitude_deg=m.lat * 1e-7,
        longitude_deg=m.lon * 1e-7,
        altitude_m=m.altitude * 1e-3,
        geometric=m.altitude_type == dialect.ADSB_ALTITUDE_TYPE_GEOMETRIC,
        velocity=Vec(speed * cos(course), speed * sin(course), -m.ver_velocity * 0.01),
        age_s=float(m.tslc),
        position_valid=bool(
            m.flags & dialect.ADSB_FLAGS_VALID_COORDS and m.flags & dialect.ADSB_FLAGS_VALID_ALTITUDE
        ),
        velocity_valid=bool(horizontal),
    )


def _drone_identity(m: Any) -> DroneIdentity | None:
    name = _text(bytes(m.uas_id)).strip()
    return DroneIdentity(bytes(m.id_or_mac), name) if name else None


def _drone_location(m: Any) -> DroneLocation | None:
    pressure = m.altitude_geodetic <= _NO_HEIGHT
    altitude = m.altitude_barometric if pressure else m.altitude_geodetic
    placed = m.latitude != 0 or m.longitude != 0  # 0°, 0° is how the standard says unknown
    if not (placed and _on_earth(m.latitude, m.longitude) and isfinite(altitude) and altitude > _NO_HEIGHT):
        return None
    velocity = None
    if m.direction < 36_000 and m.speed_horizontal < 25_500:
        course, speed = radians(m.direction * 0.01), m.speed_horizontal * 0.01
        climb = m.speed_vertical * 0.01 if abs(m.speed_vertical) < 6_300 else 0.0
        velocity = Vec(speed * cos(course), speed * sin(course), -climb)
    bound = _ACCURACY_M.get(m.horizontal_accuracy)
    sigma = UNKNOWN if bound is None else bound / _PLANE_95
    return DroneLocation(
        bytes(m.id_or_mac), m.latitude * 1e-7, m.longitude * 1e-7, altitude, pressure, velocity, sigma
    )


def _radio_status(m: Any) -> RadioStatus:
    return RadioStatus(min(m.txbuf, 100) * 0.01, m.rssi, m.remrssi, m.rxerrors)


def _message_interval(m: Any) -> MessageInterval:
    return MessageInterval(m.message_id, max(0, m.interval_us) * 1e-6)


def _rc_channels(m: Any) -> RcChannels:
    """A channel that is not heard reads 0."""
    pulses: list[int] = []
    for number in range(1, min(m.chancount, 18) + 1):
        pulse = getattr(m, f"chan{number}_raw")
        pulses.append(pulse if 0 < pulse < 65535 else 0)
    return RcChannels(tuple(pulses))


def _text(raw: str | bytes) -> str:
    if isinstance(raw, bytes):
        raw = raw.split(b"\0", 1)[0].decode("ascii", errors="replace")
    return raw.rstrip("\0")


_PLAIN: dict[int, Callable[[tuple[Any, ...]], Value | None]] = {
    dialect.MAVLINK_MSG_ID_HEARTBEAT: _heartbeat,
    dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: _global_position,
    dialect.MAVLINK_MSG_ID_ATTITUDE: _attitude,
    dialect.MAVLINK_MSG_ID_VFR_HUD: _air_data,
    dialect.MAVLINK_MSG_ID_WIND: _wind,
    dialect.MAVLINK_MSG_ID_WIND_COV: _wind_cov,
    dialect.MAVLINK_MSG_ID_SYS_STATUS: _sys_status,
    dialect.MAVLINK_MSG_ID_GPS_RAW_INT: _gps_fix,
    dialect.MAVLINK_MSG_ID_EKF_STATUS_REPORT: _ekf_status_report,
    dialect.MAVLINK_MSG_ID_ESTIMATOR_STATUS: _estimator_status,
    dialect.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: _extended_state,
    dialect.MAVLINK_MSG_ID_COMMAND_ACK: _command_ack,
    dialect.MAVLINK_MSG_ID_TIMESYNC: _timesync,
}
_READERS: dict[int, Callable[[Any], Value | None]] = {
    dialect.MAVLINK_MSG_ID_BATTERY_STATUS: _battery,
    dialect.MAVLINK_MSG_ID_STATUSTEXT: _status_text,
    dialect.MAVLINK_MSG_ID_HOME_POSITION: _home,
    dialect.MAVLINK_MSG_ID_PARAM_VALUE: _param_value,
    dialect.MAVLINK_MSG_ID_AUTOPILOT_VERSION: _version,
    dialect.MAVLINK_MSG_ID_ADSB_VEHICLE: _adsb_vehicle,
    dialect.MAVLINK_MSG_ID_OPEN_DRONE_ID_BASIC_ID: _drone_identity,
    dialect.MAVLINK_MSG_ID_OPEN_DRONE_ID_LOCATION: _drone_location,
    dialect.MAVLINK_MSG_ID_RADIO_STATUS: _radio_status,
    dialect.MAVLINK_MSG_ID_RADIO: _radio_status,  # of older radios: the same fields
    dialect.MAVLINK_MSG_ID_MESSAGE_INTERVAL: _message_interval,
    dialect.MAVLINK_MSG_ID_RC_CHANNELS: _rc_channels,
}

READ = frozenset((*_PLAIN, *_READERS))
"""Numbers of the messages that `decode` has a value for."""
FLIGHT = READ - {dialect.MAVLINK_MSG_ID_STATUSTEXT}
"""Those that flight depends on: all but the words for people."""
