"""Structs of files and of the bus that are derived from a type of the core."""

from __future__ import annotations

from math import pi, radians
from typing import Annotated, NamedTuple

import msgspec
import pytest

from onboard.config.derive import Key, core_from, struct_from
from onboard.config.strict import ConfigError, StrictConfig, convert
from onboard.wire.bus.messages import Message

Positive = Annotated[float, msgspec.Meta(gt=0.0, description="a positive number")]


class Wing(NamedTuple):
    """A type as the core has them."""

    span: float  # [m]
    sweep: float = pi / 6  # [rad]
    lambda_: float = 1.0
    planar: bool = False
    age: float = 3.0  # [s]


KEYS = {
    "span": Key(Positive, None),
    "mass": Key(Positive, 2.0),  # the file's alone
    "sweep": Key(degrees=True),
    "lambda_": Key(name="lambda"),
    "age": Key(Positive, seconds=True),
}


class WingSpec(struct_from(Wing, StrictConfig, KEYS, ("planar",))):  # type: ignore[misc]
    """A table of a file."""


class WingMessage(struct_from(Wing, Message)):  # type: ignore[misc]
    """The same on the bus."""


def test_a_file_gives_the_core_s_value_with_radians_and_what_it_is_given() -> None:
    spec = convert({"sweep_deg": 45, "lambda": 0.5, "age_s": 4.0}, WingSpec, "file")
    assert core_from(spec, Wing, KEYS, span=9.0, planar=True) == Wing(9.0, radians(45.0), 0.5, True, 4.0)
    assert (spec.span, spec.mass) == (None, 2.0)


def test_defaults_are_the_core_s_unless_the_file_has_its_own() -> None:
    assert WingSpec().sweep_deg == pytest.approx(30.0)
    assert WingSpec().lambda_ == 1.0


@pytest.mark.parametrize(("data", "said"), [
    ({"sweep": 0.5}, "file: sweep: unknown key; did you mean 'sweep_deg'?"),
    ({"planar": True}, "file: planar: unknown key"),
    ({"age_s": -1.0}, "file: age_s: found -1.0, expected a positive number"),
    ({"mass": -1.0}, "file: mass: found -1.0, expected a positive number"),
    ({"sweep_deg": "steep"}, "file: sweep_deg: found 'steep', expected a number"),
])  # fmt: skip
def test_a_file_is_strict(data: dict[str, object], said: str) -> None:
    with pytest.raises(ConfigError) as ended:
        convert(data, WingSpec, "file")
    assert str(ended.value) == said


def test_the_bus_carries_the_core_s_fields_in_their_order() -> None:
    wing = Wing(9.0, 0.25, 0.5, True, 2.0)
    payload = msgspec.msgpack.encode(WingMessage(*wing))
    assert msgspec.msgpack.decode(payload) == [9.0, 0.25, 0.5, True, 2.0]
    assert core_from(msgspec.msgpack.decode(payload, type=WingMessage), Wing) == wing


def test_the_bus_takes_a_message_with_fewer_and_with_more_fields() -> None:
    sent = ([9.0, 0.25], [9.0, 0.25, 0.5, True, 2.0, "new"])
    older, newer = (msgspec.msgpack.encode(fields) for fields in sent)
    assert core_from(msgspec.msgpack.decode(older, type=WingMessage), Wing) == Wing(9.0, 0.25)
    assert core_from(msgspec.msgpack.decode(newer, type=WingMessage), Wing) == Wing(9.0, 0.25, 0.5, True, 2.0)
