"""What stands between a decision and an aircraft: the agent's supervisor and encoder, and the autopilot.

The supervisor and the orders are the very functions that fly onboard; the autopilot's part is that of the
simulated ArduPlane in GUIDED. Kernel style, but for `policy_of` and `autopilot_of`.
"""

from __future__ import annotations

from math import atan, atan2, pi, sin, tan
from typing import NamedTuple

from onboard.core.geometry.zones import NO_ZONES, Zones
from onboard.core.guidance.plane import (
    ALTITUDE_STEP,
    CREEP,
    LOOK_AHEAD,
    SPEED_STEP,
    Reference,
    Said,
    bank_for,
    begins,
    due,
    followed,
)
from onboard.core.math.constants import NEVER, STANDARD_GRAVITY
from onboard.core.math.states import Mate, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, add, clamp, norm
from onboard.core.safety.policy import Envelope, Fence, Policy
from onboard.core.safety.supervisor import Before, Flying, allow
from sim_bridge.vehicle.autopilot.winged import ALTITUDE_S
from sim_bridge.vehicle.flight.plane import Command, PlaneModel, PlaneState, Steer, pitch_for_climb
from sim_bridge.vehicle.wind.estimate import Estimate

BANK_MAX = pi / 4  # [rad] that an agent asks of a plane, unless its configuration says otherwise
NOBODY = Mate(0, ZERO, ZERO, 1e9)  # a mate unheard for so long does not count


class Autopilot(NamedTuple):
    """What the autopilot lets the aircraft do."""

    bank_max: float  # [rad]
    climb_max: float  # [m/s; up]
    sink_max: float  # [m/s; down]


class Aboard(NamedTuple):
    """What agent and autopilot of one vehicle remember."""

    demand: Vec  # last setpoint through the air [m/s]
    stamp: float  # when that was [s]; NEVER: none
    reference: Reference  # of the altitude [m]
    altitude: Said  # to the autopilot [m]
    airspeed: Said  # to the autopilot [m/s]
    bank: float  # the autopilot's now [rad]
    wind: Estimate  # the autopilot's


class Instant(NamedTuple):
    """A vehicle as its agent knows it when it decides."""

    now: float  # [s]
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    wind: Vec  # [m/s]
    id: int


def policy_of(
    limits: VehicleLimits, fences: tuple[Fence, ...], separation: float, zones: Zones = NO_ZONES
) -> Policy:
    """The supervisor's policy of a plane whose agent is configured by its defaults."""
    turn = STANDARD_GRAVITY * tan(BANK_MAX) / max(limits.speed_max, 1.0)
    declared = limits.turn_rate if limits.turn_rate > 0.0 else turn
    envelope = Envelope(
        hovers=False,
        speed_min=limits.speed_min,
        speed_max=limits.speed_max,
        climb_max=max(0.5, limits.speed_max * sin(max(0.0, limits.pitch_max))),
        sink_max=max(0.5, limits.speed_max * sin(max(0.0, -limits.pitch_min))),
        turn_rate=declared,
        turn_radius=limits.speed_max / max(1e-3, min(declared, turn)),
    )
    return Policy(envelope=envelope, fences=fences, zones=zones, separation=separation)


def autopilot_of(limits: VehicleLimits, speed: float, turn_rate: float) -> Autopilot:
    """The simulated ArduPlane's limits for a vehicle that cruises at `speed` [m/s]; `turn_rate` [rad/s]."""
    return Autopilot(
        min(85.0 * pi / 180.0, atan(turn_rate * max(speed, 1.0) / STANDARD_GRAVITY)),
        max(5.0, speed * sin(limits.pitch_max)),
        max(5.0, speed * sin(-limits.pitch_min)),
    )


def boarded(velocity: Vec, stamp: float, height: float, speed: float, wind: Estimate) -> Aboard:
    """Before the first order: in flight at `velocity` through the air [m/s], demanded at `stamp` [s], at
    `height` [m] and `speed` [m/s]."""
    return Aboard(velocity, stamp, Reference(), Said(height, NEVER), Said(speed, NEVER), 0.0, wind)


def aware(a: Aboard, wind: Estimate) -> Aboard:
    """The same with another estimate of the wind."""
    return Aboard(a.demand, a.stamp, a.reference, a.altitude, a.airspeed, a.bank, wind)


def ordered(aboard: Aboard, wanted: Vec, at: Instant, policy: Policy, mates: tuple[Mate, ...]) -> Aboard:
    """After a decision: `wanted` [m/s; air], as the supervisor lets it pass and the encoder commands it."""
    flying = Flying(at.now, at.id, at.position, at.velocity)
    air = allow(wanted, at.wind, flying, mates, policy, Before(aboard.demand, aboard.stamp)).air
    ground = add(air, at.wind)
    bank = aboard.bank
    if ground.x * ground.x + ground.y * ground.y >= 1e-6:
        yaw = 0.0  # not asked for, where there is a course
        vx, vy = at.velocity.x, at.velocity.y
        if vx * vx + vy * vy <= 1.01 * CREEP * CREEP:
            yaw = atan2(vy, vx)  # heard in flight; here the course of one that always moves
        bank = bank_for(atan2(ground.y, ground.x), at.velocity, yaw, BANK_MAX)
    anew = begins(aboard.reference, at.now)
    reference = followed(aboard.reference, at.now, -at.position.z, -ground.z)
    altitude = reference.altitude - ground.z * LOOK_AHEAD
    said = aboard.altitude
    if anew or due(said, at.now, altitude, ALTITUDE_STEP, False):
        said = Said(altitude, at.now)
    speed = norm(air)
    airspeed = aboard.airspeed
    if due(airspeed, at.now, speed, SPEED_STEP, False):
        airspeed = Said(speed, at.now)
    return Aboard(air, at.now, reference, said, airspeed, bank, aboard.wind)


def commanded(
    aboard: Aboard, plane: PlaneState, model: PlaneModel, autopilot: Autopilot, down: float
) -> Command:
    """What the autopilot tells the aircraft for one sample; `down` is how fast the air itself sinks [m/s]."""
    climb = clamp(
        (aboard.altitude.value + plane.position.z) / ALTITUDE_S, -autopilot.sink_max, autopilot.climb_max
    )
    pitch = pitch_for_climb(plane.speed, climb + down + plane.drift.z, model)
    bank = clamp(aboard.bank, -autopilot.bank_max, autopilot.bank_max)
    return Command(Steer.ROLL, bank, pitch, aboard.airspeed.value)
