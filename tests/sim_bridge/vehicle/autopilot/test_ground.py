"""A start from the ground: the estimator takes its time, arming is refused until then, and then it flies."""

from __future__ import annotations

import pytest

from onboard.core.math.vectors import Vec
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.flown_autopilot import PX4, FlownAutopilot

GCS = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)

KINDS = pytest.mark.parametrize("kind", list(Kind), ids=lambda kind: kind.value)
PREARM = 268435456


@KINDS
def test_arming_is_refused_with_a_reason_until_it_is_ready(kind: Kind) -> None:
    flown = FlownAutopilot(kind, airborne=False, ready_s=10.0)
    flown.send(GCS, DialectSender(255, 190))
    flown.forward(1.0)
    assert flown.got("GLOBAL_POSITION_INT") == []
    assert flown.got("LOCAL_POSITION_NED") == []
    assert flown.command(512, 242) == 0
    assert flown.got("HOME_POSITION") == []
    assert flown.command(400, 1) == (1 if kind in PX4 else 4)
    assert "rm" in "".join(flown.texts()[-2:])  # PX4's is 51 bytes: in two chunks
    assert not flown.last("HEARTBEAT").base_mode & 128
    assert not flown.last("SYS_STATUS").onboard_control_sensors_health & PREARM
    flown.forward(10.0)
    assert flown.got("HOME_POSITION")
    assert flown.got("GLOBAL_POSITION_INT")
    assert flown.last("SYS_STATUS").onboard_control_sensors_health & PREARM
    assert flown.command(400, 1) == 0
    assert flown.forward(1.0).last("HEARTBEAT").base_mode & 128
    assert flown.position == Vec(0.0, 0.0, 0.0)
    assert flown.autopilot.parked


@KINDS
def test_an_armed_vehicle_on_the_ground_can_be_disarmed_but_not_one_in_flight(kind: Kind) -> None:
    ground = FlownAutopilot(kind, airborne=False, ready_s=0.0)
    assert ground.command(400, 1) == 0
    assert ground.command(400, 1) == 0
    assert ground.command(400, 0) == 0
    assert not ground.autopilot.armed
    assert ground.command(400, 7) == 3
    air = FlownAutopilot(kind).forward(1.0)
    assert air.command(400, 0) == (1 if kind in PX4 else 4)
    assert air.autopilot.armed
    assert air.command(400, 0, 21196) == 0
    assert not air.autopilot.armed


@KINDS
def test_a_reboot_is_for_the_ground_only(kind: Kind) -> None:
    assert FlownAutopilot(kind).command(246, 1) == 4
    ground = FlownAutopilot(kind, airborne=False, ready_s=0.0).forward(5.0)
    assert ground.command(246, 1) == 0
    ground.forward(1.0)
    assert ground.last("ATTITUDE").time_boot_ms <= 1000


@pytest.mark.parametrize("kind", [Kind.PX4, Kind.ARDUCOPTER], ids=lambda kind: kind.value)
def test_armed_without_taking_off_a_multicopter_disarms_itself(kind: Kind) -> None:
    flown = FlownAutopilot(kind, airborne=False, ready_s=0.0).forward(2.0)
    assert flown.command(400, 1) == 0
    flown.forward(9.0)
    assert flown.autopilot.armed
    flown.forward(3.0)
    assert not flown.autopilot.armed
    assert not flown.last("HEARTBEAT").base_mode & 128


def test_arducopter_takes_off_in_guided_returns_and_lands() -> None:
    flown = FlownAutopilot(Kind.ARDUCOPTER, airborne=False, ready_s=0.0).forward(1.0)
    assert flown.command(22, 0, 0, 0, 0, 0, 0, 20) == 4  # neither armed nor in GUIDED
    assert flown.mode_to("GUIDED") == 0
    assert flown.command(400, 1) == 0
    flown.forward(1.0, every_s=0.1, send=lambda: flown.velocity_target(Vec(3.0, 0.0, -1.0)))
    assert flown.position == Vec(0.0, 0.0, 0.0)  # velocities are not for the ground
    assert flown.command_int(22, z=20.0, frame=0) == 2
    assert flown.command(22, 0, 0, 0, 0, 0, 0, 20) == 0
    flown.forward(15.0)
    assert flown.height == pytest.approx(20.0, abs=1.2)
    assert flown.last("EXTENDED_SYS_STATE").landed_state == 2
    flown.forward(6.0, every_s=0.1, send=lambda: flown.velocity_target(Vec(5.0, 0.0, 0.0)))
    assert flown.position.x > 20.0
    assert flown.command(20) == 0
    assert flown.mode == "RTL"
    assert flown.command(400, 1) == 0  # already armed
    flown.forward(60.0)
    assert not flown.autopilot.armed
    assert flown.autopilot.parked
    assert abs(flown.position.x) < 1.5
    assert flown.height == pytest.approx(0.0, abs=0.1)
    assert flown.last("EXTENDED_SYS_STATE").landed_state == 1
    assert flown.command(400, 1) == 4
    assert "not armable" in flown.texts()[-1]


def test_px4_takes_off_holds_lands_and_disarms() -> None:
    flown = FlownAutopilot(Kind.PX4, airborne=False, ready_s=0.0).forward(1.0)
    assert flown.command(400, 1) == 0
    assert flown.command(22, -1, 0, 0, float("nan"), float("nan"), float("nan"), 488.0 + 12.0) == 0
    assert flown.mode == "TAKEOFF"
    flown.forward(12.0)
    assert flown.mode == "HOLD"
    assert flown.height == pytest.approx(12.0, abs=1.1)
    assert flown.command(21) == 0
    flown.forward(40.0)
    assert flown.autopilot.parked
    assert not flown.autopilot.armed
    assert flown.height == pytest.approx(0.0, abs=0.1)


def test_px4_offboard_leaves_the_ground_by_an_upward_velocity() -> None:
    flown = FlownAutopilot(Kind.PX4, airborne=False, ready_s=0.0)
    flown.forward(1.5, every_s=0.1, send=lambda: flown.velocity_target(Vec(0.0, 0.0, -1.0)))
    assert flown.mode_to("OFFBOARD") == 0
    flown.forward(1.0, every_s=0.1, send=lambda: flown.velocity_target(Vec(0.0, 0.0, -1.0)))
    assert flown.autopilot.parked  # not armed
    assert flown.command(400, 1) == 0
    flown.forward(5.0, every_s=0.1, send=lambda: flown.velocity_target(Vec(0.0, 0.0, -1.0)))
    assert flown.height > 3.0
    assert not flown.autopilot.parked


def test_arduplane_takes_off_by_its_mode_and_then_circles() -> None:
    flown = FlownAutopilot(Kind.ARDUPLANE, airborne=False, ready_s=0.0).forward(1.0)
    assert flown.mode_to("TAKEOFF") == 0
    assert flown.autopilot.parked
    assert flown.command(22, 0, 0, 0, 0, 0, 0, 50) == 4  # not a plane's command
    assert flown.command(400, 1) == 0
    flown.forward(8.0)
    assert not flown.autopilot.parked
    assert flown.height > 10.0
    assert abs(flown.position.y) < 1.0
    flown.forward(40.0)
    assert flown.height == pytest.approx(100.0, abs=2.5)
    assert any(text.startswith("Takeoff to 100m") for text in flown.texts())
    assert flown.mode_to("GUIDED") == 0


@KINDS
def test_a_vehicle_on_the_ground_ignores_modes_that_would_move_it(kind: Kind) -> None:
    flown = FlownAutopilot(kind, airborne=False, ready_s=0.0).forward(1.0)
    for name in ("RTL", "LAND" if kind != Kind.ARDUPLANE else "LOITER"):
        assert flown.mode_to(name) == 0
        flown.forward(2.0)
        assert flown.position == Vec(0.0, 0.0, 0.0)


@KINDS
def test_prearm_reasons_are_repeated_as_status_text(kind: Kind) -> None:
    flown = FlownAutopilot(kind, airborne=False, ready_s=60.0).forward(40.0)
    prearm = [m for m in flown.got("STATUSTEXT") if m.text.startswith("PreArm:")]
    assert [m.severity for m in prearm] == ([] if kind in PX4 else [dialect.MAV_SEVERITY_CRITICAL])
