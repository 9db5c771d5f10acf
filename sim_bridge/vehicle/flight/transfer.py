"""Transfer functions (36)–(37) of an axis, and the exact sampled model the kernel steps.

Coefficients run from the highest power of s down. Surface to rate: degrees to degrees per second.
Wind to rate: m/s to degrees per second. `sampled` turns all into radians.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import NamedTuple

import numpy as np

from onboard.config.strict import ConfigError
from sim_bridge.vehicle.flight.axis import AxisModel
from sim_bridge.vehicle.flight.control_toolbox import Array

LEAST_SHARE = (
    0.2  # of the coefficient that the denominator implies: V_b is not exactly known; 57.3 is refused
)
ORDER = 2  # of the denominators: the short-period and the yaw motion


class AxisTransfer(NamedTuple):
    """Three transfer functions over one denominator, as in (36) and (37)."""

    denominator: tuple[float, ...]
    surface: tuple[float, ...]  # elevator or rudder [deg] → rate [deg/s]
    wind1: tuple[float, ...]  # w_x or w_z [m/s] → rate [deg/s]
    wind2: tuple[float, ...]  # w_y or nothing

    @property
    def steady(self) -> float:
        """Steady rate per surface angle [1/s]."""
        return self.surface[-1] / self.denominator[-1]


def check(transfer: AxisTransfer, name: str, keys: tuple[str, str, str, str]) -> None:
    """Refuse what cannot fly. Raises ConfigError with the reason; `keys` name the four polynomials."""
    key = keys[0]
    denominator = transfer.denominator
    if len(denominator) != ORDER + 1 or denominator[0] == 0.0:
        raise ConfigError(
            f"{name}: {key}: found {list(denominator)}, expected a polynomial of degree {ORDER} "
            "(three coefficients, the first not zero)"
        )
    unstable = [pole for pole in np.roots(denominator) if pole.real >= 0.0]
    if unstable:
        pole = unstable[0]
        raise ConfigError(
            f"{name}: {key}: unstable: found a pole at {pole.real:.4g}{pole.imag:+.4g}j, "
            "expected every pole left of the imaginary axis"
        )
    for key, numerator in zip(keys[1:], (transfer.surface, transfer.wind1, transfer.wind2), strict=True):
        trimmed = trim(numerator)
        if len(trimmed) > len(denominator):
            raise ConfigError(
                f"{name}: {key}: improper: found degree {len(trimmed) - 1} over degree {ORDER}, "
                f"expected at most {ORDER}"
            )
    if not transfer.surface or transfer.surface[-1] == 0.0:
        raise ConfigError(
            f"{name}: {keys[1]}: found a zero at s = 0 (no steady effect), "
            "expected a last coefficient that is not zero"
        )


def weathercock(transfer: AxisTransfer, speed: float) -> float:
    """What (34) and (35) say of the wind across the path: the leading coefficient to expect [deg/s² per m/s].

    Both have the form v' + b v ± k V ω = b w, ω' + c ω − m v = −m w: the surface's zero is −b, the
    denominator s² + (b + c) s + b c + k V m, and the wind's numerator −m s. `speed` is V_b [m/s].
    """
    lead, first, last = transfer.denominator
    slope, level = (0.0, 0.0, *transfer.surface)[-2:]
    lag = level / slope if slope != 0.0 else 0.0
    return -(last / lead - lag * (first / lead - lag)) / (speed * pi / 180.0)


def check_wind(transfer: AxisTransfer, across: tuple[float, ...], speed: float, place: str) -> None:
    """Refuse the wrong sign or unit of the wind across the path. Raises ConfigError with the reason.

    An updraft pushes the nose down, a gust to the right turns it left; `across` is that numerator, `place`
    names it. Nothing but zeros is accepted: an aircraft that the wind does not turn.
    """
    if not any(across):
        return
    expected = weathercock(transfer, speed)
    if expected >= 0.0:  # the denominator says that it is no weathercock: nothing to compare with
        return
    found = (0.0, 0.0, *across)[-2] / transfer.denominator[0]
    if not LEAST_SHARE * expected >= found >= expected / LEAST_SHARE:
        raise ConfigError(
            f"{place}: found {found:.3g} deg/s² per m/s as its coefficient of s, expected about "
            f"{expected:.3g} by the denominator: the nose turns into the relative wind "
            "(negative), angles are in degrees"
        )


def trim(polynomial: Sequence[float]) -> tuple[float, ...]:
    """A polynomial without its leading zeros, highest power first."""
    for index, value in enumerate(polynomial):
        if value != 0.0:
            return tuple(polynomial[index:])
    return (0.0,)


def matrices(transfer: AxisTransfer) -> tuple[Array, Array, Array, Array]:
    """Observable canonical form of the three functions together: A (2, 2), B (2, 3), C (1, 2), D (1, 3)."""
    lead, first, last = transfer.denominator
    a1, a0 = first / lead, last / lead
    b = np.zeros((2, 3))
    d = np.zeros((1, 3))
    for column, numerator in enumerate((transfer.surface, transfer.wind1, transfer.wind2)):
        padded = (0.0, 0.0, 0.0, *numerator)[-3:]
        n2, n1, n0 = (value / lead for value in padded)
        b[0, column] = n1 - n2 * a1
        b[1, column] = n0 - n2 * a0
        d[0, column] = n2
    return np.array([[-a1, 1.0], [-a0, 0.0]]), b, np.array([[1.0, 0.0]]), d


def held(a: Array, b: Array, dt: float) -> tuple[Array, Array]:
    """The exact transition over `dt` [s] of x' = A x + B u, and what an input held over it adds: (A, B).

    What python-control finds too (`control_toolbox.hold`), whose import takes longer than many a flight.
    """
    from scipy.linalg import expm

    n = len(a)
    wide = np.zeros((n + b.shape[1], n + b.shape[1]))
    wide[:n, :n], wide[:n, n:] = a, b
    found = np.asarray(expm(dt * wide), dtype=float)
    return found[:n, :n], found[:n, n:]


def sampled(transfer: AxisTransfer, dt: float) -> AxisModel:
    """The exact model for inputs held over `dt` [s], in radians: rate, and its integral, the angle."""
    a, b, c, d = matrices(transfer)
    radians = np.diag([1.0, pi / 180.0, pi / 180.0])  # winds arrive in m/s, surfaces in radians
    b, d = b @ radians, d @ radians
    wide = np.zeros((3, 3))
    wide[:2, :2] = a
    wide[2, :2] = c[0]
    ad, bd = held(wide, np.vstack([b, d]), dt)
    values = (
        ad[0, 0], ad[0, 1], ad[1, 0], ad[1, 1],
        bd[0, 0], bd[1, 0], bd[0, 1], bd[1, 1], bd[0, 2], bd[1, 2],
        c[0, 0], c[0, 1], d[0, 0], d[0, 1], d[0, 2],
        ad[2, 0], ad[2, 1], bd[2, 0], bd[2, 1], bd[2, 2],
    )  # fmt: skip
    return AxisModel(*(float(value) for value in values))
