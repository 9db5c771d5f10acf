"""ArduPlane in GUIDED: course, altitude, airspeed, roll, places; and what it does not take."""

from __future__ import annotations

from math import atan2, degrees, hypot, pi

import pytest

from onboard.core.math.angles import wrap
from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import ZERO, Vec, norm
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.flown_autopilot import ORIGIN, FlownAutopilot

GCS = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)


def guided(**more: object) -> FlownAutopilot:
    flown = FlownAutopilot(Kind.ARDUPLANE, **more)  # type: ignore[arg-type]
    assert flown.mode_to("GUIDED") == 0
    return flown


def course(flown: FlownAutopilot) -> float:
    return degrees(atan2(flown.velocity.y, flown.velocity.x)) % 360.0


def speed(flown: FlownAutopilot) -> float:
    return flown.airframe.motion.airspeed


def test_it_follows_a_course_over_ground_in_wind() -> None:
    flown = guided(wind=Vec(0.0, 6.0, 0.0))
    assert flown.command_int(43002, 0, 315.0, 9.8) == 0
    flown.forward(15.0)
    assert course(flown) == pytest.approx(315.0, abs=0.5)


def test_it_follows_a_heading_and_drifts() -> None:
    flown = guided(wind=Vec(0.0, 6.0, 0.0))
    assert flown.command_int(43002, 1, 0.0, 9.8) == 0
    flown.forward(15.0)
    assert abs(wrap(flown.airframe.motion.yaw)) < 0.01
    assert course(flown) == pytest.approx(degrees(atan2(6.0, 22.0)), abs=0.5)


@pytest.mark.parametrize("p", [(0, 360.0), (0, -1.0), (0, float("nan")), (2, 90.0)])
def test_a_heading_that_is_none_is_denied(p: tuple[float, float]) -> None:
    assert guided().command_int(43002, *p, 9.8) == 2


def test_a_heading_has_no_timeout() -> None:
    flown = guided()
    flown.command_int(43002, 0, 90.0, 9.8)
    flown.forward(120.0)
    assert course(flown) == pytest.approx(90.0, abs=0.5)
    assert flown.position.y > 2000.0


def test_altitude_above_home_and_above_the_sea() -> None:
    flown = guided()
    assert flown.command_int(43001, z=130.0, frame=3) == 0
    flown.forward(40.0)
    assert flown.height == pytest.approx(130.0, abs=0.5)
    assert flown.command_int(43001, z=488.0 + 80.0, frame=0, p3=2.0) == 0
    before = flown.height
    flown.forward(5.0)
    assert before - flown.height == pytest.approx(10.0, abs=1.5)  # at no more than 2 m/s
    flown.forward(60.0)
    assert flown.height == pytest.approx(80.0, abs=0.5)


def test_altitude_ahead_by_three_seconds_makes_a_climb_rate() -> None:
    flown = guided()
    flown.command_int(43002, 0, 0.0, 9.8)
    flown.forward(
        10.0,
        every_s=0.5,
        send=lambda: dialect.MAVLink_command_int_message(
            1, 1, 3, 43001, 0, 0, 0, 0, 0, 0, 0, 0, flown.height + 3.0 * 3.3
        ),
    )
    assert -flown.velocity.z == pytest.approx(3.0, abs=0.6)


@pytest.mark.parametrize(("z", "frame"), [(0.0, 3), (-1.0, 3), (100.0, 10), (100.0, 6), (float("nan"), 3)])
def test_an_altitude_that_is_none_is_denied(z: float, frame: int) -> None:
    assert guided().command_int(43001, z=z, frame=frame) == 2


def test_airspeed_within_its_range() -> None:
    flown = guided()
    assert flown.command_int(43000, 0, 27.0) == 0
    flown.forward(10.0)
    assert speed(flown) == pytest.approx(27.0)
    assert flown.command_int(43000, 0, 20.0, 0.5) == 0
    flown.forward(4.0)
    assert speed(flown) == pytest.approx(25.0, abs=0.1)  # no faster than 0.5 m/s²
    assert flown.command_int(43000, 1, 20.0) == 2  # ground speed
    for value in (9.0, 31.0, 100.0, float("nan")):
        assert flown.command_int(43000, 0, value) == 2


@pytest.mark.parametrize("number", [43000, 43001, 43002])
def test_guided_commands_fail_in_other_modes(number: int) -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE)
    assert flown.mode == "LOITER"
    assert flown.command_int(number, 0, 20.0, 0, z=100.0, frame=3) == 4


def test_a_roll_alone_turns_it_level_and_lapses_after_three_seconds() -> None:
    flown = guided()
    flown.command_int(43002, 0, 0.0, 9.8)
    flown.forward(3.0)
    flown.forward(5.0, every_s=0.05, send=lambda: flown.roll_target(30.0))
    before = flown.airframe.motion.yaw
    assert degrees(flown.airframe.motion.roll) == pytest.approx(30.0)
    assert flown.airframe.motion.rates.z == pytest.approx(STANDARD_GRAVITY * 0.57735 / 22.0, rel=0.01)
    assert flown.height == pytest.approx(100.0, abs=0.1)
    assert speed(flown) == pytest.approx(22.0)
    flown.forward(2.8)
    assert degrees(flown.airframe.motion.roll) == pytest.approx(30.0)  # silence, not yet long enough
    assert abs(wrap(flown.airframe.motion.yaw - before)) > 0.5
    flown.forward(15.0)
    assert abs(flown.airframe.motion.roll) < 0.02
    assert course(flown) % 359.5 < 0.5


def test_the_bank_is_limited_by_its_parameter() -> None:
    flown = guided(parameters={"ROLL_LIMIT_DEG": 20.0})
    flown.forward(2.0, every_s=0.05, send=lambda: flown.roll_target(60.0))
    assert degrees(flown.airframe.motion.roll) == pytest.approx(20.0)


def test_a_roll_outside_guided_is_ignored() -> None:
    flown, other = FlownAutopilot(Kind.ARDUPLANE), FlownAutopilot(Kind.ARDUPLANE)
    flown.forward(5.0, every_s=0.05, send=lambda: flown.roll_target(-50.0))
    assert flown.position == other.forward(5.0).position
    assert flown.autopilot.counters["target_outside_guided"] == 100


def test_pitch_without_thrust_lets_the_speed_collapse() -> None:
    flown = guided()
    flown.forward(6.0, every_s=0.05, send=lambda: flown.roll_target(0.0, mask=70))
    assert speed(flown) < 12.0
    thrusting = guided()
    thrusting.forward(6.0, every_s=0.05, send=lambda: thrusting.roll_target(0.0, mask=7, thrust=0.9))
    assert speed(thrusting) == pytest.approx(28.0)


def test_velocity_targets_are_not_for_a_plane() -> None:
    flown, other = guided(), guided()
    flown.forward(6.0, every_s=0.05, send=lambda: flown.velocity_target(Vec(-20.0, 0.0, -5.0)))
    other.forward(6.0)
    assert flown.position == other.position
    assert flown.autopilot.counters["target_not_supported"] == 120


def test_a_global_velocity_target_is_read_as_altitude_zero() -> None:
    flown = guided()
    flown.forward(
        5.0,
        every_s=0.1,
        send=lambda: dialect.MAVLink_set_position_target_global_int_message(
            0, 1, 1, 6, 0x0DC7, 0, 0, 0.0, 10.0, 0.0, 0.0, 0, 0, 0, 0, 0
        ),
    )
    assert flown.height < 85.0
    flown.send(
        dialect.MAVLink_set_position_target_global_int_message(
            0, 1, 1, 1, 0x0DC7, 0, 0, 0.0, 10.0, 0.0, 0.0, 0, 0, 0, 0, 0
        )
    )
    assert flown.texts()[-1].startswith("Invalid coord frame")


def reposition(
    flown: FlownAutopilot, north: float, east: float, z: float = 120.0, p2: float = 0.0, frame: int = 6
) -> int:
    place = ORIGIN.geodetic_from_ned(Vec(north, east, 0.0))
    return flown.command_int(
        192, -1, p2, 100.0, 0, round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7), z, frame
    )


def test_it_circles_the_place_it_was_sent_to() -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE)
    assert reposition(flown, 500.0, 0.0) == 4  # not in GUIDED
    assert reposition(flown, 500.0, 0.0, p2=1.0) == 0
    assert flown.mode == "GUIDED"
    flown.forward(60.0)
    distances = []
    for _ in range(40):
        flown.forward(1.0)
        distances.append(hypot(flown.position.x - 500.0, flown.position.y))
    assert 90.0 < min(distances) <= max(distances) < 115.0
    assert flown.height == pytest.approx(120.0, abs=0.5)
    turn = wrap(flown.airframe.motion.rates.z)
    assert turn > 0.1  # clockwise
    assert reposition(flown, 500.0, 0.0, frame=2) == 2


def test_after_a_course_a_place_is_followed_in_altitude_only_until_guided_is_entered_again() -> None:
    flown = guided()
    flown.command_int(43002, 0, 90.0, 9.8)
    assert reposition(flown, -500.0, 0.0) == 0
    flown.forward(20.0)
    assert course(flown) == pytest.approx(90.0, abs=0.5)
    assert flown.height == pytest.approx(120.0, abs=0.5)
    assert flown.mode_to("GUIDED") == 0  # already in it: nothing changes
    flown.forward(5.0)
    assert course(flown) == pytest.approx(90.0, abs=0.5)
    assert flown.mode_to("LOITER") == 0
    assert flown.mode_to("GUIDED") == 0
    assert reposition(flown, -500.0, 0.0) == 0
    flown.forward(60.0)
    assert hypot(flown.position.x + 500.0, flown.position.y) < 130.0


def test_loiter_circles_where_it_was_and_return_leads_home() -> None:
    flown = guided()
    flown.command_int(43002, 0, 0.0, 9.8)
    flown.forward(60.0)
    there = flown.position
    assert flown.command(17) == 0
    assert flown.mode == "LOITER"
    flown.forward(40.0)
    radius = flown.autopilot.parameters["WP_LOITER_RAD"]
    assert hypot(flown.position.x - there.x, flown.position.y - there.y) < radius + 25.0
    assert flown.command(20) == 0
    assert flown.mode == "RTL"
    flown.forward(120.0)
    assert hypot(flown.position.x, flown.position.y) < radius + 25.0
    assert flown.height == pytest.approx(100.0, abs=1.0)


def test_a_wind_leaves_the_circle_a_circle() -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE, wind=Vec(6.0, 0.0, 0.0)).forward(60.0)
    radius, distances = flown.autopilot.parameters["WP_LOITER_RAD"], []
    for _ in range(60):
        flown.forward(1.0)
        distances.append(hypot(flown.position.x, flown.position.y))
    assert max(distances) < 1.35 * radius
    assert min(distances) > 0.7 * radius


def test_modes_flown_by_hand_keep_straight_and_level_without_a_pilot() -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE)
    for name in ("FBWA", "CRUISE", "STABILIZE", "MANUAL"):
        flown.autopilot.pilot_mode(flown.now_ns, name)
        heading = flown.airframe.motion.yaw
        flown.forward(5.0)
        assert abs(wrap(flown.airframe.motion.yaw - heading)) < 0.2
        assert flown.height == pytest.approx(100.0)


@pytest.mark.parametrize("name", ["AUTO", "QHOVER", "AUTOTUNE", "INITIALISING"])
def test_modes_it_cannot_enter_fail(name: str) -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE)
    assert flown.mode_to(name) == 4
    assert flown.mode == "LOITER"


@pytest.mark.parametrize(
    ("enabled", "action", "mode", "expected"),
    [
        (0, 1, "GUIDED", "GUIDED"),
        (1, 0, "GUIDED", "GUIDED"),
        (1, 1, "GUIDED", "RTL"),
        (1, 0, "LOITER", "RTL"),
        (1, 2, "GUIDED", "FBWA"),
    ],
)
def test_the_ground_stations_silence(enabled: int, action: int, mode: str, expected: str) -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE, parameters={"FS_GCS_ENABL": enabled, "FS_LONG_ACTN": action})
    assert flown.mode_to(mode) == 0
    flown.send(GCS, DialectSender(255, 190))
    flown.forward(4.5)
    assert flown.mode == mode
    flown.forward(1.0)
    assert flown.mode == expected


def test_a_dead_agent_is_missed_only_if_its_system_is_watched() -> None:
    flown = guided(parameters={"FS_GCS_ENABL": 1, "FS_LONG_ACTN": 1, "SYSID_MYGCS": 1})
    flown.command_int(43002, 0, 90.0, 9.8)
    flown.forward(10.0, every_s=1.0, send=lambda: dialect.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3))
    assert flown.mode == "GUIDED"
    flown.forward(6.0)
    assert flown.mode == "RTL"


def test_its_parameters_fit_the_airframe_it_is_mounted_in() -> None:
    p = guided().autopilot.parameters
    assert (p["AIRSPEED_MIN"], p["AIRSPEED_MAX"], p["AIRSPEED_CRUISE"]) == (10.0, 30.0, 22.0)
    assert p["ROLL_LIMIT_DEG"] == pytest.approx(degrees(atan2(22.0 * 40.0 * pi / 180.0, STANDARD_GRAVITY)))
    with pytest.raises(ValueError, match="NO_SUCH"):
        guided(parameters={"NO_SUCH": 1})


def test_entering_guided_from_rest_demands_nothing_wild() -> None:
    flown = guided().forward(60.0)
    assert norm(flown.velocity) == pytest.approx(22.0)
    assert flown.height == pytest.approx(100.0)
    assert flown.demand is not None
    assert flown.demand.velocity == ZERO
