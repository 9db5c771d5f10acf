"""Polygons that cross themselves are known, and those that do not are let be."""

from __future__ import annotations

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onboard.core.geometry.polygon import Corner, area, crossing, without_repeats

RADII = st.lists(st.floats(1.0, 100.0), min_size=4, max_size=20)


def star(radii: list[float]) -> tuple[Corner, ...]:
    """Corners in their order around a centre that sees them all: such a polygon never crosses itself."""
    turns = [2.0 * pi * k / len(radii) for k in range(len(radii))]
    return tuple((r * cos(t), r * sin(t)) for r, t in zip(radii, turns, strict=True))


@given(RADII, st.booleans())
def test_what_goes_once_around_does_not_cross(radii: list[float], backwards: bool) -> None:
    polygon = star(radii)[:: -1 if backwards else 1]
    assert crossing(polygon) == (-1, -1)
    parts = sum(
        0.5 * a * b * sin(2.0 * pi / len(radii)) for a, b in zip(radii, [*radii[1:], radii[0]], strict=True)
    )
    assert area(polygon) == pytest.approx(parts)


@given(RADII, st.data())
def test_what_takes_two_neighbours_in_the_wrong_order_crosses(
    radii: list[float], data: st.DataObject
) -> None:
    """On a circle, corners out of their order cross, whichever two it are."""
    polygon = list(star([50.0] * len(radii)))
    at = data.draw(st.integers(0, len(polygon) - 2))
    polygon[at], polygon[at + 1] = polygon[at + 1], polygon[at]
    assert crossing(tuple(polygon)) != (-1, -1)


@pytest.mark.parametrize(
    ("polygon", "crosses"),
    [
        (((0, 0), (4, 0), (4, 4), (0, 4)), False),
        (((0, 0), (4, 4), (4, 0), (0, 4)), True),  # a bow tie
        (((0, 0), (4, 0), (2, 0), (2, 4)), True),  # leads back on itself
        (((0, 0), (4, 0), (4, 4), (2, 0), (0, 4)), True),  # a corner touches an edge
        (((0, 0), (4, 0), (2, 1), (4, 4), (0, 4), (2, 1)), True),  # two corners in one place
        (((0, 0), (2, 0), (4, 0), (4, 4)), False),  # a corner on a straight edge
    ],
)
def test_touching_is_crossing(polygon: tuple[Corner, ...], crosses: bool) -> None:
    assert (crossing(polygon) != (-1, -1)) == crosses


def test_repeats_are_left_out() -> None:
    assert without_repeats(((0, 0), (0, 0), (1, 0), (1, 1), (0, 0))) == ((0, 0), (1, 0), (1, 1))
