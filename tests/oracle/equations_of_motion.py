"""Aircraft in gusts from first principles: vectors, forces and moments in radians. Nothing of the product.

A fin turns the nose into the relative wind; the side force carries the path after the nose. The same in the
vertical plane with the tail and the lift. Constants are those that (36) and (37) imply by (34) and (35).
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, sin

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Gust = Callable[[float], float]

# (37): zero −k_β, denominator s² + (k_β + n_ψ) s + k_β n_ψ + n_β; 0.072 = n_β / V_b
K_BETA = 0.75 / 4.5
N_PSI = 1.1 - K_BETA
N_BETA = 4.2 - K_BETA * N_PSI
V_YAW = N_BETA / 0.072
# (36), over 0.139: zero −b_y, denominator s² + (b_y + c_θ) s + b_y c_θ + M; 0.355 = 0.139 M / (k V_b)
B_Y = 1.213 / 0.753
C_THETA = 0.537 / 0.139 - B_Y
M_ALPHA = 1.0 / 0.139 - B_Y * C_THETA
V_PITCH = np.degrees(M_ALPHA) * 0.139 / 0.355


def nose_in_side_gust(gust: Gust, times: Array, heading: float = 0.0) -> Array:
    """Angle of the nose [rad, to the right, from `heading`] in a gust to the right of `heading` [m/s]."""
    right = np.array([-sin(heading), cos(heading)])

    def rates(t: float, x: Array) -> list[float]:
        psi, turning, north, east = x
        relative = np.array([north, east]) - gust(t) * right
        slip = _within(atan2(relative[1], relative[0]) - psi)  # how far right of the nose the air is met
        force = -K_BETA * V_YAW * slip  # [m/s²] to the right of the nose: against the slip
        return [turning, N_BETA * slip - N_PSI * turning, -force * sin(psi), force * cos(psi)]

    first = [heading, 0.0, V_YAW * cos(heading), V_YAW * sin(heading)]
    return _solve(rates, first, times)[0] - heading


def nose_in_updraft(gust: Gust, times: Array) -> Array:
    """Pitch of the nose [rad, up, from trim] in a gust upwards [m/s]."""

    def rates(t: float, x: Array) -> list[float]:
        theta, turning, rising = x
        alpha = theta - atan2(rising - gust(t), V_PITCH)  # the nose above where the air is met
        return [turning, -M_ALPHA * alpha - C_THETA * turning, B_Y * V_PITCH * alpha]

    return _solve(rates, [0.0, 0.0, 0.0], times)[0]


def _within(angle: float) -> float:
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def _solve(rates: Callable[[float, Array], list[float]], first: list[float], times: Array) -> Array:
    found = solve_ivp(
        rates, (0.0, float(times[-1])), first, t_eval=times, max_step=0.01, rtol=1e-8, atol=1e-10
    )
    assert found.success, found.message
    return np.asarray(found.y)


def response(e: Array, a: Array, b: Array, c: Array, omega: Array) -> NDArray[np.complex128]:
    """Frequency response of E x' = A x + B u, y = C x, at `omega` [rad/s]."""
    return np.array([c @ np.linalg.solve(1j * w * e - a, b) for w in omega])


def lateral_35(n: dict[str, float], omega: Array) -> dict[str, NDArray[np.complex128]]:
    """(35) as printed (yaw to the left, w_z to the right), all in radians: to the yaw rate [rad/s; left].

    States β, ψ', γ, γ'; inputs rudder, aileron [rad], w_z [m/s].
    """
    v = n["speed"]
    a = np.array([
        [-n["k_beta"], 1.0, n["k_gamma"], 0.0],
        [-n["n_beta"], -n["n_psi"], 0.0, -n["n_gamma"]],
        [0.0, 0.0, 0.0, 1.0],
        [-n["l_beta"], -n["l_psi"], 0.0, -n["l_gamma"]],
    ])  # fmt: skip
    inputs = {
        "rudder": np.array([0.0, -n["n_rudder"], 0.0, 0.0]),
        "aileron": np.array([0.0, 0.0, 0.0, -n["l_aileron"]]),
        "wind_z": np.array([n["k_beta"] / v, n["n_beta"] / v, 0.0, n["l_beta"] / v]),
    }
    out = np.array([0.0, 1.0, 0.0, 0.0])
    return {name: response(np.eye(4), a, b, out, omega) for name, b in inputs.items()}


def longitudinal_33(n: dict[str, float], omega: Array) -> dict[str, NDArray[np.complex128]]:
    """(33) with angles in degrees as printed with k: to the pitch rate [deg/s; up].

    States θ, θ', ΔV_gx, V_gy; inputs elevator [deg], w_x and w_y (up) [m/s].
    """
    kv = n["speed"] * np.pi / 180.0
    e = np.eye(4)
    e[1, 3] = -n["c_ydd"]
    a = np.array([
        [0.0, 1.0, 0.0, 0.0],
        [0.0, -n["c_theta"], -n["c_xd"], n["c_yd"]],
        [-n["a_theta"], 0.0, -n["a_xd"], -n["a_yd"]],
        [0.0, -kv, n["b_xd"], -n["b_yd"]],
    ])  # fmt: skip
    inputs = {
        "elevator": np.array([0.0, -n["c_delta"], 0.0, 0.0]),
        "wind_x": np.array([0.0, n["c_xd"], n["a_xd"], -n["b_xd"]]),
        "wind_y": np.array([0.0, -n["c_yd"], n["a_yd"], n["b_yd"]]),
    }
    out = np.array([0.0, 1.0, 0.0, 0.0])
    return {name: response(e, a, b, out, omega) for name, b in inputs.items()}
