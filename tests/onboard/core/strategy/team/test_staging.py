"""The ring's linear programme in closed form against SciPy's linprog, and its swings against brute force."""

from __future__ import annotations

from math import cos, hypot, inf, pi, sin

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linprog

from onboard.core.math.vectors import Vec, distance
from onboard.core.strategy.team.plan_types import Heights
from onboard.core.strategy.team.staging import flight, radius_at, ring_of, slots_of, stacked, swing

Array = NDArray[np.float64]


def least_cost(b: Array, d: Array, h: Array, ease: float) -> float:
    """The programme as a textbook would hand it to a solver, once for each member in front."""
    n = len(b)
    best = inf
    for front in range(n):
        rows, right = [], []
        for i in range(n):
            j = (i + 1) % n
            turn = 2.0 * pi if j == 0 else 0.0
            apart, order = np.zeros(n + 2), np.zeros(n + 2)
            apart[j] += 1.0
            apart[i] -= 1.0
            order[j] -= 1.0
            order[i] += 1.0
            apart[n] = -1.0
            rows += [apart, order]
            right += [h[i] + h[j] - turn, turn]
        for sign in (1.0, -1.0):
            off = np.zeros(n + 2)
            off[front] = sign
            off[n + 1] = -1.0
            rows.append(off)
            right.append(0.0)
        bounds = [(x - y, x + y) for x, y in zip(b, d, strict=True)]
        cost = np.r_[np.zeros(n), 1.0, 1.0]
        found = linprog(cost, A_ub=np.array(rows), b_ub=right, bounds=[*bounds, (-ease, None), (0, None)])
        if found.status == 0:
            best = min(best, found.fun)
    return best


@pytest.mark.parametrize("n", [2, 3, 4, 5, 8])
def test_ring_is_the_solution_of_the_linear_programme(n: int) -> None:
    rng = np.random.default_rng(n)
    for trial in range(12):
        b = np.sort(rng.uniform(-pi, pi, n))
        d = rng.uniform(0.0, rng.choice([0.2, 1.0, 3.0]), n)
        h = rng.uniform(0.2, 1.2, n) if trial % 2 else np.full(n, 0.87)
        ease = float(rng.uniform(0.0, 0.5))
        lows, highs, halves = (b - d).tolist(), (b + d).tolist(), h.tolist()
        ring = ring_of(lows, highs, halves, ease, True)
        s = max(ring.gap, -ease)
        assert s + abs(ring.off) == pytest.approx(least_cost(b, d, h, ease), abs=1e-7)
        x = slots_of(ring._replace(gap=s), b.tolist(), lows, highs, halves)
        assert x[ring.front] == pytest.approx(ring.off)
        for i in range(n):
            j = (i + 1) % n
            apart = x[j] - x[i] + (2.0 * pi if j == 0 else 0.0)
            assert abs(x[i] - b[i]) <= d[i] + 1e-9
            assert -1e-9 <= apart <= h[i] + h[j] + s + 1e-7


def test_a_closed_ring_with_one_in_front_stays_where_it_is() -> None:
    bearings = [-1.5, 0.0, 1.4, 3.0]
    lows, highs, halves = [b - 1.0 for b in bearings], [b + 1.0 for b in bearings], [0.9] * 4
    ring = ring_of(lows, highs, halves, 0.0, True)
    assert ring.off == 0.0
    assert slots_of(ring._replace(gap=0.0), bearings, lows, highs, halves) == pytest.approx(bearings)


@pytest.mark.parametrize("far", [300.0, 1499.0, 1501.0, 2500.0, 6000.0])
@pytest.mark.parametrize("reach", [0.0, 200.0, 1800.0, 4480.0])
def test_swing_is_the_farthest_bearing_that_is_reached(far: float, reach: float) -> None:
    """Against a search over all places within reach that are far enough out."""
    nearest = 1500.0
    farthest = 0.0
    for k in range(720):
        a = pi * k / 720
        for r in np.linspace(nearest, max(far, nearest) + reach, 300):
            if hypot(r * cos(a) - far, r * sin(a)) <= reach:
                farthest = a
                break
    found = swing(far, reach, nearest)
    assert found == pytest.approx(farthest, abs=0.02)
    if 0.0 < found < pi:
        slot = radius_at(far, found, nearest)
        assert slot >= nearest
        assert flight(far, found, nearest) <= reach + 1e-6


@pytest.mark.parametrize("seed", range(8))
def test_slots_keep_the_separation_of_each_other_by_their_heights(seed: int) -> None:
    """Slots of a plan lay 0, 9 and 15 m apart where two pursuers reach no other bearing in time."""
    rng = np.random.default_rng(seed)
    places = [Vec(*rng.uniform(-90.0, 90.0, 2).tolist(), -1500.0) for _ in range(4)]
    places.append(Vec(2e3, 0.0, -1500.0))
    heights = Heights(1450.0, 3000.0)
    found = stacked(places, 100.0, heights)
    assert found[4] == places[4]
    assert found[0] == places[0]
    for i in range(5):
        assert (found[i].x, found[i].y) == (places[i].x, places[i].y)
        assert heights.floor <= -found[i].z <= heights.ceiling
        assert all(distance(found[i], found[j]) >= 100.0 for j in range(i))
