"""From the game frame (north, east, down) to the viewers' world (east, north, up), and turns in it."""

from __future__ import annotations

from math import cos, pi, radians, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.recording.foxglove import Quaternion, attitude, enu, time_of, turn_to
from onboard.core.math.vectors import direction

Three = tuple[float, float, float]
ANGLES = st.floats(-pi, pi)


def turned(q: Quaternion, v: Three) -> Three:
    """q v q*."""
    tx, ty, tz = (2 * c for c in (q.y * v[2] - q.z * v[1], q.z * v[0] - q.x * v[2], q.x * v[1] - q.y * v[0]))
    return (
        v[0] + q.w * tx + q.y * tz - q.z * ty,
        v[1] + q.w * ty + q.z * tx - q.x * tz,
        v[2] + q.w * tz + q.x * ty - q.y * tx,
    )


def test_north_is_y_east_is_x_and_up_is_positive() -> None:
    place = enu((10.0, 20.0, -30.0))
    assert (place.x, place.y, place.z) == (20.0, 10.0, 30.0)
    assert (time_of(1_500_000_000).sec, time_of(1_500_000_000).nsec) == (1, 500_000_000)


@settings(max_examples=100, deadline=None)
@given(pitch=st.floats(-1.5, 1.5), yaw=ANGLES, roll=ANGLES)
def test_a_vehicles_nose_points_where_it_flies_whatever_its_roll(
    pitch: float, yaw: float, roll: float
) -> None:
    nose = turned(attitude(roll, pitch, yaw), (1.0, 0.0, 0.0))
    ahead = direction(pitch, yaw)
    assert nose == pytest.approx((ahead.y, ahead.x, -ahead.z), abs=1e-4)


def test_rolling_right_lowers_the_right_wing() -> None:
    left_wing = turned(attitude(radians(30.0), 0.0, 0.0), (0.0, 1.0, 0.0))  # heading north: left is west
    assert left_wing == pytest.approx((-cos(radians(30.0)), 0.0, sin(radians(30.0))), abs=1e-4)


@settings(max_examples=100, deadline=None)
@given(pitch=st.floats(-pi / 2, pi / 2), yaw=ANGLES, length=st.floats(0.1, 10.0))
def test_a_cones_axis_points_where_it_should(pitch: float, yaw: float, length: float) -> None:
    ahead = direction(pitch, yaw)
    axis = turned(turn_to((ahead.x * length, ahead.y * length, ahead.z * length)), (0.0, 0.0, 1.0))
    assert axis == pytest.approx((ahead.y, ahead.x, -ahead.z), abs=1e-4)


def test_no_direction_is_no_turn_and_straight_down_is_half_a_turn() -> None:
    assert turn_to((0.0, 0.0, 0.0)) == Quaternion()
    assert turned(turn_to((0.0, 0.0, 1.0)), (0.0, 0.0, 1.0)) == pytest.approx((0.0, 0.0, -1.0))
