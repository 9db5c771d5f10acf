"""What every personality does alike: whom it hears, what it streams, what it answers, how it fails."""

from __future__ import annotations

import itertools
from math import atan2, degrees, hypot
from struct import pack, unpack

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec, norm, sub
from onboard.game.scenario import WINGED, Kind
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.signing import MemoryStore, Signing
from sim_bridge.vehicle.autopilot.health import Fault
from tests.support.flown_autopilot import EPOCH_NS, ORIGIN, PX4, FlownAutopilot

KINDS = pytest.mark.parametrize("kind", list(Kind), ids=lambda kind: kind.value)
FLYING_MODE = {Kind.PX4: "HOLD", Kind.PX4_PLANE: "HOLD", Kind.ARDUCOPTER: "LOITER", Kind.ARDUPLANE: "LOITER"}
FOLLOWING_MODE = {kind: "OFFBOARD" if kind in PX4 else "GUIDED" for kind in Kind}
GCS = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)


@KINDS
def test_it_starts_in_the_air_armed_and_stays_about_its_place(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    start = flown.position
    flown.forward(30.0)
    assert flown.mode == FLYING_MODE[kind]
    assert flown.last("HEARTBEAT").base_mode & 128
    assert flown.last("EXTENDED_SYS_STATE").landed_state == 2
    radius = {Kind.ARDUPLANE: "WP_LOITER_RAD", Kind.PX4_PLANE: "NAV_LOITER_RAD"}
    reach = 2.2 * flown.autopilot.parameters[radius[kind]] if kind in WINGED else 0.5
    assert norm(sub(flown.position, start)) < reach


@KINDS
def test_the_heartbeat_comes_once_a_second_and_tells_kind_mode_and_arming(kind: Kind) -> None:
    flown = FlownAutopilot(kind, system=7).forward(10.0)
    beats = flown.got("HEARTBEAT")
    assert 10 <= len(beats) <= 12
    assert {b.autopilot for b in beats} == {12 if kind in PX4 else 3}
    assert {b.type for b in beats} == {1 if kind in WINGED else 2}
    assert {b.get_srcSystem() for b in beats} == {7}
    assert {b.get_srcComponent() for b in beats} == {1}
    assert {b.custom_mode for b in beats} == {flown.autopilot.modes[FLYING_MODE[kind]]}


@KINDS
def test_sequence_numbers_are_without_gap(kind: Kind) -> None:
    flown = FlownAutopilot(kind).forward(20.0)
    numbers = [frame[4] for frame in flown.frames]
    assert len(numbers) > 300
    assert all((b - a) % 256 == 1 for a, b in itertools.pairwise(numbers))


@KINDS
def test_what_is_addressed_to_another_is_not_heard(kind: Kind) -> None:
    flown = FlownAutopilot(kind, system=3).forward(1.0)
    heard = len(flown.heard)
    before = flown.mode
    for system, component in ((2, 1), (3, 191), (4, 0), (255, 190)):
        flown.send(dialect.MAVLink_command_long_message(system, component, 400, 0, 0, 21196, 0, 0, 0, 0, 0))
        flown.send(dialect.MAVLink_command_long_message(system, component, 512, 0, 148, 0, 0, 0, 0, 0, 0))
        flown.send(dialect.MAVLink_param_request_list_message(system, component))
    assert len(flown.heard) == heard
    assert flown.autopilot.armed
    assert flown.mode == before
    assert flown.autopilot.counters["for_others"] == 12


@KINDS
def test_a_broadcast_is_heard(kind: Kind) -> None:
    flown = FlownAutopilot(kind, system=3).forward(1.0)
    flown.send(dialect.MAVLink_command_long_message(0, 0, 512, 0, 148, 0, 0, 0, 0, 0, 0))
    assert flown.last("COMMAND_ACK").result == 0
    assert flown.last("AUTOPILOT_VERSION").uid == 3


@KINDS
def test_streams_run_at_the_rate_that_was_asked(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    assert flown.command(511, 32, 50_000) == 0  # LOCAL_POSITION_NED at 20 Hz
    assert flown.command(511, 30, 1e6) == 0  # ATTITUDE at 1 Hz
    assert flown.command(511, 74, -1) == 0  # VFR_HUD off
    since = flown.now_ns + 1
    flown.forward(10.0)
    assert len(flown.got("LOCAL_POSITION_NED", since)) == pytest.approx(200, abs=2)
    assert len(flown.got("ATTITUDE", since)) == pytest.approx(10, abs=1)
    assert flown.got("VFR_HUD", since) == []
    assert flown.command(511, 74, 0) == 0  # the default again
    since = flown.now_ns + 1
    flown.forward(10.0)
    assert len(flown.got("VFR_HUD", since)) == pytest.approx(20, abs=1)
    assert flown.command(510, 32) == 0
    assert flown.last("MESSAGE_INTERVAL").interval_us == 50_000


@KINDS
def test_a_rate_above_the_ticks_is_bounded_by_them(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    assert flown.command(511, 30, 1.0) == 0  # 1 MHz
    since = flown.now_ns + 1
    flown.forward(1.0)
    assert len(flown.got("ATTITUDE", since)) <= 50


@KINDS
@pytest.mark.parametrize("number", [0.5 - 1, 9999.0, float("nan"), float("inf"), -3.0])
def test_a_message_that_it_does_not_have_is_refused(kind: Kind, number: float) -> None:
    flown = FlownAutopilot(kind)
    assert flown.command(512, number) != 0
    assert flown.command(511, number, 50_000) != 0


@KINDS
def test_data_streams_as_ground_stations_of_old_ask_for_them(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    flown.send(dialect.MAVLink_request_data_stream_message(1, 1, 6, 10, 1))  # POSITION
    since = flown.now_ns + 1
    flown.forward(5.0)
    assert len(flown.got("GLOBAL_POSITION_INT", since)) == pytest.approx(50, abs=1)
    flown.send(dialect.MAVLink_request_data_stream_message(1, 1, 6, 10, 0))
    since = flown.now_ns + 1
    flown.forward(2.0)
    assert flown.got("GLOBAL_POSITION_INT", since) == []


@KINDS
def test_everything_a_ground_station_needs_to_list_a_vehicle_is_streamed(kind: Kind) -> None:
    names = {m.get_type() for _, m in FlownAutopilot(kind).forward(3.0).heard}
    assert names >= {
        "HEARTBEAT",
        "SYS_STATUS",
        "GPS_RAW_INT",
        "GLOBAL_POSITION_INT",
        "LOCAL_POSITION_NED",
        "ATTITUDE",
        "VFR_HUD",
        "EXTENDED_SYS_STATE",
        "BATTERY_STATUS",
        "SYSTEM_TIME",
        *(("WIND_COV", "ESTIMATOR_STATUS", "ALTITUDE") if kind in PX4 else ("WIND", "EKF_STATUS_REPORT")),
    }


@KINDS
def test_position_is_reported_in_its_own_frame_and_geodetically_alike(kind: Kind) -> None:
    flown = FlownAutopilot(kind, system=5).forward(4.0)
    local, world = flown.last("LOCAL_POSITION_NED"), flown.last("GLOBAL_POSITION_INT")
    flown.send(dialect.MAVLink_command_long_message(5, 1, 512, 0, 49, 0, 0, 0, 0, 0, 0))
    origin = flown.last("GPS_GLOBAL_ORIGIN")
    at = next(t for t, m in flown.heard if m is world)
    assert next(t for t, m in flown.heard if m is local) == at
    game = ORIGIN.ned_from_geodetic(world.lat * 1e-7, world.lon * 1e-7, world.alt * 1e-3)
    # The motion of that instant lies within a tick's way of the present one.
    assert norm(sub(game, flown.position)) < 22.0 * (flown.now_ns - at) / NS_PER_S + 0.5
    own = type(ORIGIN)(origin.latitude * 1e-7, origin.longitude * 1e-7, origin.altitude * 1e-3)
    seen = own.ned_from_geodetic(world.lat * 1e-7, world.lon * 1e-7, world.alt * 1e-3)
    assert norm(sub(seen, Vec(local.x, local.y, local.z))) < 0.05
    assert norm(sub(Vec(local.x, local.y, local.z), game)) > 5.0  # the two origins differ


@KINDS
def test_version_and_home_are_told(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    assert flown.command(520, 1) == 0
    assert flown.got("AUTOPILOT_VERSION")
    assert flown.command(512, 148) == 0
    assert flown.last("AUTOPILOT_VERSION").flight_sw_version >> 24 == (1 if kind in PX4 else 4)
    assert flown.command(512, 242) == 0
    assert flown.command(410) == 0
    home = flown.last("HOME_POSITION")
    assert (home.latitude, home.longitude, home.altitude) == (473977420, 85455940, 488000)
    assert flown.command(179, 1) == 0
    assert flown.last("HOME_POSITION").altitude == pytest.approx(488000 + 1000 * flown.height, abs=500)
    assert flown.command_int(179, x=1_000_000_000, y=0, z=5.0) == 2  # no such latitude


@KINDS
def test_an_unknown_command_is_unsupported(kind: Kind) -> None:
    assert FlownAutopilot(kind).command(31_000) == 3


@KINDS
def test_the_parameter_list_is_whole_and_numbered(kind: Kind) -> None:
    flown = FlownAutopilot(kind, system=9)
    flown.send(GCS, DialectSender(255, 190))  # PX4 sends its texts to ground stations only
    flown.send(dialect.MAVLink_param_request_list_message(9, 1))
    flown.forward(5.0)
    values = flown.got("PARAM_VALUE")
    assert [v.param_index for v in values] == list(range(values[0].param_count))
    assert len({v.param_id for v in values}) == len(values) >= 30
    assert flown.texts()[0].startswith("PX4" if kind in PX4 else "Ardu")
    name = "MAV_SYS_ID" if kind in PX4 else "SYSID_THISMAV"
    [own] = [v for v in values if v.param_id == name]
    value = unpack("<i", pack("<f", own.param_value))[0] if kind in PX4 else own.param_value
    assert value == 9


@KINDS
def test_a_parameter_is_read_by_name_and_number_and_written(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    name, number = ("NAV_DLL_ACT", 6) if kind in PX4 else ("SYSID_MYGCS", 4)
    flown.send(dialect.MAVLink_param_request_read_message(1, 1, name.encode(), -1))
    value = flown.last("PARAM_VALUE")
    assert value.param_id == name
    flown.send(dialect.MAVLink_param_request_read_message(1, 1, b"", value.param_index))
    assert flown.last("PARAM_VALUE").param_id == name
    coded = unpack("<f", pack("<i", 2))[0] if kind in PX4 else 2.0
    flown.send(dialect.MAVLink_param_set_message(1, 1, name.encode(), coded, number))
    assert flown.last("PARAM_VALUE").param_value == coded
    assert flown.autopilot.parameters[name] == 2.0
    heard = len(flown.heard)
    for unknown in (b"NO_SUCH", b""):
        flown.send(dialect.MAVLink_param_set_message(1, 1, unknown, 1.0, 9))
        flown.send(dialect.MAVLink_param_request_read_message(1, 1, unknown, -1))
    flown.send(dialect.MAVLink_param_request_read_message(1, 1, b"", 9999))
    assert len(flown.heard) == heard


@KINDS
@settings(max_examples=30, deadline=None)
@given(value=st.floats(width=32))
def test_no_value_written_breaks_a_parameter(kind: Kind, value: float) -> None:
    flown = FlownAutopilot(kind)
    for name in ("COM_OF_LOSS_T", "NAV_DLL_ACT") if kind in PX4 else ("SYSID_MYGCS", "BATT_LOW_VOLT"):
        flown.send(dialect.MAVLink_param_set_message(1, 1, name.encode(), value, 9))
        assert flown.last("PARAM_VALUE").param_id == name
    flown.forward(0.2)


@KINDS
def test_missions_are_empty_and_files_refused(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    flown.send(dialect.MAVLink_mission_request_list_message(1, 1, 0))
    count = flown.last("MISSION_COUNT")
    assert (count.count, count.target_system, count.target_component) == (0, 1, 191)
    flown.send(dialect.MAVLink_mission_count_message(1, 1, 5, 0))
    assert flown.last("MISSION_ACK").type != 0
    flown.send(dialect.MAVLink_mission_request_int_message(1, 1, 0, 0))
    assert flown.last("MISSION_ACK").type == 13
    request = pack("<HBBBBBBI", 41, 0, 4, 5, 0, 0, 0, 0) + b"@MISS"
    flown.send(dialect.MAVLink_file_transfer_protocol_message(0, 1, 1, request.ljust(251, b"\0")))
    sequence, _, opcode, _, asked, *_ = unpack(
        "<HBBBBBBI", bytes(flown.last("FILE_TRANSFER_PROTOCOL").payload[:12])
    )
    assert (sequence, opcode, asked) == (42, 129, 4)


@KINDS
def test_time_is_told(kind: Kind) -> None:
    flown = FlownAutopilot(kind).forward(12.0)
    flown.send(dialect.MAVLink_timesync_message(0, 777))
    answer = flown.last("TIMESYNC")
    assert (answer.tc1, answer.ts1) == (12 * NS_PER_S, 777)
    heard = len(flown.heard)
    flown.send(dialect.MAVLink_timesync_message(1, 777))  # somebody's answer: nothing to say
    assert len(flown.heard) == heard
    clock = flown.last("SYSTEM_TIME")
    assert clock.time_unix_usec == EPOCH_NS // 1000 + clock.time_boot_ms * 1000


@KINDS
def test_the_wind_is_told_as_this_kind_tells_it(kind: Kind) -> None:
    flown = FlownAutopilot(kind, wind=Vec(3.0, -4.0, 0.0)).forward(2.0)
    if kind in PX4:
        told = flown.last("WIND_COV")
        assert (told.wind_x, told.wind_y) == (3.0, -4.0)
    else:
        told = flown.last("WIND")
        assert told.speed == pytest.approx(5.0)
        assert told.direction == pytest.approx(degrees(atan2(4.0, -3.0)))  # where it comes from


@KINDS
def test_the_battery_drains_in_flight_and_can_be_emptied(kind: Kind) -> None:
    flown = FlownAutopilot(kind, battery_s=100.0).forward(50.0)
    assert flown.last("SYS_STATUS").battery_remaining == pytest.approx(50, abs=2)
    assert flown.last("BATTERY_STATUS").battery_remaining == pytest.approx(50, abs=4)
    voltage = flown.last("SYS_STATUS").voltage_battery
    flown.autopilot.set_battery(0.1)
    flown.forward(2.0)
    assert flown.last("SYS_STATUS").battery_remaining == pytest.approx(9, abs=2)
    assert flown.last("SYS_STATUS").voltage_battery < voltage


@KINDS
def test_without_satellites_there_is_no_position_and_it_recovers(kind: Kind) -> None:
    flown = FlownAutopilot(kind).forward(2.0)
    flown.autopilot.fail(Fault.GPS)
    since = flown.now_ns + 1
    flown.forward(7.0)
    assert flown.got("GLOBAL_POSITION_INT", since) == [] == flown.got("LOCAL_POSITION_NED", since)
    assert flown.last("GPS_RAW_INT").fix_type == 1
    recorded = {Kind.ARDUPLANE: 4}  # plane-agent2-restart-gpsloss-abort: a plane reckons on
    assert flown.last("HEARTBEAT").system_status == recorded.get(kind, 5)
    report = flown.last("ESTIMATOR_STATUS" if kind in PX4 else "EKF_STATUS_REPORT")
    assert not report.flags & 16
    assert report.flags & 1
    assert not flown.last("SYS_STATUS").onboard_control_sensors_health & 32
    if kind != Kind.ARDUPLANE:
        assert flown.mode == "LAND"
    flown.autopilot.fail(Fault.GPS, failed=False)
    flown.forward(2.0)
    assert flown.last("GPS_RAW_INT").fix_type == 3
    assert flown.last("EKF_STATUS_REPORT" if kind not in PX4 else "ESTIMATOR_STATUS").flags & 16


@KINDS
def test_an_estimator_fault_is_not_the_satellites(kind: Kind) -> None:
    flown = FlownAutopilot(kind).forward(2.0)
    flown.autopilot.fail(Fault.EKF)
    flown.forward(3.0)
    assert flown.last("GPS_RAW_INT").fix_type == 3
    assert not flown.last("EKF_STATUS_REPORT" if kind not in PX4 else "ESTIMATOR_STATUS").flags & 16


@KINDS
def test_a_reboot_in_flight_restarts_sequence_and_boot_time(kind: Kind) -> None:
    flown = FlownAutopilot(kind).forward(20.0)
    assert flown.last("ATTITUDE").time_boot_ms > 19_000
    flown.command(511, 30, 20_000)
    flown.autopilot.reboot(flown.now_ns)
    rebooted, count = flown.now_ns, len(flown.frames)
    flown.forward(2.0)
    assert flown.frames[count][4] == 0
    assert 1900 < flown.last("ATTITUDE").time_boot_ms <= 2000
    assert flown.autopilot.armed
    assert flown.mode == FLYING_MODE[kind]
    assert len(flown.got("ATTITUDE", rebooted)) < 15  # the rates are its defaults again
    assert norm(flown.velocity) < 23.0


@KINDS
def test_a_second_ground_station_changes_nothing(kind: Kind) -> None:
    alone, watched = FlownAutopilot(kind), FlownAutopilot(kind, client=(254, 190))
    alone.forward(20.0)
    watched.forward(20.0, every_s=1.0, send=lambda: GCS)
    assert watched.frames == alone.frames
    assert watched.position == alone.position


@KINDS
def test_its_own_frames_coming_back_are_not_obeyed(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    disarm = dialect.MAVLink_command_long_message(0, 0, 400, 0, 0, 21196, 0, 0, 0, 0, 0)
    flown.send(disarm, DialectSender(1, 1))
    assert flown.autopilot.armed
    assert flown.autopilot.counters["own_echo"] == 1


@KINDS
@settings(max_examples=60, deadline=None)
@given(data=st.binary(max_size=300))
def test_garbage_is_counted_and_never_raises(kind: Kind, data: bytes) -> None:
    flown = FlownAutopilot(kind)
    flown.autopilot.receive(0, data, "stranger")
    heartbeat = flown.client.pack(dialect.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3))
    flown.autopilot.receive(0, heartbeat, "stranger")  # until then a beginning of a frame may go on
    assert not data or sum(flown.autopilot.counters.values()) > 0
    assert flown.command(512, 148) == 0


NUMBERS = st.one_of(
    st.floats(width=32), st.sampled_from([0.0, 1.0, 4.0, 6.0, 15.0, 129.0, 21196.0, float("nan")])
)
COMMANDS = st.sampled_from(
    [16, 17, 20, 21, 22, 176, 178, 179, 192, 246, 400, 410, 510, 511, 512, 520, 43000, 43001, 43002, 0, 65535]
)


@KINDS
@settings(max_examples=80, deadline=None)
@given(
    number=COMMANDS,
    p=st.tuples(*[NUMBERS] * 7),
    x=st.integers(-(2**31), 2**31 - 1),
    y=st.integers(-(2**31), 2**31 - 1),
    frame=st.integers(0, 255),
)
def test_no_command_raises_and_every_one_is_acknowledged(
    kind: Kind, number: int, p: tuple[float, ...], x: int, y: int, frame: int
) -> None:
    flown = FlownAutopilot(kind)
    flown.mode_to(FOLLOWING_MODE[kind])
    assert flown.command(number, *p) in range(9)
    assert flown.command_int(number, p[0], p[1], p[2], p[3], x, y, p[4], frame) in range(9)
    flown.forward(0.2)
    assert all(abs(value) < 1e9 for value in (*flown.position, *flown.velocity))


@KINDS
@settings(max_examples=80, deadline=None)
@given(
    v=st.tuples(NUMBERS, NUMBERS, NUMBERS),
    p=st.tuples(NUMBERS, NUMBERS, NUMBERS),
    mask=st.integers(0, 65535),
    frame=st.integers(0, 255),
)
def test_no_setpoint_raises_or_spoils_the_motion(
    kind: Kind, v: tuple[float, ...], p: tuple[float, ...], mask: int, frame: int
) -> None:
    flown = FlownAutopilot(kind)
    if kind in PX4:
        flown.forward(1.2, every_s=0.1, send=lambda: flown.velocity_target(Vec(0.0, 0.0, 0.0)))
    assert flown.mode_to(FOLLOWING_MODE[kind]) == 0
    flown.send(
        dialect.MAVLink_set_position_target_local_ned_message(0, 1, 1, frame, mask, *p, *v, 0, 0, 0, 0, 0)
    )
    flown.send(
        dialect.MAVLink_set_position_target_global_int_message(
            0, 1, 1, frame, mask, 473_977_420, 85_455_940, p[2], *v, 0, 0, 0, 0, 0
        )
    )
    flown.send(dialect.MAVLink_set_attitude_target_message(0, 1, 1, mask & 255, [*v, p[0]], 0, 0, 0, p[1]))
    flown.forward(0.4)
    assert hypot(flown.velocity.x, flown.velocity.y) < 31.0
    assert all(abs(value) < 1e4 for value in flown.position)


@KINDS
def test_with_a_key_it_obeys_signed_frames_alone_and_signs_its_own(kind: Kind) -> None:
    key = bytes(range(32))
    flown = FlownAutopilot(kind, signing=Signing(key, MemoryStore()))
    flown.forward(1.0)
    assert all(frame[2] & 1 for frame in flown.frames)
    request = dialect.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0)
    flown.send(request)
    assert flown.got("COMMAND_ACK") == []
    assert flown.autopilot.counters["signature_unsigned"] == 1
    signed = DialectSender(1, 191, signing=Signing(key, MemoryStore()))
    frame = signed.pack(request, EPOCH_NS + flown.now_ns)
    flown.autopilot.receive(flown.now_ns, frame, "peer")
    flown.forward(0.1)
    assert flown.last("COMMAND_ACK").result == 0
    verifier = Framer(signing=Signing(key, MemoryStore()))
    assert all(verifier.feed(frame, EPOCH_NS + NS_PER_S) for frame in flown.frames[-3:])


@KINDS
def test_the_same_flight_gives_the_same_bytes(kind: Kind) -> None:
    def flight() -> list[bytes]:
        flown = FlownAutopilot(kind, wind=Vec(2.0, -1.0, 0.0))
        flown.forward(1.5, every_s=0.1, send=lambda: flown.velocity_target(Vec(2.0, 1.0, 0.0)))
        flown.mode_to(FOLLOWING_MODE[kind])
        flown.forward(5.0, every_s=0.1, send=lambda: flown.velocity_target(Vec(2.0, 1.0, 0.0)))
        return flown.frames

    assert flight() == flight()


def test_peers_are_bounded_and_one_peers_torn_frame_does_not_harm_another() -> None:
    flown = FlownAutopilot(Kind.ARDUCOPTER)
    frame = flown.client.pack(dialect.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0))
    for number in range(50):
        flown.autopilot.receive(0, frame[:20], ("stranger", number))
        flown.autopilot.receive(0, frame, "peer")
    flown.forward(0.1)
    assert len(flown.got("COMMAND_ACK")) == 50
    counters = flown.autopilot.counters
    assert counters["truncated"] == counters["peers_forgotten"] > 30


def test_a_landed_vehicle_reports_rest() -> None:
    flown = FlownAutopilot(Kind.ARDUCOPTER)
    flown.mode_to("LAND")
    flown.forward(60.0)
    assert flown.autopilot.parked
    told = flown.last("LOCAL_POSITION_NED")
    assert (told.vx, told.vy, told.vz) == (0.0, 0.0, 0.0)


@KINDS
def test_a_ping_is_answered_unless_it_is_somebodys_answer(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    flown.send(dialect.MAVLink_ping_message(123, 7, 0, 0))
    answer = flown.last("PING")
    assert (answer.time_usec, answer.seq, answer.target_system, answer.target_component) == (123, 7, 1, 191)
    flown.send(dialect.MAVLink_ping_message(123, 7, 1, 1))
    assert len(flown.got("PING")) == 1


@KINDS
def test_an_empty_mission_can_be_cleared(kind: Kind) -> None:
    flown = FlownAutopilot(kind)
    flown.send(dialect.MAVLink_mission_clear_all_message(1, 1, 0))
    assert flown.last("MISSION_ACK").type == 0


@KINDS
def test_the_quaternion_is_the_attitude(kind: Kind) -> None:
    flown = FlownAutopilot(kind).forward(6.0)
    assert flown.command(512, 31) == 0
    assert flown.command(512, 30) == 0
    q, a = flown.last("ATTITUDE_QUATERNION"), flown.last("ATTITUDE")
    w, x, y, z = q.q1, q.q2, q.q3, q.q4
    assert atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) == pytest.approx(a.roll, abs=1e-5)
    assert atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) == pytest.approx(a.yaw, abs=1e-5)


def test_the_speed_of_what_they_fly_by_themselves_can_be_changed() -> None:
    for kind in (Kind.PX4, Kind.ARDUCOPTER):
        flown = FlownAutopilot(kind)
        assert flown.command(178, 1, 2.0, -1) == 0
        assert flown.command(178, 1, -5.0, -1) != 0
        place = ORIGIN.geodetic_from_ned(Vec(200.0, 0.0, 0.0))
        x, y = round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7)
        assert flown.command_int(192, -1, 1, 0, 0, x, y, 488.0 + 50.0, 0) == 0
        flown.forward(10.0)
        assert norm(flown.velocity) == pytest.approx(2.0, abs=0.01)
    plane = FlownAutopilot(Kind.ARDUPLANE)
    assert plane.command(178, 0, 26.0, -1) == 0
    assert plane.command(178, 0, 99.0, -1) == 4
    plane.forward(5.0)
    assert plane.airframe.motion.airspeed == pytest.approx(26.0)


def test_a_plane_disarmed_by_force_glides_down() -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE).forward(1.0)
    assert flown.command(400, 0, 21196) == 0
    flown.forward(10.0)
    assert flown.height < 70.0
    assert flown.airframe.motion.airspeed == pytest.approx(10.0)
