"""The loop as flown, as matrices: the kernel's own step, linearised about trimmed flight.

The step is linear while nothing saturates, so finite differences of it are exact to rounding.
The loop is cut where the controller's command enters the servo.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from sim_bridge.vehicle.flight import control_toolbox as linear
from sim_bridge.vehicle.flight.axis import (
    AxisLaw,
    AxisModel,
    AxisState,
    integrate,
    move,
    rate_asked,
    surface_asked,
)
from sim_bridge.vehicle.flight.control_toolbox import Array

SIZE = len(AxisState._fields)
SMALL = 1e-6  # [rad] well inside every limit


def _state(vector: Array) -> AxisState:
    return AxisState(*(float(value) for value in vector))


def _sample(
    model: AxisModel, law: AxisLaw, x: Array, wanted: float, cut: float | None
) -> tuple[Array, float]:
    """One sample towards the angle `wanted` [rad]: the next state, and the surface angle asked for [rad].

    `cut` is the command at the servo [rad], None = what the controller asks for: the loop is closed.
    """
    state = _state(x)
    rate = rate_asked(law, wanted - state.angle)
    asked = surface_asked(state, law, rate)
    command = asked if cut is None else cut
    after = move(state, model, law, command, integrate(state, law, rate, asked, asked), 0.0, 0.0)
    return np.array(after), asked


def _columns(model: AxisModel, law: AxisLaw, cut: float | None) -> tuple[Array, Array]:
    """What a small change of each state makes of the state (6, 6) and of the controller's answer (1, 6)."""
    a = np.zeros((SIZE, SIZE))
    c = np.zeros((1, SIZE))
    for column in range(SIZE):
        x = np.zeros(SIZE)
        x[column] = SMALL
        after, asked = _sample(model, law, x, 0.0, cut)
        a[:, column] = after / SMALL
        c[0, column] = asked / SMALL
    return a, c


def open_loop(model: AxisModel, law: AxisLaw, dt: float) -> Any:
    """L(z) from the servo's command to the controller's answer, sign such that 1 + L closes it."""
    a, c = _columns(model, law, 0.0)
    after, _ = _sample(model, law, np.zeros(SIZE), 0.0, SMALL)
    return linear.state_space(a, (after / SMALL).reshape(SIZE, 1), -c, np.zeros((1, 1)), dt)


def closed_loop(model: AxisModel, law: AxisLaw) -> Array:
    """The closed loop's transition matrix over a sample: (6, 6)."""
    return _columns(model, law, None)[0]


def closed_response(model: AxisModel, law: AxisLaw, dt: float) -> Any:
    """T(z) from the demanded angle to the angle."""
    after, _ = _sample(model, law, np.zeros(SIZE), SMALL, None)
    c = np.zeros((1, SIZE))
    c[0, AxisState._fields.index("angle")] = 1.0
    b = (after / SMALL).reshape(SIZE, 1)
    return linear.state_space(closed_loop(model, law), b, c, np.zeros((1, 1)), dt)
