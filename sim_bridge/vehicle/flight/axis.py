"""One axis of an aircraft as it is flown: plant, servo and rate loop, one sample at a time.

The pitch and the yaw axis share this kernel. The plant is a pair of states per axis, stepped by
an exact (zero-order hold) discretisation; the loop around it is a cascade: an angle error asks
for a rate, a proportional-integral law turns the rate error into a surface angle. Kernel style:
floats and NamedTuples alone. Angles in radians, winds in m/s, surfaces in radians.
"""

from __future__ import annotations

from typing import NamedTuple


class AxisModel(NamedTuple):
    """x⁺ = A x + B u, rate = C x + D u, angle⁺ = angle + J x + K u, with u = (surface, wind 1, wind 2)."""

    a11: float
    a12: float
    a21: float
    a22: float
    bs1: float  # surface → x1
    bs2: float
    bp1: float  # first wind component → x1
    bp2: float
    bq1: float  # second wind component → x1
    bq2: float
    c1: float
    c2: float
    ds: float
    dp: float
    dq: float
    j1: float  # the integral of the rate over the sample
    j2: float
    ks: float
    kp: float
    kq: float


class AxisLaw(NamedTuple):
    """Gains and limits of an axis. The surface's sign lies in the gains."""

    angle_gain: float  # [1/s] rate asked per angle error
    rate_limit: float  # [rad/s] largest rate asked
    rate_gain: float  # [rad per rad/s]
    integral_gain: float  # per sample [rad per rad/s]
    release: float  # back-calculation: share of (attainable − asked surface) added to the integral per sample
    surface_limit: float  # [rad]
    servo: float  # share of the servo's error removed per sample (first-order lag)
    servo_reach: float  # [rad] command error at which the servo moves at its rate limit


class AxisState(NamedTuple):
    """State of an axis; the angle is continuous (not wrapped)."""

    x1: float
    x2: float
    angle: float  # [rad]
    rate: float  # [rad/s] as measured
    surface: float  # [rad] where the servo stands
    integral: float  # [rad]


def rate_asked(law: AxisLaw, error: float) -> float:
    """The rate an angle error asks for, within the limit [rad/s]."""
    rate = law.angle_gain * error
    if rate > law.rate_limit:
        return law.rate_limit
    if rate < -law.rate_limit:
        return -law.rate_limit
    return rate


def surface_asked(state: AxisState, law: AxisLaw, rate: float) -> float:
    """The surface angle asked for to reach `rate` [rad], before any limit."""
    return law.rate_gain * (rate - state.rate) + state.integral


def attainable(surface: float, law: AxisLaw, asked: float) -> float:
    """`asked` cut to the position limit, and to what the servo's rate limit lets it follow [rad]."""
    limit = law.surface_limit
    value = limit if asked > limit else (-limit if asked < -limit else asked)
    high = surface + law.servo_reach
    low = surface - law.servo_reach
    return high if value > high else (low if value < low else value)


def integrate(state: AxisState, law: AxisLaw, rate: float, asked: float, given: float) -> float:
    """The integral after a sample: what could not be given is taken off it (back-calculation)."""
    return state.integral + law.integral_gain * (rate - state.rate) + law.release * (given - asked)


def move(
    state: AxisState,
    model: AxisModel,
    law: AxisLaw,
    given: float,
    integral: float,
    wind1: float,
    wind2: float,
) -> AxisState:
    """One sample of servo and plant under an attainable surface command and two wind components.

    The plant is driven by the surface as it stood at the start of the sample.
    """
    u = state.surface
    x1 = model.a11 * state.x1 + model.a12 * state.x2 + model.bs1 * u + model.bp1 * wind1 + model.bq1 * wind2
    x2 = model.a21 * state.x1 + model.a22 * state.x2 + model.bs2 * u + model.bp2 * wind1 + model.bq2 * wind2
    turned = model.j1 * state.x1 + model.j2 * state.x2 + model.ks * u + model.kp * wind1 + model.kq * wind2
    surface = u + law.servo * (given - u)
    rate = model.c1 * x1 + model.c2 * x2 + model.ds * surface + model.dp * wind1 + model.dq * wind2
    angle = state.angle + turned
    return AxisState(x1, x2, angle, rate, surface, integral)


def step_axis(
    state: AxisState, model: AxisModel, law: AxisLaw, rate: float, wind1: float, wind2: float
) -> AxisState:
    """One sample of the closed rate loop: `rate` is asked for [rad/s], winds in heading axes [m/s]."""
    asked = surface_asked(state, law, rate)
    given = attainable(state.surface, law, asked)
    return move(state, model, law, given, integrate(state, law, rate, asked, given), wind1, wind2)
