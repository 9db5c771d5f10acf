"""The wind as an autopilot knows it: estimated from its own motion, late and a little wrong. Kernel style.

Planes: two states, north and east, of a Kalman filter that takes the airspeed for the length of ground
velocity less wind, and the nose for its direction with no sideslip, as the EKFs of PX4 and ArduPilot do,
with the noises of their parameters' defaults. What is true of the air and the filter cannot know makes its
error: the airspeed sensor's scale, the compass, sideslip. Multicopters: what the lean is more than the
acceleration needs is drag (`multicopter_wind`), and drag is airspeed.

Level wind alone; an autopilot believes that the air does not rise.
"""

from __future__ import annotations

from math import cos, sin, sqrt, tan
from typing import NamedTuple

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import Vec
from sim_bridge.draws import Key, normal, threefry
from sim_bridge.vehicle.flight.multicopter_wind import DRAG

EVERY = 0.1  # [s] between two updates of the filter
SLOWEST = 5.0  # [m/s] of airspeed: below it nothing is learnt
GATE = 5.0  # standard deviations beyond which a measurement is refused (EKF2_TAS_GATE, EKF2_BETA_GATE)
KNOWN = 0.5  # [m/s; an axis, 1σ] error of one that starts in the air: it has circled there before
UNKNOWN = 5.0  # [m/s; an axis, 1σ] on the ground
AIRSPEED_SCALE = 0.01  # 1σ of the airspeed sensor's scale
HEADING_ERROR = 0.0175  # [rad] 1σ of the compass: 1°
DRAG_SCALE = 0.1  # 1σ of what a multicopter's autopilot knows of its drag
SMOOTHING = 3.0  # [s] of a multicopter's estimate


class Trust(NamedTuple):
    """What a filter believes of wind and sensors."""

    walk: float  # [m²/s³] growth of the variance of the wind, an axis, in level flight
    climbing: float  # [s/m] share by which climbing adds to the root of that
    airspeed: float  # [(m/s)²] variance
    sideslip: float  # [rad²]


# EKF2_WIND_NSD, EKF2_EAS_NOISE, EKF2_BETA_NOISE of PX4
PX4 = Trust(0.05 * 0.05, 0.5, 1.4 * 1.4, 0.3 * 0.3)
# EK3_WIND_P_NSE, in m/s² an update of 12 ms; EK3_WIND_PSCALE, EK3_EAS_M_NSE; sideslip "of about 10°"
ARDUPILOT = Trust(0.1 * 0.1 * 0.012, 0.5, 1.4 * 1.4, 0.03)


class Errors(NamedTuple):
    """What is wrong with one vehicle's sensors, constant through a game."""

    airspeed: float  # share by which the airspeed reads too much
    heading: float  # [rad] by which the nose reads too far to the right
    north: float  # [m/s] of the estimate at a start in the air
    east: float
    drag: float  # share by which a multicopter's drag is taken too large


EXACT = Errors(0.0, 0.0, 0.0, 0.0, 0.0)


class Estimate(NamedTuple):
    """The filter's state: the wind [m/s; where the air moves to] and its covariance [(m/s)²]."""

    north: float
    east: float
    nn: float
    ne: float
    ee: float


ON_GROUND = Estimate(0.0, 0.0, UNKNOWN * UNKNOWN, 0.0, UNKNOWN * UNKNOWN)


class Sensed(NamedTuple):
    """What the filter is told."""

    velocity: Vec  # [m/s; ground, NED]
    airspeed: float  # [m/s]
    yaw: float  # [rad] of the nose


def drawn_errors(key: Key) -> Errors:
    """The errors of one vehicle in one world; `key` is of its numbers for this purpose."""
    a, b = threefry(key.a, key.b, 0, 0)
    c, d = threefry(key.a, key.b, 0, 1)
    e, _spare = threefry(key.a, key.b, 0, 2)
    return Errors(
        AIRSPEED_SCALE * normal(a),
        HEADING_ERROR * normal(b),
        KNOWN * normal(c),
        KNOWN * normal(d),
        DRAG_SCALE * normal(e),
    )


def begun(wind: Vec, errors: Errors) -> Estimate:
    """The estimate of one that starts in the air, in a mean wind [m/s; NED]."""
    known = KNOWN * KNOWN
    return Estimate(wind.x + errors.north, wind.y + errors.east, known, 0.0, known)


def wind_of(estimate: Estimate) -> Vec:
    """The estimate as a vector [m/s; NED, where the air moves to]."""
    return Vec(estimate.north, estimate.east, 0.0)


def corrected(s: Estimate, a: float, b: float, innovation: float, noise: float) -> Estimate:
    """The estimate after a measurement a · north + b · east whose `innovation` has the variance `noise`."""
    pn = s.nn * a + s.ne * b
    pe = s.ne * a + s.ee * b
    spread = a * pn + b * pe + noise
    if innovation * innovation > GATE * GATE * spread:
        return s
    kn = pn / spread
    ke = pe / spread
    return Estimate(
        s.north + kn * innovation,
        s.east + ke * innovation,
        s.nn - kn * pn,
        s.ne - kn * pe,
        s.ee - ke * pe,
    )


def estimated(s: Estimate, trust: Trust, errors: Errors, sensed: Sensed) -> Estimate:
    """A plane's estimate `EVERY` seconds on."""
    if sensed.airspeed < SLOWEST:
        return s
    v = sensed.velocity
    root = 1.0 + trust.climbing * abs(v.z)
    grown = trust.walk * root * root * EVERY
    s = Estimate(s.north, s.east, s.nn + grown, s.ne, s.ee + grown)
    n = v.x - s.north
    e = v.y - s.east
    length = max(SLOWEST, sqrt(n * n + e * e + v.z * v.z))
    read = sensed.airspeed * (1.0 + errors.airspeed)
    s = corrected(s, -n / length, -e / length, read - length, trust.airspeed)
    yaw = sensed.yaw + errors.heading
    c = cos(yaw)
    d = sin(yaw)
    n = v.x - s.north
    e = v.y - s.east
    ahead = c * n + d * e
    if ahead < SLOWEST:  # the air from behind: no sideslip to speak of
        return s
    slip = (c * e - d * n) / ahead
    return corrected(s, (d + slip * c) / ahead, (slip * d - c) / ahead, -slip, trust.sideslip)


class Lean(NamedTuple):
    """A multicopter's attitude and how its velocity changes."""

    roll: float  # [rad]
    pitch: float  # [rad, up]
    yaw: float  # [rad]
    velocity: Vec  # [m/s; ground, NED]
    acceleration: Vec  # [m/s²; NED]


def estimated_by_drag(s: Estimate, errors: Errors, lean: Lean) -> Estimate:
    """A multicopter's estimate `EVERY` seconds on."""
    forward = -STANDARD_GRAVITY * tan(lean.pitch)
    right = STANDARD_GRAVITY * tan(lean.roll)
    c = cos(lean.yaw)
    d = sin(lean.yaw)
    drag = DRAG * (1.0 + errors.drag)
    north = lean.velocity.x + (lean.acceleration.x - forward * c + right * d) / drag
    east = lean.velocity.y + (lean.acceleration.y - forward * d - right * c) / drag
    share = EVERY / (SMOOTHING + EVERY)
    return Estimate(s.north + share * (north - s.north), s.east + share * (east - s.east), s.nn, s.ne, s.ee)
