"""What moving air does to a multicopter, and what its autopilot does against it.

Rotor drag pushes with an acceleration of k times the airspeed, k = DRAG. In still air the autopilot knows
that drag and leans against it; what the wind adds it only sees in its velocity, and leans against that by
its velocity loop, a proportional and an integral part through the lag of the attitude, within its tilt
limit. The integral divided by k is its estimate of the wind. So a multicopter departs from what it would do
in still air by a deviation, which this module reckons: zero, to the bit, as long as the air stands still.
"""

from __future__ import annotations

from math import hypot, radians, tan
from typing import NamedTuple

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import ZERO, Vec
from onboard.game.scenario import Kind

# [1/s] of the 1.5 kg Iris of RotorS and PX4's Gazebo models: rotor drag 1.75e-4 N s²/m per rad/s of each
# of four rotors, which hover at sqrt(m g / (4 · 5.84e-6 N s²)) = 793 rad/s; divided by the mass.
DRAG = 4.0 * 1.75e-4 * 793.5 / 1.5


class WindLoop(NamedTuple):
    """How an autopilot holds its velocity: its parameters' defaults."""

    gain: float  # [1/s] of velocity
    integral: float  # [1/s²]
    lag: float  # [s] of the attitude: 1 / its angle gain
    tilt_max: float  # [rad]


LOOPS = {
    # MPC_XY_VEL_P_ACC, MPC_XY_VEL_I_ACC, 1 / MC_ROLL_P, MPC_TILTMAX_AIR
    Kind.PX4: WindLoop(1.8, 0.4, 1.0 / 6.5, radians(45.0)),
    # PSC_VELXY_P, PSC_VELXY_I, 1 / ATC_ANG_RLL_P, ANGLE_MAX
    Kind.ARDUCOPTER: WindLoop(2.0, 1.0, 1.0 / 4.5, radians(30.0)),
}


class Deviation(NamedTuple):
    """How moving air has changed a multicopter's flight."""

    velocity: Vec = ZERO  # [m/s] over ground, beside that in still air
    lean: Vec = ZERO  # [m/s²] of the thrust, against the wind
    integral: Vec = ZERO  # [m/s²] of the velocity loop


STILL = Deviation()


def settled(air: Vec) -> Deviation:
    """The deviation of one that has long flown in a steady wind [m/s; NED]."""
    against = Vec(-DRAG * air.x, -DRAG * air.y, -DRAG * air.z)
    return Deviation(ZERO, against, against)


def wind_estimate(deviation: Deviation) -> Vec:
    """The wind that the autopilot's integral stands for [m/s; NED]."""
    i = deviation.integral
    return Vec(-i.x / DRAG, -i.y / DRAG, -i.z / DRAG)


def wind_held(tilt_max: float) -> float:
    """The strongest steady wind in which a hovering multicopter keeps its place [m/s]: g tan θ / k."""
    return STANDARD_GRAVITY * tan(tilt_max) / DRAG


def deviated(old: Deviation, loop: WindLoop, air: Vec, thrust: Vec, dt: float) -> Deviation:
    """The deviation `dt` [s] on, in air that moves with `air` [m/s; gusts included].

    `thrust` is the level acceleration that the thrust gives in still air [m/s²]; together with the lean
    against the wind it stays within the tilt limit.
    """
    v, lean = old.velocity, old.lean
    share = min(1.0, dt / loop.lag)
    wanted = [-loop.gain * e + i for e, i in zip(v, old.integral, strict=True)]
    led = [c + share * (w - c) for c, w in zip(lean, wanted, strict=True)]
    x, y = thrust.x + led[0], thrust.y + led[1]
    most, asked = STANDARD_GRAVITY * tan(loop.tilt_max), hypot(x, y)
    limited = asked > most
    if limited:  # the still air's part was within it, or is what is cut
        x, y = x * most / asked, y * most / asked
    led[0], led[1] = x - thrust.x, y - thrust.y
    velocity = Vec(*(e + dt * (DRAG * (w - e) + c) for e, w, c in zip(v, air, led, strict=True)))
    integral = old.integral
    if not limited:  # no integration against the limit
        integral = Vec(*(i - loop.integral * e * dt for i, e in zip(integral, velocity, strict=True)))
    return Deviation(velocity, Vec(*led), integral)
