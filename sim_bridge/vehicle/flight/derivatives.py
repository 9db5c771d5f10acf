"""From stability derivatives to transfer functions: the equations of motion (33)–(35).

For users with an aircraft of their own: the result goes into the aircraft's configuration file.
Angles in degrees, speeds in m/s, as in the paper, with its factor k = 1/57.3 exactly π/180. Pitch up,
w_y up, yaw to the right and w_z to the right are positive; a positive surface turns down or left.

Readings of what is printed (docs/flight-model.md has them all in one table):

* the third equation of (33) uses one symbol for the coefficients of dV_gy/dt and V_gy, here `c_ydd` and
  `c_yd`;
* (34) as printed, with w_y upwards, gives the w_y numerator of (36) with the other sign: an updraft
  pushes the nose down. The source of (36) counts w_y downwards;
* (35) counts yaw to the left where w_z points to the right. Here yaw is to the right, so w_z enters with the
  other sign: a gust to the right turns the nose left, into the relative wind;
* w_z / V_b of (35) is an angle in radians. With the other angles in degrees it is (180/π) w_z / V_b.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial as poly
from numpy.typing import NDArray

from sim_bridge.vehicle.flight.transfer import AxisTransfer

Polynomial = NDArray[np.float64]  # lowest power first inside this file
K = pi / 180.0


class Longitudinal(NamedTuple):
    """Coefficients a, b, c of (33)–(34)."""

    speed: float  # V_b [m/s]
    b_yd: float  # vertical damping [1/s]
    c_theta: float  # pitch damping [1/s]
    c_delta: float  # elevator [1/s²]
    c_ydd: float = 0.0  # of dV_gy/dt
    c_yd: float = 0.0  # of V_gy
    b_xd: float = 0.0
    c_xd: float = 0.0
    a_theta: float = 0.0  # gravity, per degree, [m/s²]
    a_xd: float = 0.0  # drag [1/s]
    a_yd: float = 0.0


class Lateral(NamedTuple):
    """Coefficients k, l, n of (35)."""

    speed: float  # V_b [m/s]
    k_beta: float  # [1/s]
    n_beta: float  # weathercock stability [1/s²]
    n_psi: float  # yaw damping [1/s]
    n_rudder: float  # [1/s²]
    k_gamma: float = 0.0  # roll into slip [1/s]
    l_beta: float = 0.0
    l_gamma: float = 0.0  # roll damping [1/s]
    l_psi: float = 0.0
    l_aileron: float = 0.0
    n_gamma: float = 0.0


class Transfer(NamedTuple):
    """A numerator over a denominator, highest power of s first."""

    numerator: tuple[float, ...]
    denominator: tuple[float, ...]


def short_period(d: Longitudinal) -> AxisTransfer:
    """(34): elevator, w_x and w_y to the pitch rate [deg/s]."""
    turn = K * d.speed
    determinant = (1.0, d.b_yd + d.c_theta + turn * d.c_ydd, d.b_yd * d.c_theta + turn * d.c_yd)
    return AxisTransfer(
        determinant,
        surface=(-d.c_delta, -d.c_delta * d.b_yd),
        wind1=(d.c_xd - d.b_xd * d.c_ydd, d.c_xd * d.b_yd - d.b_xd * d.c_yd),
        wind2=(d.b_yd * d.c_ydd - d.c_yd, 0.0),
    )


def yaw(d: Lateral) -> AxisTransfer:
    """(35) without roll, as the paper discards it: rudder and w_z to the yaw rate [deg/s; right]."""
    determinant = (1.0, d.k_beta + d.n_psi, d.k_beta * d.n_psi + d.n_beta)
    return AxisTransfer(
        determinant,
        surface=(-d.n_rudder, -d.n_rudder * d.k_beta),
        wind1=(d.n_beta * slip_per_wind(d), 0.0),
        wind2=(0.0,),
    )


def slip_per_wind(d: Lateral) -> float:
    """β that a side wind to the right makes, yaw counted to the right [deg per m/s]: −(180/π) / V_b."""
    return -1.0 / (K * d.speed)


def longitudinal(d: Longitudinal) -> dict[str, Transfer]:
    """All of (33), phugoid included: elevator, w_x and w_y to the pitch rate [deg/s].

    Keys: `elevator`, `wind_x`, `wind_y`; all over one denominator of degree four.
    """
    v = K * d.speed
    # unknowns: pitch θ [deg], ΔV_gx, V_gy; rows: the three equations; polynomials lowest power first
    system = [
        [_p(d.a_theta), _p(d.a_xd, 1.0), _p(d.a_yd)],
        [_p(0.0, v), _p(-d.b_xd), _p(d.b_yd, 1.0)],
        [_p(0.0, d.c_theta, 1.0), _p(d.c_xd), _p(-d.c_yd, -d.c_ydd)],
    ]
    inputs = {
        "elevator": [_p(0.0), _p(0.0), _p(-d.c_delta)],
        "wind_x": [_p(d.a_xd), _p(-d.b_xd), _p(d.c_xd)],
        "wind_y": [_p(d.a_yd), _p(d.b_yd), _p(-d.c_yd)],
    }
    return _rates(system, inputs, unknown=0)


def lateral(d: Lateral) -> dict[str, Transfer]:
    """All of (35), roll included: rudder, aileron and w_z to the yaw rate [deg/s; right].

    Keys: `rudder`, `aileron`, `wind_z`; all over one denominator.
    """
    # unknowns: yaw ψ, slip β_g, roll γ [deg]
    system = [
        [_p(0.0, -1.0), _p(d.k_beta, 1.0), _p(-d.k_gamma)],
        [_p(0.0, d.l_psi), _p(d.l_beta), _p(0.0, d.l_gamma, 1.0)],
        [_p(0.0, d.n_psi, 1.0), _p(d.n_beta), _p(0.0, d.n_gamma)],
    ]
    wind = slip_per_wind(d)
    inputs = {
        "rudder": [_p(0.0), _p(0.0), _p(-d.n_rudder)],
        "aileron": [_p(0.0), _p(-d.l_aileron), _p(0.0)],
        "wind_z": [_p(d.k_beta * wind), _p(d.l_beta * wind), _p(d.n_beta * wind)],
    }
    return _rates(system, inputs, unknown=0)


def _p(*coefficients: float) -> Polynomial:
    return np.array(coefficients, dtype=float)


def _determinant(m: list[list[Polynomial]]) -> Polynomial:
    """Determinant of a 3 × 3 matrix of polynomials."""
    total: Polynomial = np.array([0.0])
    even, odd = ((0, 1, 2), (1, 2, 0), (2, 0, 1)), ((0, 2, 1), (2, 1, 0), (1, 0, 2))
    for (i, j, k), sign in [*((p, 1) for p in even), *((p, -1) for p in odd)]:
        term = poly.polymul(poly.polymul(m[0][i], m[1][j]), m[2][k])
        total = _p(*poly.polyadd(total, sign * term))
    return total


def _rates(
    system: list[list[Polynomial]], inputs: dict[str, list[Polynomial]], unknown: int
) -> dict[str, Transfer]:
    """Cramer's rule for s × unknown, with common factors of s cancelled."""
    below = poly.polytrim(_determinant(system))
    found: dict[str, Polynomial] = {}
    for name, column in inputs.items():
        replaced = [[column[r] if c == unknown else system[r][c] for c in range(3)] for r in range(3)]
        found[name] = poly.polymul(_determinant(replaced), np.array([0.0, 1.0]))  # the rate: times s
    while below[0] == 0.0 and not any(np.any(above[:1]) for above in found.values()):
        below = below[1:]
        found = {name: above[1:] if len(above) > 1 else above for name, above in found.items()}
    lead = below[-1]
    return {
        name: Transfer(
            tuple(float(value / lead) for value in poly.polytrim(above)[::-1]),
            tuple(float(value / lead) for value in below[::-1]),
        )
        for name, above in found.items()
    }
