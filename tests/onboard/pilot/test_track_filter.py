"""The track filter against what sensors really deliver."""

from __future__ import annotations

from math import cos, inf, isfinite, nan, sin, sqrt

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.vectors import Vec, distance, norm
from onboard.pilot.kalman import Variance
from onboard.pilot.track_filter import Fate, FilterSettings, TrackFilter

EXACT: Variance = (0.01, 0.01, 0.01, -1.0, -1.0, -1.0)
ROUGH: Variance = (9.0, 9.0, 9.0, -1.0, -1.0, -1.0)


def straight(t: float) -> Vec:
    return Vec(10.0 + 30.0 * t, -5.0 + 40.0 * t, -100.0)


def turning(t: float) -> Vec:
    return Vec(200.0 * sin(t / 4.0), 200.0 * cos(t / 4.0), -100.0)


def test_a_noisy_straight_track_is_smoothed_and_carried_forward() -> None:
    rng = np.random.default_rng(1)
    track = TrackFilter()
    for k in range(200):
        t = 0.05 * k
        noise = rng.normal(0.0, 3.0, 3)
        p = straight(t)
        track.add(t, Vec(p.x + noise[0], p.y + noise[1], p.z + noise[2]), None, ROUGH)
    ahead = track.estimate(track.newest + 0.5)
    assert distance(ahead.position, straight(ahead.t)) < 3.0  # a single sample errs by 5.2 m
    assert distance(ahead.velocity, Vec(30.0, 40.0, 0.0)) < 3.0
    assert 0.5 < ahead.sigma < 6.0


def test_the_stated_error_is_what_the_error_is() -> None:
    rng = np.random.default_rng(2)
    shares = []
    for _ in range(40):
        track = TrackFilter()
        for k in range(120):
            t = 0.1 * k
            noise = rng.normal(0.0, 3.0, 3)
            p = turning(t)
            track.add(t, Vec(p.x + noise[0], p.y + noise[1], p.z + noise[2]), None, ROUGH)
        here = track.estimate(track.newest)
        shares.append((distance(here.position, turning(here.t)) / here.sigma) ** 2)
    assert 0.5 < sqrt(sum(shares) / len(shares)) < 1.5


def test_a_hard_turn_raises_the_density_and_is_followed() -> None:
    track = TrackFilter()
    for k in range(200):
        t = 0.1 * k
        p = Vec(50.0 * t, 0.0, 0.0) if t < 10.0 else Vec(500.0, 50.0 * (t - 10.0), 0.0)
        track.add(t, p, None, EXACT)
        if abs(t - 11.0) < 1e-9:
            here = track.estimate(t)
            assert distance(here.velocity, Vec(0.0, 50.0, 0.0)) < 10.0
    assert distance(track.estimate(20.0).velocity, Vec(0.0, 50.0, 0.0)) < 1.0


@settings(max_examples=40, deadline=None)
@given(st.permutations(list(range(12))), st.integers(0, 11))
def test_the_order_of_arrival_does_not_matter(order: list[int], repeated: int) -> None:
    in_order = TrackFilter()
    shuffled = TrackFilter()
    first = (0.0, turning(0.0), None, EXACT)
    in_order.add(*first)
    shuffled.add(*first)
    for k in range(12):
        in_order.add(0.1 * (k + 1), turning(0.1 * (k + 1)), None, EXACT)
    for k in order:
        shuffled.add(0.1 * (k + 1), turning(0.1 * (k + 1)), None, EXACT)
    duplicate = 0.1 * (repeated + 1)
    assert shuffled.add(duplicate, turning(duplicate), None, EXACT) is Fate.DUPLICATE
    assert shuffled.estimate(2.0) == in_order.estimate(2.0)


def test_measured_velocities_are_used() -> None:
    with_velocity = TrackFilter()
    with_velocity.add(0.0, straight(0.0), Vec(30.0, 40.0, 0.0), (9.0, 9.0, 9.0, 0.1, 0.1, 0.1))
    ahead = with_velocity.estimate(1.0)
    assert distance(ahead.position, straight(1.0)) < 1e-9
    without = TrackFilter()
    without.add(0.0, straight(0.0), None, ROUGH)
    assert norm(without.estimate(1.0).velocity) == 0.0
    assert without.estimate(1.0).sigma > 5.0 * ahead.sigma


def test_a_kilometre_jump_is_refused_until_it_repeats_itself() -> None:
    track = TrackFilter()
    for k in range(20):
        track.add(0.1 * k, straight(0.1 * k), None, EXACT)
    far = Vec(5000.0, 5000.0, 0.0)
    assert track.add(2.0, far, None, EXACT) is Fate.JUMP
    assert distance(track.estimate(2.0).position, straight(2.0)) < 0.5
    assert track.add(2.1, straight(2.1), None, EXACT) is Fate.TAKEN
    assert track.add(2.2, far, None, EXACT) is Fate.JUMP
    assert track.add(2.3, far, None, EXACT) is Fate.JUMP
    assert track.add(2.4, far, None, EXACT) is Fate.RESTARTED
    assert distance(track.estimate(2.5).position, far) < 1.0


def test_time_running_backwards_restarts_only_when_it_goes_on() -> None:
    track = TrackFilter(FilterSettings(history=0.8))
    for k in range(20):
        track.add(100.0 + 0.1 * k, straight(0.1 * k), None, EXACT)
    assert track.add(5.0, straight(2.0), None, EXACT) is Fate.STALE
    assert track.newest > 101.0
    assert track.add(5.1, straight(2.1), None, EXACT) is Fate.STALE
    assert track.add(5.2, straight(2.2), None, EXACT) is Fate.RESTARTED
    assert track.newest == 5.2


def test_a_stamp_far_in_the_future_does_not_blind_the_filter() -> None:
    track = TrackFilter()
    for k in range(10):
        track.add(0.1 * k, straight(0.1 * k), None, EXACT)
    assert track.add(1e9, straight(1.0), None, EXACT) is Fate.JUMP
    assert track.add(1.0, straight(1.0), None, EXACT) is Fate.TAKEN


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(*[st.floats(allow_nan=True, allow_infinity=True) for _ in range(10)]), max_size=12),
    st.floats(-1e6, 1e6),
)
def test_nothing_makes_it_raise_or_answer_nan(rows: list[tuple[float, ...]], t: float) -> None:
    track = TrackFilter()
    for row in rows:
        variance = (row[4], row[5], row[6], row[7], row[8], row[9])
        track.add(row[0], Vec(*row[1:4]), Vec(*row[1:4]), variance)
    answer = track.estimate(t)
    if track.empty:
        assert answer.sigma == inf
    else:
        assert not any(map(lambda x: x != x, (*answer.position, *answer.velocity, answer.sigma)))


def test_bad_numbers_are_counted() -> None:
    track = TrackFilter()
    assert track.add(nan, straight(0.0), None, EXACT) is Fate.NOT_FINITE
    assert track.add(0.0, Vec(nan, 0.0, 0.0), None, EXACT) is Fate.NOT_FINITE
    assert track.add(0.0, straight(0.0), None, (-1.0, 1.0, 1.0, 1.0, 1.0, 1.0)) is Fate.NOT_FINITE
    assert track.fates[Fate.NOT_FINITE] == 3
    assert track.empty
    assert not isfinite(track.estimate(0.0).sigma)


def test_a_place_told_again_is_refused_of_a_target_that_moves_and_taken_of_one_that_rests() -> None:
    moving, resting, blind = TrackFilter(), TrackFilter(), TrackFilter()
    measured = (1.0, 1.0, 1.0, 0.01, 0.01, 0.01)
    for k in range(20):
        place = Vec(10.0 * (k // 5), 0.0, 0.0)  # a new fix every fifth row, at 20 m/s
        fate = moving.add(0.1 * k, place, Vec(20.0, 0.0, 0.0), measured)
        assert fate is (Fate.TAKEN if k % 5 == 0 else Fate.REPEATED)
        assert resting.add(0.1 * k, Vec(1.0, 2.0, 3.0), Vec(0.02, 0.0, 0.0), measured) is Fate.TAKEN
        assert blind.add(0.1 * k, Vec(1.0, 2.0, 3.0), None, (1.0, 1.0, 1.0, -1.0, -1.0, -1.0)) is Fate.TAKEN
    assert moving.fates[Fate.REPEATED] == 16


def test_a_target_that_stops_for_good_is_found_where_it_stopped() -> None:
    """Told without velocity and without noise, a stop cannot be told from a receiver's last fix at once."""
    track = TrackFilter()
    variance = (1.0, 1.0, 1.0, -1.0, -1.0, -1.0)
    for k in range(400):
        track.add(0.1 * k, Vec(min(2.0 * k, 100.0), 0.0, 0.0), None, variance)
    estimate = track.estimate(40.0)
    assert abs(estimate.position.x - 100.0) < 1.0
    assert abs(estimate.velocity.x) < 1.0
