"""The sampled models against python-control, and the equations of motion against the printed constants."""

from __future__ import annotations

import subprocess
import sys
from math import pi

import control
import numpy as np
import pytest

from sim_bridge.vehicle.flight.aircraft import Aircraft, named
from sim_bridge.vehicle.flight.axis import AxisLaw, AxisModel, AxisState, move
from sim_bridge.vehicle.flight.derivatives import (
    K,
    Lateral,
    Longitudinal,
    lateral,
    longitudinal,
    short_period,
    yaw,
)
from sim_bridge.vehicle.flight.transfer import AxisTransfer, held, matrices, sampled

OPEN = AxisLaw(0.0, 1.0, 0.0, 0.0, 0.0, 1e9, 1.0, 1e9)  # no controller, a servo that follows at once
AXES = ["pitch", "yaw"]


@pytest.fixture(scope="module")
def aircraft() -> Aircraft:
    return named("nose")


def transfer_of(aircraft: Aircraft, axis: str) -> AxisTransfer:
    return aircraft.pitch if axis == "pitch" else aircraft.yaw


@pytest.mark.parametrize("name", ["nose", "slip", "coordinated"])
@pytest.mark.parametrize("dt", [0.01, 0.025, 0.05])
def test_the_hold_is_that_of_python_control(name: str, dt: float) -> None:
    for axis in AXES:
        a, b, _, _ = matrices(transfer_of(named(name), axis))
        ours = held(a, b, dt)
        theirs = control.sample_system(control.ss(a, b, np.eye(2), np.zeros((2, 3))), dt, "zoh")
        np.testing.assert_allclose(ours[0], theirs.A, rtol=1e-13)
        np.testing.assert_allclose(ours[1], theirs.B, rtol=1e-13)


def test_an_aircraft_is_loaded_without_python_control() -> None:
    told = (
        "import sys; from sim_bridge.vehicle.flight.aircraft import named; named('nose');"
        "print([name for name in ('control', 'scipy.signal', 'matplotlib') if name in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", told], check=True, capture_output=True, text=True)
    assert found.stdout.strip() == "[]"


@pytest.mark.parametrize("axis", AXES)
def test_the_state_space_has_the_printed_poles_zeros_and_steady_gains(aircraft: Aircraft, axis: str) -> None:
    transfer = transfer_of(aircraft, axis)
    a, b, c, d = matrices(transfer)
    for column, numerator in enumerate((transfer.surface, transfer.wind1, transfer.wind2)):
        if not any(numerator):
            assert not b[:, column].any()
            continue
        ours = control.ss(a, b[:, [column]], c, d[:, [column]])
        theirs = control.tf(list(numerator), list(transfer.denominator))
        np.testing.assert_allclose(np.sort(ours.poles()), np.sort(theirs.poles()), atol=1e-9)
        assert control.dcgain(ours) == pytest.approx(control.dcgain(theirs), abs=1e-9)
        if len(theirs.zeros()):
            np.testing.assert_allclose(np.sort(ours.zeros()), np.sort(theirs.zeros()), atol=1e-9)


def test_the_printed_constants_give_the_known_figures(aircraft: Aircraft) -> None:
    assert aircraft.pitch.steady == pytest.approx(-1.213)
    assert aircraft.yaw.steady == pytest.approx(-0.75 / 4.2)
    poles = np.roots(aircraft.pitch.denominator)
    assert abs(poles[0]) == pytest.approx(2.682, abs=1e-3)
    assert -poles[0].real / abs(poles[0]) == pytest.approx(0.720, abs=1e-3)
    poles = np.roots(aircraft.yaw.denominator)
    assert abs(poles[0]) == pytest.approx(2.049, abs=1e-3)
    assert -poles[0].real / abs(poles[0]) == pytest.approx(0.268, abs=1e-3)


def run(model: AxisModel, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rates and angles of the kernel under held inputs (n, 3)."""
    state = AxisState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    rates, angles = [], []
    for surface, first, second in inputs:
        state = state._replace(surface=float(surface))  # the plant sees what stands at the start
        state = move(state, model, OPEN, float(surface), 0.0, float(first), float(second))
        rates.append(state.rate)
        angles.append(state.angle)
    return np.array(rates), np.array(angles)


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("rate_hz", [100.0, 250.0])
@pytest.mark.parametrize("column", [0, 1, 2])
def test_steps_agree_with_python_control(aircraft: Aircraft, axis: str, rate_hz: float, column: int) -> None:
    transfer = transfer_of(aircraft, axis)
    dt = 1.0 / rate_hz
    numerator = (transfer.surface, transfer.wind1, transfer.wind2)[column]
    inputs = np.zeros((600, 3))
    inputs[:, column] = 1.0
    rates, angles = run(sampled(transfer, dt), inputs)
    unit = 1.0 if column == 0 else pi / 180.0  # winds give degrees in the file, radians in the kernel
    system = control.tf(list(numerator), list(transfer.denominator))
    time = dt * np.arange(601)
    expected = control.step_response(system, time).outputs * unit
    np.testing.assert_allclose(rates, expected[1:], atol=1e-9)
    turned = control.step_response(system * control.tf([1], [1, 0]), time).outputs * unit
    np.testing.assert_allclose(angles, turned[1:], atol=1e-9)


@pytest.mark.parametrize("axis", AXES)
def test_the_frequency_response_agrees_with_python_control(aircraft: Aircraft, axis: str) -> None:
    transfer = transfer_of(aircraft, axis)
    dt = 0.01
    m = sampled(transfer, dt)
    a = np.array([[m.a11, m.a12], [m.a21, m.a22]])
    omega = np.geomspace(0.01, 300.0, 200)
    columns = (
        (transfer.surface, (m.bs1, m.bs2), m.ds, 1.0),
        (transfer.wind1, (m.bp1, m.bp2), m.dp, pi / 180.0),
        (transfer.wind2, (m.bq1, m.bq2), m.dq, pi / 180.0),
    )
    for numerator, b, d, unit in columns:
        ours = control.ss(a, np.reshape(b, (2, 1)), np.array([[m.c1, m.c2]]), [[d]], dt)
        continuous = control.tf(list(numerator), list(transfer.denominator))
        theirs = control.sample_system(control.ss(continuous), dt, "zoh")
        np.testing.assert_allclose(
            control.frequency_response(ours, omega).frdata.reshape(-1),
            control.frequency_response(theirs, omega).frdata.reshape(-1) * unit,
            atol=1e-9,
        )


def test_equations_34_recover_36() -> None:
    lead = 0.139
    b_yd = 1.213 / 0.753
    turn = 1.396  # k V_b
    c_delta = 0.753 / lead
    # the two unknown coefficients of V_gy follow from the damping and from the numerator of w_y
    c_theta = 1.2
    c_ydd = (0.537 / lead - b_yd - c_theta) / turn
    c_yd = b_yd * c_ydd + 0.355 / lead
    found = short_period(
        Longitudinal(turn / K, b_yd, c_theta, c_delta, c_ydd, c_yd, c_xd=0.057 / lead / b_yd)
    )
    np.testing.assert_allclose(np.array(found.denominator) * lead, [lead, 0.537, 1.0], atol=2e-3)
    np.testing.assert_allclose(np.array(found.surface) * lead, [-0.753, -1.213], atol=1e-12)
    # the source of (36) has w_y downwards: an updraft pushes the nose down
    np.testing.assert_allclose(np.array(found.wind2) * lead, [-0.355, 0.0], atol=1e-12)
    assert found.wind1[-1] * lead == pytest.approx(0.057)


def test_no_aircraft_of_34_has_the_sign_of_w_y_that_36_prints() -> None:
    """With w_y upwards no choice of c_θ gives both the denominator and the printed w_y numerator of (36)."""
    lead = 0.139
    b_yd = 1.213 / 0.753
    damping, stiffness = 0.537 / lead, 1.0 / lead
    # b_yd · (first) − (second) of the denominator's equations leaves k V_b · (w_y's numerator)
    product = b_yd * (damping - b_yd) - stiffness
    assert product / (0.355 / lead) == pytest.approx(-1.396, abs=1e-2)


def test_equations_35_without_roll_recover_37_but_for_the_unit_and_the_constant_of_w_z() -> None:
    """0.072 is n_β / V_b in rad/s per m/s, with yaw to the left; in degrees to the right −4.125."""
    k_beta = 0.75 / 4.5
    n_psi = 1.1 - k_beta
    n_beta = 4.2 - k_beta * n_psi
    found = yaw(Lateral(n_beta / 0.072, k_beta, n_beta, n_psi, 4.5))
    np.testing.assert_allclose(found.denominator, [1.0, 1.1, 4.2], atol=1e-12)
    np.testing.assert_allclose(found.surface, [-4.5, -0.75], atol=1e-12)
    assert found.wind1[0] == pytest.approx(-0.072 * 180.0 / pi)
    assert found.wind1[0] == pytest.approx(named("nose").yaw.wind1[0], rel=1e-4)
    assert found.wind1[1] == 0.0  # a uniform wind turns nobody: the printed 0.175 cannot come from here


def test_the_full_lateral_equations_fall_back_to_the_yaw_ones_without_roll() -> None:
    d = Lateral(56.0, 1 / 6, 4.04, 0.93, 4.5, l_gamma=2.0)
    full = lateral(d)["rudder"]
    small = yaw(d)
    omega = np.geomspace(0.01, 50.0, 50)
    np.testing.assert_allclose(
        control.frequency_response(control.tf(*map(list, full)), omega).frdata.reshape(-1),
        control.frequency_response(
            control.tf(list(small.surface), list(small.denominator)), omega
        ).frdata.reshape(-1),
        rtol=1e-9,
    )


def test_the_short_period_is_the_fast_part_of_the_full_longitudinal_motion() -> None:
    d = Longitudinal(80.0, 1.6, 1.5, 5.4, c_ydd=0.2, c_yd=2.0, b_xd=0.2, a_theta=9.8 * K, a_xd=0.05, a_yd=0.1)
    full = longitudinal(d)["elevator"]
    small = short_period(d)
    assert len(full.denominator) == 5  # short period and phugoid
    omega = np.array([3.0, 10.0, 30.0])
    wide = control.frequency_response(control.tf(*map(list, full)), omega).frdata.reshape(-1)
    short = control.frequency_response(
        control.tf(list(small.surface), list(small.denominator)), omega
    ).frdata.reshape(-1)
    np.testing.assert_allclose(np.abs(wide / short), 1.0, atol=0.05)
