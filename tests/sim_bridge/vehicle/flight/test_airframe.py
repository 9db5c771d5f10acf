"""The aircraft behind the seam of the autopilots: what a pilot would see."""

from __future__ import annotations

from math import cos, degrees, pi, radians, sin, sqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.angles import wrap
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, norm
from sim_bridge.vehicle.flight.airframe import Plane, fixed_wing
from sim_bridge.vehicle.motion import CALM, Air, Airframe, Demand, Lateral

ALL = ["nose", "slip", "coordinated"]
FREE = VehicleLimits()


def fly(plane: Plane, demand: Demand, air: Air, seconds: float, dt: float = 0.05) -> None:
    for _ in range(round(seconds / dt)):
        plane.step(demand, air, dt)


def demand(kind: Lateral, angle_deg: float, climb: float = 0.0, airspeed: float = 45.0) -> Demand:
    return Demand(kind, ZERO, radians(angle_deg), climb, airspeed)


@pytest.mark.parametrize("name", ALL)
def test_a_course_over_ground_is_held_in_a_crosswind(name: str) -> None:
    plane: Airframe = fixed_wing(name, FREE, ZERO, 0.0, 45.0)
    air = Air(Vec(0.0, 6.0, 0.0), ZERO)
    for _ in range(3000):
        plane.step(demand(Lateral.COURSE, 60.0), air, 0.05)
    v = plane.motion.velocity
    assert degrees(wrap(atan_course(v) - radians(60.0))) == pytest.approx(0.0, abs=0.1)
    assert plane.motion.airspeed == pytest.approx(45.0, abs=0.01)
    crab = degrees(wrap(plane.motion.yaw - radians(60.0)))
    assert crab == pytest.approx(-3.8, abs=0.3)  # the nose points into the wind
    assert norm(v) == pytest.approx(45.0 * cos(radians(3.83)) + 6.0 * sin(radians(60.0)), abs=0.1)


def atan_course(v: Vec) -> float:
    from onboard.core.math.vectors import yaw_of

    return yaw_of(v)


def test_a_roll_setpoint_turns_the_coordinated_aircraft() -> None:
    plane = fixed_wing("coordinated", FREE, ZERO, 0.0, 45.0)
    fly(plane, demand(Lateral.ROLL, 30.0), CALM, 5.0)
    assert degrees(plane.motion.roll) == pytest.approx(30.0, abs=0.1)
    rate = 9.80665 * (1 / sqrt(3)) / 45.0
    before = plane.motion.yaw
    fly(plane, demand(Lateral.ROLL, 30.0), CALM, 2.0)
    assert wrap(plane.motion.yaw - before) / 2.0 == pytest.approx(rate, rel=0.01)
    assert plane.motion.rates.z == pytest.approx(rate, rel=0.01)


@pytest.mark.parametrize("name", ["nose", "slip"])
def test_a_roll_setpoint_becomes_a_turn_that_the_rudder_can_hold(name: str) -> None:
    plane = fixed_wing(name, FREE, ZERO, 0.0, 45.0)
    fly(plane, demand(Lateral.ROLL, 60.0), CALM, 40.0)
    assert degrees(plane.motion.rates.z) == pytest.approx(4.46, abs=0.1)
    small = fixed_wing(name, FREE, ZERO, 0.0, 45.0)
    fly(small, demand(Lateral.ROLL, 5.0), CALM, 40.0)
    assert small.motion.rates.z == pytest.approx(9.80665 * 0.08749 / 45.0, rel=0.02)


def test_the_path_of_the_slipping_aircraft_lags_behind_its_nose() -> None:
    """A nose that has turned 5° has hardly moved the path: k_β = 1/6 per second."""
    plane = fixed_wing("slip", FREE, ZERO, 0.0, 45.0)
    fly(plane, demand(Lateral.HEADING, 20.0), CALM, 4.0)
    course = degrees(atan_course(plane.motion.velocity))
    nose = degrees(plane.motion.yaw)
    assert nose > 8.0
    assert course < 0.4 * nose
    fly(plane, demand(Lateral.HEADING, 20.0), CALM, 60.0)
    assert degrees(atan_course(plane.motion.velocity)) == pytest.approx(20.0, abs=0.1)


def test_asked_for_a_course_the_slipping_aircraft_leads_with_its_nose() -> None:
    direct = fixed_wing("slip", FREE, ZERO, 0.0, 45.0)
    led = fixed_wing("slip", FREE, ZERO, 0.0, 45.0)
    fly(direct, demand(Lateral.HEADING, 40.0), CALM, 15.0)
    fly(led, demand(Lateral.COURSE, 40.0), CALM, 15.0)
    assert degrees(atan_course(led.motion.velocity)) > degrees(atan_course(direct.motion.velocity)) + 3.0


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("climb", [-6.0, 6.0])
def test_it_climbs_as_demanded_and_keeps_its_airspeed(name: str, climb: float) -> None:
    plane = fixed_wing(name, FREE, Vec(0.0, 0.0, -500.0), 0.0, 45.0)
    fly(plane, demand(Lateral.HEADING, 0.0, climb), CALM, 20.0)
    assert -plane.motion.velocity.z == pytest.approx(climb, abs=0.05)
    assert plane.motion.airspeed == pytest.approx(45.0, abs=0.1)


def test_a_velocity_demand_is_flown_as_course_climb_and_airspeed() -> None:
    plane = fixed_wing("coordinated", FREE, ZERO, 0.0, 45.0)
    wanted = Vec(20.0, 35.0, -3.0)
    fly(plane, Demand(Lateral.VELOCITY, wanted, 0.0, 0.0, 0.0), Air(Vec(3.0, -4.0, 0.0), ZERO), 40.0)
    for found, expected in zip(plane.motion.velocity, wanted, strict=True):
        assert found == pytest.approx(expected, abs=0.2)


@pytest.mark.parametrize("name", ALL)
def test_the_size_of_the_caller_s_step_changes_nothing(name: str) -> None:
    whole = fixed_wing(name, FREE, ZERO, 0.0, 45.0)
    parts = fixed_wing(name, FREE, ZERO, 0.0, 45.0)
    air = Air(Vec(1.0, 2.0, 0.0), Vec(0.5, -1.0, 0.3))
    asked = demand(Lateral.COURSE, 50.0, 2.0)
    for _ in range(200):
        whole.step(asked, air, 0.05)
    for _ in range(1250):
        parts.step(asked, air, 0.008)
    for a, b in zip(whole.motion.position, parts.motion.position, strict=True):
        assert a == pytest.approx(b, abs=1e-6)


def test_airspeed_feels_the_gust_and_groundspeed_the_wind() -> None:
    plane = fixed_wing("nose", FREE, ZERO, 0.0, 45.0, Vec(8.0, 0.0, 0.0))
    motion = plane.step(demand(Lateral.HEADING, 0.0), Air(Vec(8.0, 0.0, 0.0), Vec(-3.0, 0.0, 0.0)), 0.01)
    assert motion.airspeed == pytest.approx(48.0, abs=0.05)
    assert norm(motion.velocity) == pytest.approx(53.0, abs=0.05)


angles = st.floats(-pi, pi)


@settings(max_examples=25, deadline=None)
@given(
    st.sampled_from(ALL),
    st.lists(
        st.tuples(
            st.sampled_from([Lateral.ROLL, Lateral.HEADING, Lateral.COURSE]),
            angles,
            st.floats(-40.0, 40.0),
            st.floats(0.0, 90.0),
            st.tuples(*[st.floats(-4.0, 4.0)] * 3),
        ),
        min_size=1,
        max_size=8,
    ),
)
def test_no_demand_and_no_gust_takes_it_out_of_its_limits(name: str, orders: list) -> None:  # type: ignore[type-arg]
    plane = fixed_wing(name, VehicleLimits(20.0, 50.0, radians(-20.0), radians(20.0)), ZERO, 0.0, 45.0)
    for kind, angle, climb, airspeed, gust in orders:
        asked = Demand(kind, ZERO, angle, climb, airspeed)
        for _ in range(30):
            plane.step(asked, Air(Vec(4.0, -3.0, 0.0), Vec(*gust)), 0.05)
            state = plane.state
            assert abs(degrees(state.pitch.surface)) <= 25.0 + 1e-9
            assert abs(degrees(state.yaw.surface)) <= 25.0 + 1e-9
            assert abs(degrees(state.pitch.angle)) <= 25.0
            assert abs(degrees(state.bank)) <= 45.0 + 1e-9
            assert 19.0 <= state.speed <= 51.0
            assert abs(plane.motion.yaw) <= pi


def test_gravity_turns_only_as_far_as_the_bank_limit() -> None:
    plane = fixed_wing("coordinated", FREE, ZERO, 0.0, 45.0)
    fly(plane, demand(Lateral.ROLL, 80.0), CALM, 5.0)
    assert degrees(plane.motion.roll) == pytest.approx(45.0, abs=0.1)
