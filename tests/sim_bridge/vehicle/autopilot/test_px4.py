"""PX4 in OFFBOARD: the stream before, the stream during, and what happens when it ends."""

from __future__ import annotations

from itertools import pairwise

import pytest

from onboard.core.math.vectors import ZERO, Vec, norm, sub
from onboard.game.scenario import Kind, VehicleSpec
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.flown_autopilot import ORIGIN, FlownAutopilot

GCS = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)


def stream(
    flown: FlownAutopilot, v: Vec, seconds: float, every_s: float = 0.05, **more: int
) -> FlownAutopilot:
    return flown.forward(seconds, every_s=every_s, send=lambda: flown.velocity_target(v, **more))


def offboard(**more: object) -> FlownAutopilot:
    flown = stream(FlownAutopilot(Kind.PX4, **more), ZERO, 1.2)  # type: ignore[arg-type]
    assert flown.mode_to("OFFBOARD") == 0
    return flown


def test_offboard_is_refused_without_a_fresh_target_and_one_is_enough() -> None:
    flown = heard(FlownAutopilot(Kind.PX4).forward(0.5))
    assert flown.mode_to("OFFBOARD") == 1
    assert flown.mode == "HOLD"
    # 53 bytes: in two chunks
    assert "".join(flown.texts()[-2:]) == "Switching to mode 'Offboard' is currently not possible"
    flown.send(flown.velocity_target(ZERO))
    assert flown.mode_to("OFFBOARD") == 0
    assert flown.last("HEARTBEAT").custom_mode == 4 << 16 | 3 << 24  # not told at once …
    assert flown.forward(0.06).last("HEARTBEAT").custom_mode == 6 << 16  # … but 0.04 s after the order


def test_a_target_older_than_com_of_loss_t_does_not_count() -> None:
    assert stream(FlownAutopilot(Kind.PX4), ZERO, 3.0).forward(1.2).mode_to("OFFBOARD") == 1


@pytest.mark.parametrize(("frame", "mask"), [(2, 0x9C7), (7, 0x9C7), (1, 0xFFF), (1, 0x9FF)])
def test_what_it_does_not_understand_is_no_stream(frame: int, mask: int) -> None:
    flown = stream(FlownAutopilot(Kind.PX4), ZERO, 3.0, frame=frame, mask=mask)
    assert flown.mode_to("OFFBOARD") == 1


def test_it_follows_a_velocity() -> None:
    flown = stream(offboard(), Vec(3.0, 2.0, -1.0), 4.0)
    assert norm(sub(flown.velocity, Vec(3.0, 2.0, -1.0))) < 1e-6


def test_setpoints_do_nothing_in_hold() -> None:
    assert norm(stream(FlownAutopilot(Kind.PX4), Vec(5.0, 0.0, 0.0), 4.0).velocity) < 1e-6


def test_the_loss_of_setpoints_is_seen_after_a_second_and_it_holds() -> None:
    flown = stream(offboard(), Vec(5.0, 0.0, 0.0), 4.0)
    flown.forward(0.9)
    assert flown.mode == "OFFBOARD"
    assert flown.velocity.x == pytest.approx(5.0)
    flown.forward(0.2)
    assert flown.mode == "HOLD"
    beat = flown.forward(1.0).last("HEARTBEAT")
    assert (beat.custom_mode, beat.system_status) == (4 << 16 | 3 << 24, 5)
    flown.forward(4.0)
    stream(flown, Vec(5.0, 0.0, 0.0), 3.0)  # they come again: it goes back by itself
    assert flown.mode == "OFFBOARD"
    assert flown.velocity.x == pytest.approx(5.0)
    assert flown.last("HEARTBEAT").system_status == 4


def test_a_mode_that_was_chosen_meanwhile_keeps_it_out_of_offboard() -> None:
    flown = stream(offboard(), ZERO, 2.0).forward(2.0)
    assert flown.mode_to("HOLD") == 0
    assert stream(flown, Vec(5.0, 0.0, 0.0), 3.0).mode == "HOLD"


def test_modes_are_told_by_the_heartbeat_that_is_due_and_no_other() -> None:
    flown = offboard()
    stream(flown, ZERO, 3.0)
    flown.autopilot.pilot_mode(flown.now_ns, "POSCTL")
    times = [t for t, m in flown.forward(3.0).heard if m.get_type() == "HEARTBEAT"]
    gaps = [round((b - a) * 1e-9, 2) for a, b in pairwise(times)]
    assert set(gaps[-4:]) == {1.0}


@pytest.mark.parametrize(("throttle", "sink"), [(None, 0.8), (0.5, 0.0), (0.0, 1.5)])
def test_position_mode_sinks_where_nobody_holds_the_sticks(throttle: float | None, sink: float) -> None:
    flown = stream(offboard(parameters={"COM_OBL_RC_ACT": 0}, throttle=throttle), ZERO, 1.0).forward(3.0)
    assert flown.mode == "POSCTL"
    height = flown.height
    assert (height - flown.forward(10.0).height) / 10.0 == pytest.approx(sink, abs=0.01)


def heard(flown: FlownAutopilot) -> FlownAutopilot:
    """The autopilot has heard a ground station, and so sends its texts."""
    flown.send(GCS, DialectSender(255, 190))
    return flown


def test_texts_go_to_ground_stations_only() -> None:
    flown = FlownAutopilot(Kind.PX4)
    flown.mode_to("OFFBOARD")
    assert flown.texts() == []
    heard(flown).mode_to("OFFBOARD")
    assert len(flown.texts()) == 2


def test_orders_of_a_mode_are_acknowledged_twice() -> None:
    flown = FlownAutopilot(Kind.PX4)
    flown.mode_to("OFFBOARD")
    flown.send(flown.velocity_target(ZERO))
    flown.mode_to("OFFBOARD")
    assert [ack.result for ack in flown.got("COMMAND_ACK")] == [0, 1, 0, 0]


@pytest.mark.parametrize(("action", "mode"), [(3, "RTL"), (4, "LAND"), (0, "POSCTL"), (5, "HOLD")])
def test_what_it_does_then_is_a_parameter(action: int, mode: str) -> None:
    flown = stream(offboard(parameters={"COM_OBL_RC_ACT": action}), Vec(1.0, 0.0, 0.0), 1.0).forward(1.5)
    assert flown.mode == mode


def test_the_data_link_is_any_ground_station_and_by_default_not_missed() -> None:
    for action, mode in ((0, "OFFBOARD"), (2, "RTL"), (3, "LAND"), (1, "HOLD")):
        flown = offboard(parameters={"NAV_DLL_ACT": action, "COM_DL_LOSS_T": 3})
        flown.send(GCS, DialectSender(77, 190))
        stream(flown, ZERO, 2.5)
        assert flown.mode == "OFFBOARD"
        stream(flown, ZERO, 1.0)
        assert flown.mode == ("HOLD" if action else mode)  # COM_FAIL_ACT_T: a person may step in
        stream(flown, ZERO, 5.0)
        assert flown.mode == mode
        assert "Connection to ground station lost" in flown.texts()


def test_a_companions_heartbeat_is_no_ground_station() -> None:
    flown = offboard(parameters={"NAV_DLL_ACT": 2, "COM_DL_LOSS_T": 3})
    flown.send(dialect.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3))
    assert stream(flown, ZERO, 10.0).mode == "OFFBOARD"


def test_a_critical_battery_acts_as_its_parameter_says() -> None:
    for action, mode in ((0, "OFFBOARD"), (2, "LAND"), (3, "RTL")):
        flown = offboard(parameters={"COM_LOW_BAT_ACT": action})
        flown.autopilot.set_battery(0.06)
        assert stream(flown, ZERO, 1.0).mode == ("HOLD" if action else mode)
        assert stream(flown, ZERO, 5.0).mode == mode


def test_a_person_who_chooses_a_mode_ends_a_failsafe() -> None:
    flown = offboard(parameters={"COM_LOW_BAT_ACT": 3})
    flown.autopilot.set_battery(0.06)
    assert stream(flown, ZERO, 1.0).mode == "HOLD"
    assert flown.mode_to("OFFBOARD") == 0
    assert stream(flown, ZERO, 8.0).mode == "OFFBOARD"
    flown.autopilot.set_battery(0.04)  # worse: emergency
    assert stream(flown, ZERO, 1.0).mode == "HOLD"
    assert stream(flown, ZERO, 5.0).mode == "LAND"


@pytest.mark.parametrize("parts", [(1, 4, 4), (1, 9, 0), (0, 6, 0), (1, 4, 0), (float("nan"), 6, 0)])
def test_modes_it_cannot_enter_are_refused_for_now(parts: tuple[float, ...]) -> None:
    flown = stream(FlownAutopilot(Kind.PX4), ZERO, 2.0)
    assert flown.command(176, *parts) == 1
    assert flown.mode == "HOLD"


def test_the_pilots_switch_takes_it_out_of_offboard() -> None:
    flown = offboard()
    flown.autopilot.pilot_mode(flown.now_ns, "POSCTL")
    stream(flown, Vec(3.0, 0.0, 0.0), 2.0)
    assert flown.mode == "POSCTL"
    assert norm(flown.velocity) < 0.3


def test_it_repositions_in_hold() -> None:
    flown = FlownAutopilot(Kind.PX4)
    place = ORIGIN.geodetic_from_ned(Vec(12.0, -9.0, 0.0))
    x, y = round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7)
    assert flown.command_int(192, -1, 1, 0, float("nan"), x, y, 488.0 + 40.0, 5) == 0
    flown.forward(25.0)
    assert norm(sub(flown.position, Vec(12.0, -9.0, -40.0))) < 0.5
    assert flown.command_int(192, -1, 1, 0, 0, x, y, 40.0, 1) == 8
    assert flown.command_int(192, -1, 1, 0, 0, 1_000_000_000, y, 40.0, 5) == 2


def test_a_position_setpoint_is_of_its_own_frame() -> None:
    flown = offboard(system=6).forward(0.5)
    here = flown.last("LOCAL_POSITION_NED")
    flown.forward(
        12.0,
        every_s=0.1,
        send=lambda: dialect.MAVLink_set_position_target_local_ned_message(
            0, 6, 1, 1, 0xDF8, here.x + 10.0, here.y, here.z, 0, 0, 0, 0, 0, 0, 0, 0
        ),
    )
    assert norm(sub(flown.position, Vec(10.0, 0.0, -50.0))) < 0.5


def test_velocities_are_clipped_at_its_parameters() -> None:
    spec = VehicleSpec(position=(0.0, 0.0, 50.0), speed=20.0)
    flown = stream(
        offboard(spec=spec, parameters={"MPC_XY_VEL_MAX": 12, "MPC_Z_VEL_MAX_UP": 3}),
        Vec(20.0, 0.0, -10.0),
        8.0,
    )
    assert norm(sub(flown.velocity, Vec(12.0, 0.0, -3.0))) < 1e-6
    faster = stream(offboard(spec=spec), Vec(20.0, 0.0, 0.0), 8.0)  # as delivered they fit its airframe
    assert faster.velocity.x == pytest.approx(20.0)
