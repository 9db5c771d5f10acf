"""Typed wrapper around python-control: the few calls that the flight models need.

python-control and scipy are imported here, at the first call (1.8 s), and never in a loop.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def control() -> Any:
    """The module python-control, imported at the first call."""
    import control as module

    return module


def state_space(a: Array, b: Array, c: Array, d: Array, dt: float = 0.0) -> Any:
    """A python-control state-space system; `dt` 0 means continuous."""
    return control().ss(a, b, c, d, dt) if dt > 0.0 else control().ss(a, b, c, d)


def hold(system: Any, dt: float) -> tuple[Array, Array, Array, Array]:
    """Exact discretisation for inputs held over `dt` [s]: (A, B, C, D)."""
    sampled = control().sample_system(system, dt, "zoh")
    return (
        np.asarray(sampled.A, dtype=float),
        np.asarray(sampled.B, dtype=float),
        np.asarray(sampled.C, dtype=float),
        np.asarray(sampled.D, dtype=float),
    )


def response(system: Any, omega: Array) -> NDArray[np.complex128]:
    """Frequency response of a single-input, single-output system at `omega` [rad/s]: (n,)."""
    return np.asarray(control().frequency_response(system, omega).frdata, dtype=complex).reshape(-1)


class Margins(NamedTuple):
    """Distance of an open loop from instability."""

    gain_db: float  # the loop gain may rise by this [dB]; infinite where it may rise for ever
    gain_down_db: float  # and fall by this [dB]
    phase_deg: float  # [deg] at the gain crossover where it is least
    phase_crossover: float  # [rad/s] where gain_db is read
    gain_crossover: float  # [rad/s] where phase_deg is read
    delay_s: float  # [s] the added delay that uses up the phase margin


def margins(system: Any, dt: float, points: int = 20000) -> Margins:
    """Margins of a sampled open loop, read from its frequency response.

    Not by polynomial roots: with two poles at z = 1 those find crossings at zero frequency.
    """
    omega = np.geomspace(1e-2, np.pi / dt * 0.9999, points)
    values = response(system, omega)
    size = 20.0 * np.log10(np.abs(values))
    phase = np.degrees(np.unwrap(np.angle(values)))
    phase -= 360.0 * np.round((phase[0] + 180.0) / 360.0)  # starts near −180: two integrators
    up, down, at_phase = np.inf, np.inf, float("nan")
    around = (phase + 180.0) / 360.0
    for k in np.flatnonzero(np.floor(around[1:]) != np.floor(around[:-1])):
        if abs(np.floor(around[k + 1]) - np.floor(around[k])) != 1:
            continue
        level = float(size[k])
        if level < 0.0 and -level < up:
            up, at_phase = -level, float(omega[k])
        if level > 0.0:
            down = min(down, level)
    least, at_gain, delay = np.inf, float("nan"), np.inf
    for k in np.flatnonzero(np.sign(size[1:]) != np.sign(size[:-1])):
        margin = float((phase[k] + 180.0 + 180.0) % 360.0 - 180.0)
        if abs(margin) < least:
            least, at_gain = abs(margin), float(omega[k])
        if margin > 0.0:
            delay = min(delay, float(np.radians(margin) / omega[k]))
    return Margins(float(up), float(down), float(least), at_phase, at_gain, float(delay))
