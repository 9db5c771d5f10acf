"""The bound of the dodge against flown encounters, whose pursuers try everything within their turn."""

from __future__ import annotations

from math import hypot, inf, radians, sqrt

import numpy as np
import pytest

from onboard.core.strategy.team.dodge_bound import Turner, dodge_always, wall_needed

EVADER, PURSUER, R = Turner(50.0, radians(4.5)), Turner(40.0, radians(4.5)), 25.0
DT = 0.02


def nearest(far: float, offsets: list[float], turns: np.ndarray, speed: float = 50.0) -> float:
    """The least distance [m] while an evader turns as hard as it can, a quarter turn long.

    Pursuers come head on from `far`, abreast at `offsets` [m]; `turns` (trials, pieces) are their turn rates
    as shares of what they can, piece after piece of time.
    """
    rate = EVADER.rate
    steps = round(0.5 * np.pi / rate / DT)
    trials, pieces = turns.shape
    count = len(offsets)
    x = np.full((trials, count), far)
    y = np.tile(np.array(offsets), (trials, 1))
    course = np.zeros((trials, count))  # from head on, towards the side to which the evader turns
    ex = ey = 0.0
    least = inf
    for n in range(steps):
        a = rate * (n + 0.5) * DT
        ex, ey = ex + speed * DT * np.cos(a), ey + speed * DT * np.sin(a)
        course = course + DT * PURSUER.rate * turns[:, min(pieces - 1, n * pieces // steps)][:, None]
        x = x - PURSUER.speed * DT * np.cos(course)
        y = y + PURSUER.speed * DT * np.sin(course)
        least = min(least, float(np.min(np.hypot(x - ex, y - ey))))
    return least


def tries(seed: int) -> np.ndarray:
    """Turn rates as shares: hard over for good, and 400 ways at random."""
    rng = np.random.default_rng(seed)
    some = rng.choice([-1.0, -0.5, 0.0, 0.5, 0.8, 1.0], (400, 6))
    return np.vstack([np.ones((1, 6)), some])


@pytest.mark.parametrize("offsets", [[0.0], [-50.0, 50.0], [-72.5, 72.5]])
def test_nobody_stops_a_dodge_that_begins_far_enough(offsets: list[float]) -> None:
    bound = dodge_always(EVADER, PURSUER, offsets[-1], R)
    assert bound < inf
    assert nearest(1.002 * bound, offsets, tries(len(offsets))) > R


def test_a_dodge_that_begins_much_nearer_is_answered() -> None:
    """The bound lets pursuers be as far on as in straight flight and as far across as in a turn: it is never
    too small, and not much too large."""
    for offsets in ([0.0], [-50.0, 50.0]):
        bound = dodge_always(EVADER, PURSUER, offsets[-1], R)
        assert nearest(0.8 * bound, offsets, tries(3)) <= R


def test_it_is_the_parabola_of_small_angles() -> None:
    slow = Turner(50.0, radians(1.0)), Turner(40.0, radians(1.0))
    time = sqrt(2.0 * 5.0 / (slow[0].rate * 50.0 - slow[1].rate * 40.0))
    assert dodge_always(*slow, 0.0, 5.0) == pytest.approx(90.0 * time, rel=0.02)


def test_a_wall_as_wide_as_a_quarter_turn_wins_is_passed_by_none() -> None:
    won = (50.0 - 40.0) / EVADER.rate  # r_e − r_p
    assert dodge_always(EVADER, PURSUER, won - R + 1.0, R) == inf
    assert dodge_always(EVADER, PURSUER, won - R - 5.0, R) < inf
    assert dodge_always(EVADER, EVADER, 0.0, R) == inf


def test_how_many_abreast_it_takes() -> None:
    assert [wall_needed(EVADER, PURSUER, 145.0, R, far) for far in (600.0, 1077.0, 1400.0)] == [1, 2, 3]
    assert hypot(0.5 * 145.0, R) < (50.0 - 40.0) / EVADER.rate  # so that two are passed from somewhere
