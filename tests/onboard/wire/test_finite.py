"""The check of arriving messages for numbers that are none."""

from math import inf, nan

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.wire.bus.topics import TOPICS
from onboard.wire.finite import all_finite, finite_check


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


class _Message(msgspec.Struct, frozen=True):
    time: float
    name: str
    place: tuple[float, float, float]
    number: int
    row: tuple[float, ...] = ()
    aim: tuple[float, float] | None = None
    inner: _Inner = _Inner(0.0)
    rows: tuple[tuple[float, float], ...] = ()
    age: float | None = None


number = st.one_of(
    st.sampled_from([0.0, -0.0, 1.7976931348623157e308, -1.7976931348623157e308, inf, -inf, nan, 5e-324]),
    st.floats(),
)
messages = st.builds(
    _Message, number, st.text(max_size=3), st.tuples(number, number, number), st.integers(),
    st.lists(number, max_size=4).map(tuple), st.none() | st.tuples(number, number), st.builds(_Inner, number),
    st.lists(st.tuples(number, number), max_size=2).map(tuple), st.none() | number,
)  # fmt: skip


@pytest.mark.hypothesis
@settings(max_examples=400, deadline=None)
@given(messages)
def test_the_quick_test_finds_what_looking_at_each_number_finds(message: _Message) -> None:
    """Also where the sum of large numbers overflows, and where infinities of both signs meet."""
    assert finite_check(_Message)(message) == all_finite(msgspec.structs.astuple(message))


def test_every_float_of_every_topic_is_looked_at() -> None:
    """A field that is made NaN, each in turn, is found; a message of plain zeros passes."""
    looked_at = 0
    for topic in TOPICS:
        kind, check = topic.message, finite_check(topic.message)
        blank = {field.name: 0 for field in msgspec.structs.fields(kind)}
        for field in msgspec.structs.fields(kind):
            if field.type is float:
                assert not check(_plain(kind, blank | {field.name: nan})), (topic.suffix, field.name)
            elif "float" in str(field.type) or "messages." in str(field.type):
                row = {field.name: ((0.0, nan),)}
                assert not check(_plain(kind, blank | row)), (topic.suffix, field.name)
            else:
                continue
            looked_at += 1
    assert looked_at > 30


def _plain(kind: type[msgspec.Struct], values: dict[str, object]) -> msgspec.Struct:
    """A message as its fields are, unchecked; fields that hold rows get one of the right depth."""
    fixed = {}
    for field in msgspec.structs.fields(kind):
        value = values[field.name]
        rows = str(field.type).startswith("tuple[float")
        if rows:
            value = value[0] if isinstance(value, tuple) else ()
        fixed[field.name] = value
    return kind(**fixed)
