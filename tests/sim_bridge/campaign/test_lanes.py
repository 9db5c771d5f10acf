"""Vehicles eight at a time: the numbers of one at a time, elementary functions and whole flights."""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple

import numpy as np
import pytest
from msgspec.structs import replace

from onboard.core.math.angles import wrap
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Scenario
from sim_bridge.campaign import lane_math
from sim_bridge.campaign.lanes import in_lanes, lane_normal, packing, twins
from sim_bridge.campaign.plane_in_wind import Flown, fly
from sim_bridge.campaign.spatial_campaign import play_drawn
from sim_bridge.campaign.spatial_draw import draw, spatial
from sim_bridge.campaign.spatial_fixed import plain
from sim_bridge.campaign.spatial_game import Evasion
from sim_bridge.draws import normal
from sim_bridge.vehicle.wind.dryden import power12

Function = Callable[[float], float]


@pytest.mark.parametrize(
    ("ours", "theirs", "low", "high", "ulps"),
    [
        (lane_math.lane_sin, math.sin, -100.0, 100.0, 2.0),
        (lane_math.lane_cos, math.cos, -100.0, 100.0, 2.0),
        (lane_math.lane_tan, math.tan, -1.57, 1.57, 4.0),
        (lane_math.lane_asin, math.asin, -1.0, 1.0, 2.0),
        (lane_math.lane_atan, math.atan, -50.0, 50.0, 4.0),
        (lane_math.lane_exp, math.exp, -700.0, 700.0, 2.0),
        (lane_math.lane_exp, math.exp, -1.0, 1.0, 2.0),
        (lane_math.lane_log, math.log, 1e-3, 4.0, 2.0),
        (lane_math.lane_log, math.log, 1e-300, 1e300, 2.0),
    ],
)
def test_elementary_functions(ours: Function, theirs: Function, low: float, high: float, ulps: float) -> None:
    rng = np.random.default_rng(3)
    numbers = [*rng.uniform(low, high, 4000).tolist(), low, high]
    for x in numbers:
        scale = max(math.ulp(theirs(x)), 2.0**-56)  # a root is as good as its argument's reduction
        assert abs(float(ours(x)) - theirs(x)) <= ulps * scale, x


def test_small_numbers_keep_their_digits() -> None:
    for x in (0.0, 1e-300, -1e-12, 3e-5):
        for ours, theirs in (
            (lane_math.lane_sin, math.sin),
            (lane_math.lane_tan, math.tan),
            (lane_math.lane_asin, math.asin),
            (lane_math.lane_atan, math.atan),
        ):
            assert float(ours(x)) == pytest.approx(theirs(x), rel=1e-15, abs=0.0)


def test_the_same_direction_and_the_same_normal_numbers() -> None:
    rng = np.random.default_rng(4)
    for angle in rng.uniform(-400.0, 400.0, 1000).tolist():
        assert lane_math.lane_wrap(angle) == pytest.approx(wrap(angle), abs=1e-13)
    words = [0, 1, 2**32 - 1, *rng.integers(0, 2**32, 2000).tolist()]
    for word in words:
        assert lane_normal(np.int64(word)) == pytest.approx(normal(word), rel=1e-14)


def test_the_power_of_the_scale_lengths() -> None:
    for x in np.linspace(0.17, 1.1, 200).tolist():
        assert lane_math.lane_power12(x) == pytest.approx(power12(x), rel=1e-14)


def leaves(value: object) -> list[object]:
    return [x for part in value for x in leaves(part)] if isinstance(value, tuple) else [value]


def test_a_start_holds_plain_numbers_equal_to_those_it_was_made_of() -> None:
    class Kind(IntEnum):
        A = 3

    class Held(NamedTuple):
        kind: int
        far: tuple[float, Kind]

    found = plain(Held(Kind.A, (1.5, Kind.A)))
    assert found == Held(3, (1.5, 3))  # type: ignore[arg-type]
    assert [type(x) for x in leaves(found)] == [int, float, int]
    start = draw(spatial("five"), 1, 0.2, compiled=False).start
    assert {type(x) for x in leaves(start)} == {int, float, bool}


class Leaf(NamedTuple):
    number: float
    count: int


class Tree(NamedTuple):
    place: Vec
    leaves: tuple[Leaf, Leaf]


def test_a_value_comes_back_from_its_lane_and_touches_no_other() -> None:
    tree = Tree(Vec(1.0, 2.0, 3.0), (Leaf(4.0, 5), Leaf(6.0, 7)))
    way = packing(Tree, 8)
    assert way.width == 7
    array = np.zeros((2, 56))
    way.store(array, 1, 3, tree)
    assert way.load(array, 1, 3) == tree
    assert np.flatnonzero(array).tolist() == list(range(59, 112, 8))

    class Bad(NamedTuple):
        words: list[int]

    with pytest.raises(ValueError, match=r"v\.words: found list\[int\], expected a number"):
        packing(Bad, 8)


def test_a_twin_has_the_code_of_its_original_over_other_functions() -> None:
    twin = in_lanes(fly)
    assert twin is in_lanes(fly)
    assert twin in twins()
    assert twin.__code__ is fly.__code__  # type: ignore[attr-defined]
    assert twin.__globals__["step_plane"].__globals__["sin"] is lane_math.lane_sin  # type: ignore[attr-defined]
    number = 1.0

    def closed(x: float) -> float:
        return x + number

    closed.__module__ = "sim_bridge.campaign.lanes"
    with pytest.raises(ValueError, match="found a closure"):
        in_lanes(closed)


def flat(value: object) -> list[float]:
    return [x for part in value for x in flat(part)] if isinstance(value, tuple) else [float(value)]  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def five() -> Scenario:
    """Of a game that test_spatial_game.py plays, too: its kernels are compiled once for both."""
    found = spatial("five")
    return replace(found, parameters=replace(found.parameters, horizon=10.0))


@pytest.mark.timeout(480)
def test_a_game_in_lanes_is_that_of_one_vehicle_at_a_time(five: Scenario) -> None:
    lanes, single = (draw(five, 3, 2.0, compiled) for compiled in (True, False))
    for a, b in zip(lanes.players, single.players, strict=True):
        assert isinstance(a, Flown)
        np.testing.assert_allclose(flat(a), flat(b), rtol=1e-12, atol=1e-12)
    for mine, theirs in zip(lanes.tracks, single.tracks, strict=True):
        np.testing.assert_allclose(mine, theirs, rtol=1e-12, atol=1e-12)
    a, b = play_drawn(lanes, Evasion.STRATEGY, True), play_drawn(single, Evasion.STRATEGY, False)
    assert (a.verdict, a.time) == (b.verdict, pytest.approx(b.time, abs=1e-12))
    assert len(a.log) > 100
    np.testing.assert_allclose(a.log, b.log, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(a.play.envelope, b.play.envelope, rtol=1e-12)
    assert (a.reversals, a.decided_reversals) == (b.reversals, b.decided_reversals)
