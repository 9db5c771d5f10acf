"""What is around an autopilot: a transmitter or none, late answers, neighbours, generations of firmware."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from onboard.core.math.vectors import ZERO, Vec
from onboard.game.scenario import Firmware, Kind
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.flown_autopilot import FlownAutopilot

GCS = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
NOBODY: tuple[float | None, ...] = (None, 0.0)  # no transmitter; one as software in the loop has it


def copter(**more: Any) -> FlownAutopilot:
    return FlownAutopilot(Kind.ARDUCOPTER, **more)


@pytest.mark.parametrize("throttle", NOBODY)
@pytest.mark.parametrize("mode", ["LOITER", "ALT_HOLD", "POSHOLD"])
def test_modes_flown_by_stick_sink_a_copter_that_has_none(mode: str, throttle: float | None) -> None:
    flown = copter(throttle=throttle)
    assert flown.mode == "BRAKE"  # where nobody flies it, it cannot begin in LOITER
    assert flown.mode_to(mode) == 0
    flown.forward(2.0)
    height = flown.height
    assert height - flown.forward(10.0).height == pytest.approx(24.5, abs=0.6)  # 39.4 m in 16.5 s
    flown.forward(20.0, until=lambda: flown.autopilot.landed)
    assert flown.autopilot.armed
    assert not flown.forward(10.5).autopilot.armed  # DISARM_DELAY


def test_brake_holds_without_a_stick_and_loiter_with_one() -> None:
    for throttle, mode in ((None, "BRAKE"), (0.0, "BRAKE"), (0.5, "LOITER"), (0.55, "LOITER")):
        flown = copter(throttle=throttle)
        assert flown.mode_to(mode) == 0
        height = flown.height
        assert abs(flown.forward(20.0).height - height) < 0.1


def test_the_stick_climbs_and_its_loss_sinks() -> None:
    flown = copter()
    flown.autopilot.set_throttle(flown.now_ns, 1.0)
    assert flown.forward(5.0).velocity.z == pytest.approx(-2.5)
    flown.autopilot.set_throttle(flown.now_ns, 0.5)
    height = flown.forward(2.0).height
    assert flown.forward(5.0).height == pytest.approx(height, abs=0.1)
    flown.autopilot.set_throttle(flown.now_ns, None)
    assert flown.forward(3.0).velocity.z == pytest.approx(2.5)


@pytest.mark.parametrize(("throttle", "count", "pwm"), [(None, 0, 0), (0.0, 16, 1000), (0.5, 16, 1500)])
def test_rc_channels_tell_the_stick(throttle: float | None, count: int, pwm: int) -> None:
    told = copter(throttle=throttle).forward(1.0).last("RC_CHANNELS")
    assert (told.chancount, told.chan3_raw, told.rssi) == (count, pwm, 255)
    if throttle is None:
        assert FlownAutopilot(Kind.PX4, throttle=None).forward(3.0).got("RC_CHANNELS") == []


def beats(flown: FlownAutopilot, seconds: int, sender: tuple[int, int]) -> FlownAutopilot:
    beat = DialectSender(*sender)
    for _ in range(seconds):
        flown.send(GCS, beat)
        flown.forward(1.0)
    return flown


def test_the_ground_stations_silence_disarms_a_copter_on_the_ground_and_keeps_it_from_arming() -> None:
    flown = copter(airborne=False, ready_s=0.0, parameters={"FS_GCS_ENABLE": 1, "DISARM_DELAY": 0})
    beats(flown, 2, (255, 190))
    assert flown.command(400, 1) == 0
    beats(flown, 2, (255, 190)).forward(4.5)
    assert not flown.autopilot.armed
    assert "GCS Failsafe - Disarming" in flown.texts()
    assert flown.last("HEARTBEAT").system_status == 5
    assert flown.command(400, 1) == 4
    assert flown.texts()[-1] == "Arm: GCS failsafe on"
    flown.forward(31.0)
    assert "PreArm: GCS failsafe on" in flown.texts()
    beats(flown, 1, (255, 190))
    assert "GCS Failsafe Cleared" in flown.texts()
    assert flown.command(400, 1) == 0


@pytest.mark.parametrize(("options", "mode"), [(16, "BRAKE"), (0, "RTL")])
def test_brake_is_a_pilots_mode_to_the_ground_stations_failsafe(options: int, mode: str) -> None:
    flown = copter(throttle=None, parameters={"FS_GCS_ENABLE": 1, "FS_OPTIONS": options})
    beats(flown, 2, (255, 190)).forward(6.0)
    assert flown.mode == mode
    assert ("GCS Failsafe - Continuing Pilot Control" in flown.texts()) == (mode == "BRAKE")


def test_a_gimbal_of_the_own_system_keeps_the_failsafe_quiet() -> None:
    watch = {"FS_GCS_ENABLE": 1, "SYSID_MYGCS": 1}
    for gimbal, mode in ((False, "RTL"), (True, "GUIDED")):
        flown = copter(parameters=watch, gimbal=gimbal)
        flown.mode_to("GUIDED")
        beats(flown, 3, (1, 191)).forward(30.0)  # the agent has been killed
        assert flown.mode == mode


def test_a_plane_counts_the_silence_from_boot_and_says_so_by_its_status() -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE, parameters={"FS_GCS_ENABL": 1, "FS_LONG_ACTN": 1})
    assert flown.forward(7.0).mode == "RTL"
    assert flown.last("HEARTBEAT").system_status == 5
    beats(flown, 2, (255, 190))
    assert flown.texts()[-1] == "GCS Failsafe Off"
    assert flown.last("HEARTBEAT").system_status == 4


def test_late_answers_cross_one_another() -> None:
    flown = copter(answer_delay_s=(0.4, 3.0), generator=np.random.default_rng(4))
    names = ["GUIDED", "LOITER"] * 6
    for name in names:
        number = flown.autopilot.modes[name]
        flown.send(dialect.MAVLink_command_long_message(1, 1, 176, 0, 1, number, 0, 0, 0, 0, 0))
        flown.forward(0.1)
    assert len(flown.got("COMMAND_ACK")) < 6
    flown.forward(3.0)
    assert [ack.result for ack in flown.got("COMMAND_ACK")] == [0] * 12
    order = [m.custom_mode for m in flown.got("HEARTBEAT")]
    changes = [b for a, b in pairwise(order) if b != a]
    assert changes != [4, 5] * 6  # not in the order in which they were asked


def test_another_stations_request_overrides_ours_again_and_again() -> None:
    flown = copter(other_station_hz=4.0)
    for _ in range(2):
        assert flown.command(511, 33, 50_000) == 0
        since = flown.now_ns
        flown.forward(11.0)
        assert 4.0 <= len(flown.got("GLOBAL_POSITION_INT", since + 6_000_000_000)) / 5.0 <= 4.5
    assert any(m.get_srcSystem() == 254 for m in flown.got("HEARTBEAT"))


def test_the_second_battery_feeds_a_payload() -> None:
    flown = copter(batteries=2)
    flown.autopilot.health.payload = 0.1
    flown.forward(5.0)
    told = {(m.id, m.battery_function): m.battery_remaining for m in flown.got("BATTERY_STATUS")}
    assert told == {(0, 1): 100, (1, 4): 10}
    assert flown.last("SYS_STATUS").battery_remaining == 100


@pytest.mark.parametrize(
    ("low", "critical", "mode"),
    [(0, 0, "GUIDED"), (1, 0, "LAND"), (2, 0, "RTL"), (7, 0, "BRAKE"), (0, 1, "GUIDED"), (2, 1, "RTL")],
)
def test_a_voltage_that_sags_acts_after_its_timer(low: int, critical: int, mode: str) -> None:
    more = {"BATT_FS_LOW_ACT": low, "BATT_FS_CRT_ACT": critical, "BATT_LOW_VOLT": 10.5, "BATT_CRT_VOLT": 9.0}
    flown = copter(parameters=more)
    flown.mode_to("GUIDED")
    flown.autopilot.set_voltage(9.6)
    assert flown.forward(9.5).mode == "GUIDED"
    assert flown.forward(1.0).mode == mode
    flown.autopilot.set_voltage(8.8)
    assert flown.forward(11.0).mode == ("LAND" if critical else mode)


@pytest.mark.parametrize(
    ("kind", "set_up", "mode"),
    [
        (Kind.ARDUCOPTER, {"FS_THR_ENABLE": 1}, "RTL"),
        (Kind.ARDUCOPTER, {"FS_THR_ENABLE": 1, "FS_OPTIONS": 20}, "GUIDED"),
        (Kind.ARDUCOPTER, {"FS_THR_ENABLE": 3}, "LAND"),
        (Kind.ARDUCOPTER, {"FS_THR_ENABLE": 0}, "GUIDED"),
        (Kind.ARDUPLANE, {"FS_LONG_ACTN": 1}, "RTL"),
        (Kind.ARDUPLANE, {"FS_LONG_ACTN": 0}, "GUIDED"),
        (Kind.PX4, {"NAV_RCL_ACT": 2, "COM_RCL_EXCEPT": 0}, "RTL"),
        (Kind.PX4, {"NAV_RCL_ACT": 2, "COM_RCL_EXCEPT": 4}, "OFFBOARD"),
    ],
)
def test_the_loss_of_the_transmitter(kind: Kind, set_up: dict[str, float], mode: str) -> None:
    flown = FlownAutopilot(kind, parameters=set_up)
    if kind is Kind.PX4:
        flown.send(flown.velocity_target(ZERO))
    flown.mode_to("OFFBOARD" if kind is Kind.PX4 else "GUIDED")
    flown.autopilot.set_throttle(flown.now_ns, None)
    going = {"every_s": 0.05, "send": lambda: flown.velocity_target(ZERO)} if kind is Kind.PX4 else {}
    assert flown.forward(8.0, **going).mode == mode


def test_a_transmitter_that_never_was_there_is_not_lost() -> None:
    flown = copter(throttle=None, parameters={"FS_THR_ENABLE": 1})
    assert flown.forward(10.0).mode == "BRAKE"


def test_the_fence_brings_a_copter_home() -> None:
    flown = copter(parameters={"FENCE_ENABLE": 1, "FENCE_RADIUS": 20})
    flown.mode_to("GUIDED")
    flown.forward(8.0, every_s=0.1, send=lambda: flown.velocity_target(Vec(4.0, 0.0, 0.0)))
    assert flown.mode == "RTL"
    assert "Fence Breached" in flown.texts()


@pytest.mark.parametrize(
    ("kind", "firmware", "name", "recorded", "value"),
    [
        (Kind.ARDUCOPTER, Firmware.NEWER, "WP_SPD", "WPNAV_SPEED", 10.0),
        (Kind.ARDUCOPTER, Firmware.NEWER, "ATC_ANGLE_MAX", "ANGLE_MAX", 30.0),
        (Kind.ARDUCOPTER, Firmware.NEWER, "RTL_ALT_M", "RTL_ALT", 15.0),
        (Kind.ARDUPLANE, Firmware.NEWER, "MAV_GCS_SYSID", "SYSID_MYGCS", 255.0),
        (Kind.ARDUPLANE, Firmware.OLDER, "ARSPD_FBW_MIN", "AIRSPEED_MIN", 10.0),
        (Kind.ARDUPLANE, Firmware.OLDER, "ALT_HOLD_RTL", "RTL_ALTITUDE", 10_000.0),
    ],
)
def test_each_generation_has_its_names_and_units(
    kind: Kind, firmware: Firmware, name: str, recorded: str, value: float
) -> None:
    flown = FlownAutopilot(kind, firmware=firmware)
    flown.send(dialect.MAVLink_param_request_read_message(1, 1, name.encode(), -1))
    assert flown.last("PARAM_VALUE").param_value == pytest.approx(value)
    flown.send(dialect.MAVLink_param_request_read_message(1, 1, recorded.encode(), -1))
    assert len(flown.got("PARAM_VALUE")) == 1  # of the other generation: no answer
    written = FlownAutopilot(kind, firmware=firmware, parameters={name: 2 * value})
    plain = FlownAutopilot(
        kind, firmware=firmware, parameters={recorded: 2.0 * flown.autopilot.parameters[recorded]}
    )
    assert written.autopilot.parameters[recorded] == pytest.approx(plain.autopilot.parameters[recorded])


def test_from_4_7_on_a_range_of_ground_stations_is_watched() -> None:
    range_of = {"FS_GCS_ENABLE": 1, "MAV_GCS_SYSID": 250, "MAV_GCS_SYSID_HI": 253}
    for sender, mode in ((252, "RTL"), (254, "GUIDED")):
        flown = copter(firmware=Firmware.NEWER, parameters=range_of)
        flown.mode_to("GUIDED")
        assert beats(flown, 2, (sender, 190)).forward(7.0).mode == mode


@pytest.mark.parametrize("number", [410, 520])
def test_px4_1_18_knows_the_removed_commands_no_more(number: int) -> None:
    assert FlownAutopilot(Kind.PX4).command(number) == 0
    assert FlownAutopilot(Kind.PX4, firmware=Firmware.NEWER).command(number) == 3


def test_a_guided_point_comes_as_a_mission_item_with_current_2() -> None:
    for kind in (Kind.ARDUCOPTER, Kind.ARDUPLANE, Kind.PX4):
        flown = FlownAutopilot(kind)
        place = flown.autopilot.setup.frame.geodetic_from_ned(Vec(60.0, 0.0, -60.0))
        x, y = round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7)
        item = dialect.MAVLink_mission_item_int_message(1, 1, 0, 6, 16, 2, 0, 0, 0, 0, 0, x, y, 60.0)
        flown.send(item)
        assert flown.last("MISSION_ACK").type == 1  # not in GUIDED
        if kind is Kind.PX4:
            continue
        flown.mode_to("GUIDED")
        flown.send(item)
        assert flown.last("MISSION_ACK").type == 0
        flown.forward(60.0)
        assert flown.height == pytest.approx(60.0, abs=1.5)
        if kind is Kind.ARDUCOPTER:
            flown.assert_near(Vec(60.0, 0.0, -60.0), 1.0)


def test_a_mode_can_be_blocked_for_ground_stations() -> None:
    flown = copter(parameters={"FLTMODE_GCSBLOCK": 1 << 12})
    assert flown.mode_to("BRAKE") == 4
    assert "".join(flown.texts()[-2:]) == "Mode change to BRAKE failed: GCS entry disabled (FLTMODE_GCSBLOCK)"
    assert flown.mode_to("RTL") == 0


def test_px4_takes_off_where_it_is_told_and_never_to_a_place_that_was_left_out() -> None:
    nan = float("nan")
    for x, y, climbs in ((nan, nan, True), (0.0, 0.0, False)):
        flown = FlownAutopilot(Kind.PX4, airborne=False, ready_s=0.0).forward(1.0)
        assert flown.command(400, 1) == 0
        assert flown.command(22, 0, 0, 0, nan, x, y, 488.0 + 20.0) == 0
        flown.forward(9.0)
        assert (flown.height > 10.0) == climbs
        assert flown.forward(2.0).autopilot.armed == climbs
    flown = FlownAutopilot(Kind.PX4)  # in the air it is accepted too, and flies there
    place = flown.autopilot.setup.frame.geodetic_from_ned(Vec(20.0, 10.0, 0.0))
    assert flown.command(22, 0, 0, 0, nan, place.latitude_deg, place.longitude_deg, 488.0 + 40.0) == 0
    flown.forward(30.0)
    flown.assert_near(Vec(20.0, 10.0, -40.0), 1.5)
    assert flown.mode == "HOLD"


def test_px4_fills_a_link_with_its_default_streams_until_they_are_switched_off() -> None:
    flown = FlownAutopilot(Kind.PX4, full_streams=True).forward(1.0)
    before = len(flown.frames)
    flown.forward(10.0)
    rate = sum(len(frame) for frame in flown.frames[before:]) / 10.0
    assert rate == pytest.approx(22_000, rel=0.2)  # 22 kB/s
    for number in (30, 31, 105, 331, 83, 85, 36, 141, 74):
        assert flown.command(511, number, -1) == 0
    before = len(flown.frames)
    flown.forward(10.0)
    assert sum(len(frame) for frame in flown.frames[before:]) / 10.0 < 6_000


def test_px4_at_rest_says_constant_position_and_is_healthy() -> None:
    flown = FlownAutopilot(Kind.PX4, airborne=False, ready_s=0.0).forward(2.0)
    assert flown.last("ESTIMATOR_STATUS").flags & 128
    assert flown.last("ESTIMATOR_STATUS").flags & 16
    assert not FlownAutopilot(Kind.PX4).forward(2.0).last("ESTIMATOR_STATUS").flags & 128
