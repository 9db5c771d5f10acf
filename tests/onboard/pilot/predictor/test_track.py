"""A track's predictor: what it says, and how it meets bad input."""

from __future__ import annotations

from itertools import pairwise
from math import isfinite, nan, pi, sin
from typing import NamedTuple

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.vectors import Vec, distance
from onboard.pilot.kalman import Variance
from onboard.pilot.predictor import PredictorKind, TrackPredictor, Trainer

UNMEASURED: Variance = (0.01, 0.01, 0.01, -1.0, -1.0, -1.0)


def test_no_sample_is_a_refusal() -> None:
    answer = TrackPredictor().predict(0.0)
    assert not answer.usable
    assert answer.source is PredictorKind.NOTHING


def test_one_sample_is_the_last_known_place_with_a_large_error() -> None:
    track = TrackPredictor()
    track.add(0.0, Vec(1.0, 2.0, 3.0), None, UNMEASURED)
    answer = track.predict(2.0)
    assert answer.usable
    assert answer.source is PredictorKind.LAST_KNOWN
    assert answer.position == Vec(1.0, 2.0, 3.0)
    assert answer.sigma > 50.0


def test_one_sample_with_a_velocity_is_carried_forward() -> None:
    track = TrackPredictor()
    track.add(0.0, Vec(1.0, 2.0, 3.0), Vec(10.0, 0.0, 0.0), (0.1, 0.1, 0.1, 0.1, 0.1, 0.1))
    answer = track.predict(2.0)
    assert answer.source is PredictorKind.CONSTANT_VELOCITY
    assert distance(answer.position, Vec(21.0, 2.0, 3.0)) < 1e-9


def test_instants_out_of_reason_are_refused() -> None:
    track = TrackPredictor()
    track.add(0.0, Vec(1.0, 2.0, 3.0), None, UNMEASURED)
    for t in (nan, float("inf"), -1e9, 1e9):
        assert not track.predict(t).usable


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(*[st.floats(allow_nan=True, allow_infinity=True) for _ in range(10)]), max_size=12),
    st.floats(allow_nan=True, allow_infinity=True),
)
def test_nothing_makes_it_raise_or_answer_nan(rows: list[tuple[float, ...]], t: float) -> None:
    track = TrackPredictor()
    for row in rows:
        variance = (row[4], row[5], row[6], row[7], row[8], row[9])
        track.add(row[0], Vec(*row[1:4]), Vec(*row[1:4]), variance)
    for instant in (t, 0.0, track.filter.newest + 0.5):
        answer = track.predict(instant)
        assert all(map(isfinite, (*answer.position, *answer.velocity)))
        assert isfinite(answer.sigma) == answer.usable


# ── flights ──


def weave(t: float) -> Vec:
    """50 m/s north-east, weaving with a period of 8 s."""
    side = 60.0 * sin(2.0 * pi * t / 8.0)
    return Vec(35.0 * t - 0.7 * side, 35.0 * t + 0.7 * side, -300.0)


class Flight(NamedTuple):
    """A track that was followed, with its training."""

    track: TrackPredictor
    end: float


def fly(
    seconds: float, rate: float = 10.0, sigma: float = 3.0, seed: int = 1, slices: int = 2, lost: float = 0.0
) -> Flight:
    """Follow the weave with a noisy sensor, training between samples as an agent does."""
    rng = np.random.default_rng(seed)
    track, trainer = TrackPredictor(seed), Trainer()
    variance = (sigma**2, sigma**2, sigma**2, -1.0, -1.0, -1.0)
    t = 0.0
    for k in range(int(seconds * rate)):
        t = k / rate
        noise = rng.normal(0.0, sigma, 3)
        p = weave(t)
        if rng.uniform() >= lost:
            track.add(t, Vec(p.x + noise[0], p.y + noise[1], p.z + noise[2]), None, variance)
        trainer.advance(t, {1: track}, slices)
    return Flight(track, t)


def test_a_trained_track_sees_the_next_turn_of_a_weave() -> None:
    track, end = fly(45.0)
    for ahead in (0.5, 1.0, 2.0, 3.9):
        mine = track.predict(end + ahead)
        steady = track.filter.estimate(end + ahead)
        truth = weave(end + ahead)
        assert mine.source in (PredictorKind.RIDGE, PredictorKind.NETWORK)
        assert distance(mine.position, truth) < 0.6 * distance(steady.position, truth) + 2.0
        assert distance(mine.position, truth) < 3.0 * mine.sigma
    assert distance(track.predict(end + 2.0).velocity, track.predict(end + 2.1).velocity) < 10.0


def test_drop_outs_are_bridged() -> None:
    track, end = fly(45.0, lost=0.3)
    assert distance(track.predict(end + 1.0).position, weave(end + 1.0)) < 12.0


def test_the_path_joins_the_filter_and_goes_on_past_the_longest_horizon() -> None:
    track, _ = fly(30.0)
    newest, longest = track.filter.newest, track.longest
    assert distance(track.predict(newest + 1e-6).position, track.filter.estimate(newest).position) < 1e-3
    last, beyond = track.predict(newest + longest), track.predict(newest + longest + 1e-6)
    assert distance(last.position, beyond.position) < 1e-3
    assert beyond.source is PredictorKind.CONSTANT_VELOCITY
    sigmas = [track.predict(newest + longest * k).sigma for k in (1.0, 2.0, 4.0)]
    assert sigmas[0] < sigmas[1] < sigmas[2]


def test_late_samples_lead_to_the_grid_that_punctual_ones_give() -> None:
    punctual, late = TrackPredictor(), TrackPredictor()
    times = [0.1 * k for k in range(60)]
    swapped = list(times)
    swapped[30], swapped[34] = swapped[34], swapped[30]
    for t in times:
        punctual.add(t, weave(t), None, UNMEASURED)
    for t in swapped:
        late.add(t, weave(t), None, UNMEASURED)
    np.testing.assert_allclose(late.grid.arrays()[0], punctual.grid.arrays()[0], atol=1e-9)
    assert late.grid.added == punctual.grid.added


def test_a_silence_makes_the_grid_begin_anew_and_predictions_go_on() -> None:
    track, end = fly(30.0, sigma=0.1)
    for k in range(5):
        t = end + 5.0 + 0.1 * k
        track.add(t, weave(t), None, UNMEASURED)
    assert 1 <= len(track.grid) <= 3
    assert track.predict(t + 1.0).source is PredictorKind.CONSTANT_VELOCITY


def test_a_restart_throws_away_a_training_under_way() -> None:
    track, end = fly(20.0)
    training = track.train()
    next(training)
    for k in range(3):
        track.add(end + 1.0 + 0.1 * k, Vec(9e4, 9e4, 0.0), None, UNMEASURED)
    assert track.model is None
    for _ in training:
        pass
    assert track.model is None


def test_a_stationary_target_stays_where_it_is() -> None:
    track, trainer = TrackPredictor(), Trainer()
    rng = np.random.default_rng(5)
    for k in range(300):
        noise = rng.normal(0.0, 1.0, 3)
        track.add(0.1 * k, Vec(*noise.tolist()), None, (1.0, 1.0, 1.0, -1.0, -1.0, -1.0))
        trainer.advance(0.1 * k, {1: track}, 2)
    assert distance(track.predict(32.0).position, Vec(0.0, 0.0, 0.0)) < 6.0


def test_the_same_flight_gives_the_same_answers() -> None:
    answers = []
    for _ in range(2):
        track, end = fly(20.0, lost=0.2)
        answers.append([track.predict(end + 0.1 * k) for k in range(40)])
    assert answers[0] == answers[1]


def test_wild_samples_in_a_flight_never_break_it() -> None:
    rng = np.random.default_rng(8)
    track, trainer = TrackPredictor(), Trainer()
    for k in range(600):
        t = 0.05 * k
        p = weave(t)
        match int(rng.integers(0, 12)):
            case 0:
                p = Vec(nan, p.y, p.z)
            case 1:
                p = Vec(p.x + 8000.0, p.y, p.z)
            case 2:
                t = t - float(rng.uniform(0.0, 8.0))
            case 3:
                t = 0.05 * (k - 1)
            case _:
                pass
        track.add(t, p, None, UNMEASURED)
        trainer.advance(0.05 * k, {1: track}, 2)
        answer = track.predict(0.05 * k + 0.5)
        assert all(map(isfinite, (*answer.position, *answer.velocity)))
        assert isfinite(answer.sigma) == answer.usable
    assert track.trainings > 3


def test_trainings_take_turns_and_keep_their_distance() -> None:
    tracks = {name: fly(12.0, slices=0).track for name in ("a", "b", "c")}
    for track in tracks.values():
        track.need.rising = True  # each asks at every turn
    trainer = Trainer(period=4.0)
    begun: list[tuple[float, str]] = []
    for k in range(2000):
        now = 0.05 * k
        before = {name: track.trainings for name, track in tracks.items()}
        assert trainer.advance(now, tracks, 1) <= 1
        begun += [(now, name) for name, track in tracks.items() if track.trainings > before[name]]
    assert [name for _, name in begun[:6]] == ["a", "b", "c", "a", "b", "c"]
    for name in tracks:
        times = [t for t, who in begun if who == name]
        assert len(times) > 5
        assert all(b - a >= 4.0 for a, b in pairwise(times))
