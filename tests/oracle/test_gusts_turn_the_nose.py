"""The aircraft in gusts against first principles: a weathercock turns into the relative wind, by how much."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, degrees, radians, sin

import numpy as np
import pytest

from onboard.core.math.vectors import ZERO, Vec
from sim_bridge.vehicle.flight.aircraft import named
from sim_bridge.vehicle.flight.airframe import Plane
from sim_bridge.vehicle.flight.axis import AxisLaw, AxisState, move
from sim_bridge.vehicle.flight.derivatives import Lateral, Longitudinal, Transfer, lateral, longitudinal
from sim_bridge.vehicle.flight.plane import PlaneModel, nose_yaw
from sim_bridge.vehicle.motion import Air, Demand
from sim_bridge.vehicle.motion import Lateral as Steering
from tests.oracle import equations_of_motion as oracle

AIRCRAFT = ["nose", "slip", "coordinated"]
FREE = AxisLaw(0.0, 1.0, 0.0, 0.0, 0.0, 1e9, 1.0, 1e9)  # hands off: surfaces in their middle
DT = 0.01


def pulse(t: float) -> float:
    """5 m/s for half a second."""
    return 5.0 if t < 0.5 else 0.0


def swell(t: float) -> float:
    """Gusts from slow to quick."""
    return 2.0 * sin(0.3 * t) + 1.5 * sin(1.9 * t + 1.0) + 1.0 * sin(6.0 * t + 2.0)


def flown(model: PlaneModel, axis: str, gust: Callable[[float], float], seconds: float) -> np.ndarray:
    """The product's axis without a controller: its angle after every sample [rad]."""
    state = AxisState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    angles = []
    for k in range(round(seconds / DT)):
        w = gust(k * DT)  # held over the sample
        winds = (w, 0.0) if axis == "yaw" else (0.0, w)
        state = move(state, model.yaw if axis == "yaw" else model.pitch, FREE, 0.0, 0.0, *winds)
        angles.append(state.angle)
    return np.array(angles)


def held(gust: Callable[[float], float]) -> Callable[[float], float]:
    return lambda t: gust(int(t / DT + 1e-9) * DT)


@pytest.mark.parametrize("gust", [pulse, swell])
@pytest.mark.parametrize("axis", ["yaw", "pitch"])
@pytest.mark.parametrize("name", AIRCRAFT)
def test_the_nose_swings_as_the_fin_and_the_tail_say(
    name: str, axis: str, gust: Callable[[float], float]
) -> None:
    ours = flown(named(name).model, axis, gust, 8.0)
    times = DT * np.arange(1, len(ours) + 1)
    swing = oracle.nose_in_side_gust if axis == "yaw" else oracle.nose_in_updraft
    theirs = swing(held(gust), times)
    largest = float(np.max(np.abs(theirs)))
    assert degrees(largest) > 0.5  # the gusts do turn it
    np.testing.assert_allclose(ours, theirs, atol=0.02 * largest)


def test_half_a_second_of_gust_turns_the_nose_left_and_down() -> None:
    model = named("nose").model
    left, down = (degrees(flown(model, axis, pulse, 0.5)[-1]) for axis in ("yaw", "pitch"))
    assert -3.0 < left < -1.5
    assert -3.0 < down < -0.7


@pytest.mark.parametrize("heading", [0.0, 90.0, 217.0])
@pytest.mark.parametrize("name", AIRCRAFT)
def test_in_flight_at_any_heading_too(name: str, heading: float) -> None:
    """With the loops at work the first swing is smaller, and of the same sign."""
    psi = radians(heading)
    demand = Demand(Steering.HEADING, ZERO, psi, 0.0, 45.0)
    for side in (-5.0, 5.0):
        plane = Plane(named(name).model, Vec(0.0, 0.0, -300.0), psi, 45.0)
        plane.step(demand, Air(ZERO, Vec(-side * sin(psi), side * cos(psi), -side)), 0.2)
        swung = nose_yaw(plane.state, plane.model) - psi
        assert swung * side < 0.0
        assert abs(degrees(swung)) > 0.2
        assert plane.motion.pitch * side < 0.0
        assert abs(degrees(plane.motion.pitch)) > 0.1


OMEGA = np.geomspace(0.05, 40.0, 60)


def at(transfer: Transfer) -> np.ndarray:
    return np.polyval(transfer.numerator, 1j * OMEGA) / np.polyval(transfer.denominator, 1j * OMEGA)


def test_all_of_35_with_roll_as_a_state_space() -> None:
    """In print yaw is to the left: seen to the right, w_z turns its sign, and degrees come from radians."""
    d = Lateral(56.0, 1 / 6, 4.04, 0.93, 4.5, 0.17, 6.0, 3.0, 1.2, 9.0, 0.3)
    theirs = oracle.lateral_35(d._asdict(), OMEGA)
    ours = lateral(d)
    np.testing.assert_allclose(at(ours["rudder"]), theirs["rudder"], rtol=1e-6)
    np.testing.assert_allclose(at(ours["aileron"]), theirs["aileron"], rtol=1e-6)
    np.testing.assert_allclose(at(ours["wind_z"]), -np.degrees(1.0) * theirs["wind_z"], rtol=1e-6)


def test_all_of_33_as_a_state_space() -> None:
    d = Longitudinal(80.0, 1.6, 1.5, 5.4, 0.2, 2.0, 0.2, 0.03, 0.17, 0.05, 0.1)
    theirs = oracle.longitudinal_33(d._asdict(), OMEGA)
    for name, ours in longitudinal(d).items():
        np.testing.assert_allclose(at(ours), theirs[name], rtol=1e-6, err_msg=name)


def test_a_uniform_wind_turns_nobody() -> None:
    """By (35), and because nothing but the air's motion against the ground has changed."""
    for name in AIRCRAFT:
        angles = flown(named(name).model, "yaw", lambda _: 5.0, 60.0)
        assert abs(degrees(angles[-1] - angles[-500])) < 1e-3
