"""The kinematic airframes keep their limits and drift with the wind."""

from __future__ import annotations

from math import atan, atan2, cos, hypot, pi, radians, sin, tan

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.angles import wrap
from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import ZERO, Vec, norm, sub
from onboard.game.scenario import Kind, VehicleSpec
from sim_bridge.vehicle.flight.kinematic import ability_of, crab, kinematic, start_motion
from sim_bridge.vehicle.motion import CALM, Air, Airframe, Demand, Lateral

DT = 0.02
COPTER = VehicleSpec(position=(0.0, 0.0, 50.0), speed=5.0, speed_max=8.0, acceleration=4.0)
PLANE = VehicleSpec(
    position=(0.0, 0.0, 100.0),
    speed=22.0,
    speed_min=10.0,
    speed_max=30.0,
    turn_rate_deg=40.0,
    pitch_min_deg=-20.0,
    pitch_max_deg=25.0,
    acceleration=4.0,
)
speeds = st.floats(-30.0, 30.0)


def copter() -> Airframe:
    return kinematic(
        COPTER, Kind.ARDUCOPTER, start_motion(COPTER.start(), 0.0, Kind.ARDUCOPTER, 5.0, CALM, True)
    )


def plane(air: Air = CALM) -> Airframe:
    return kinematic(
        PLANE, Kind.ARDUPLANE, start_motion(PLANE.start(), 0.0, Kind.ARDUPLANE, 22.0, air, True), air
    )


def velocity(v: Vec) -> Demand:
    return Demand(Lateral.VELOCITY, v, 0.0, 0.0, 0.0)


def flown(lateral: Lateral, angle: float, climb: float = 0.0, airspeed: float = 22.0) -> Demand:
    return Demand(lateral, ZERO, angle, climb, airspeed)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(speeds, speeds, speeds), min_size=1, max_size=8))
def test_a_multicopter_never_exceeds_its_speed_and_acceleration(
    targets: list[tuple[float, float, float]],
) -> None:
    airframe = copter()
    for target in targets:
        for _ in range(40):
            before = airframe.motion
            after = airframe.step(velocity(Vec(*target)), CALM, DT)
            assert norm(after.velocity) <= 8.0 + 1e-9
            assert norm(sub(after.velocity, before.velocity)) <= 4.0 * DT + 1e-9
            moved = sub(after.position, before.position)
            mean = Vec(*(0.5 * (a + b) * DT for a, b in zip(before.velocity, after.velocity, strict=True)))
            assert norm(sub(moved, mean)) < 1e-12


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from((Lateral.ROLL, Lateral.HEADING, Lateral.COURSE)),
            st.floats(-pi, pi),
            st.floats(-40, 40),
            st.floats(1, 60),
        ),
        min_size=1,
        max_size=8,
    ),
    st.floats(0, 8),
    st.floats(-pi, pi),
)
def test_a_plane_keeps_turn_rate_climb_angle_acceleration_and_speeds(
    demands: list[tuple[Lateral, float, float, float]], wind: float, towards: float
) -> None:
    air = Air(Vec(wind * cos(towards), wind * sin(towards), 0.0), ZERO)
    airframe = plane(air)
    for lateral, angle, climb, airspeed in demands:
        for _ in range(40):
            before = airframe.motion
            after = airframe.step(flown(lateral, angle, climb, airspeed), air, DT)
            through = sub(after.velocity, air.wind)
            assert norm(through) == pytest.approx(after.airspeed, abs=1e-9)
            assert 10.0 - 1e-9 <= after.airspeed <= 30.0 + 1e-9
            assert abs(after.airspeed - before.airspeed) <= 4.0 * DT + 1e-9
            assert abs(wrap(after.yaw - before.yaw)) <= radians(40.0) * DT + 1e-9
            assert radians(-20.0) - 1e-6 <= after.pitch <= radians(25.0) + 1e-6


def test_a_bank_turns_at_g_tan_phi_over_v_and_closes_the_circle() -> None:
    airframe, roll = plane(), radians(30.0)
    while airframe.motion.roll < roll:
        airframe.step(flown(Lateral.ROLL, roll), CALM, DT)
    start = airframe.motion
    period = 2.0 * pi * 22.0 / (STANDARD_GRAVITY * tan(roll))
    steps = 2000
    for _ in range(steps):
        airframe.step(flown(Lateral.ROLL, roll), CALM, period / steps)
    assert norm(sub(airframe.motion.position, start.position)) < 0.05
    assert wrap(airframe.motion.yaw - start.yaw) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("lateral", [Lateral.HEADING, Lateral.COURSE])
def test_in_a_crosswind_a_heading_drifts_and_a_course_does_not(lateral: Lateral) -> None:
    air = Air(Vec(0.0, 6.0, 0.0), ZERO)  # from the west
    airframe = plane(air)
    for _ in range(500):
        airframe.step(flown(lateral, radians(-20.0)), air, DT)
    v = airframe.motion.velocity
    course = atan2(v.y, v.x)
    if lateral == Lateral.COURSE:
        assert course == pytest.approx(radians(-20.0), abs=1e-3)
    else:
        assert airframe.motion.yaw == pytest.approx(radians(-20.0), abs=1e-3)
        assert course == pytest.approx(
            atan2(22 * sin(radians(-20.0)) + 6.0, 22 * cos(radians(-20.0))), abs=1e-3
        )


def test_the_wind_carries_a_plane_and_a_multicopter_leans_against_it() -> None:
    air = Air(Vec(3.0, 4.0, 0.0), ZERO)
    airframe, multicopter = plane(air), copter()
    for _ in range(500):
        airframe.step(flown(Lateral.HEADING, 0.0), air, DT)
        multicopter.step(velocity(ZERO), air, DT)
    assert airframe.motion.position.x == pytest.approx(250.0)
    assert airframe.motion.position.y == pytest.approx(40.0)
    assert norm(sub(multicopter.motion.position, COPTER.start())) < 3.0  # pushed, then stopped: 10 s
    assert norm(multicopter.motion.velocity) < 0.1
    assert multicopter.motion.airspeed == pytest.approx(5.0, abs=0.1)


def test_a_parked_plane_stands_in_the_wind_and_speeds_up_before_it_climbs() -> None:
    air = Air(Vec(-5.0, 0.0, 0.0), ZERO)
    start = start_motion(Vec(0.0, 0.0, 0.0), 0.0, Kind.ARDUPLANE, 22.0, air, False)
    airframe = kinematic(PLANE, Kind.ARDUPLANE, start, air)
    for _ in range(100):
        airframe.step(flown(Lateral.HEADING, 0.0, 0.0, 0.0), air, DT)
    assert airframe.motion == start
    while airframe.motion.airspeed < 9.9:
        airframe.step(flown(Lateral.HEADING, 0.0, 5.0), air, DT)
        assert airframe.motion.position.z == 0.0
    for _ in range(200):
        airframe.step(flown(Lateral.HEADING, 0.0, 5.0), air, DT)
    assert airframe.motion.position.z < -5.0


def test_a_plane_without_a_least_speed_stalls_below_two_fifths_of_its_speed() -> None:
    spec = VehicleSpec(position=(0.0, 0.0), speed=50.0)
    assert ability_of(spec, Kind.ARDUPLANE).speed_min == 20.0
    assert ability_of(spec, Kind.PX4).speed_min == 0.0


@settings(max_examples=100, deadline=None)
@given(st.floats(-pi, pi), st.floats(10, 50), st.floats(0, 9), st.floats(-pi, pi))
def test_crabbing_makes_the_course_good(course: float, airspeed: float, wind: float, towards: float) -> None:
    w = Vec(wind * cos(towards), wind * sin(towards), 0.0)
    heading = crab(course, airspeed, w)
    x, y = airspeed * cos(heading) + w.x, airspeed * sin(heading) + w.y
    assert abs(wrap(atan2(y, x) - course)) < 1e-6
    assert hypot(x, y) > 0.0


def test_the_same_demands_give_the_same_motion_to_the_last_bit() -> None:
    first, second = plane(), plane()
    for i in range(300):
        demand = flown(Lateral.ROLL, atan(0.01 * (i % 50)), 2.0 * sin(0.1 * i), 20.0 + i % 7)
        assert first.step(demand, CALM, DT) == second.step(demand, CALM, DT)
