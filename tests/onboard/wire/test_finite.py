"""The check of arriving messages for numbers that are none."""

from math import inf, nan

import msgspec
import pytest

from onboard.wire.finite import all_finite


class _Inner(msgspec.Struct, frozen=True):
    value: float


@pytest.mark.parametrize("number", [nan, inf, -inf])
def test_one_bad_number_is_found_at_any_depth(number: float) -> None:
    assert not all_finite((1.0, number))
    assert not all_finite((1.0, (2.0, ("text", number))))
    assert not all_finite((1, "text", _Inner(number)))


def test_everything_else_passes() -> None:
    assert all_finite(())
    assert all_finite((1.0, -1.7976931348623157e308, 5e-324, 1, "nan", None, True, (), _Inner(0.0)))
