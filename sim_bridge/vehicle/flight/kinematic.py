"""The kinematic airframes: (7)–(8) with limited turn rate, climb angle and acceleration.

Multicopters follow a ground velocity under an acceleration limit; wind and gusts push them off it. Planes fly
relative to the air: a roll, heading or course, a climb rate and an airspeed in; the mean wind carries them at
once, gusts through the lags of (33)–(35), as they do the aircraft of transfer functions. They have no nose
of their own that a gust could turn.

Deterministic: the same demands give the same motion to the last bit.
"""

from __future__ import annotations

from math import asin, atan, atan2, cos, exp, radians, sin, sqrt, tan
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.each import new
from onboard.core.math.vectors import ZERO, Vec, add, along, clamp, norm, sub
from onboard.game.scenario import WINGED, Kind, VehicleSpec
from sim_bridge.vehicle.flight.multicopter_wind import (
    DRAG,
    LOOPS,
    STILL,
    WindLoop,
    deviated,
    settled,
    wind_estimate,
)
from sim_bridge.vehicle.flight.plane import carried
from sim_bridge.vehicle.motion import CALM, Air, Airframe, Demand, Lateral, Motion

VELOCITY = Lateral.VELOCITY
ROLL_RATE = radians(180.0)  # [rad/s] how fast a plane banks
HEADING_GAIN = 2.0  # [1/s] turn rate per heading error, below the limit
MOVING = 0.3  # [m/s] a multicopter turns its nose along its course above this
STALL_SHARE = 0.4  # of the speed the game reckons with
CARRY = Vec(0.05, 1.0 / 6.0, 1.213 / 0.753)  # [1/s] a_x, k_β and b_y: how gusts come to carry a plane
WIND_FROM_COURSE = 0.999  # of the airspeed: a stronger crosswind cannot be crabbed against


class Ability(NamedTuple):
    """What a kinematic airframe can do."""

    speed_min: float  # [m/s; air] 0 for multicopters
    speed_max: float  # [m/s; air; ground for multicopters]
    pitch_min: float  # [rad] of the path, for planes
    pitch_max: float  # [rad]
    turn_rate: float  # [rad/s]
    acceleration: float  # [m/s²]


def toward(value: float, target: float, most: float) -> float:
    """`target`, or as far towards it as a step of `most` leads."""
    return value + clamp(target - value, -most, most)


class KinematicMulticopter:
    """Follows a ground velocity under an acceleration limit; its nose turns along the course, or as demanded.

    Moving air pushes it off that by `multicopter_wind`. Any demand but `Lateral.VELOCITY` means: stop.
    """

    def __init__(self, ability: Ability, motion: Motion, loop: WindLoop, air: Air = CALM) -> None:
        """One that flies at the start has long flown in the wind of `air`."""
        self._ability = ability
        self._motion = motion
        self._loop = loop
        self._still = motion.velocity  # over ground, as it would be in still air
        flying = motion.airspeed > 0.0 and air.wind != ZERO
        self._deviation = settled(air.wind) if flying else STILL

    @property
    def motion(self) -> Motion:
        return self._motion

    def step(self, demand: Demand, air: Air, dt: float) -> Motion:
        (px, py, pz), (ox, oy, oz), _, old_roll, old_pitch, yaw, _ = self._motion
        sx, sy, _ = self._still
        lx, ly, lz = self._still = led = self._follow(demand, dt)
        ax, ay = (lx - sx) / dt, (ly - sy) / dt
        x, y, z, mx, my, mz, velocity = lx, ly, lz, 0.0, 0.0, 0.0, led
        if air is not CALM or self._deviation is not STILL:
            (mx, my, mz), velocity, (ax, ay) = self._pushed(air, led, ax, ay, dt)
            x, y, z = velocity
        place = (px + 0.5 * (ox + x) * dt, py + 0.5 * (oy + y) * dt, pz + 0.5 * (oz + z) * dt)
        turned, facing = 0.0, demand.facing
        if facing is None and lx * lx + ly * ly > MOVING * MOVING:  # gusts turn no nose
            facing = atan2(ly, lx)
        if facing is not None:
            most = self._ability.turn_rate * dt
            after = wrap(yaw + clamp(wrap(facing - yaw), -most, most))
            yaw, turned = after, wrap(after - yaw)
        c, s = cos(yaw), sin(yaw)
        roll = atan((c * ay - s * ax) / STANDARD_GRAVITY)  # thrust leans into the acceleration
        pitch = -atan((c * ax + s * ay) / STANDARD_GRAVITY)
        rates = new(Vec, ((roll - old_roll) / dt, (pitch - old_pitch) / dt, turned / dt))
        x, y, z = x - mx, y - my, z - mz
        moved = (new(Vec, place), velocity, sqrt(x * x + y * y + z * z), roll, pitch, yaw, rates)
        self._motion = motion = new(Motion, moved)
        return motion

    def _pushed(
        self, air: Air, led: Vec, ax: float, ay: float, dt: float
    ) -> tuple[Vec, Vec, tuple[float, float]]:
        """What moves about it [m/s], its velocity over ground in it, and the acceleration that it leans into
        [m/s²], of what they would be in still air."""
        moving, (gx, gy, gz) = air.wind, air.gust
        moving = Vec(moving.x + gx, moving.y + gy, moving.z + gz)
        if moving == ZERO and self._deviation == STILL:
            return moving, led, (ax, ay)
        thrust = Vec(ax + DRAG * led.x, ay + DRAG * led.y, 0.0)
        self._deviation = deviated(self._deviation, self._loop, moving, thrust, dt)
        lean = self._deviation.lean
        return moving, add(led, self._deviation.velocity), (thrust.x + lean.x, thrust.y + lean.y)

    def _follow(self, demand: Demand, dt: float) -> Vec:
        """The velocity over ground [m/s; NED] a step on, as it would be in still air."""
        a, still = self._ability, self._still
        wanted = demand.velocity if demand.lateral == VELOCITY else ZERO
        x, y, z = wanted
        speed = sqrt(x * x + y * y + z * z)
        if speed > a.speed_max:
            k = a.speed_max / speed
            x, y, z = wanted = new(Vec, (x * k, y * k, z * k))
        sx, sy, sz = still
        x, y, z = x - sx, y - sy, z - sz
        size = sqrt(x * x + y * y + z * z)
        most = a.acceleration * dt
        if size <= most:
            return wanted
        return new(Vec, (sx + x * most / size, sy + y * most / size, sz + z * most / size))

    @property
    def wind_estimate(self) -> Vec:
        """The wind that the autopilot leans against [m/s; NED]."""
        return wind_estimate(self._deviation)


class KinematicPlane:
    """Coordinated flight of a mass point: turn rate g tan φ / V, path angle and speed under limits.

    A demanded airspeed of 0 or less means the engine is off: on the ground the plane stands, so an airframe
    that stands speeds up from rest once it is asked to fly. In the air it never flies below its least speed.
    """

    def __init__(self, ability: Ability, motion: Motion, air: Air = CALM) -> None:
        self._ability = ability
        self._motion = motion
        self._speed = motion.airspeed
        self._heading = motion.yaw
        self._climb = -(motion.velocity.z - air.wind.z)
        self._roll = motion.roll
        self._drift = ZERO  # [m/s; NED] how gusts carry it

    @property
    def motion(self) -> Motion:
        return self._motion

    def step(self, demand: Demand, air: Air, dt: float) -> Motion:
        a = self._ability
        old = self._motion
        if demand.airspeed <= 0.0 and self._speed < a.speed_min:
            self._speed = self._climb = self._roll = 0.0
            self._motion = Motion(old.position, ZERO, 0.0, 0.0, 0.0, old.yaw)
            return self._motion
        most = a.acceleration * dt
        speed = toward(self._speed, clamp(demand.airspeed, a.speed_min, a.speed_max), most)
        flying = max(speed, 1.0)
        bank_max = atan(a.turn_rate * flying / STANDARD_GRAVITY)
        roll = toward(self._roll, clamp(self._bank(demand, air, flying), -bank_max, bank_max), ROLL_RATE * dt)
        turn = clamp(STANDARD_GRAVITY * tan(roll) / flying, -a.turn_rate, a.turn_rate)
        middle = self._heading + 0.5 * turn * dt
        heading = wrap(self._heading + turn * dt)
        low, high = flying * sin(a.pitch_min), flying * sin(a.pitch_max)
        rolling = speed < a.speed_min - 1e-9  # taking off: no lift yet
        climb = 0.0 if rolling else toward(self._climb, clamp(demand.climb, low, high), most)
        climb = clamp(climb, min(low, 0.0), max(high, 0.0))
        level = sqrt(max(0.0, speed * speed - climb * climb))
        before, drift = self._drifted(air.gust, middle, dt, rolling)
        velocity = Vec(
            level * cos(heading) + air.wind.x + drift.x,
            level * sin(heading) + air.wind.y + drift.y,
            air.wind.z + drift.z - climb,
        )
        if rolling:
            velocity = Vec(level * cos(heading), level * sin(heading), 0.0)
        # Over the step: along the middle heading, exact for a circle to third order.
        half = 0.5 * (level + sqrt(max(0.0, self._speed * self._speed - self._climb * self._climb)))
        wx, wy, wz = (0.0, 0.0, 0.0) if rolling else along(air.wind, add(before, drift), 0.5)
        position = Vec(
            old.position.x + (half * cos(middle) + wx) * dt,
            old.position.y + (half * sin(middle) + wy) * dt,
            old.position.z + (wz - 0.5 * (climb + self._climb)) * dt,
        )
        pitch = asin(clamp(climb / flying, -1.0, 1.0))
        rates = Vec((roll - self._roll) / dt, (pitch - old.pitch) / dt, turn)
        self._speed, self._heading, self._climb, self._roll = speed, heading, climb, roll
        felt = speed  # by the pitot tube, which feels gusts
        if air.gust != ZERO and not rolling:
            felt = norm(sub(velocity, add(air.wind, air.gust)))
        self._motion = Motion(position, velocity, felt, roll, pitch, heading, rates)
        return self._motion

    def _drifted(self, gust: Vec, heading: float, dt: float, rolling: bool) -> tuple[Vec, Vec]:
        """The drift before the step and after it; none on the ground."""
        before = self._drift
        if rolling or (gust == ZERO and before == ZERO):
            self._drift = ZERO
            return ZERO, ZERO
        shares = Vec(*(1.0 - exp(-rate * dt) for rate in CARRY))
        self._drift = carried(before, gust, shares, cos(heading), sin(heading))
        return before, self._drift

    def _bank(self, demand: Demand, air: Air, speed: float) -> float:
        """The bank angle a demand asks for [rad]."""
        if demand.lateral == Lateral.ROLL:
            return demand.angle
        heading = demand.angle
        if demand.lateral == Lateral.COURSE:
            heading = crab(demand.angle, speed, add(air.wind, self._drift))
        elif demand.lateral == Lateral.VELOCITY:
            heading = self._heading
        rate = clamp(
            HEADING_GAIN * wrap(heading - self._heading), -self._ability.turn_rate, self._ability.turn_rate
        )
        return atan(rate * speed / STANDARD_GRAVITY)


def crab(course: float, airspeed: float, wind: Vec) -> float:
    """The heading that makes good a course over ground [rad] in a wind [m/s; NED, where it moves to]."""
    across = wind.y * cos(course) - wind.x * sin(course)
    most = WIND_FROM_COURSE * airspeed
    return wrap(course - asin(clamp(across, -most, most) / airspeed))


def ability_of(spec: VehicleSpec, kind: Kind) -> Ability:
    """Limits of a scenario's vehicle. A plane that names no least speed stalls below 40 % of its speed."""
    limits = spec.limits()
    stall = STALL_SHARE * spec.speed if kind in WINGED and spec.speed_min <= 0.0 else 0.0
    return Ability(
        max(limits.speed_min, stall),
        limits.speed_max,
        limits.pitch_min,
        limits.pitch_max,
        radians(spec.turn_rate_deg),
        spec.acceleration,
    )


def start_motion(position: Vec, yaw: float, kind: Kind, speed: float, air: Air, airborne: bool) -> Motion:
    """How a vehicle starts: a plane at its airspeed, a multicopter hovering, either at rest on the ground."""
    if not airborne or kind not in WINGED:
        return Motion(position, ZERO, norm(air.wind) if airborne else 0.0, 0.0, 0.0, yaw)
    velocity = Vec(speed * cos(yaw) + air.wind.x, speed * sin(yaw) + air.wind.y, air.wind.z)
    return Motion(position, velocity, speed, 0.0, 0.0, yaw)


def kinematic(spec: VehicleSpec, kind: Kind, start: Motion, air: Air = CALM) -> Airframe:
    """The kinematic airframe of a scenario's vehicle: of a plane for ArduPlane, else of a multicopter."""
    ability = ability_of(spec, kind)
    if kind in WINGED:
        return KinematicPlane(ability, start, air)
    return KinematicMulticopter(ability, start, LOOPS[kind], air)
