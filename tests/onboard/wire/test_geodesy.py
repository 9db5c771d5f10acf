"""Between the game frame and geodetic coordinates, against pymap3d."""

from __future__ import annotations

import pymap3d  # type: ignore[import-untyped]
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.vectors import Vec
from onboard.wire.geodesy import Frame

latitudes = st.floats(-89.5, 89.5)
longitudes = st.floats(-180.0, 180.0)
altitudes = st.floats(-400.0, 5000.0)
near = st.floats(-50_000.0, 50_000.0)
downs = st.floats(-3000.0, 3000.0)


@settings(max_examples=300, deadline=None)
@given(latitudes, longitudes, altitudes, near, near, downs)
def test_there_and_back(lat: float, lon: float, alt: float, north: float, east: float, down: float) -> None:
    frame = Frame(lat, lon, alt)
    back = frame.ned_from_geodetic(*frame.geodetic_from_ned(Vec(north, east, down)))
    assert back == pytest.approx((north, east, down), abs=1e-5)


@settings(max_examples=200, deadline=None)
@given(latitudes, longitudes, altitudes, st.floats(-0.3, 0.3), st.floats(-0.3, 0.3), altitudes)
def test_north_and_east_are_those_of_the_tangent_plane(
    lat: float, lon: float, alt: float, dlat: float, dlon: float, high: float
) -> None:
    frame = Frame(lat, lon, alt)
    there = (lat + dlat, lon + dlon, high)
    north, east, _ = pymap3d.geodetic2ned(*there, lat, lon, alt)
    x, y, z = frame.ned_from_geodetic(*there)
    assert (x, y) == pytest.approx((float(north), float(east)), abs=1e-6)
    assert z == alt - high


def test_down_is_altitude_and_not_the_plane() -> None:
    """20 km away at the same altitude is 0 m down; the tangent plane is 31 m off there."""
    frame = Frame(47.4, 8.5, 500.0)
    place = frame.geodetic_from_ned(Vec(20_000.0, 0.0, 0.0))
    assert place.altitude_m == 500.0
    _, _, plumb = pymap3d.geodetic2ned(*place, 47.4, 8.5, 500.0)
    assert float(plumb) == pytest.approx(31.4, abs=0.2)


def test_the_origin_is_zero_and_the_date_line_is_no_edge() -> None:
    frame = Frame(-17.0, 179.9999, 30.0)
    assert frame.ned_from_geodetic(-17.0, 179.9999, 30.0) == pytest.approx((0.0, 0.0, 0.0), abs=1e-8)
    east = frame.ned_from_geodetic(-17.0, -179.9999, 30.0)
    assert east.y == pytest.approx(21.3, abs=0.1)
    assert frame.geodetic_from_ned(east).longitude_deg == pytest.approx(-179.9999, abs=1e-10)
