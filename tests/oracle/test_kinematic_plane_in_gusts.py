"""A kinematic plane in gusts: each axis of its heading is carried through a first-order lag, by solve_ivp."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from onboard.core.math.vectors import ZERO, Vec
from onboard.game.scenario import Kind, VehicleSpec, WindSpec
from sim_bridge.vehicle.flight.kinematic import KinematicPlane, kinematic, start_motion
from sim_bridge.vehicle.motion import CALM, Air, Demand, Lateral
from sim_bridge.vehicle.wind.field import WindField

DT = 0.01
SPEC = VehicleSpec(position=(0.0, 0.0, 100.0), speed=20.0, speed_min=12.0, speed_max=30.0, acceleration=4.0)
RATES = {"along": 0.05, "across": 0.75 / 4.5, "down": 1.213 / 0.753}  # a_x; the printed zeros of (37), (36)
YAW = 0.7
AXES = {
    "along": Vec(cos(YAW), sin(YAW), 0.0),
    "across": Vec(-sin(YAW), cos(YAW), 0.0),
    "down": Vec(0.0, 0.0, 1.0),
}


def straight_on(airframe: KinematicPlane, air: Air) -> None:
    airframe.step(Demand(Lateral.HEADING, ZERO, YAW, 0.0, 20.0), air, DT)


def plane(air: Air = CALM) -> KinematicPlane:
    start = start_motion(SPEC.start(), YAW, Kind.ARDUPLANE, 20.0, air, True)
    made = kinematic(SPEC, Kind.ARDUPLANE, start, air)
    assert isinstance(made, KinematicPlane)
    return made


@pytest.mark.parametrize("name", list(RATES))
@pytest.mark.parametrize("size", [3.0, -2.0])
def test_a_gust_carries_it_through_the_lag_of_its_axis(name: str, size: float) -> None:
    axis = np.array(AXES[name])
    still, blown = plane(), plane()
    air = Air(ZERO, Vec(*(size * axis)))
    steps = 500
    for _ in range(steps):
        straight_on(still, CALM)
        straight_on(blown, air)

    def rates(_t: float, x: np.ndarray) -> list[float]:
        return [RATES[name] * (size - x[0]), x[0]]

    expected = solve_ivp(rates, (0.0, steps * DT), [0.0, 0.0], rtol=1e-9, atol=1e-9).y[:, -1]
    moved = np.subtract(blown.motion.position, still.motion.position)
    faster = np.subtract(blown.motion.velocity, still.motion.velocity)
    np.testing.assert_allclose(faster, expected[0] * axis, atol=1e-6)
    np.testing.assert_allclose(moved, expected[1] * axis, atol=1e-3)
    assert blown.motion.yaw == still.motion.yaw  # it has no nose that a gust could turn


def test_what_a_gust_has_not_yet_carried_the_airspeed_shows() -> None:
    """A gust from ahead of 3 m/s: the pitot tube reads 23 m/s at once, and 20 again in the long run."""
    blown = plane()
    air = Air(ZERO, Vec(*(-3.0 * np.array(AXES["along"]))))
    straight_on(blown, air)
    assert blown.motion.airspeed == pytest.approx(23.0, abs=0.01)
    for _ in range(20_000):
        straight_on(blown, air)
    assert blown.motion.airspeed == pytest.approx(20.0, abs=0.01)


def test_in_dryden_gusts_it_strays_and_still_holds_a_course() -> None:
    """A course north in a side wind with gusts: no mean drift, and a scatter that the still plane has not."""
    spec = WindSpec(speed=5.0, from_deg=270.0, gust_sigma=2.0)
    across = []
    for id in range(1, 5):
        field = WindField(spec, 11, [id])
        airframe = plane(Air(Vec(0.0, 5.0, 0.0), ZERO))
        for k in range(6000):
            air = field.air(0, airframe.motion, k * DT)
            airframe.step(Demand(Lateral.COURSE, ZERO, 0.0, 0.0, 20.0), air, DT)
            if k > 1000:
                across.append(airframe.motion.velocity.y)
    assert abs(float(np.mean(across))) < 0.3
    assert 0.02 < float(np.std(across)) < 2.0
    assert abs(airframe.motion.yaw) < pi / 4
