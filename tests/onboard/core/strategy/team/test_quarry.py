"""Who goes for whom: SciPy as the oracle, bands closed first, no needless change, no way too far."""

from __future__ import annotations

from math import asin, ceil, cos, inf, pi, sin

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from onboard.core.game.rules import NO_TARGET, Rules, Target
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, Vec, distance, scale
from onboard.core.strategy.team.plan_types import NOBODY, Member
from onboard.core.strategy.team.quarry import (
    BEYOND,
    KEEP,
    Quarry,
    late,
    nearest,
    needed_there,
    quarries_of,
    shares,
    time_to_catch,
)

RULES = Rules(2.0, 4.0, planar=True, target_known=True)
LONG = 1e6


def pursuer(x: float, y: float, speed: float = 4.0, fit: bool = True) -> Member:
    return Member(Vehicle(Vec(x, y, 0.0), scale(NORTH, speed), speed), FREE, fit)


def evader(x: float, y: float, goal: Vec | None = None, speed: float = 5.0, live: bool = True) -> Quarry:
    target = NO_TARGET if goal is None else Target(True, goal)
    return Quarry(Vehicle(Vec(x, y, 0.0), scale(NORTH, speed), speed), FREE, live, target)


def random_case(seed: int) -> tuple[tuple[Member, ...], tuple[Quarry, ...], tuple[int, ...]]:
    rng = np.random.default_rng(seed)
    team = tuple(
        pursuer(*rng.uniform(-300, 300, 2).tolist(), float(rng.uniform(2.0, 7.0)), bool(rng.random() < 0.9))
        for _ in range(rng.integers(2, 13))
    )
    many = int(rng.integers(2, 5))
    quarries = tuple(
        evader(*rng.uniform(-200, 200, 2).tolist(),
               Vec(*rng.uniform(-300, 300, 2).tolist(), 0.0) if rng.random() < 0.7 else None,
               float(rng.uniform(3.0, 6.0)), bool(rng.random() < 0.85))
        for _ in range(many)
    )  # fmt: skip
    return team, quarries, tuple(int(k) for k in rng.integers(-1, many, len(team)))


@pytest.mark.parametrize("seed", range(60))
def test_the_assignment_is_scipys(seed: int) -> None:
    """SciPy is given a column for each place that is needed, and beyond one for each at each evader."""
    team, quarries, before = random_case(seed)
    found = quarries_of(team, quarries, before, RULES, LONG)
    fit = [i for i, member in enumerate(team) if member.fit]
    there = [j for j, quarry in enumerate(quarries) if quarry.live]
    assert all(found[i] == NOBODY for i in range(len(team)) if i not in fit or not there)
    if len(there) < 2 or not fit:
        assert {found[i] for i in fit} <= set(there or [NOBODY])
        return
    given = [nearest(m.vehicle, quarries, k) if m.fit else NOBODY for m, k in zip(team, before, strict=True)]
    stays = needed_there(given, team, quarries, RULES)
    assert all(found[i] == given[i] for i in fit if stays[i])
    free = [i for i in fit if not stays[i]]
    held = [sum(stays[i] and given[i] == j for i in fit) for j in range(len(quarries))]
    share = shares(team, quarries, held, len(free), RULES)
    columns = [(j, True) for j in there for _ in range(share[j])] + [(j, False) for j in there for _ in free]

    def cost(i: int, j: int, wanted: bool) -> float:
        own, kept = team[i].vehicle, KEEP if before[i] == j else 1.0
        tardy = 1e6 if late(own, quarries[j], LONG) else 0.0
        if wanted:
            return time_to_catch(own, quarries[j]) * kept + tardy
        return distance(own.position, quarries[j].vehicle.position) / own.speed * kept + max(tardy, BEYOND)

    if not free:
        return
    matrix = np.array([[cost(i, *column) for column in columns] for i in free])
    rows, chosen = linear_sum_assignment(matrix)
    own = np.array([[cost(i, *c) if c[0] == found[i] else 1e12 for c in columns] for i in free])
    mine = own[linear_sum_assignment(own)].sum()  # the cheapest places at the evaders that were found
    assert mine == pytest.approx(float(matrix[rows, chosen].sum()), rel=1e-9)


def test_a_band_of_who_has_a_target_is_closed_before_another_gets_more_than_one() -> None:
    """⌈π / asin(4/5)⌉ = 4 in the plane: ten pursuers, three evaders in the order of their times to go."""
    need = ceil(pi / asin(0.8))
    team = tuple(pursuer(10.0 * k, 0.0) for k in range(10))
    quarries = (
        evader(0, 50, Vec(0, 250, 0)), evader(0, 50, Vec(0, 90, 0)), evader(0, 50, Vec(0, 150, 0)),
    )  # fmt: skip
    nobody = [0, 0, 0]
    assert shares(team, quarries, nobody, 10, RULES) == [10 - 2 * need, need, need]
    assert shares(team, quarries, nobody, 2, RULES) == [0, 1, 1]
    assert shares(team, quarries, [0, need, 0], 10 - need, RULES) == [10 - 2 * need, 0, need]
    gone = quarries[1]._replace(live=False)
    assert shares(team, (quarries[0], gone, quarries[2]), nobody, 10, RULES) == [need, 0, need]
    aimless = quarries[0]._replace(target=NO_TARGET)
    assert shares(team, (aimless, *quarries[1:]), nobody, 10, RULES) == [1, need, need]


def test_nobody_leaves_a_closed_ring_who_is_needed_there() -> None:
    """Five around an evader at 4 of 5 m/s, four of which close its band: the fifth goes to the other."""
    ring = tuple(pursuer(60.0 * cos(0.5 * pi * k), 60.0 * sin(0.5 * pi * k)) for k in range(4))
    spare = pursuer(70.0, 70.0)
    quarries = (evader(0, 0), evader(400, 400, Vec(400, 900, 0)))
    found = quarries_of((*ring, spare), quarries, (NOBODY,) * 5, RULES, LONG)
    assert found == (0, 0, 0, 0, 1)
    assert quarries_of(ring, quarries, (NOBODY,) * 4, RULES, LONG) == (0, 0, 0, 0)
    open_ring = quarries_of(ring[:3], quarries, (NOBODY,) * 3, RULES, LONG)
    assert sorted(open_ring) == [0, 1, 1]  # it closes nothing: the one with a target is served first


def test_times_are_those_of_the_field() -> None:
    """Head on 90 m at 4 and 5 m/s: 10 s. Straight behind a faster one: never, and farther is worse."""
    ahead = evader(0, 0, Vec(500, 0, 0))
    assert time_to_catch(pursuer(90, 0).vehicle, ahead) == pytest.approx(10.0)
    behind = [time_to_catch(pursuer(-far, 0).vehicle, ahead) for far in (10.0, 20.0)]
    assert behind[1] == pytest.approx(2 * behind[0])
    assert time_to_catch(pursuer(90, 0).vehicle, evader(0, 0)) == pytest.approx(22.5)  # it may turn
    assert late(pursuer(1000, 0).vehicle, ahead, inf)
    assert not late(pursuer(890, 0).vehicle, ahead, inf)
    assert late(pursuer(100, 0).vehicle, ahead, 11.0)


def test_nobody_changes_its_quarry_for_little_and_everybody_for_much() -> None:
    team = (pursuer(0.0, 0.0, 8.0), pursuer(0.0, 2.0, 8.0))
    quarries = (evader(50.0, 0.5), evader(50.0, 1.5))
    for before in ((0, 1), (1, 0)):
        assert quarries_of(team, quarries, before, RULES, LONG) == before
    far = (evader(50.0, -200.0), evader(50.0, 200.0))
    apart = (pursuer(0.0, -150.0, 8.0), pursuer(0.0, 150.0, 8.0))
    assert quarries_of(apart, far, (1, 0), RULES, LONG) == (0, 1)


def test_who_would_be_late_stays_where_it_is_of_use() -> None:
    """Six beside one evader, the other so far away that nobody is there in time."""
    team = tuple(pursuer(20.0 * k, 30.0) for k in range(6))
    quarries = (evader(9000, 0, Vec(9000, 60, 0)), evader(0, 0, Vec(0, 200, 0)))
    assert distance(team[0].vehicle.position, quarries[0].vehicle.position) > 8000
    assert quarries_of(team, quarries, (NOBODY,) * 6, RULES, LONG) == (1,) * 6
