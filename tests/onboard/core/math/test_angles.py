"""The wrap of angles: the half-open interval, exactness, and the same result compiled."""

from math import cos, nextafter, pi, sin

import numba
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onboard.core.math.angles import wrap


@pytest.mark.parametrize(
    ("angle", "expected"),
    [
        (pi, pi),
        (-pi, pi),
        (nextafter(-pi, 0.0), nextafter(-pi, 0.0)),
        (nextafter(pi, 4.0), nextafter(-pi, 0.0)),
        (0.0, 0.0),
        (1e-300, 1e-300),
        (3.0 * pi / 2.0, -pi / 2.0),
        (-3.0 * pi / 2.0, pi / 2.0),
        (2.0 * pi, 0.0),
    ],
)
def test_the_interval_is_open_at_minus_pi_and_closed_at_pi(angle: float, expected: float) -> None:
    assert wrap(angle) == expected


@given(st.floats(-1e6, 1e6))
def test_the_direction_stays_and_wrapping_again_changes_nothing(angle: float) -> None:
    wrapped = wrap(angle)
    assert -pi < wrapped <= pi
    assert wrap(wrapped) == wrapped
    assert cos(wrapped) == pytest.approx(cos(angle), abs=1e-9)
    assert sin(wrapped) == pytest.approx(sin(angle), abs=1e-9)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_no_finite_angle_is_too_large(angle: float) -> None:
    assert -pi < wrap(angle) <= pi


def test_compiled_it_gives_the_same_to_the_last_bit() -> None:
    compiled = numba.njit(wrap)
    angles = [pi, -pi, nextafter(pi, 4.0), 7.0, 12345.678, -1e9, 1e300, *(0.37 * k for k in range(-99, 99))]
    assert [compiled(angle) for angle in angles] == [wrap(angle) for angle in angles]
