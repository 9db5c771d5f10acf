"""Along what gusts are longitudinal: rotations by SciPy, heights in feet as MIL-F-8785C has them."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from onboard.core.math.vectors import Vec
from onboard.game.scenario import WindSpec
from sim_bridge.campaign.plane_in_wind import Flown, climate_of, gust_at
from sim_bridge.vehicle.flight.aircraft import named
from sim_bridge.vehicle.flight.plane import nose_yaw, start_state, trimmed
from sim_bridge.vehicle.motion import Motion
from sim_bridge.vehicle.wind.dryden import GustAxes, GustState, gust_of
from sim_bridge.vehicle.wind.field import TICK, WindField

FOOT = 0.3048
SIGMA = 3.0
ONLY_U, ONLY_V, ONLY_W = np.eye(3)
FROM_DEG = 250.0  # the wind comes from here, so that it blows to 70°


def state_of(components: np.ndarray) -> GustState:
    """Filters whose outputs are these components: of a pair the first weighs √3, the second 1 − √3."""
    u, v, w = components
    root = np.sqrt(3.0)
    return GustState(u, v / root, 0.0, 0.0, w / (1.0 - root))


def expected(components: np.ndarray, feet: float, yaw: float, pitch: float) -> np.ndarray:
    """As the standard has it: along the mean wind to 1000 ft, the body from 2000 ft, linear between."""
    wind = Rotation.from_euler("z", np.radians(FROM_DEG + 180.0)).apply(components)
    body = Rotation.from_euler("ZY", [yaw, pitch]).apply(components)
    share = np.interp(feet, [1000.0, 2000.0], [0.0, 1.0])
    return SIGMA * ((1.0 - share) * wind + share * body)


@pytest.mark.parametrize("feet", [50.0, 1000.0, 1250.0, 1500.0, 1900.0, 2000.0, 9000.0])
@pytest.mark.parametrize("components", [ONLY_U, ONLY_V, ONLY_W, np.array([0.3, -1.2, 0.8])])
@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, 0.0), (radians(160.0), radians(15.0)), (-2.0, -0.4)])
def test_axes_of_the_wind_below_and_of_the_body_above(
    feet: float, components: np.ndarray, yaw: float, pitch: float
) -> None:
    blows = radians(FROM_DEG + 180.0)
    axes = GustAxes(float(np.cos(blows)), float(np.sin(blows)), yaw, pitch, feet * FOOT)
    found = gust_of(state_of(components), SIGMA, axes)
    np.testing.assert_allclose(found, expected(components, feet, yaw, pitch), atol=1e-9)


@pytest.mark.parametrize("feet", [500.0, 1400.0, 4000.0])
@pytest.mark.parametrize("name", ["nose", "coordinated"])
def test_the_campaign_s_aircraft_meets_them_so(feet: float, name: str) -> None:
    model = named(name).model
    climate = climate_of(WindSpec(speed=5.0, from_deg=FROM_DEG, gust_sigma=SIGMA))
    plane = trimmed(start_state(Vec(0.0, 0.0, -feet * FOOT), 2.5, 45.0, climate.reference), model)
    assert nose_yaw(plane, model) == pytest.approx(2.5)
    components = np.array([1.0, 0.5, -0.7])
    found = gust_at(climate, Flown(plane, state_of(components)), model)
    np.testing.assert_allclose(found, expected(components, feet, 2.5, 0.0), atol=1e-9)


@pytest.mark.parametrize(("feet", "turns"), [(500.0, False), (3000.0, True)])
def test_above_2000_ft_the_gusts_turn_with_the_vehicle(feet: float, turns: bool) -> None:
    """The same seed met by two vehicles of one height and different headings."""
    spec = WindSpec(speed=5.0, from_deg=FROM_DEG, gust_sigma=SIGMA)
    gusts = []
    for yaw in (0.0, radians(120.0)):
        field = WindField(spec, 7, range(1, 2))
        motion = Motion(Vec(0.0, 0.0, -feet * FOOT), Vec(45.0, 0.0, 0.0), 45.0, 0.0, 0.0, yaw)
        gusts.append(np.array([field.air(0, motion, k * TICK).gust for k in range(200)]))
    turned = Rotation.from_euler("z", 120.0 if turns else 0.0, degrees=True).apply(gusts[0])
    np.testing.assert_allclose(gusts[1], turned, atol=1e-9)
    assert float(np.std(gusts[0])) > 0.1
