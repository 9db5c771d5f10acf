"""PX4 fixed wing: OFFBOARD flies towards a position target; no airspeed can be commanded.

A velocity target alone is no course: the plane wanders. A position target some hundred metres ahead along the
wanted course, sent anew at 20 Hz, flies it (as PX4 1.16 did; figures of that flight, not a recording).
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, ceil, floor, hypot, radians, sin, tan

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import ZERO, Vec, clamp
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.autopilot import default_parameters as tables
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, Command
from sim_bridge.vehicle.autopilot.px4 import BY_HAND, M, Px4
from sim_bridge.vehicle.autopilot.setup import Setup
from sim_bridge.vehicle.autopilot.winged import ALTITUDE_S, circling_course
from sim_bridge.vehicle.motion import Demand, Lateral

WANDER = radians(6.0)  # [rad] of bank under velocity targets alone
REACHED = 5.0  # [m] of a take-off's height
TOUCHED = 0.3  # [m] above the ground
FLARE = 1.0  # [m/s] of sinking at the ground
SINK_WITHOUT_STICKS = 0.8  # [m/s] in modes flown by hand where nobody does


class Px4Plane(Px4):
    """PX4 1.16 on an aeroplane."""

    vehicle_type = dialect.MAV_TYPE_FIXED_WING
    table = tables.PX4_PLANE

    def __init__(self, setup: Setup, now_ns: int) -> None:
        self._centre = setup.start.position  # of the circle of HOLD and RTL
        self._altitude_z = setup.start.position.z  # [m; down] sought
        self._heading = setup.start.yaw  # kept by modes flown by hand and by a take-off
        self._climbs_out = False  # taking off: until the height is reached
        self._idle_ns = now_ns  # armed on the ground
        super().__init__(setup, now_ns)

    def own_parameters(self) -> dict[str, float]:
        s = self.setup
        bank = min(65.0, s.bank_max_deg)
        radius = 1.5 * s.speed_cruise * s.speed_cruise / (STANDARD_GRAVITY * max(0.1, tan(radians(bank))))
        return {
            "FW_AIRSPD_MIN": float(floor(s.speed_min)),
            "FW_AIRSPD_MAX": float(ceil(s.speed_max)),
            "FW_AIRSPD_TRIM": s.speed_cruise,
            "FW_R_LIM": bank,
            "FW_P_LIM_MAX": s.pitch_max_deg,
            "FW_P_LIM_MIN": s.pitch_min_deg,
            "FW_T_CLMB_MAX": max(5.0, s.speed_cruise * sin(radians(s.pitch_max_deg))),
            "FW_T_SINK_MAX": max(5.0, s.speed_cruise * sin(radians(-s.pitch_min_deg))),
            "NAV_LOITER_RAD": float(ceil(max(60.0, radius))),
        }

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        return super()._command_handlers() | {dialect.MAV_CMD_DO_CHANGE_SPEED: self._do_change_speed}

    @property
    def first_mode(self) -> int:
        return M["HOLD"]

    def enter(self, now_ns: int, mode: int) -> None:
        position = self.motion.position
        self._centre, self._altitude_z = position, position.z
        self._heading = self.motion.yaw
        self._climbs_out = False
        home = self.game_position(*self.home)
        if mode == M["RTL"]:
            self._centre = home
            self._altitude_z = min(position.z, home.z - self.parameters["RTL_RETURN_ALT"])
        elif mode == M["TAKEOFF"]:
            self.take_off_to(now_ns, Vec(position.x, position.y, home.z - self.parameters["MIS_TAKEOFF_ALT"]))

    def go_to(self, now_ns: int, place: Vec) -> None:
        self._centre, self._altitude_z = place, place.z

    def take_off_to(self, now_ns: int, place: Vec) -> None:
        p = self.motion.position
        if hypot(place.x - p.x, place.y - p.y) > 1.0:
            self._heading = atan2(place.y - p.y, place.x - p.x)
        self._centre, self._altitude_z, self._climbs_out = place, place.z, True

    def on_armed(self, now_ns: int) -> None:
        if self.landed:
            self.home = self.place
            self.emit(telemetry.home_position(self, now_ns))
        self.say(dialect.MAV_SEVERITY_INFO, "Armed by external command")

    def guide(self, now_ns: int, dt: float) -> Demand:
        if self.landed and not self._leaves_ground(now_ns):
            return Demand(Lateral.HEADING, ZERO, self.motion.yaw, 0.0, 0.0)
        if not self.armed:
            low = self.parameters["FW_AIRSPD_MIN"]
            return Demand(Lateral.ROLL, ZERO, 0.0, -self.parameters["FW_T_SINK_MAX"], low)
        speed = self.parameters["FW_AIRSPD_TRIM"]
        if self.is_mode("LAND"):
            return self._land(now_ns, speed)
        if self._climbs_out:
            if self.motion.position.z <= self._altitude_z + REACHED:
                self._climbs_out = False
                self.request_mode(now_ns, M["HOLD"])
            return Demand(Lateral.COURSE, ZERO, self._heading, self._climb(self._altitude_z), speed)
        if self.is_mode("OFFBOARD"):
            return self._offboard(speed)
        if self.mode in BY_HAND:
            climb = -SINK_WITHOUT_STICKS if self.transmitter.throttle is None else 0.0
            return Demand(Lateral.HEADING, ZERO, self._heading, climb, speed)
        radius = self.parameters["NAV_LOITER_RAD"]
        course = circling_course(self.motion.position, self.motion.yaw, self._centre, radius, 1.0)
        return Demand(Lateral.COURSE, ZERO, course, self._climb(self._altitude_z), speed)

    def _leaves_ground(self, now_ns: int) -> bool:
        if self.armed and self.is_mode("TAKEOFF"):
            self.lift_off()
            return True
        idle_s = self.parameters["COM_DISARM_PRFLT"]
        if not self.armed:
            self._idle_ns = now_ns
        elif 0.0 < idle_s < (now_ns - self._idle_ns) * 1e-9:
            self.disarm(now_ns)
        return False

    def _offboard(self, speed: float) -> Demand:
        place, velocity, _ = self._setpoint
        p = self.motion.position
        if place is None:
            climb = 0.0 if velocity is None else -velocity.z
            return Demand(Lateral.ROLL, ZERO, WANDER, clamp(climb, -1.0, 1.0), speed)
        course = atan2(place.y - p.y, place.x - p.x)
        return Demand(Lateral.COURSE, ZERO, course, self._climb(place.z), speed)

    def _land(self, now_ns: int, speed: float) -> Demand:
        """Sink in a circle, or straight ahead without a position, down to the ground."""
        if self.above_ground <= TOUCHED:
            self.touch_down()
            self.disarm(now_ns)
            return Demand(Lateral.HEADING, ZERO, self.motion.yaw, 0.0, 0.0)
        sink = clamp(0.3 * self.above_ground, FLARE, self.parameters["FW_T_SINK_MAX"])
        if not self.positioned(now_ns):
            return Demand(Lateral.ROLL, ZERO, 0.0, -sink, speed)
        radius = self.parameters["NAV_LOITER_RAD"]
        course = circling_course(self.motion.position, self.motion.yaw, self._centre, radius, 1.0)
        return Demand(Lateral.COURSE, ZERO, course, -sink, speed)

    def _climb(self, z: float) -> float:
        """Climb rate towards a height [m/s, up]."""
        p = self.parameters
        return clamp((self.motion.position.z - z) / ALTITUDE_S, -p["FW_T_SINK_MAX"], p["FW_T_CLMB_MAX"])

    def _do_change_speed(self, now_ns: int, command: Command) -> int:
        """Accepted within the limits, and without effect under OFFBOARD: only FW_AIRSPD_TRIM counts there."""
        low, high = self.parameters["FW_AIRSPD_MIN"], self.parameters["FW_AIRSPD_MAX"]
        return ACCEPTED if low <= command.p2 <= high else DENIED
