"""Values of the classical problems against optimisation that knows their rules and not their formulas."""

from __future__ import annotations

from math import asin, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize, minimize_scalar

from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import DOWN, ZERO, Vec, distance
from sim_bridge.classic.values.escort import escort, flag_return
from sim_bridge.classic.values.hull import depth
from sim_bridge.classic.values.regions import balls_of, farthest_from, lowest, nearest_to
from sim_bridge.classic.values.rim import breach

RNG = np.random.default_rng(19)
CASES = range(12)


def vehicle(place: NDArray[np.float64], speed: float) -> Vehicle:
    return Vehicle(Vec(*(float(x) for x in place)), ZERO, speed)


def game(seed: int, pursuers: int, space: bool = False) -> tuple[Vehicle, tuple[Vehicle, ...]]:
    rng = np.random.default_rng(seed)
    shape = np.array([1.0, 1.0, 1.0 if space else 0.0])
    team = tuple(vehicle(rng.uniform(-100, 100, 3) * shape, rng.uniform(9, 14)) for _ in range(pursuers))
    return vehicle(rng.uniform(-30, 30, 3) * shape, 8.0), team


def caught_after(e: Vehicle, p: Vehicle, heading: float) -> float:
    """When a pursuer first can be where an evader is that flies straight: a root, not a formula."""

    def late(t: float) -> float:
        x = e.position.x + e.speed * t * cos(heading), e.position.y + e.speed * t * sin(heading)
        return hypot(x[0] - p.position.x, x[1] - p.position.y) - p.speed * t

    return float(brentq(late, 0.0, 1e3))


@pytest.mark.parametrize("seed", CASES)
def test_the_cutters_catch_the_ship_as_late_as_any_heading_allows(seed: int) -> None:
    e, team = game(seed, 2)

    def lived(heading: float) -> float:
        return min(caught_after(e, p, heading) for p in team)

    coarse = max(np.linspace(-pi, pi, 181), key=lived)
    best = minimize_scalar(lambda h: -lived(h), bounds=(coarse - 0.04, coarse + 0.04), method="bounded",
                           options={"xatol": 1e-10})  # fmt: skip
    value = distance(farthest_from(e.position, balls_of(e, team)), e.position) / e.speed
    assert value == pytest.approx(-best.fun, rel=1e-5)


def first_at(e: Vehicle, team: tuple[Vehicle, ...], x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of each pursuer: how much later than the evader it is at a place, times both speeds."""
    d = float(np.linalg.norm(x - e.position))
    return np.array([float(np.linalg.norm(x - p.position)) * e.speed - d * p.speed for p in team])


@pytest.mark.parametrize(("seed", "pursuers", "space"), [*((s, 5, False) for s in range(8)),
                                                         *((s, 2, True) for s in range(8))])  # fmt: skip
def test_the_lowest_point_is_the_lowest_that_the_evader_reaches_first(
    seed: int, pursuers: int, space: bool
) -> None:
    e, team = game(seed, pursuers, space)
    down = DOWN if space else Vec(-1.0, 0.0, 0.0)
    bounds = [(None, None), (None, None), (None, None) if space else (0.0, 0.0)]
    found = minimize(
        lambda x: -float(np.dot(x, down)), np.array(e.position), bounds=bounds, method="SLSQP",
        constraints={"type": "ineq", "fun": lambda x: first_at(e, team, x)},
        options={"ftol": 1e-10, "maxiter": 300},
    )  # fmt: skip
    assert first_at(e, team, found.x).min() > -1e-5
    place = lowest(balls_of(e, team), down, e.position)
    assert np.dot(place, down) == pytest.approx(-found.fun, abs=1e-3)


@pytest.mark.parametrize("seed", CASES)
def test_a_disc_is_defended_at_the_nearest_point_that_the_attacker_reaches_first(seed: int) -> None:
    e, team = game(seed, 1)
    centre = np.array([400.0, 300.0, 0.0])
    found = minimize(
        lambda x: float(np.linalg.norm(x - centre)), np.array(e.position),
        bounds=[(None, None), (None, None), (0, 0)],
        constraints={"type": "ineq", "fun": lambda x: first_at(e, team, x)}, method="SLSQP",
        options={"ftol": 1e-12, "maxiter": 300},
    )  # fmt: skip
    place = nearest_to(Vec(*centre), balls_of(e, team)[0])
    assert np.linalg.norm(np.array(place) - centre) == pytest.approx(found.fun, abs=1e-3)


@pytest.mark.parametrize("seed", CASES)
def test_the_escorted_target_gets_the_saddle_of_all_aims_and_headings(seed: int) -> None:
    """All meeting points of attacker and defender against all headings of the target, on a grid."""
    rng = np.random.default_rng(seed)
    a, alpha = float(rng.uniform(50, 150)), float(rng.uniform(0.2, 0.8))
    own_side = seed % 2 == 0
    x, y = float(rng.uniform(-80, -5) if own_side else rng.uniform(2, 25)), float(rng.uniform(-80, 80))
    aims, headings = np.linspace(-400, 400, 1601), np.linspace(-pi, pi, 720, endpoint=False)
    run = alpha * np.hypot(a, aims)[:, None]
    left = np.hypot(x + run * np.cos(headings), y + run * np.sin(headings) - aims[:, None])
    if own_side:  # the attacker chooses last against a target that answers: least of the greatest
        assert escort(a, x, y, alpha).value == pytest.approx(left.max(axis=1).min(), abs=0.05)
        return
    value = max(alpha * hypot(a, s) - hypot(s - y, x) for s in aims)  # how far past the point it has flown
    assert escort(a, x, y, alpha).value == pytest.approx(value, abs=0.05)


def test_a_target_on_the_bisector_is_met_where_its_value_is_the_same_from_both_sides() -> None:
    """Closed form for x = 0, y = 0: the attacker comes straight, and the target has flown α a away."""
    assert escort(100.0, 0.0, 0.0, 0.5).value == pytest.approx(50.0, abs=1e-6)
    assert escort(100.0, 1e-9, 0.0, 0.5).value == pytest.approx(50.0, abs=1e-3)


@pytest.mark.parametrize("seed", range(3))
def test_the_flag_comes_as_near_to_home_as_any_way_back_from_the_best_place(seed: int) -> None:
    rng = np.random.default_rng(seed)
    east, north, time = float(rng.uniform(120, 250)), float(rng.uniform(-80, 80)), float(rng.uniform(5, 11))
    v_a, v_d = 8.0, 10.0
    headings = np.linspace(-pi, pi, 241)

    def nearest_home(bearing: float) -> float:
        """The least north over straight ways back, each until a defender from there can be at it."""
        n, e = north + v_d * time * cos(bearing), east + v_d * time * sin(bearing)
        defender, attacker = Vehicle(Vec(n, e, 0.0), ZERO, v_d), Vehicle(ZERO, ZERO, v_a)
        return min(v_a * caught_after(attacker, defender, h) * cos(h) for h in headings)

    best = max(nearest_home(b) for b in np.linspace(-pi, pi, 31))
    found = flag_return(east, north, time, (v_a, v_d))
    assert found.north >= best - 0.02
    assert found.north == pytest.approx(nearest_home(found.bearing), abs=0.05)


@pytest.mark.parametrize("ratio", [0.3, 0.8, 1.0])
def test_the_breach_is_the_best_of_all_points_that_a_straight_path_reaches(ratio: float) -> None:
    r, between = 2.5, 0.7
    angles = np.linspace(0.0, np.arccos(1.0 / r), 20001)  # beyond, the path would cross the circle
    path = np.hypot(r - np.cos(angles), np.sin(angles))
    best = (between + angles - path / ratio).max()
    found = breach(r, between, ratio)
    assert found.value == pytest.approx(best, abs=1e-6)
    assert r * sin(found.angle) / found.path == pytest.approx(ratio)  # the path meets the rim at acos(ratio)


@pytest.mark.parametrize("seed", CASES)
def test_the_depth_is_the_least_number_ahead_over_all_headings(seed: int) -> None:
    rng = np.random.default_rng(seed)
    places = rng.normal(0.0, 50.0, (int(rng.integers(1, 9)), 2))
    headings = np.linspace(-pi, pi, 7200)
    ahead = places @ np.stack([np.cos(headings), np.sin(headings)]) > 0.0
    found = depth(ZERO, tuple(Vec(float(x), float(y), 0.0) for x, y in places))
    assert found.ahead == ahead.sum(axis=0).min()
    assert sum(x * found.way.x + y * found.way.y > 0.0 for x, y in places) == found.ahead


def test_figures_that_follow_from_the_literature_by_hand() -> None:
    """Symmetric cases whose answer needs no search."""
    e, w, d = Vehicle(ZERO, ZERO, 8.0), 0.8, 60.0
    pair = tuple(Vehicle(Vec(0.0, side * d, 0.0), ZERO, 10.0) for side in (-1.0, 1.0))
    on_axis = d * w / sqrt(1.0 - w * w)  # |X − E| = w |X − P| on the bisector
    assert distance(farthest_from(ZERO, balls_of(e, pair)), ZERO) == pytest.approx(on_axis)
    alone = farthest_from(ZERO, balls_of(e, pair[:1]))
    assert distance(alone, ZERO) / 8.0 == pytest.approx(d / (10.0 - 8.0))  # one cutter: a stern chase
    assert distance(alone, ZERO) > on_axis
    assert breach(1.0 + 1e-12, 0.4, 0.5).value == pytest.approx(0.4, abs=1e-5)  # it stands on the rim
    assert asin(w) < pi / 2  # the pair leaves the axis free: it is caught there by both at once
