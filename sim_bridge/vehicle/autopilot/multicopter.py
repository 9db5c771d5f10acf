"""How multicopters fly: one leg at a time, whatever autopilot flies it.

Positions are in the frame in which motion is given [m; NED], velocities over ground [m/s; NED].
"""

from __future__ import annotations

from abc import abstractmethod
from enum import Enum
from math import hypot, sqrt
from typing import ClassVar, NamedTuple

from onboard.core.math.vectors import ZERO, Vec, norm, sub
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.setup import Setup
from sim_bridge.vehicle.motion import Demand, Lateral

HOLD_GAIN = 1.0  # [1/s] of position
STOPPED = 0.2  # [m/s] below this a place to hold is taken
NEAR = 1.0  # [m] counts as there
TOUCHED = 0.05  # [m] above the ground
BRAKING = 2.0  # [m/s²] reckoned with on the way to a place
UPWARDS = 0.1  # [m/s] a velocity that leaves the ground
LOW = 10.0  # [m] above the ground: the last part of a landing is slow


class Leg(Enum):
    """Parts of a multicopter's flight, of which it flies one at a time."""

    HOLD = "hold"  # stop, then keep the place
    VELOCITY = "velocity"
    GOTO = "go to"
    TAKEOFF = "take-off"
    CLIMB = "climb to the height of return"
    RETURN = "return"
    LINGER = "linger above home"
    LAND = "land"
    STICK = "climb or sink by the pilot's stick, above one place"


class Speeds(NamedTuple):
    """Speeds with which an autopilot flies a leg by itself [m/s]."""

    level: float
    up: float
    down: float
    landing: float


def velocity_demand(velocity: Vec, facing: float | None = None) -> Demand:
    """The demand for a ground velocity, with the nose along the path or at a yaw [rad]."""
    return Demand(Lateral.VELOCITY, velocity, 0.0, 0.0, 0.0, facing)


REST = velocity_demand(ZERO)


def towards(position: Vec, target: Vec, speeds: Speeds) -> Vec:
    """Velocity that leads to a place and stops there."""
    x, y, z = target.x - position.x, target.y - position.y, target.z - position.z
    flat = sqrt(x * x + y * y)
    speed = min(speeds.level, HOLD_GAIN * flat, sqrt(2.0 * BRAKING * flat))
    k = speed / flat if flat > 1e-9 else 0.0
    return Vec(x * k, y * k, max(-speeds.up, min(speeds.down, HOLD_GAIN * z)))


class Multicopter(Autopilot):
    """An autopilot of a multicopter: legs, and when they end."""

    vehicle_type = dialect.MAV_TYPE_QUADROTOR
    starts_by_velocity: ClassVar[bool]  # whether an upward velocity target takes it off the ground
    armed_text: ClassVar[str]  # the STATUSTEXT that tells of an arming

    def __init__(self, setup: Setup, now_ns: int) -> None:
        self.leg = Leg.HOLD
        self.target = ZERO  # of GOTO, TAKEOFF, CLIMB, RETURN, LINGER and LAND, and the place held
        self.velocity = ZERO  # of VELOCITY
        self.facing: float | None = None  # of VELOCITY [rad]; None: along the path
        self.feed_forward = ZERO  # of GOTO: velocity that comes with a moving place
        self._climb = 0.0  # of STICK [m/s, up]
        self._drift: Vec | None = None  # of STICK; None: above one place
        self._held = False  # whether `target` is the place to hold
        self._since_ns = now_ns  # of the leg
        self._idle_ns = now_ns  # armed on the ground without a leg that leaves it
        super().__init__(setup, now_ns)

    # ------------------------------------------------------------------ the personality's side

    @property
    @abstractmethod
    def speeds(self) -> Speeds:
        """Speeds of flying by itself, from the parameters [m/s]."""

    @property
    @abstractmethod
    def linger_s(self) -> float:
        """Time above home before a return lands [s]."""

    @property
    @abstractmethod
    def idle_disarm_s(self) -> float:
        """Time armed on the ground after which it disarms itself [s]; 0 = never."""

    @abstractmethod
    def taken_off(self, now_ns: int) -> None:
        """The height of take-off is reached."""

    def on_armed(self, now_ns: int) -> None:
        """Make the place of arming home where it stands on the ground, and say that it is armed."""
        if self.landed:
            self.home = self.place
            self.emit(telemetry.home_position(self, now_ns))
        self.say(dialect.MAV_SEVERITY_INFO, self.armed_text)

    def escape(self, now_ns: int, name: str) -> None:
        """Enter the mode that a failsafe wants; land where that mode cannot be entered."""
        if not self.is_mode("LAND") and self.request_mode(now_ns, self.modes[name]):
            self.request_mode(now_ns, self.modes["LAND"])

    # ------------------------------------------------------------------ legs

    def fly(self, leg: Leg, now_ns: int, target: Vec = ZERO) -> None:
        """Begin a leg to `target` [m; NED, frame of motion]."""
        self.leg = leg
        self.target = target
        self.feed_forward = ZERO
        self._held = False
        self._since_ns = now_ns

    def fly_velocity(self, velocity: Vec, now_ns: int, facing: float | None = None) -> None:
        """Follow a velocity over ground [m/s; NED], the nose along it or at a yaw [rad]."""
        self.leg = Leg.VELOCITY
        self.velocity, self.facing = velocity, facing
        self._since_ns = now_ns

    def fly_by_stick(self, now_ns: int, climb: float, drift: Vec | None = None) -> None:
        """Climb at `climb` [m/s, up] above one place, or drifting over ground with `drift` [m/s; NED]."""
        if self.leg != Leg.STICK:
            self.fly(Leg.STICK, now_ns)
        self._climb, self._drift = climb, drift

    def fly_home(self, now_ns: int, height: float) -> None:
        """Climb to at least a height above home [m], return, land."""
        p = self.motion.position
        top = self.home_position.z - height
        self.fly(Leg.CLIMB, now_ns, Vec(p.x, p.y, min(p.z, top)))

    def land_here(self, now_ns: int) -> None:
        """Sink to the ground below."""
        self.fly(Leg.LAND, now_ns, self.motion.position)

    @property
    def home_position(self) -> Vec:
        """Home in the frame of motion [m; NED]."""
        return self.game_position(*self.home)

    def guide(self, now_ns: int, dt: float) -> Demand:
        if self.landed:
            return self._guide_on_ground(now_ns)
        position = self.motion.position
        leg = self.leg
        if leg == Leg.VELOCITY:
            return velocity_demand(self.velocity, self.facing)
        if leg == Leg.HOLD:
            return self._hold()
        if leg == Leg.LAND:
            return self._land(now_ns)
        if leg == Leg.STICK:
            return self._by_stick(now_ns)
        if leg == Leg.LINGER:
            if (now_ns - self._since_ns) * 1e-9 >= self.linger_s:
                self.fly(Leg.LAND, now_ns, self.target)
        elif norm(sub(position, self.target)) < NEAR:
            self._arrived(now_ns)
        wanted = towards(position, self.target, self.speeds)
        f = self.feed_forward
        return velocity_demand(Vec(wanted.x + f.x, wanted.y + f.y, wanted.z + f.z))

    def _guide_on_ground(self, now_ns: int) -> Demand:
        takes_off = self.leg == Leg.TAKEOFF or (
            self.starts_by_velocity and self.leg == Leg.VELOCITY and self.velocity.z < -UPWARDS
        )
        if self.armed and takes_off:
            self.lift_off()
            return self.guide(now_ns, 0.0)
        if not self.armed or takes_off:
            self._idle_ns = now_ns
        elif 0.0 < self.idle_disarm_s < (now_ns - self._idle_ns) * 1e-9:
            self.disarm(now_ns)
        return REST

    def _hold(self) -> Demand:
        if not self._held:
            if norm(self.motion.velocity) > STOPPED:
                return REST
            self.target = self.motion.position
            self._held = True
        return velocity_demand(towards(self.motion.position, self.target, self.speeds))

    def _by_stick(self, now_ns: int) -> Demand:
        if self._climb < 0.0 and self.above_ground <= TOUCHED:
            self.touch_down()
            self._idle_ns = now_ns
            self.fly(Leg.HOLD, now_ns)
            return REST
        motion = self.motion
        if self._drift is not None:
            self._held = False
            return velocity_demand(Vec(self._drift.x, self._drift.y, -self._climb))
        if not self._held and hypot(motion.velocity.x, motion.velocity.y) > STOPPED:
            return velocity_demand(Vec(0.0, 0.0, -self._climb))
        if not self._held:
            self.target, self._held = motion.position, True
        flat = towards(motion.position, self.target, self.speeds)
        return velocity_demand(Vec(flat.x, flat.y, -self._climb))

    def _land(self, now_ns: int) -> Demand:
        above = self.above_ground
        if above <= TOUCHED:
            self.touch_down()
            self.fly(Leg.HOLD, now_ns)
            self.disarm(now_ns)
            return REST
        speeds = self.speeds
        flat = towards(self.motion.position, self.target, speeds)
        sink = speeds.down if above > LOW else speeds.landing
        return velocity_demand(Vec(flat.x, flat.y, min(sink, max(0.2, above))))

    def _arrived(self, now_ns: int) -> None:
        place = self.target
        if self.leg == Leg.TAKEOFF:
            self.leg = Leg.HOLD
            self._held = True
            self.taken_off(now_ns)
        elif self.leg == Leg.CLIMB:
            home = self.home_position
            self.fly(Leg.RETURN, now_ns, Vec(home.x, home.y, place.z))
        elif self.leg == Leg.RETURN:
            self.fly(Leg.LINGER, now_ns, place)
