"""Edges come in their order, the nearest first, in whatever portions they are looked up."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from onboard.core.geometry.edges import _nearest_four
from onboard.core.geometry.rims import Rim


@given(st.lists(st.sampled_from([-1.0, -0.5, 0.0, 0.25, 0.5, 0.5000001, 1.0]), min_size=1, max_size=30))
def test_four_at_a_time_is_the_order_of_a_stable_sort(nears: list[float]) -> None:
    rims = [Rim(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, near) for near in nears]
    came: list[int] = []
    near, index = 2.0, -1
    while True:
        four = [k for k in _nearest_four(near, index, rims, len(rims)) if k >= 0]
        came += four
        if len(four) < 4:
            break
        near, index = nears[four[-1]], four[-1]
    assert came == sorted(range(len(nears)), key=lambda k: -nears[k])
