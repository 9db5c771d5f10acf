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


def _cut(model: AxisModel, law: AxisLaw, x: Array, command: float, wanted: float) -> tuple[Array, float]:
    """One sample with `command` at the servo; returns the next state and what the controller asks for."""
    state = _state(x)
    rate = rate_asked(law, wanted - state.angle)
    asked = surface_asked(state, law, rate)
    after = move(state, model, law, command, integrate(state, law, rate, asked, asked), 0.0, 0.0)
    return np.array(after), asked


def open_loop(model: AxisModel, law: AxisLaw, dt: float) -> Any:
    """L(z) from the servo's command to the controller's answer, sign such that 1 + L closes it."""
    a = np.zeros((SIZE, SIZE))
    c = np.zeros((1, SIZE))
    for column in range(SIZE):
        x = np.zeros(SIZE)
        x[column] = SMALL
        after, asked = _cut(model, law, x, 0.0, 0.0)
        a[:, column] = after / SMALL
        c[0, column] = -asked / SMALL
    after, _ = _cut(model, law, np.zeros(SIZE), SMALL, 0.0)
    b = (after / SMALL).reshape(SIZE, 1)
    return linear.state_space(a, b, c, np.zeros((1, 1)), dt)


def closed_loop(model: AxisModel, law: AxisLaw) -> Array:
    """The closed loop's transition matrix over a sample: (6, 6)."""
    a = np.zeros((SIZE, SIZE))
    for column in range(SIZE):
        x = np.zeros(SIZE)
        x[column] = SMALL
        state = _state(x)
        rate = rate_asked(law, -state.angle)
        asked = surface_asked(state, law, rate)
        after = move(state, model, law, asked, integrate(state, law, rate, asked, asked), 0.0, 0.0)
        a[:, column] = np.array(after) / SMALL
    return a


def closed_response(model: AxisModel, law: AxisLaw, dt: float) -> Any:
    """T(z) from the demanded angle to the angle."""
    a = closed_loop(model, law)
    x = np.zeros(SIZE)
    state = _state(x)
    rate = rate_asked(law, SMALL)
    asked = surface_asked(state, law, rate)
    after = move(state, model, law, asked, integrate(state, law, rate, asked, asked), 0.0, 0.0)
    b = (np.array(after) / SMALL).reshape(SIZE, 1)
    c = np.zeros((1, SIZE))
    c[0, 2] = 1.0
    return linear.state_space(a, b, c, np.zeros((1, 1)), dt)
