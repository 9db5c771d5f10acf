"""A track's predictor: what it says, and how it meets bad input."""

from __future__ import annotations

from math import isfinite, nan

from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.vectors import Vec, distance
from onboard.pilot.filter import Variance
from onboard.pilot.predictor import PredictorKind, TrackPredictor

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
