"""The Hungarian method against SciPy's, with ties, forbidden tasks and more tasks than members."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from onboard.core.strategy.team.assignment import FORBIDDEN, assigned, total


def demand_cheapest(matrix: NDArray[np.float64]) -> None:
    members, tasks = matrix.shape
    costs = [float(cost) for cost in matrix.ravel()]
    found = assigned(costs, members, tasks)
    assert len(set(found)) == members
    assert all(0 <= task < tasks for task in found)
    rows, columns = linear_sum_assignment(matrix)
    assert total(costs, tasks, found) == pytest.approx(float(matrix[rows, columns].sum()), rel=1e-12)


@pytest.mark.parametrize("members", [1, 2, 3, 5, 8, 13, 30])
@pytest.mark.parametrize("more", [0, 1, 4])
def test_random_costs(members: int, more: int) -> None:
    rng = np.random.default_rng([members, more])
    for _ in range(20):
        demand_cheapest(rng.normal(size=(members, members + more)) * 10.0 ** rng.integers(-3, 6))


@pytest.mark.parametrize("size", [2, 4, 8])
def test_ties_zeros_and_forbidden_tasks(size: int) -> None:
    rng = np.random.default_rng(size)
    demand_cheapest(np.zeros((size, size)))
    demand_cheapest(np.ones((size, size + 2)))
    for _ in range(30):
        demand_cheapest(rng.integers(0, 3, (size, size)).astype(float))
        barred = np.where(rng.random((size, size + 1)) < 0.4, FORBIDDEN, rng.random((size, size + 1)))
        demand_cheapest(barred)


def test_every_permutation_of_four() -> None:
    rng = np.random.default_rng(7)
    costs = rng.random((4, 4))
    flat = [float(cost) for cost in costs.ravel()]
    best = min(permutations(range(4)), key=lambda p: sum(costs[i, p[i]] for i in range(4)))
    assert assigned(flat, 4, 4) == list(best)
    assert assigned(flat, 4, 4) == assigned(list(flat), 4, 4)
