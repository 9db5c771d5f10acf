"""What an autopilot can know of the wind: kinematics by hand, Kalman gains by SciPy's Riccati equation."""

from __future__ import annotations

from math import cos, degrees, hypot, pi, radians, sin

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from onboard.core.math.vectors import ZERO, Vec
from onboard.game.scenario import Kind, VehicleSpec
from sim_bridge.draws import Purpose, key_of
from sim_bridge.vehicle.autopilot.wind_filter import WindFilter
from sim_bridge.vehicle.flight.kinematic import kinematic, start_motion
from sim_bridge.vehicle.motion import Air, Demand, Lateral, Motion
from sim_bridge.vehicle.wind.estimate import EXACT, Errors, drawn_errors

WIND = np.array([6.0, -4.0])
SPEED = 40.0
# PX4: EKF2_WIND_NSD, EKF2_EAS_NOISE, EKF2_BETA_NOISE; ArduPilot: EK3_WIND_P_NSE an update of 12 ms, …
NOISES = {
    Kind.PX4_PLANE: (0.05**2, 1.4**2, 0.3**2),
    Kind.ARDUPLANE: (0.1**2 * 0.012, 1.4**2, 0.03),
}
PLANES = tuple(NOISES)
STEP_NS = 20_000_000


def flown(
    filter_: WindFilter, seconds: float, yaw: float, turn: float, wind: np.ndarray, start: float
) -> np.ndarray:
    """The estimate after level flight without sideslip, the nose from `yaw` at `turn` [rad/s], in `wind`."""
    for k in range(round(seconds / 0.1)):
        t = start + 0.1 * k
        nose = yaw + turn * 0.1 * k
        over = SPEED * np.array([cos(nose), sin(nose)]) + wind
        motion = Motion(ZERO, Vec(over[0], over[1], 0.0), SPEED, 0.0, 0.0, nose)
        filter_.step(round(t * 1e9), motion, Air(Vec(*WIND, 0.0), ZERO), landed=False)
    return np.array(filter_.wind[:2])


@pytest.mark.parametrize("kind", PLANES)
def test_it_begins_near_the_wind_and_circles_find_the_rest(kind: Kind) -> None:
    filter_ = WindFilter(kind, EXACT._replace(north=0.9, east=-0.9))
    assert flown(filter_, 0.1, 0.0, 0.1, WIND, 0.0) == pytest.approx(WIND + np.array([0.9, -0.9]), abs=0.15)
    assert flown(filter_, 400.0, 0.0, 0.1, WIND, 0.1) == pytest.approx(WIND, abs=0.1)


@pytest.mark.parametrize("kind", PLANES)
@pytest.mark.parametrize("across", [False, True])
def test_a_changed_wind_is_learnt_with_the_lag_of_the_riccati_equation(kind: Kind, across: bool) -> None:
    """Flown north for long, then 1 m/s more from behind, or from the side: the gain is SciPy's."""
    walk, airspeed, sideslip = NOISES[kind]
    noise = sideslip * SPEED**2 if across else airspeed
    one = np.eye(1)
    spread = solve_discrete_are(one, one, walk * 0.1 * one, noise * one)[0, 0]
    left = 1.0 - spread / (spread + noise)  # of an error, after each update
    filter_ = WindFilter(kind, EXACT)
    before = flown(filter_, 3000.0, 0.0, 0.0, WIND, 0.0)
    assert before == pytest.approx(WIND, abs=1e-6)
    more = np.array([0.0, 1.0]) if across else np.array([1.0, 0.0])
    seconds = 20.0
    after = flown(filter_, seconds, 0.0, 0.0, WIND + more, 3000.0)
    assert (after - before) @ more == pytest.approx(1.0 - left ** (seconds / 0.1), rel=0.03, abs=0.002)


@pytest.mark.parametrize("kind", PLANES)
def test_an_airspeed_that_reads_too_much_is_a_headwind_until_it_circles(kind: Kind) -> None:
    """Straight on, 2 % of 40 m/s is 0.8 m/s from ahead; around circles such errors cancel."""
    wrong = EXACT._replace(airspeed=0.02)
    straight = flown(WindFilter(kind, wrong), 2000.0, 0.0, 0.0, WIND, 0.0)
    assert straight - WIND == pytest.approx([-0.8, 0.0], abs=0.08)
    filter_ = WindFilter(kind, wrong)
    turn = 0.2
    circles = [flown(filter_, 2.0, turn * 2.0 * k, turn, WIND, 2.0 * k) for k in range(round(600.0 / 2.0))]
    mean = np.mean(circles[-round(10 * 2 * pi / turn / 2.0) :], axis=0)
    assert hypot(*(mean - WIND)) < 0.15


@pytest.mark.parametrize("kind", PLANES)
def test_a_compass_that_is_wrong_is_a_wind_from_the_side(kind: Kind) -> None:
    """One degree at 40 m/s is 0.7 m/s: the filter believes the nose."""
    wrong = EXACT._replace(heading=radians(1.0))
    found = flown(WindFilter(kind, wrong), 4000.0, 0.0, 0.0, WIND, 0.0)
    assert found - WIND == pytest.approx([0.0, -SPEED * sin(radians(1.0))], abs=0.05)


@pytest.mark.parametrize("kind", [Kind.PX4, Kind.ARDUCOPTER])
def test_a_multicopter_reads_the_wind_off_its_lean(kind: Kind) -> None:
    """Hovering and flying fast in a steady wind; a drag taken 10 % too large reads a tenth too little."""
    spec = VehicleSpec(position=(0.0, 0.0, 50.0), speed=10.0, acceleration=4.0)
    air = Air(Vec(*WIND, 0.0), ZERO)
    copter = kinematic(spec, kind, start_motion(spec.start(), 0.3, kind, 10.0, air, True), air)
    step = 0
    exact, wrong = WindFilter(kind, EXACT), WindFilter(kind, EXACT._replace(drag=0.1))
    for demand, through in ((ZERO, WIND), (Vec(8.0, 3.0, 0.0), WIND - np.array([8.0, 3.0]))):
        for _ in range(1500):
            copter.step(Demand(Lateral.VELOCITY, demand, 0.0, 0.0, 0.0), air, 0.02)
            for filter_ in (exact, wrong):
                filter_.step(step * STEP_NS, copter.motion, air, False)
            step += 1
        assert exact.wind[:2] == pytest.approx(WIND, abs=0.05)
        over = np.array([demand.x, demand.y])
        assert wrong.wind[:2] == pytest.approx(over + through / 1.1, abs=0.05)


def test_on_the_ground_nothing_is_known() -> None:
    filter_ = WindFilter(Kind.ARDUPLANE, drawn_errors(key_of(3, 2, Purpose.ESTIMATE)))
    for k in range(100):
        filter_.step(k * STEP_NS, Motion(ZERO, ZERO, 0.0, 0.0, 0.0, 0.4), Air(Vec(5.0, 5.0, 0.0), ZERO), True)
    assert filter_.wind == ZERO


@pytest.mark.parametrize("kind", PLANES)
def test_after_a_take_off_the_first_minute_of_circling_finds_it(kind: Kind) -> None:
    filter_ = WindFilter(kind, EXACT)
    still = Motion(ZERO, ZERO, 0.0, 0.0, 0.0, 0.4)
    for k in range(20):
        filter_.step(round(k * 1e8), still, Air(Vec(*WIND, 0.0), ZERO), landed=True)
    assert flown(filter_, 60.0, 0.4, 0.15, WIND, 2.0) == pytest.approx(WIND, abs=0.5)


def test_the_errors_of_many_vehicles_are_as_large_as_stated() -> None:
    """1 % of airspeed, 1° of compass, half a metre a second at the start, 10 % of the drag: one sigma."""
    drawn = np.array([drawn_errors(key_of(seed, 2, Purpose.ESTIMATE)) for seed in range(4000)])
    assert np.mean(drawn, axis=0) == pytest.approx(np.zeros(5), abs=0.03)
    expected = Errors(0.01, radians(1.0), 0.5, 0.5, 0.1)
    assert np.std(drawn, axis=0) == pytest.approx(list(expected), rel=0.04)
    assert degrees(expected.heading) == pytest.approx(1.0)
