"""Closed forms against independent numerical minimisation."""

from __future__ import annotations

from math import asin, cos, pi, sin, sqrt

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq, minimize_scalar

from onboard.core.geometry.apollonius import apollonius_sphere, closest_approach, intercept
from onboard.core.math.vectors import NORTH, ZERO, Vec, along, angle_between, distance, scale, sub, unit
from tests.support.random_situations import headings, points

speeds = st.floats(0.2, 10.0)


def left_after(e: Vec, heading: Vec, v_e: float, p: Vec, v_p: float, t: float) -> float:
    """Distance that a pursuer heading for the evader's place at t has left then."""
    return distance(along(e, heading, v_e * t), p) - v_p * t


@settings(max_examples=2000, deadline=None)
@given(points(), headings(), speeds, points(), speeds)
def test_intercept_is_the_first_meeting_that_a_scan_finds(e, heading, v_e, p, v_p):
    assume(distance(e, p) > 1e-3)
    meeting = intercept(e, heading, v_e, p, v_p)
    horizon = 50.0 * distance(e, p) / max(abs(v_e - v_p), 0.05)
    times = [horizon * (k / 400.0) ** 3 for k in range(401)]
    gaps = [left_after(e, heading, v_e, p, v_p, t) for t in times]
    crossing = next((k for k in range(400) if gaps[k + 1] <= 0.0), None)
    if crossing is None:
        if meeting.exists:  # the meeting is a touch, or lies beyond the scan
            reach = abs(left_after(e, heading, v_e, p, v_p, meeting.time))
            assert reach < 1e-6 * (1.0 + v_e * meeting.time)
        return
    assert meeting.exists
    first = brentq(lambda t: left_after(e, heading, v_e, p, v_p, t), times[crossing], times[crossing + 1])
    # Near a touch both roots lie close together and the scan may see the second; never an earlier one.
    assert meeting.time <= first * (1.0 + 1e-6) + 1e-9
    left = left_after(e, heading, v_e, p, v_p, meeting.time)
    assert left == pytest.approx(0.0, abs=1e-6 * (1 + v_e * first))
    assert distance(meeting.point, along(e, heading, v_e * meeting.time)) < 1e-9 * (1 + v_e * meeting.time)


@settings(max_examples=1500, deadline=None)
@given(points(), headings(), speeds, points(), st.floats(0.01, 0.98))
def test_closest_approach_is_the_minimum_over_all_times(e, heading, v_e, p, gamma):
    v_p = gamma * v_e
    d = distance(e, p)
    assume(d > 1.0)
    meeting = closest_approach(e, heading, v_e, p, v_p)
    if intercept(e, heading, v_e, p, v_p).exists or not meeting.exists:
        return
    # Whatever the pursuer does, it is left with |e(t) − p| − v_p t at the time t it aims for.
    bound = 4.0 * d / (v_e * sqrt(1.0 - gamma * gamma))
    found = minimize_scalar(
        lambda t: left_after(e, heading, v_e, p, v_p, t),
        bounds=(0.0, bound),
        method="bounded",
        options={"xatol": 1e-10 * bound},
    )
    assert meeting.miss == pytest.approx(found.fun, abs=1e-6 * d)
    assert meeting.time == pytest.approx(found.x, rel=1e-3, abs=1e-3 * d / v_e)


@settings(max_examples=1000, deadline=None)
@given(headings(), points(), speeds, st.floats(0.05, 0.95))
def test_the_corrected_19_agrees_with_the_closed_form(heading, p, v_e, gamma):
    """(19) with the factor v_e that print lost, at the optimal heading u of (20)."""
    v_p = gamma * v_e
    meeting = closest_approach(ZERO, heading, v_e, p, v_p)
    assume(meeting.exists and meeting.miss > 1e-3 and distance(ZERO, p) > 1.0)
    u = unit(sub(meeting.point, p), heading)
    line = sub(ZERO, p)
    f = sub(scale(u, v_p), scale(heading, v_e))
    top = line.x * f.x + line.y * f.y + line.z * f.z
    along_u = heading.x * u.x + heading.y * u.y + heading.z * u.z
    bottom = v_p * v_p + v_e * v_e - 2.0 * v_p * v_e * along_u
    assert top / bottom == pytest.approx(meeting.time, rel=1e-6, abs=1e-7)


@settings(max_examples=500, deadline=None)
@given(points(), points(), speeds, speeds, headings())
def test_both_players_reach_the_sphere_at_the_same_time(e, p, v_e, v_p, way):
    sphere = apollonius_sphere(e, v_e, p, v_p)
    assume(sphere.exists and abs(v_e - v_p) > 0.05 * v_e)
    place = along(sphere.centre, way, sphere.radius)
    assert distance(place, e) / v_e == pytest.approx(distance(place, p) / v_p, rel=1e-6, abs=1e-6)


def test_the_sphere_seen_from_the_evader():
    """Centre at d/(1−γ²) along e→p, radius γd/(1−γ²)."""
    sphere = apollonius_sphere(ZERO, 5.0, Vec(36.0, 0.0, 0.0), 4.0)
    assert sphere.centre.x == pytest.approx(100.0)
    assert sphere.radius == pytest.approx(80.0)


def test_an_intercept_exists_up_to_the_angle_asin_gamma():
    edge = asin(0.8)
    for turn, meets in ((edge - 1e-6, True), (edge + 1e-6, False)):
        assert intercept(ZERO, Vec(cos(turn), sin(turn), 0.0), 5.0, Vec(30.0, 0.0, 0.0), 4.0).exists == meets


@pytest.mark.parametrize("v_p", [5.0 * (1.0 - 1e-9), 5.0, 5.0 * (1.0 + 1e-9)])
def test_equal_speeds_meet_in_the_middle_of_the_way(v_p):
    meeting = intercept(ZERO, NORTH, 5.0, Vec(60.0, 80.0, 0.0), v_p)
    assert meeting.exists
    assert meeting.time == pytest.approx(100.0 * 100.0 / (2.0 * 5.0 * 60.0), rel=1e-6)


def test_a_slower_evader_is_always_met_also_from_behind():
    for turn in (0.0, 1.0, 2.0, pi):
        meeting = intercept(ZERO, Vec(cos(turn), sin(turn), 0.0), 4.0, Vec(50.0, 0.0, 0.0), 5.0)
        assert meeting.exists
        assert distance(meeting.point, Vec(50.0, 0.0, 0.0)) == pytest.approx(5.0 * meeting.time)


def test_equal_speeds_and_a_fleeing_evader_never_meet():
    assert not intercept(ZERO, NORTH, 5.0, Vec(-50.0, 0.0, 0.0), 5.0).exists
    assert not closest_approach(ZERO, NORTH, 5.0, Vec(-50.0, 0.0, 0.0), 5.0).exists


def test_a_pursuer_at_rest_is_met_only_head_on_and_else_passed_at_the_foot():
    assert intercept(ZERO, NORTH, 5.0, Vec(50.0, 0.0, 0.0), 0.0).time == pytest.approx(10.0)
    assert not intercept(ZERO, NORTH, 5.0, Vec(50.0, 1.0, 0.0), 0.0).exists
    passed = closest_approach(ZERO, NORTH, 5.0, Vec(50.0, 1.0, 0.0), 0.0)
    assert (passed.time, passed.miss) == (pytest.approx(10.0), pytest.approx(1.0))


def test_an_evader_at_rest_is_met_straight():
    assert intercept(ZERO, NORTH, 0.0, Vec(0.0, 50.0, 0.0), 4.0).time == pytest.approx(12.5)
    assert not closest_approach(ZERO, NORTH, 0.0, Vec(0.0, 50.0, 0.0), 4.0).exists


def test_players_in_one_place_have_met():
    assert intercept(ZERO, NORTH, 5.0, ZERO, 4.0) == (True, 0.0, ZERO, 0.0)


def test_opposite_directions_have_no_closest_approach_ahead():
    meeting = closest_approach(ZERO, NORTH, 5.0, Vec(-50.0, 10.0, 0.0), 4.0)
    assert not meeting.exists


def test_the_integral_cost_of_10_has_another_optimum_than_19_and_20():
    """(10) minimises ∫d² up to its T, (19)–(20) the final distance: the optima differ.

    The evader passes at an angle that cannot be intercepted. Heading for the closest approach
    leaves the smallest distance in the end; a pursuer that minimises the integral leans towards
    the evader's present place, because early distance counts as much as late.
    """
    p, heading, v_e, v_p = Vec(60.0, 100.0, 0.0), NORTH, 5.0, 2.0
    best = closest_approach(ZERO, heading, v_e, p, v_p)
    T = best.time

    def motion(yaw: float, t: float) -> float:
        return distance(Vec(v_e * t, 0.0, 0.0), Vec(p.x + v_p * t * cos(yaw), p.y + v_p * t * sin(yaw), 0.0))

    def integral(yaw: float) -> float:
        steps = 400
        return sum(motion(yaw, T * (k + 0.5) / steps) ** 2 for k in range(steps)) * T / steps

    options = {"xatol": 1e-9}
    final = minimize_scalar(lambda y: motion(y, T), bounds=(-pi, 0.0), method="bounded", options=options)
    whole = minimize_scalar(integral, bounds=(-pi, 0.0), method="bounded", options=options)
    aim = unit(sub(best.point, p), heading)
    by_integral = Vec(cos(whole.x), sin(whole.x), 0.0)
    assert angle_between(aim, Vec(cos(final.x), sin(final.x), 0.0)) < 1e-4
    assert motion(final.x, T) == pytest.approx(best.miss, abs=1e-6)
    assert angle_between(aim, by_integral) > 0.05
    assert integral(whole.x) < integral(final.x)
    assert motion(whole.x, T) > best.miss + 0.01
    present = unit(sub(ZERO, p), heading)
    assert angle_between(by_integral, present) < angle_between(aim, present)
