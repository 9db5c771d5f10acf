"""Random situations for property tests."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

from hypothesis import strategies as st

from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import ZERO, Vec, norm, scale

coordinate = st.floats(-500.0, 500.0)
angle = st.floats(-pi, pi)


@st.composite
def points(draw: st.DrawFn, planar: bool = False) -> Vec:
    """A place within half a kilometre."""
    return Vec(draw(coordinate), draw(coordinate), 0.0 if planar else draw(coordinate))


@st.composite
def headings(draw: st.DrawFn, planar: bool = False) -> Vec:
    """A unit vector, uniform enough."""
    yaw = draw(angle)
    z = 0.0 if planar else draw(st.floats(-1.0, 1.0))
    r = sqrt(max(0.0, 1.0 - z * z))
    u = Vec(r * cos(yaw), r * sin(yaw), z)
    return scale(u, 1.0 / norm(u))


@st.composite
def pursuers(draw: st.DrawFn, planar: bool = False, most: int = 7) -> tuple[Vehicle, ...]:
    """One to `most` pursuers, slower than an evader of 5 m/s, none at the origin."""
    count = draw(st.integers(1, most))
    found = []
    for _ in range(count):
        way = draw(headings(planar))
        far = draw(st.floats(0.5, 300.0))
        found.append(Vehicle(scale(way, far), ZERO, draw(st.floats(0.0, 4.9))))
    return tuple(found)
