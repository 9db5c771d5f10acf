"""ArduCopter in GUIDED: velocity targets, their end, refusals and failsafes."""

from __future__ import annotations

from math import atan2, radians

import pytest

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import ZERO, Vec, norm, sub
from onboard.game.scenario import Kind, VehicleSpec
from onboard.wire.mavlink.dialect import DialectSender, dialect
from sim_bridge.vehicle.flight.multicopter_wind import DRAG, wind_held
from sim_bridge.vehicle.motion import Air
from tests.support.flown_autopilot import ORIGIN, FlownAutopilot

GCS = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)


def guided(**more: object) -> FlownAutopilot:
    flown = FlownAutopilot(Kind.ARDUCOPTER, **more)  # type: ignore[arg-type]
    assert flown.mode_to("GUIDED") == 0
    return flown


def chase(flown: FlownAutopilot, v: Vec, seconds: float, **more: int) -> FlownAutopilot:
    return flown.forward(seconds, every_s=0.1, send=lambda: flown.velocity_target(v, **more))


def test_it_follows_a_velocity_within_its_limits() -> None:
    flown = chase(guided(), Vec(3.0, -2.0, -1.0), 5.0)
    assert norm(sub(flown.velocity, Vec(3.0, -2.0, -1.0))) < 1e-6
    chase(flown, Vec(40.0, 0.0, 0.0), 5.0)
    assert norm(flown.velocity) == pytest.approx(8.0)  # its airframe's most


def test_velocity_outside_guided_is_ignored() -> None:
    flown = chase(FlownAutopilot(Kind.ARDUCOPTER), Vec(5.0, 0.0, 0.0), 3.0)
    assert norm(flown.velocity) < 1e-6
    assert flown.autopilot.counters["target_outside_guided"] == 30


def test_when_targets_cease_it_stops_by_itself_after_three_seconds() -> None:
    flown = chase(guided(), Vec(5.0, 0.0, 0.0), 4.0)
    flown.forward(2.8)
    assert flown.velocity.x == pytest.approx(5.0)
    flown.forward(2.0)
    assert norm(flown.velocity) < 0.3
    assert flown.mode == "GUIDED"
    where = flown.position
    flown.forward(10.0)
    assert norm(sub(flown.position, where)) < 0.5
    chase(flown, Vec(0.0, 4.0, 0.0), 3.0)
    assert flown.velocity.y == pytest.approx(4.0)  # and goes on when they come again


def test_its_patience_is_a_parameter() -> None:
    flown = chase(guided(parameters={"GUID_TIMEOUT": 0.5}), Vec(5.0, 0.0, 0.0), 4.0).forward(2.2)
    assert norm(flown.velocity) < 0.3


@pytest.mark.parametrize("mask", [0x0DC7, 0x09C7])
def test_both_masks_of_velocity_are_followed(mask: int) -> None:
    assert chase(guided(), Vec(0.0, 3.0, 0.0), 3.0, mask=mask).velocity.y == pytest.approx(3.0)


@pytest.mark.parametrize(("frame", "mask"), [(2, 0x0DC7), (20, 0x0DC7), (1, 0x0FFF), (1, 0x0E07)])
def test_what_it_does_not_understand_stops_it(frame: int, mask: int) -> None:
    flown = chase(guided(), Vec(5.0, 0.0, 0.0), 3.0)
    chase(flown, Vec(5.0, 0.0, 0.0), 3.0, frame=frame, mask=mask)
    assert norm(flown.velocity) < 0.3
    assert flown.autopilot.counters["target_refused"] == 30


def test_a_velocity_that_is_no_number_stops_it() -> None:
    flown = chase(guided(), Vec(5.0, 0.0, 0.0), 3.0)
    flown.send(flown.velocity_target(Vec(float("nan"), 0.0, 0.0)))
    flown.forward(2.5)
    assert norm(flown.velocity) < 0.3


def test_a_velocity_in_the_bodys_frame_is_turned_by_its_heading() -> None:
    spec = VehicleSpec(position=(0.0, 0.0, 50.0), speed=5.0, heading_deg=90.0)
    flown = guided(spec=spec)
    flown.send(flown.velocity_target(Vec(3.0, 0.0, 0.0), frame=8))
    flown.forward(2.0)
    assert flown.velocity.y == pytest.approx(3.0, abs=1e-6)
    assert abs(flown.velocity.x) < 1e-6


def test_it_goes_to_a_local_position_of_its_own_frame() -> None:
    flown = guided(system=4).forward(1.0)
    here = flown.last("LOCAL_POSITION_NED")
    flown.send(
        dialect.MAVLink_set_position_target_local_ned_message(
            0, 4, 1, 1, 0x0DF8, here.x + 20.0, here.y - 10.0, here.z - 5.0, 0, 0, 0, 0, 0, 0, 0, 0
        )
    )
    flown.forward(30.0)
    assert norm(sub(flown.position, Vec(20.0, -10.0, -55.0))) < 0.5


def test_it_repositions_and_refuses_frames_it_does_not_know() -> None:
    flown = FlownAutopilot(Kind.ARDUCOPTER)
    place = ORIGIN.geodetic_from_ned(Vec(30.0, 15.0, 0.0))
    x, y = round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7)
    assert flown.command_int(192, -1, 0, 0, 0, x, y, 60.0, 6) == 4  # not in GUIDED, and not asked to change
    assert flown.command_int(192, -1, 1, 0, 0, x, y, 60.0, 2) == 2
    assert flown.command_int(192, -1, 1, 0, 0, 1_000_000_000, y, 60.0, 6) == 2
    assert flown.command_int(192, -1, 1, 0, float("nan"), x, y, 60.0, 6) == 0
    assert flown.mode == "GUIDED"
    flown.forward(30.0)
    assert norm(sub(flown.position, Vec(30.0, 15.0, -60.0))) < 0.5


def test_global_targets_are_followed_too() -> None:
    flown = guided()
    flown.forward(
        3.0,
        every_s=0.1,
        send=lambda: dialect.MAVLink_set_position_target_global_int_message(
            0, 1, 1, 6, 0x0DC7, 0, 0, 0, 2.0, 1.0, 0.0, 0, 0, 0, 0, 0
        ),
    )
    assert norm(sub(flown.velocity, Vec(2.0, 1.0, 0.0))) < 1e-6


def test_modes_by_command_and_by_message_are_acknowledged() -> None:
    flown = FlownAutopilot(Kind.ARDUCOPTER)
    assert flown.command(176, 1, 99) == 4
    assert flown.texts()[-1] == "No such mode 99"
    assert flown.command(176, 0, 4) == 2  # not a custom mode
    assert flown.command(176, 1, 3) == 4
    assert "AUTO failed" in flown.texts()[-1]
    assert flown.mode == "LOITER"
    for name in ("BRAKE", "ALT_HOLD", "STABILIZE", "GUIDED", "POSHOLD", "LOITER"):
        assert flown.mode_to(name) == 0
        assert flown.last("HEARTBEAT").custom_mode == flown.autopilot.modes[name]
    flown.send(dialect.MAVLink_set_mode_message(1, 1, 4))
    assert flown.mode == "GUIDED"
    assert flown.last("COMMAND_ACK").command == 11


def test_the_pilots_switch_takes_it_out_of_guided_at_once() -> None:
    flown = chase(guided(), Vec(5.0, 0.0, 0.0), 3.0)
    flown.autopilot.pilot_mode(flown.now_ns, "LOITER")
    chase(flown, Vec(5.0, 0.0, 0.0), 3.0)
    assert flown.mode == "LOITER"
    assert norm(flown.velocity) < 0.3
    with pytest.raises(KeyError):
        flown.autopilot.pilot_mode(flown.now_ns, "OFFBOARD")


def silent(flown: FlownAutopilot, gcs: tuple[int, int], seconds: float) -> FlownAutopilot:
    """Ten heartbeats of a ground station, then silence; velocities all the while."""
    beat = DialectSender(*gcs)
    for _ in range(10):
        flown.send(GCS, beat)
        chase(flown, Vec(1.0, 0.0, 0.0), 1.0)
    return chase(flown, Vec(1.0, 0.0, 0.0), seconds)


def test_the_ground_stations_silence_brings_it_home_if_the_parameter_says_so() -> None:
    flown = silent(guided(parameters={"FS_GCS_ENABLE": 1}), (255, 190), 3.0)
    assert flown.mode == "GUIDED"
    chase(flown, Vec(1.0, 0.0, 0.0), 2.0)
    assert flown.mode == "RTL"
    assert "GCS Failsafe" in flown.texts()
    flown.send(GCS, DialectSender(255, 190))
    flown.forward(1.0)
    assert flown.texts()[-1] == "GCS Failsafe Cleared"
    assert flown.mode == "RTL"


def test_as_delivered_it_does_not_care() -> None:
    assert silent(guided(), (255, 190), 20.0).mode == "GUIDED"


def test_it_watches_one_system_alone() -> None:
    watched = guided(parameters={"FS_GCS_ENABLE": 1, "SYSID_MYGCS": 1})
    assert silent(watched, (255, 190), 10.0).mode == "GUIDED"  # never heard of system 1: nothing to lose
    assert silent(watched, (1, 191), 4.0).mode == "GUIDED"
    chase(watched, Vec(1.0, 0.0, 0.0), 2.0)
    assert watched.mode == "RTL"  # its agent fell silent


@pytest.mark.parametrize(("action", "mode"), [(1, "RTL"), (5, "LAND"), (7, "BRAKE")])
def test_what_it_does_then_is_a_parameter(action: int, mode: str) -> None:
    assert silent(guided(parameters={"FS_GCS_ENABLE": action}), (255, 190), 6.0).mode == mode


def test_a_mode_flown_by_hand_goes_on() -> None:
    flown = FlownAutopilot(Kind.ARDUCOPTER, parameters={"FS_GCS_ENABLE": 1})
    silent(flown, (255, 190), 8.0)
    assert flown.mode == "LOITER"
    assert "GCS Failsafe - Continuing Pilot Control" in flown.texts()


def test_a_low_battery_acts_as_its_parameter_says() -> None:
    flown = guided(parameters={"BATT_FS_LOW_ACT": 2})
    flown.autopilot.set_battery(0.05)
    chase(flown, Vec(1.0, 0.0, 0.0), 9.5)
    assert flown.mode == "GUIDED"  # BATT_LOW_TIMER has not passed
    chase(flown, Vec(1.0, 0.0, 0.0), 1.0)
    assert flown.mode == "RTL"
    assert [t.split(" used")[0] for t in flown.texts()[-2:]] == [
        "Battery 1 is low 10.30V",
        "Battery Failsafe",
    ]
    assert flown.forward(1.0).last("HEARTBEAT").system_status == 5
    quiet = guided()
    quiet.autopilot.set_battery(0.05)
    assert chase(quiet, Vec(1.0, 0.0, 0.0), 12.0).mode == "GUIDED"


def test_return_climbs_first_and_home_may_be_moved() -> None:
    spec = VehicleSpec(position=(60.0, 0.0, 5.0), speed=5.0)
    flown = FlownAutopilot(Kind.ARDUCOPTER, spec=spec)
    place = ORIGIN.geodetic_from_ned(ZERO)
    assert (
        flown.command_int(
            179, 0, 0, 0, 0, round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7), 488.0, 0
        )
        == 0
    )
    assert flown.mode_to("RTL") == 0
    flown.forward(5.0)
    assert flown.height > 12.0
    assert flown.position.x > 55.0
    flown.forward(70.0)
    assert flown.autopilot.parked
    assert abs(flown.position.x) < 1.5


def test_a_steady_wind_within_the_tilt_limit_moves_it_only_until_it_leans() -> None:
    """8 m/s across begin at once: it is pushed off, leans against it, and from then on flies as in still air.

    The lean is that at which gravity balances the rotors' drag: tan θ = k w / g, 17° of 30°."""
    flown = chase(guided(), ZERO, 2.0)
    before = flown.position
    flown.air = Air(Vec(0.0, 8.0, 0.0), ZERO)
    chase(flown, ZERO, 1.0)
    assert flown.velocity.y > 0.5  # nobody stands still in a gust
    chase(flown, ZERO, 9.0)
    flown.assert_near(before, 5.0)
    held = flown.position
    chase(flown, ZERO, 20.0)
    flown.assert_near(held, 0.3)
    assert norm(flown.velocity) < 0.01
    lean = -atan2(DRAG * 8.0, STANDARD_GRAVITY)
    assert flown.last("ATTITUDE").roll == pytest.approx(lean, abs=radians(0.5))
    assert flown.last("ATTITUDE").yaw == pytest.approx(0.0, abs=0.05)
    chase(flown, Vec(4.0, 0.0, 0.0), 15.0)
    assert norm(sub(flown.velocity, Vec(4.0, 0.0, 0.0))) < 0.02


def test_a_wind_beyond_the_tilt_limit_carries_it_off() -> None:
    flown = chase(guided(wind=Vec(0.0, 1.2 * wind_held(radians(30.0)), 0.0)), ZERO, 20.0)
    assert flown.position.y > 20.0
    assert abs(flown.last("ATTITUDE").roll) <= radians(30.0) + 1e-6
