"""PX4 fixed wing: position targets ahead fly a course, velocity targets alone do not."""

from __future__ import annotations

from math import atan2, cos, degrees, nan, radians, sin
from typing import Any

import pytest

from onboard.core.math.angles import wrap
from onboard.core.math.vectors import ZERO, Vec
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.autopilot.health import Fault
from tests.support.flown_autopilot import FlownAutopilot

AHEAD = 300.0  # [m] of the position target, along the wanted course


def ahead(flown: FlownAutopilot, course_deg: float, height: float) -> Any:
    """A position target ahead of the plane, in the autopilot's own local frame."""
    here = flown.autopilot.local.ned_from_geodetic(*flown.autopilot.place)
    course = radians(course_deg)
    up = flown.height - height
    return dialect.MAVLink_set_position_target_local_ned_message(
        0, 1, 1, 1, 0xFF8, here.x + AHEAD * cos(course), here.y + AHEAD * sin(course), here.z + up,
        0, 0, 0, 0, 0, 0, 0, 0,
    )  # fmt: skip


def flies(flown: FlownAutopilot, seconds: float, course_deg: float, height: float = 100.0) -> FlownAutopilot:
    return flown.forward(seconds, every_s=0.05, send=lambda: ahead(flown, course_deg, height))


def offboard(**more: Any) -> FlownAutopilot:
    flown = FlownAutopilot(Kind.PX4_PLANE, **more).forward(1.0)
    flown.send(ahead(flown, 0.0, 100.0))
    assert flown.mode_to("OFFBOARD") == 0
    return flown


def course(flown: FlownAutopilot) -> float:
    return degrees(atan2(flown.velocity.y, flown.velocity.x))


@pytest.mark.parametrize("wind", [ZERO, Vec(4.0, 4.0, 0.0)])
def test_a_position_target_ahead_flies_a_course_and_a_height(wind: Vec) -> None:
    flown = flies(offboard(wind=wind), 5.0, 0.0)
    flies(flown, 5.0, 90.0, 110.0)  # 90° in 4–5 s
    assert abs(degrees(wrap(radians(course(flown) - 90.0)))) < 6.0
    flies(flown, 15.0, 90.0, 110.0)
    assert abs(course(flown) - 90.0) < 2.0
    assert flown.height == pytest.approx(110.0, abs=1.0)
    assert flown.airframe.motion.airspeed == pytest.approx(22.0, abs=0.2)  # FW_AIRSPD_TRIM, whatever is asked


def test_velocity_targets_alone_wander() -> None:
    flown = offboard()
    flown.forward(20.0, every_s=0.05, send=lambda: flown.velocity_target(Vec(22.0, 0.0, 0.0)))
    assert flown.mode == "OFFBOARD"
    assert abs(course(flown)) > 30.0


def test_the_loss_of_targets_circles_in_hold_and_their_return_takes_it_back() -> None:
    flown = flies(offboard(), 3.0, 0.0)
    place = flown.position
    flown.forward(60.0)
    assert flown.mode == "HOLD"
    assert flown.last("HEARTBEAT").system_status == 5
    flown.assert_near(place, 2.5 * flown.autopilot.parameters["NAV_LOITER_RAD"])
    assert flown.height == pytest.approx(100.0, abs=2.0)
    assert flies(flown, 1.0, 0.0).mode == "OFFBOARD"


def test_airspeed_cannot_be_commanded_and_guided_commands_are_unknown() -> None:
    flown = flies(offboard(), 2.0, 0.0)
    assert flown.command(178, 0, 26.0, -1) == 0
    assert flown.command(178, 0, 99.0, -1) == 2
    flies(flown, 5.0, 0.0)
    assert flown.airframe.motion.airspeed == pytest.approx(22.0, abs=0.2)
    for number in (43000, 43001, 43002):
        assert flown.command(number, 0, 20.0) == 3


def test_it_takes_off_by_nav_takeoff_and_circles() -> None:
    flown = FlownAutopilot(Kind.PX4_PLANE, airborne=False, ready_s=0.0).forward(1.0)
    assert flown.command(400, 1) == 0
    assert flown.command(22, 0, 0, 0, nan, nan, nan, 488.0 + 60.0) == 0
    flown.forward(60.0)
    assert flown.mode == "HOLD"
    assert flown.height == pytest.approx(60.0, abs=6.0)


def test_return_land_and_the_loss_of_position() -> None:
    flown = FlownAutopilot(Kind.PX4_PLANE).forward(1.0)
    assert flown.mode_to("RTL") == 0
    flown.forward(90.0)
    flown.assert_near(Vec(0.0, 0.0, -100.0), 2.5 * flown.autopilot.parameters["NAV_LOITER_RAD"])
    assert flown.mode_to("LAND") == 0
    flown.forward(120.0, until=lambda: flown.autopilot.landed)
    assert not flown.autopilot.armed
    blind = FlownAutopilot(Kind.PX4_PLANE).forward(1.0)
    blind.autopilot.fail(Fault.GPS)
    assert blind.forward(6.0).mode == "LAND"
