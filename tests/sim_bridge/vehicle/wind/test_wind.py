"""The wind against its formulas, and its seed against itself."""

from __future__ import annotations

from itertools import pairwise
from math import log, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import ZERO, Vec, norm
from onboard.game.scenario import WindSpec
from sim_bridge.vehicle.motion import Motion
from sim_bridge.vehicle.wind.dryden import power12, scales
from sim_bridge.vehicle.wind.field import TICK, WindField, wind_vector
from sim_bridge.vehicle.wind.recorded import read
from sim_bridge.vehicle.wind.shear import ROUGHNESS, ROUGHNESS_TERMINAL, shear_factor

HEIGHT = 100.0
SPEED = 45.0
PLACE = Vec(0.0, 0.0, -HEIGHT)


def north(place: Vec) -> Motion:
    """Level flight to the north."""
    return Motion(place, Vec(SPEED, 0.0, 0.0), SPEED, 0.0, 0.0, 0.0)


def gusts(spec: WindSpec, seed: int, count: int, seconds: float) -> np.ndarray:
    """(ticks, count, 3): north = along, east = across, down."""
    field = WindField(spec, seed, range(1, count + 1))
    ticks = int(seconds / TICK)
    out = np.empty((ticks, count, 3))
    for k in range(ticks):
        for i in range(count):
            out[k, i] = field.air(i, north(PLACE), k * TICK).gust
    return out


@pytest.fixture(scope="module")
def ten_minutes() -> np.ndarray:
    """Gusts of 3 m/s at eight vehicles for ten minutes."""
    return gusts(WindSpec(gust_sigma=3.0), 11, 8, 600.0)


def test_the_rms_is_the_setting(ten_minutes: np.ndarray) -> None:
    rms = np.sqrt(np.mean(ten_minutes**2, axis=(0, 1)))
    np.testing.assert_allclose(rms, 3.0, rtol=0.05)


def test_the_rms_does_not_depend_on_how_the_scale_changes() -> None:
    """A vehicle that climbs and dives through the scales meets gusts of the same rms."""
    field = WindField(WindSpec(gust_sigma=3.0), 5, range(1, 7))
    squares = []
    for k in range(30_000):
        height = 150.0 + 140.0 * sin(k * 0.003)
        squares += [
            sum(x * x for x in field.air(i, north(Vec(0.0, 0.0, -height)), k * TICK).gust) for i in range(6)
        ]
    assert sqrt(float(np.mean(squares)) / 3.0) == pytest.approx(3.0, rel=0.05)


def test_the_spectrum_is_dryden_s(ten_minutes: np.ndarray) -> None:
    lengths = scales(HEIGHT)
    n = 6000  # windows of two minutes
    f = np.fft.rfftfreq(n, TICK)[1:]
    omega = 2.0 * np.pi * f
    window = np.hanning(n)
    power = np.zeros((len(f), 3))
    pieces = 0
    for i in range(ten_minutes.shape[1]):
        for start in range(0, ten_minutes.shape[0] - n + 1, n // 2):
            piece = ten_minutes[start : start + n, i] * window[:, None]
            power += np.abs(np.fft.rfft(piece, axis=0)[1:]) ** 2
            pieces += 1
    power *= 2.0 * TICK / (2.0 * np.pi) / pieces / np.sum(window**2)  # one-sided, per rad/s
    for axis, length in enumerate((lengths.horizontal, lengths.horizontal, lengths.vertical)):
        t = length / SPEED
        x = (t * omega) ** 2
        if axis == 0:
            dryden = 9.0 * 2.0 * t / np.pi / (1.0 + x)
        else:
            dryden = 9.0 * t / np.pi * (1.0 + 3.0 * x) / (1.0 + x) ** 2
        edges = np.geomspace(0.2, 30.0, 9)
        for low, high in pairwise(edges):
            band = (omega >= low) & (omega < high)
            assert np.mean(power[band, axis]) == pytest.approx(np.mean(dryden[band]), rel=0.25), (axis, low)


def test_the_same_seed_gives_the_same_wind_whatever_the_time_step() -> None:
    spec = WindSpec(speed=5.0, from_deg=300.0, gust_sigma=3.0)
    fine, coarse, other = (WindField(spec, seed, range(1, 3)) for seed in (3, 3, 4))
    for k in range(400):
        a = fine.air(0, north(PLACE), k * 0.01)
        fine.air(1, north(PLACE), k * 0.01)
        if k % 4 == 0:
            coarse.air(1, north(PLACE), k * 0.01)
            assert coarse.air(0, north(PLACE), k * 0.01) == a
    assert other.air(0, north(PLACE), 3.96) != a


def test_a_vehicle_more_changes_nobody_s_wind() -> None:
    spec = WindSpec(gust_sigma=3.0)
    few, many = WindField(spec, 3, (1, 2)), WindField(spec, 3, (4, 2, 7, 1))
    for k in range(100):
        for here, there in ((0, 3), (1, 1)):
            assert few.air(here, north(PLACE), k * TICK) == many.air(there, north(PLACE), k * TICK)


def test_neighbours_meet_the_same_gusts_and_strangers_do_not() -> None:
    field = WindField(WindSpec(gust_sigma=3.0, correlation_m=200.0), 9, range(1, 4))
    places = [PLACE, Vec(20.0, 0.0, -HEIGHT), Vec(4000.0, 0.0, -HEIGHT)]
    series = np.array(
        [[field.air(i, north(places[i]), k * TICK).gust for i in range(3)] for k in range(20_000)]
    )
    for axis in range(3):
        correlation = np.corrcoef(series[:, :, axis].T)
        assert correlation[0, 1] == pytest.approx(np.exp(-0.1), abs=0.06)
        assert abs(correlation[0, 2]) < 0.3
    np.testing.assert_allclose(np.sqrt(np.mean(series**2, axis=(0, 1))), 3.0, rtol=0.15)


@settings(max_examples=60, deadline=None)
@given(st.floats(1.0, 300.0))
def test_the_shear_profile_is_the_standard_s(height: float) -> None:
    feet = height / 0.3048
    assert shear_factor(height, ROUGHNESS) == pytest.approx(log(feet / 2.0) / log(10.0), rel=1e-12)
    expected = log(feet / 0.15) / log(20.0 / 0.15)
    assert shear_factor(height, ROUGHNESS_TERMINAL) == pytest.approx(expected, rel=1e-12)


def test_the_mean_wind_comes_from_where_it_is_said_to() -> None:
    field = WindField(WindSpec(speed=5.0, from_deg=270.0, shear=True), 0, range(1, 2))
    at_reference = field.air(0, north(Vec(0.0, 0.0, -6.096)), 0.0).wind
    assert at_reference.y == pytest.approx(5.0)  # a west wind blows east
    assert at_reference.x == pytest.approx(0.0, abs=1e-12)
    high = field.air(0, north(Vec(0.0, 0.0, -200.0)), 0.0)
    assert norm(high.wind) > norm(at_reference)
    assert high.gust == ZERO
    assert wind_vector(5.0, 0.0).x == -5.0


def test_no_wind_is_calm() -> None:
    assert WindField(WindSpec(), 0, range(1, 2)).air(0, north(PLACE), 12.0) == (ZERO, ZERO)


@settings(max_examples=50, deadline=None)
@given(st.floats(0.18, 1.0))
def test_the_power_without_a_power_function(x: float) -> None:
    assert power12(x) == pytest.approx(x**1.2, rel=1e-12)


def test_the_scales_are_continuous() -> None:
    for feet in (1000.0, 2000.0):
        below, above = scales((feet - 0.01) * 0.3048), scales((feet + 0.01) * 0.3048)
        assert below.horizontal == pytest.approx(above.horizontal, rel=1e-3)
        assert below.vertical == pytest.approx(above.vertical, rel=1e-3)


def test_a_recorded_wind_is_flown_as_recorded(tmp_path: Path) -> None:
    path = tmp_path / "wind.csv"
    path.write_text("time,north,east,down\n0,1,0,0\n10,3,-2,0\n", encoding="utf-8")
    field = WindField(WindSpec(recorded="wind.csv"), 0, range(1, 2), tmp_path)
    assert field.air(0, north(PLACE), 5.0).wind == Vec(2.0, -1.0, 0.0)
    assert field.air(0, north(PLACE), 99.0).wind == Vec(3.0, -2.0, 0.0)
    path.write_text("time,north,east,down,gust_north,gust_east,gust_down\n0,1,0,0,.5,0,0\n", encoding="utf-8")
    assert read(path).at(0.0).gust == Vec(0.5, 0.0, 0.0)


BAD = [
    ("", "line 1: found nothing"),
    ("t,n,e,d\n", "line 1: found t,n,e,d"),
    ("time,north,east,down\n", "found no rows"),
    ("time,north,east,down\n0,1,2\n", "line 2: found 0,1,2, expected 4 finite numbers"),
    ("time,north,east,down\n0,1,nan,0\n", "line 2"),
    ("time,north,east,down\n0,1,calm,0\n", "line 2"),
    ("time,north,east,down\n1,0,0,0\n1,0,0,0\n", "line 3: found time 1, expected more than 1"),
]


@pytest.mark.parametrize(("text", "reason"), BAD)
def test_a_bad_recording_is_refused_with_its_line(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "wind.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError, match=reason):
        read(path)


def test_a_missing_recording_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no such file"):
        WindField(WindSpec(recorded="none.csv"), 0, range(1, 2), tmp_path)
