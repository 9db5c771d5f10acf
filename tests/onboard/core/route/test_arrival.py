"""Paths that arrive at an instant: they lead where they should, are as long as asked, and turn no tighter."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onboard.core.math.angles import wrap
from onboard.core.route.arrival import Path, Pose, arrive, at

RADIUS, LEAST = 50.0, 60.0
places = st.floats(-200.0, 200.0)
headings = st.floats(-pi, pi)


def flown(path: Path) -> Pose:
    """Where a point ends that goes ahead and turns at the rate of the circle, in small steps."""
    x, y, heading = path.start
    steps = 20_000
    ds = path.length / steps
    legs = (
        (path.radius * abs(path.first), 1.0 if path.first >= 0.0 else -1.0),
        (path.straight, 0.0),
        (path.radius * abs(path.second), 1.0 if path.second >= 0.0 else -1.0),
        (path.last, 0.0),
    )
    ends, gone = [], 0.0
    for length, _ in legs:
        gone += length
        ends.append(gone)
    for k in range(steps):
        s = (k + 0.5) * ds
        side = next((side for end, (_, side) in zip(ends, legs, strict=True) if s <= end), 0.0)
        middle = heading + 0.5 * side * ds / path.radius
        x, y = x + ds * cos(middle), y + ds * sin(middle)
        heading += side * ds / path.radius
    return Pose(x, y, wrap(heading))


def test_a_path_flown_step_by_step_ends_where_it_should() -> None:
    goal = Pose(120.0, -80.0, 2.5)
    found = arrive(Pose(0.0, 0.0, 0.3), goal, RADIUS, 1000.0, LEAST)
    end = flown(found.path)
    assert found.exact
    assert found.path.length == pytest.approx(1000.0, abs=0.1)
    assert hypot(end.x - goal.x, end.y - goal.y) < 0.2
    assert abs(wrap(end.heading - goal.heading)) < 0.01


@given(places, places, headings, headings, st.floats(400.0, 3000.0))
def test_what_is_exact_arrives_in_time(x: float, y: float, old: float, new: float, length: float) -> None:
    start, goal = Pose(0.0, 0.0, old), Pose(x, y, new)
    found = arrive(start, goal, RADIUS, length, LEAST)
    end = at(found.path, found.path.length)
    assert hypot(end.x - x, end.y - y) < 1e-6
    assert abs(wrap(end.heading - new)) < 1e-9
    assert found.path.last >= LEAST
    if found.exact:
        assert found.path.length == pytest.approx(length, abs=1e-3 * RADIUS)
    if length > 2.0 * (hypot(x, y) + LEAST) + 6.0 * pi * RADIUS:
        assert found.exact, "who has time always has a way"


def test_of_points_along_a_path_none_jumps() -> None:
    path = arrive(Pose(0.0, 0.0, -1.0), Pose(-70.0, 40.0, 3.0), RADIUS, 900.0, LEAST).path
    before = at(path, -5.0)
    for k in range(-4, 910):
        here = at(path, float(k))
        assert hypot(here.x - before.x, here.y - before.y) == pytest.approx(1.0, abs=1e-3)
        assert abs(wrap(here.heading - before.heading)) <= 1.0 / RADIUS + 1e-9
        before = here


def test_without_time_it_is_the_shortest_way() -> None:
    found = arrive(Pose(0.0, 0.0, 0.0), Pose(300.0, 0.0, 0.0), RADIUS, 10.0, LEAST)
    assert not found.exact
    assert found.path.length == pytest.approx(300.0)
