"""Values in SI and NED: units, senses, and what is refused."""

from __future__ import annotations

from math import asin, degrees, inf, nan, pi, radians

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.vectors import Vec
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, dialect, dialect_packet
from onboard.wire.mavlink.frames import Framer, Sender
from onboard.wire.mavlink.modes import Kind, custom_mode, kind_of, mode_name
from onboard.wire.mavlink.telemetry import decode
from onboard.wire.mavlink.values import (
    AdsbVehicle,
    EkfStatus,
    GlobalPosition,
    ParamValue,
    SysStatus,
    Value,
    Wind,
)


def over_the_wire(message: MavMessage) -> Value | None:
    """The value of a message that an autopilot sends."""
    (packet,) = Framer().feed(DialectSender(1, 1).pack(message))
    return packet.value


def received(message: commands.Outgoing) -> MavMessage:
    """The dialect's message of what an autopilot receives."""
    (packet,) = Framer().feed(Sender(1, 191).pack(message))
    return dialect_packet(packet.raw).message


@settings(max_examples=100, deadline=None)
@given(origin=st.floats(-180, 360), speed=st.floats(0, 40))
def test_both_autopilots_winds_say_where_the_air_moves_to(origin: float, speed: float) -> None:
    """From the west (270°) means the air moves east."""
    ardupilot = over_the_wire(dialect.MAVLink_wind_message(origin, speed, 0.0))
    assert isinstance(ardupilot, Wind)
    north, east = ardupilot.velocity.x, ardupilot.velocity.y
    px4 = over_the_wire(dialect.MAVLink_wind_cov_message(0, north, east, nan, 1, 1, 500.0, nan, nan))
    assert isinstance(px4, Wind)
    assert px4.velocity == pytest.approx(ardupilot.velocity, abs=1e-4)


def test_wind_from_the_west_moves_east() -> None:
    wind = decode(dialect.MAVLink_wind_message(270.0, 8.0, 0.0))
    assert isinstance(wind, Wind)
    assert wind.velocity == pytest.approx((0.0, 8.0, 0.0), abs=1e-9)


def test_position_in_degrees_metres_and_metres_a_second() -> None:
    message = dialect.MAVLink_global_position_int_message(
        61_500, 473_977_000, -85_456_000, 488_020, -1_250, 150, -2_226, 120, 65535
    )
    value = over_the_wire(message)
    assert isinstance(value, GlobalPosition)
    assert value[:5] == pytest.approx((61.5, 47.3977, -8.5456, 488.02, -1.25))
    assert value.velocity == pytest.approx((1.5, -22.26, 1.2))


BAD = [
    dialect.MAVLink_global_position_int_message(0, 910_000_000, 0, 0, 0, 0, 0, 0, 0),
    dialect.MAVLink_global_position_int_message(0, 0, 1_810_000_000, 0, 0, 0, 0, 0, 0),
    dialect.MAVLink_attitude_message(0, -inf, 0.0, 0.0, 0.0, 0.0, 0.0),
    dialect.MAVLink_attitude_message(0, 1e9, 0.0, 0.0, 0.0, 0.0, 0.0),
    dialect.MAVLink_vfr_hud_message(nan, 0.0, 0, 0, 0.0, 0.0),
    dialect.MAVLink_wind_message(0.0, inf, 0.0),
    dialect.MAVLink_wind_cov_message(0, nan, 0.0, 0.0, 0, 0, 0, 0, 0),
    dialect.MAVLink_home_position_message(2**31 - 1, 0, 0, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0),
    dialect.MAVLink_param_value_message(b"X", nan, dialect.MAV_PARAM_TYPE_REAL32, 1, 0),
]


@pytest.mark.parametrize("message", BAD, ids=lambda message: str(message.get_type()))
def test_what_is_not_sound_is_no_value(message: MavMessage) -> None:
    assert over_the_wire(message) is None


def test_pre_arm_health_and_battery() -> None:
    bit = dialect.MAV_SYS_STATUS_PREARM_CHECK
    gyro = dialect.MAV_SYS_STATUS_SENSOR_3D_GYRO
    sent = dialect.MAVLink_sys_status_message(bit | gyro, gyro, bit, 100, 12_281, 0, 84, 0, 0, 0, 0, 0, 0)
    value = decode(sent)
    assert isinstance(value, SysStatus)
    assert (value.battery, value.voltage, value.pre_arm_known, value.pre_arm_ok) == (0.84, 12.281, True, True)
    assert value.unhealthy == gyro
    unknown = decode(dialect.MAVLink_sys_status_message(0, 0, 0, 0, 65535, -1, -1, 0, 0, 0, 0, 0, 0))
    assert isinstance(unknown, SysStatus)
    assert (unknown.battery, unknown.voltage, unknown.pre_arm_known) == (-1.0, -1.0, False)


@pytest.mark.parametrize("number", [-1, 0, 7, -2_000_000, 2**31 - 1])
def test_px4_integer_parameters_come_bytewise_even_where_the_float_is_no_number(number: int) -> None:
    (value,) = dialect.struct.unpack("<f", dialect.struct.pack("<i", number))
    sent = dialect.MAVLink_param_value_message(b"COM_X", value, dialect.MAV_PARAM_TYPE_INT32, 900, 3)
    frame = bytearray(DialectSender(1, 1).pack(sent))
    frame[10:14] = dialect.struct.pack("<i", number)  # Python's own way through a double quiets a NaN
    frame[-2:] = dialect.struct.pack("<H", dialect.x25crc(bytes(frame[1:-2]) + bytes([sent.crc_extra])).crc)
    (packet,) = Framer().feed(bytes(frame))
    parameter = packet.value
    assert isinstance(parameter, ParamValue)
    assert parameter.bytewise == number
    assert parameter.name == "COM_X"


def test_adsb_traffic_for_field_tracks() -> None:
    flags = dialect.ADSB_FLAGS_VALID_COORDS | dialect.ADSB_FLAGS_VALID_ALTITUDE
    flags |= dialect.ADSB_FLAGS_VALID_VELOCITY | dialect.ADSB_FLAGS_VALID_HEADING
    place = (473_000_000, 85_000_000, 1, 900_000)
    motion = (9_000, 5_000, -250)
    sent = dialect.MAVLink_adsb_vehicle_message(0x4B1805, *place, *motion, b"HB-ABC", 1, 2, flags, 7000)
    value = over_the_wire(sent)
    assert isinstance(value, AdsbVehicle)
    assert (value.icao, value.callsign, value.altitude_m, value.age_s) == (0x4B1805, "HB-ABC", 900.0, 2.0)
    assert value.velocity == pytest.approx((0.0, 50.0, 2.5), abs=1e-9)
    assert value.position_valid
    assert value.velocity_valid


GOOD = 1 | 2 | 4 | 16 | 32


@pytest.mark.parametrize(
    ("flags", "worst", "ok"),
    [
        (GOOD, 0.3, True),
        (GOOD, 1.2, False),
        (GOOD & ~16, 0.1, False),  # no absolute position
        (GOOD, nan, True),  # a ratio that is not computed
    ],
)
def test_both_estimators_say_when_they_are_good(flags: int, worst: float, ok: bool) -> None:
    ardupilot = decode(dialect.MAVLink_ekf_status_report_message(flags, 0.1, worst, 0.1, 0.1, 0.0))
    px4 = decode(dialect.MAVLink_estimator_status_message(0, flags, 0.1, worst, 0.1, 0.1, nan, nan, 1.0, 1.0))
    assert isinstance(ardupilot, EkfStatus)
    assert isinstance(px4, EkfStatus)
    assert (ardupilot.ok, px4.ok) == (ok, ok)


def test_px4_at_rest_is_healthy_and_an_ardupilot_that_holds_its_place_is_not() -> None:
    flags = GOOD | 128  # constant position mode: PX4 1.16 sets it whenever it stands still
    ardupilot = decode(dialect.MAVLink_ekf_status_report_message(flags, 0.1, 0.1, 0.1, 0.1, 0.0))
    px4 = decode(dialect.MAVLink_estimator_status_message(0, flags, 0.1, 0.1, 0.1, 0.1, nan, nan, 1.0, 1.0))
    assert isinstance(ardupilot, EkfStatus)
    assert isinstance(px4, EkfStatus)
    assert (ardupilot.ok, px4.ok) == (False, True)


def test_each_estimator_has_faults_of_its_own() -> None:
    for fault in (1024, 32768):  # not initialised; GPS glitch
        report = decode(dialect.MAVLink_ekf_status_report_message(GOOD | fault, 0.1, 0.1, 0.1, 0.1, 0.0))
        assert isinstance(report, EkfStatus)
        assert not report.ok
    for fault in (1024, 2048):  # GPS glitch; bad accelerometers
        ratios = (0.1, 0.1, 0.1, 0.1, 0.1, 0.1)
        status = decode(dialect.MAVLink_estimator_status_message(0, GOOD | fault, *ratios, 1.0, 1.0))
        assert isinstance(status, EkfStatus)
        assert not status.ok


def test_kinds_and_modes() -> None:
    assert kind_of(12, 2) is Kind.PX4_MULTICOPTER
    assert kind_of(12, 1) is Kind.PX4_PLANE
    assert kind_of(12, 22) is Kind.PX4_VTOL
    assert kind_of(3, 13) is Kind.ARDUCOPTER
    assert kind_of(3, 1) is Kind.ARDUPLANE
    assert kind_of(3, 10) is Kind.UNKNOWN  # a rover
    assert kind_of(8, 6) is Kind.UNKNOWN  # a ground station
    assert mode_name(Kind.PX4_MULTICOPTER, 6 << 16) == "OFFBOARD"
    assert mode_name(Kind.PX4_MULTICOPTER, 4 << 16 | 3 << 24) == "HOLD"
    assert mode_name(Kind.ARDUPLANE, 99) == "mode 99"
    assert custom_mode(Kind.ARDUCOPTER, "BRAKE") == 17
    assert custom_mode(Kind.ARDUCOPTER, "OFFBOARD") is None


@settings(max_examples=300, deadline=None)
@given(
    kind=st.sampled_from(sorted(dialect.mavlink_map)),
    payload=st.binary(max_size=255),
)
def test_any_payload_of_any_message_decodes_to_a_finite_value_or_none(kind: int, payload: bytes) -> None:
    body = bytes([len(payload), 0, 0, 5, 1, 1, kind & 255, kind >> 8 & 255, kind >> 16]) + payload
    crc = dialect.x25crc(body + bytes([dialect.mavlink_map[kind].crc_extra])).crc
    for packet in Framer().feed(b"\xfd" + body + crc.to_bytes(2, "little")):
        value = packet.value
        for field in value or ():
            for number in field if isinstance(field, Vec) else (field,):
                assert not isinstance(number, float) or abs(number) < inf


def test_builders_speak_the_wires_units() -> None:
    course = received(commands.change_heading(Target(7), radians(-90.0), 9.8))
    assert (course.command, course.param1, course.param2, course.frame) == (43002, 0.0, 270.0, 0)
    assert course.target_system == 7
    assert received(commands.change_heading(Target(1), 2 * pi - 1e-9, 1)).param2 == 0.0  # 360 is denied
    roll = received(commands.RollTarget(Target(1), 2.0, radians(30.0)))
    assert roll.type_mask == 198
    assert degrees(2 * asin(roll.q[1])) == pytest.approx(30.0, abs=1e-4)
    velocity = received(commands.VelocityTarget(Target(1), 2.0, Vec(1, 2, 3)))
    assert (velocity.type_mask, velocity.coordinate_frame, velocity.time_boot_ms) == (0x0DC7, 1, 2000)
    px4 = received(commands.VelocityTarget(Target(1), 2.0, Vec(1, 2, 3), yaw=1.0))
    assert (px4.type_mask, px4.yaw) == (0x9C7, 1.0)
    hold = received(commands.set_mode(Target(1), 4 << 16 | 3 << 24, px4=True))
    assert (hold.command, hold.param1, hold.param2, hold.param3) == (176, 1.0, 4.0, 3.0)
    guided = received(commands.set_mode(Target(1), 15, px4=False))
    assert (guided.param1, guided.param2) == (1.0, 15.0)
    interval = received(commands.set_message_interval(Target(1), 33, 20.0))
    assert (interval.param1, interval.param2) == (33.0, 50_000.0)
    ours = received(commands.OwnHeartbeat())
    assert (ours.type, ours.autopilot, ours.system_status) == (18, 8, 4)
    lost = received(commands.CommandLong(Target(1), 400, (1.0,), confirmation=3))
    assert (lost.param1, lost.param7, lost.confirmation) == (1.0, 0.0, 3)
    assert received(commands.CommandLong(Target(1), 400, confirmation=1000)).confirmation == 255
