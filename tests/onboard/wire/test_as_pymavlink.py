"""The own encoders and decoders beside pymavlink's: the same bytes, and the same values of the same bytes."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, isfinite, nan, pi, radians, sin
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.vectors import Vec
from onboard.wire.mavlink import commands, values
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.frames import Framer, Sender
from onboard.wire.mavlink.modes import kind_of, mode_name
from onboard.wire.mavlink.signing import MemoryStore, Signing, ticks

KEY, NOW = bytes(range(32)), 1_790_000_000 * 10**9
NUMBERS = sorted(dialect.mavlink_map)

pytestmark = pytest.mark.hypothesis


def theirs(signed: bool, sequence: int = 0, system: int = 1, component: int = 1) -> Any:
    """pymavlink's own sender, as they make one."""
    mav = dialect.MAVLink(None, srcSystem=system, srcComponent=component)
    mav.seq = sequence
    if signed:
        mav.signing.secret_key, mav.signing.sign_outgoing = KEY, True
        mav.signing.link_id, mav.signing.timestamp = 3, ticks(NOW)
    return mav


def signing(signed: bool) -> Signing | None:
    return Signing(KEY, MemoryStore()) if signed else None


def message_of(number: int, payload: bytes) -> Any:
    """pymavlink's message of a payload, read by pymavlink out of a frame that is made here byte by byte."""
    kind = dialect.mavlink_map[number]
    payload = payload[: kind.unpacker.size].ljust(1, b"\0")
    frame = bytes((0xFD, len(payload), 0, 0, 9, 1, 1)) + number.to_bytes(3, "little") + payload
    crc = dialect.x25crc(frame[1:] + bytes([kind.crc_extra])).crc
    return dialect.MAVLink(None).decode(bytearray(frame + crc.to_bytes(2, "little")))


payloads = st.one_of(
    st.binary(min_size=1, max_size=255),
    st.builds(lambda head, zeros: head + bytes(zeros), st.binary(max_size=40), st.integers(1, 200)),
)


@settings(max_examples=400, deadline=None)
@given(number=st.sampled_from(NUMBERS), payload=payloads, signed=st.booleans(), sequence=st.integers(0, 255))
def test_a_message_becomes_pymavlinks_bytes(number: int, payload: bytes, signed: bool, sequence: int) -> None:
    message = message_of(number, payload)
    ours = DialectSender(1, 1, signing=signing(signed), link_id=3, sequence=sequence)
    expected = message.pack(theirs(signed, sequence))
    assert ours.pack(message, NOW) == expected
    assert ours.pack(message, NOW)[4] == (sequence + 1) & 0xFF  # counted round


single = st.floats(width=32, allow_nan=False, allow_infinity=False)


@settings(max_examples=150, deadline=None)
@given(
    boot=st.floats(0, 5e6), velocity=st.tuples(single, single, single), yaw=st.none() | single,
    to=st.tuples(st.integers(0, 255), st.integers(0, 255)), signed=st.booleans(),
)  # fmt: skip
def test_a_velocity_becomes_pymavlinks_bytes(
    boot: float, velocity: tuple[float, float, float], yaw: float | None, to: tuple[int, int], signed: bool
) -> None:
    sent = commands.VelocityTarget(Target(*to), boot, Vec(*velocity), yaw)
    expected = dialect.MAVLink_set_position_target_local_ned_message(
        time_boot_ms=int(boot * 1e3) & 0xFFFFFFFF, target_system=to[0], target_component=to[1],
        coordinate_frame=1, type_mask=0b0000_1101_1100_0111 if yaw is None else 0b0000_1001_1100_0111,
        x=0, y=0, z=0, vx=velocity[0], vy=velocity[1], vz=velocity[2], afx=0, afy=0, afz=0,
        yaw=0 if yaw is None else yaw, yaw_rate=0,
    )  # fmt: skip
    ours = Sender(7, 191, signing=signing(signed), link_id=3)
    assert ours.pack(sent, NOW) == expected.pack(theirs(signed, 0, 7, 191))


@settings(max_examples=100, deadline=None)
@given(
    boot=st.floats(0, 5e6), latitude=st.floats(-90, 90), longitude=st.floats(-180, 180), altitude=single,
    signed=st.booleans(),
)  # fmt: skip
def test_a_place_becomes_pymavlinks_bytes(
    boot: float, latitude: float, longitude: float, altitude: float, signed: bool
) -> None:
    sent = commands.PlaceTarget(Target(2, 1), boot, latitude, longitude, altitude)
    expected = dialect.MAVLink_set_position_target_global_int_message(
        time_boot_ms=int(boot * 1e3) & 0xFFFFFFFF, target_system=2, target_component=1,
        coordinate_frame=5, type_mask=0b0000_1101_1111_1000, lat_int=round(latitude * 1e7),
        lon_int=round(longitude * 1e7), alt=altitude, vx=0, vy=0, vz=0, afx=0, afy=0, afz=0, yaw=0,
        yaw_rate=0,
    )  # fmt: skip
    ours = Sender(7, 191, signing=signing(signed), link_id=3)
    assert ours.pack(sent, NOW) == expected.pack(theirs(signed, 0, 7, 191))


# ---------------------------------------------------------------------- what arrives

PRE_ARM = 0x10000000


def _on_earth(m: Any) -> bool:
    return abs(m.lat) <= 90e7 and abs(m.lon) <= 180e7


def _finite(*numbers: float) -> bool:
    return all(isfinite(number) for number in numbers)


def _heartbeat(m: Any) -> Any:
    kind = kind_of(m.autopilot, m.type)
    name, armed = mode_name(kind, m.custom_mode), m.base_mode >= 128
    return values.Heartbeat(kind, m.type, m.autopilot, m.custom_mode, name, armed, m.system_status)


def _position(m: Any) -> Any:
    velocity = Vec(m.vx * 0.01, m.vy * 0.01, m.vz * 0.01)
    place = (m.lat * 1e-7, m.lon * 1e-7, m.alt * 1e-3, m.relative_alt * 1e-3)
    return values.GlobalPosition(m.time_boot_ms * 1e-3, *place, velocity) if _on_earth(m) else None


def _attitude(m: Any) -> Any:
    rates = Vec(m.rollspeed, m.pitchspeed, m.yawspeed)
    if not _finite(m.roll, m.pitch, m.yaw, *rates) or max(abs(m.roll), abs(m.pitch), abs(m.yaw) / 2) > 2 * pi:
        return None
    return values.Attitude(m.time_boot_ms * 1e-3, m.roll, m.pitch, m.yaw, rates)


def _air(m: Any) -> Any:
    if not _finite(m.airspeed, m.groundspeed, m.alt, m.climb):
        return None
    return values.AirData(m.airspeed, m.groundspeed, m.climb, m.throttle * 0.01, m.alt)


def _wind(m: Any) -> Any:
    if not _finite(m.direction, m.speed, m.speed_z):
        return None
    origin = radians(m.direction)
    return values.Wind(Vec(-m.speed * cos(origin), -m.speed * sin(origin), m.speed_z))


def _wind_cov(m: Any) -> Any:
    vertical = m.wind_z if isfinite(m.wind_z) else 0.0
    return values.Wind(Vec(m.wind_x, m.wind_y, vertical)) if _finite(m.wind_x, m.wind_y) else None


def _sys_status(m: Any) -> Any:
    return values.SysStatus(
        m.battery_remaining * 0.01 if 0 <= m.battery_remaining <= 100 else -1.0,
        m.voltage_battery * 1e-3 if m.voltage_battery not in (0, 65535) else -1.0,
        m.onboard_control_sensors_present & PRE_ARM != 0,
        m.onboard_control_sensors_health & PRE_ARM != 0,
        m.onboard_control_sensors_enabled & ~m.onboard_control_sensors_health,
        m.load * 1e-3,
        m.drop_rate_comm * 1e-4,
    )


def _gps(m: Any) -> Any:
    return values.GpsFix(
        m.fix_type,
        -1 if m.satellites_visible == 255 else m.satellites_visible,
        -1.0 if m.eph == 65535 else m.eph * 0.01,
        m.h_acc * 1e-3 if m.h_acc else -1.0,
    )


ORACLES: dict[str, Callable[[Any], Any]] = {
    "HEARTBEAT": _heartbeat,
    "GLOBAL_POSITION_INT": _position,
    "ATTITUDE": _attitude,
    "VFR_HUD": _air,
    "WIND": _wind,
    "WIND_COV": _wind_cov,
    "SYS_STATUS": _sys_status,
    "GPS_RAW_INT": _gps,
    "EXTENDED_SYS_STATE": lambda m: values.ExtendedState(m.vtol_state, m.landed_state),
    "COMMAND_ACK": lambda m: values.CommandAck(m.command, m.result, m.target_system, m.target_component),
    "TIMESYNC": lambda m: values.Timesync(m.tc1, m.ts1),
}
RATIOS = {
    "EKF_STATUS_REPORT": ("velocity_variance", "pos_horiz_variance", "pos_vert_variance", "compass_variance"),
    "ESTIMATOR_STATUS": ("vel_ratio", "pos_horiz_ratio", "pos_vert_ratio", "mag_ratio"),
}
BY_NAME = {kind.msgname: number for number, kind in dialect.mavlink_map.items()}


@settings(max_examples=600, deadline=None)
@given(
    name=st.sampled_from([*ORACLES, *RATIOS]), payload=payloads, signed=st.booleans(), first=st.booleans(),
    newer=st.binary(max_size=9),
)  # fmt: skip
def test_bytes_say_what_pymavlink_reads_in_them(
    name: str, payload: bytes, signed: bool, first: bool, newer: bytes
) -> None:
    """Zeros cut off, fields that a later dialect adds, MAVLink 1 and 2, signed and not."""
    message = message_of(BY_NAME[name], payload)
    if first:
        signed, frame = False, message.pack(theirs(False), force_mavlink1=True)
    else:
        frame = message.pack(theirs(signed))
    if newer and not first and not signed and len(frame) == 12 + message.unpacker.size:
        longer = bytes((frame[0], frame[1] + len(newer))) + frame[2:-2] + newer
        crc = dialect.x25crc(longer[1:] + bytes([message.crc_extra])).crc
        frame = longer + crc.to_bytes(2, "little")
    (packet,) = Framer(signing=signing(signed)).feed(frame, NOW)
    assert (packet.name, packet.system, packet.component, packet.raw) == (name, 1, 1, frame)
    if name in ORACLES:
        assert packet.value == ORACLES[name](message)
        assert repr(packet.value) == repr(ORACLES[name](message))  # also the sign of a zero
    else:
        assert isinstance(packet.value, values.EkfStatus)
        ratios = [abs(getattr(message, field)) for field in RATIOS[name]]
        worst = max((ratio for ratio in ratios if isfinite(ratio)), default=0.0)
        assert (packet.value.flags, packet.value.worst) == (message.flags, worst)


def test_a_place_that_is_not_finite_never_leaves() -> None:
    with pytest.raises(AssertionError):
        Sender(1, 191).pack(commands.PlaceTarget(Target(1, 1), 0.0, nan, 0.0, 0.0))
    with pytest.raises(AssertionError):
        Sender(1, 191).pack(commands.VelocityTarget(Target(1, 1), 0.0, Vec(nan, 0.0, 0.0), None))
