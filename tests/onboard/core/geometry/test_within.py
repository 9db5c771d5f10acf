"""The limits alone: a search that takes nothing else in finds what the whole search does, to the last bit."""

from __future__ import annotations

from math import pi

from hypothesis import given
from hypothesis import strategies as st

from onboard.core.geometry.cones import NOTHING
from onboard.core.geometry.free_ray import free_ray_limited, within
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import NORTH, Vec, unit

AXIS = st.sampled_from([-1.0, 0.0, 1.0]) | st.floats(-1.0, 1.0)


@given(
    st.tuples(AXIS, AXIS, AXIS),
    st.sampled_from([-pi, 0.0, 0.5]) | st.floats(-pi, pi),
    st.sampled_from([2.0 * pi, pi, -0.1]) | st.floats(0.0, 2.0 * pi),
    st.just(-pi / 2) | st.floats(-pi / 2, 0.0),
    st.just(pi / 2) | st.floats(0.0, pi / 2),
    st.booleans(),
)
def test_within_the_limits_is_the_free_ray_where_nobody_blocks(
    way: tuple[float, float, float], yaw: float, width: float, low: float, high: float, planar: bool
) -> None:
    wanted = unit(Vec(way[0], way[1], 0.0 if planar else way[2]), NORTH)
    limits = VehicleLimits(0.0, 1e9, low, high, yaw, yaw + width)
    assert within(wanted, limits, planar) == free_ray_limited(wanted, (NOTHING,), limits, planar).direction
