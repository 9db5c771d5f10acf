"""A multicopter in moving air, by first principles and by a state space of SciPy's.

None of the product's numbers but the two it is asked about: rotor drag a unit of mass, and the loop's gains.
"""

from __future__ import annotations

from math import atan, atan2, exp, hypot, radians, sqrt, tan

import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov

from onboard.core.math.vectors import ZERO, Vec
from onboard.game.scenario import Kind, VehicleSpec, WindSpec
from sim_bridge.vehicle.flight.kinematic import KinematicMulticopter, ability_of, kinematic, start_motion
from sim_bridge.vehicle.flight.multicopter_wind import DRAG, LOOPS, WindLoop, wind_held
from sim_bridge.vehicle.motion import CALM, Air, Demand, Lateral
from sim_bridge.vehicle.wind.field import WindField

DT = 0.02
G = 9.80665
SPEC = VehicleSpec(position=(0.0, 0.0, 50.0), speed=10.0, acceleration=4.0)
PUBLISHED = 0.1  # [m] hover accuracy of a DJI Phantom 4 RTK (1391 g) whose position is exact (RTK): its sheet
COPTERS = (Kind.PX4, Kind.ARDUCOPTER)


def still() -> Demand:
    return Demand(Lateral.VELOCITY, ZERO, 0.0, 0.0, 0.0)


def hovering(kind: Kind, air: Air = CALM, loop: WindLoop | None = None) -> KinematicMulticopter:
    start = start_motion(SPEC.start(), 0.0, kind, 10.0, air, True)
    if loop is not None:
        return KinematicMulticopter(ability_of(SPEC, kind), start, loop)
    made = kinematic(SPEC, kind, start, air)
    assert isinstance(made, KinematicMulticopter)
    return made


def test_the_drag_is_that_of_a_quadrotor_of_one_and_a_half_kilograms() -> None:
    """RotorS's Iris: thrust 5.84e-6 N s², rotor drag 1.75e-4 N s²/m per rad/s, four rotors, 1.5 kg."""
    spin = sqrt(1.5 * G / (4.0 * 5.84e-6))
    assert pytest.approx(4.0 * 1.75e-4 * spin / 1.5, rel=1e-3) == DRAG
    assert 18.0 < np.degrees(atan(DRAG * 10.0 / G)) < 23.0  # what such vehicles lean in 10 m/s


@pytest.mark.parametrize("kind", COPTERS)
def test_with_its_thrust_upright_it_drifts_as_fast_as_the_wind(kind: Kind) -> None:
    upright = LOOPS[kind]._replace(tilt_max=0.0)
    copter, air = hovering(kind, loop=upright), Air(Vec(6.0, -2.0, 0.0), ZERO)
    for step in range(1, 1501):
        copter.step(still(), air, DT)
        v = copter.motion.velocity
        assert (v.x, v.y) == pytest.approx(
            [w * (1.0 - exp(-DRAG * step * DT)) for w in (6.0, -2.0)], abs=0.03
        )
    assert (v.x, v.y) == pytest.approx((6.0, -2.0), rel=1e-3)


@pytest.mark.parametrize("kind", COPTERS)
def test_in_a_steady_wind_it_leans_by_what_the_drag_asks(kind: Kind) -> None:
    copter, air = hovering(kind), Air(Vec(8.0, 3.0, 0.0), ZERO)
    for _ in range(3000):
        copter.step(still(), air, DT)
    m = copter.motion
    lean = atan(hypot(tan(m.roll), tan(m.pitch)))
    assert lean == pytest.approx(atan(DRAG * hypot(8.0, 3.0) / G), rel=1e-3)
    assert atan2(tan(m.roll), -tan(m.pitch)) == pytest.approx(atan2(-3.0, -8.0), abs=1e-3)  # into it
    assert m.velocity == pytest.approx(ZERO, abs=1e-3)
    assert copter.wind_estimate == pytest.approx(air.wind, abs=0.01)
    assert hovering(kind, air).step(still(), air, DT).velocity == pytest.approx(ZERO, abs=1e-9)  # settled


@pytest.mark.parametrize("kind", COPTERS)
def test_the_tilt_limit_says_in_what_wind_it_keeps_its_place(kind: Kind) -> None:
    most = G * tan(LOOPS[kind].tilt_max) / DRAG
    assert wind_held(LOOPS[kind].tilt_max) == pytest.approx(most)
    assert most > 15.0
    for share, drift in ((0.97, 0.0), (1.2, 0.2)):
        copter, air = hovering(kind), Air(Vec(share * most, 0.0, 0.0), ZERO)
        for _ in range(6000):
            copter.step(still(), air, DT)
        m = copter.motion
        assert abs(m.pitch) <= LOOPS[kind].tilt_max + 1e-9
        assert m.velocity.x == pytest.approx(drift * most, abs=0.02)


def test_in_still_air_nothing_is_changed() -> None:
    copter = hovering(Kind.PX4)
    for step in range(400):
        wanted = Vec(8.0, -3.0, 1.0) if step < 200 else Vec(-5.0, 0.0, 0.0)
        before = copter.motion.velocity
        after = copter.step(Demand(Lateral.VELOCITY, wanted, 0.0, 0.0, 0.0), CALM, DT).velocity
        change = np.subtract(after, before)
        assert np.linalg.norm(change) <= 4.0 * DT + 1e-12
    assert copter.motion.velocity == Vec(-5.0, 0.0, 0.0)


def expected_rms(loop: WindLoop, sigma: float, tau: float) -> float:
    """The position's rms [m] along longitudinal Dryden gusts, held by a position gain of 1/s: Lyapunov."""
    a = np.zeros((5, 5))  # place, deviation of velocity, lean, integral, gust
    a[0, :2] = -1.0, 1.0
    a[1, 1:] = -DRAG, 1.0, 0.0, DRAG
    a[2, 1:4] = -loop.gain / loop.lag, -1.0 / loop.lag, 1.0 / loop.lag
    a[3, 1] = -loop.integral
    a[4, 4] = -1.0 / tau
    b = np.zeros((5, 1))
    b[4, 0] = sigma * sqrt(2.0 / tau)
    return float(sqrt(solve_continuous_lyapunov(a, -b @ b.T)[0, 0]))


@pytest.mark.parametrize("kind", COPTERS)
def test_gusts_move_it_by_what_its_loops_let_through(kind: Kind) -> None:
    spec = WindSpec(speed=7.0, from_deg=180.0, gust_sigma=1.5)
    count, steps = 6, 5000
    field = WindField(spec, 3, range(1, count + 1))
    copters = [hovering(kind, Air(Vec(7.0, 0.0, 0.0), ZERO)) for _ in range(count)]
    places, speeds = np.empty((steps, count)), np.empty((steps, count))
    for k in range(steps):
        for i, copter in enumerate(copters):
            m = copter.motion
            p = m.position
            back = Vec(-p.x, -p.y, -50.0 - p.z)  # what HOLD asks near its place
            copter.step(Demand(Lateral.VELOCITY, back, 0.0, 0.0, 0.0), field.air(i, m, k * DT), DT)
            places[k, i], speeds[k, i] = p.x, m.airspeed
    feet = 50.0 / 0.3048
    length = feet / (0.177 + 0.000823 * feet) ** 1.2 * 0.3048
    expected = expected_rms(LOOPS[kind], 1.5, length / float(np.mean(speeds)))
    print(f"\n{kind.value}: {np.std(places[500:]):.3f} m, expected {expected:.3f} m")
    assert float(np.std(places[500:])) == pytest.approx(expected, rel=0.25)
    assert 0.01 < expected < PUBLISHED
    assert radians(5.0) < float(np.max(np.abs([c.motion.pitch for c in copters]))) < LOOPS[kind].tilt_max
