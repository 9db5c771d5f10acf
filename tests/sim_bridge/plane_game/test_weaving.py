"""The weaving of pursuers is the strategy's own: it is there in simple motion, without noise or limits."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.game.scenario import load
from onboard.runtime.resources import configs
from tests.benchmarks.weaving import Restless, in_the_plane, restless


def test_a_straight_course_is_at_rest_and_a_zigzag_is_not() -> None:
    same = np.array(["a"] * 101)
    assert restless(np.full(101, 0.3), same, 10.0) == (0.0, 0.0, 0.0)
    circle = restless(np.linspace(0.0, 4.0 * np.pi, 101), same, 10.0)
    assert circle.reversals == 0.0
    assert circle.turned == pytest.approx(72.0)
    zigzag = restless(np.radians(5.0) * (np.arange(101) % 2), np.array(["a", "b"] * 50 + ["a"]), 10.0)
    assert zigzag.reversals == pytest.approx(9.9)
    assert zigzag.rules == 10.0


def test_the_strategies_alone_weave_twice_as_often_with_half_the_step_on_the_same_ways() -> None:
    """Which is how decisions at instants play a sliding motion along the surface where two rules meet."""
    demo = load(configs() / "scenarios" / "flight" / "demo.toml")
    _, coarse, ended = in_the_plane(demo, 0.1)
    _, fine, again = in_the_plane(demo, 0.05)
    assert coarse.reversals > 1.0
    for name in Restless._fields:
        assert 1.6 < getattr(fine, name) / getattr(coarse, name) < 2.6, name
    assert abs(again - ended) < 1.0
