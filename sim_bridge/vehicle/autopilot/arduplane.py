"""ArduPlane: GUIDED follows a roll, a course or heading, an altitude, an airspeed; no velocity targets.

Priority sideways in GUIDED: a fresh roll, then the course or heading of 43002, then the point to circle.
"""

from __future__ import annotations

from collections.abc import Callable
from math import asin, atan2, ceil, degrees, floor, isfinite, radians, sin

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import ZERO, clamp
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import DialectPacket, dialect
from onboard.wire.mavlink.modes import ARDUPLANE_MODES
from sim_bridge.vehicle.autopilot import default_parameters as tables
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.ardupilot import ABOVE_HOME, ABSOLUTE, ArduPilot, Place
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, FAILED, Command
from sim_bridge.vehicle.autopilot.generations import ADDED, renamed
from sim_bridge.vehicle.autopilot.parameters import Parameters
from sim_bridge.vehicle.autopilot.setup import Setup
from sim_bridge.vehicle.autopilot.winged import ALTITUDE_S, circling_course
from sim_bridge.vehicle.motion import Demand, Lateral

M = ARDUPLANE_MODES
NOT_SIMULATED = frozenset(number for name, number in M.items() if name.startswith("Q")) | frozenset(
    M[name] for name in ("AUTOTUNE", "AVOID_ADSB", "INITIALISING", "THERMAL", "LOITER_ALT_QLAND")
)
BY_HAND = frozenset(M[name] for name in ("MANUAL", "STABILIZE", "TRAINING", "ACRO", "FBWA", "FBWB", "CRUISE"))
KEEPS_ON_SILENCE = frozenset(M[name] for name in ("GUIDED", "AUTO", "TAKEOFF", "RTL"))
BLOCKABLE = (
    "MANUAL", "CIRCLE", "STABILIZE", "TRAINING", "ACRO", "FBWA", "FBWB", "CRUISE", "AUTOTUNE", "AUTO",
    "LOITER", "TAKEOFF", "AVOID_ADSB", "GUIDED", "THERMAL",
)  # fmt: skip
LAPSE_S = 3.0  # of a forced attitude
COURSE_OVER_GROUND, HEADING = 0, 1  # 43002, param1
TAKEOFF_CLIMB = 5.0  # [m/s]
FAST = 1000.0  # [m/s² or m/s] "as fast as possible"
ALTITUDE_ONLY = 0xFFFB  # bits of a type_mask beside the altitude's


class ArduPlane(ArduPilot):
    """ArduPlane 4.5: modes, failsafes, guided roll, course, altitude and airspeed."""

    vehicle_type = dialect.MAV_TYPE_FIXED_WING
    modes = M
    blockable = BLOCKABLE
    recovered = "Off"

    def __init__(self, setup: Setup, now_ns: int) -> None:
        self._course: tuple[Lateral, float] | None = None  # of 43002
        self._centre = setup.start.position  # of the circle
        self._radius = 0.0  # [m] 0 = WP_LOITER_RAD
        self._turn = 1.0  # clockwise
        self._altitude_z = setup.start.position.z  # [m; down] sought
        self._altitude_given = False  # by 43001
        self._climb_most = FAST  # [m/s]
        self._airspeed = setup.speed_cruise  # [m/s] demanded now
        self._airspeed_target = setup.speed_cruise
        self._acceleration = FAST  # [m/s²] of the demand
        self._roll = self._pitch = self._throttle = 0.0  # forced
        self._roll_ns = self._pitch_ns = self._throttle_ns = -1  # since when; −1: not
        self._heading = setup.start.yaw  # kept by modes flown by hand
        self._rolling = False  # taking off: until the altitude is reached
        super().__init__(setup, now_ns)

    def _new_parameters(self) -> Parameters:
        s = self.setup
        bank = min(85.0, s.bank_max_deg)
        radius = 1.5 * s.speed_cruise * s.speed_cruise / (STANDARD_GRAVITY * max(0.1, _tan_deg(bank)))
        own = {
            "SYSID_THISMAV": float(self.system),
            "AIRSPEED_MIN": float(floor(s.speed_min)),
            "AIRSPEED_MAX": float(ceil(s.speed_max)),
            "AIRSPEED_CRUISE": s.speed_cruise,
            "ROLL_LIMIT_DEG": bank,
            "PTCH_LIM_MAX_DEG": s.pitch_max_deg,
            "PTCH_LIM_MIN_DEG": s.pitch_min_deg,
            "TECS_CLMB_MAX": max(5.0, s.speed_cruise * sin(radians(s.pitch_max_deg))),
            "TECS_SINK_MAX": max(5.0, s.speed_cruise * sin(radians(-s.pitch_min_deg))),
            "WP_LOITER_RAD": float(ceil(max(60.0, radius))),
        }
        key = Kind.ARDUPLANE, s.options.firmware
        table = tables.ARDUPLANE + ADDED.get(key, ())
        return Parameters(table, own | dict(s.options.parameters), bytewise=False, aliases=renamed(*key))

    @property
    def banner(self) -> tuple[str, ...]:
        return (f"ArduPlane V{self.version_name} (simulated)",)

    def _message_handlers(self) -> dict[int, Callable[[int, DialectPacket], None]]:
        return super()._message_handlers() | {
            dialect.MAVLINK_MSG_ID_SET_ATTITUDE_TARGET: self._on_attitude_target,
            dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED: self._on_local_target,
            dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT: self._on_global_target,
        }

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        return super()._command_handlers() | {
            dialect.MAV_CMD_GUIDED_CHANGE_SPEED: self._do_guided_speed,
            dialect.MAV_CMD_GUIDED_CHANGE_ALTITUDE: self._do_guided_altitude,
            dialect.MAV_CMD_GUIDED_CHANGE_HEADING: self._do_guided_heading,
            dialect.MAV_CMD_DO_REPOSITION: self._do_reposition,
            dialect.MAV_CMD_DO_CHANGE_SPEED: self._do_change_speed,
            dialect.MAV_CMD_NAV_TAKEOFF: lambda now, c: FAILED,  # by mode TAKEOFF only
        }

    # ------------------------------------------------------------------ modes

    @property
    def first_mode(self) -> int:
        return M["MANUAL"] if self.landed else M["LOITER"]

    def allows(self, now_ns: int, mode: int) -> str:
        if mode in NOT_SIMULATED:
            return "not simulated"
        return "no mission" if mode == M["AUTO"] else ""

    def enter(self, now_ns: int, mode: int) -> None:
        position = self.motion.position
        self._course = None
        self._roll_ns = self._pitch_ns = self._throttle_ns = -1
        self._centre = position
        self._altitude_z = position.z
        self._altitude_given = False
        self._climb_most = FAST
        self._radius, self._turn = 0.0, 1.0
        self._airspeed_target = self.parameters["AIRSPEED_CRUISE"]
        self._acceleration = FAST
        self._heading = self.motion.yaw
        self._rolling = mode == M["TAKEOFF"]
        if mode == M["RTL"]:
            home = self.game_position(*self.home)
            self._centre = home
            self._altitude_z = home.z - self.parameters["RTL_ALTITUDE"]
        elif mode == M["TAKEOFF"]:
            top = self.game_position(*self.home).z - self.parameters["TKOFF_ALT"]
            self._altitude_z = min(position.z, top)

    def why_not_armable(self, now_ns: int) -> str:
        if not self.positioned(now_ns) and not self.healthy(now_ns):
            return "Arm: AHRS: waiting for home"
        if not self.healthy(now_ns) or not self.health.positioned:
            return "Arm: GPS 1: Bad fix"
        if self.health.battery <= 0.0:
            return "Arm: Battery 1 low voltage failsafe"
        return "Arm: Mode not armable" if self.is_mode("RTL", "AUTO") else ""

    def on_armed(self, now_ns: int) -> None:
        if self.landed:
            self.home = self.place
            self.emit(telemetry.home_position(self, now_ns))
            self._heading = self.motion.yaw
        self.say(dialect.MAV_SEVERITY_INFO, "Throttle armed")

    def guide(self, now_ns: int, dt: float) -> Demand:
        if self.landed:
            if not (self.armed and self.is_mode("TAKEOFF")):
                return Demand(Lateral.HEADING, ZERO, self.motion.yaw, 0.0, 0.0)
            self._take_off()
        self._airspeed += clamp(
            self._airspeed_target - self._airspeed, -self._acceleration * dt, self._acceleration * dt
        )
        if not self.armed:
            return self._glide()
        lateral, angle = self._sideways(now_ns)
        climb = self._climb(now_ns)
        return Demand(lateral, ZERO, angle, climb, self._speed(now_ns))

    def _take_off(self) -> None:
        self._heading = self.motion.yaw
        altitude = self.parameters["TKOFF_ALT"]
        self._altitude_z = self.game_position(*self.home).z - altitude
        self._rolling = True
        self.lift_off()
        distance, heading = self.parameters["TKOFF_DIST"], degrees(self._heading) % 360.0
        self.say(
            dialect.MAV_SEVERITY_INFO,
            f"Takeoff to {altitude:.0f}m for {distance:.1f}m heading {heading:.1f} deg",
        )

    def _glide(self) -> Demand:
        """Disarmed by force in the air: no engine."""
        return Demand(Lateral.ROLL, ZERO, 0.0, -self.parameters["TECS_SINK_MAX"], self.setup.speed_min)

    def _sideways(self, now_ns: int) -> tuple[Lateral, float]:
        limit = radians(self.parameters["ROLL_LIMIT_DEG"])
        if self.is_mode("GUIDED"):
            if self._fresh(self._roll_ns, now_ns):
                return Lateral.ROLL, clamp(self._roll, -limit, limit)
            if self._course is not None:
                return self._course
        if self._rolling:
            if self.motion.position.z > self._altitude_z + 2.0:
                return Lateral.HEADING, self._heading
            self._rolling = False
            self._centre = self.motion.position
        if self.mode in BY_HAND:
            return Lateral.HEADING, self._heading
        return Lateral.COURSE, self._circling()

    def _circling(self) -> float:
        """Course onto and around the circle [rad]."""
        radius = self._radius or self.parameters["WP_LOITER_RAD"]
        return circling_course(self.motion.position, self.motion.yaw, self._centre, radius, self._turn)

    def _climb(self, now_ns: int) -> float:
        """Climb rate [m/s, up]."""
        airspeed = self.motion.airspeed
        if self.is_mode("GUIDED") and self._fresh(self._pitch_ns, now_ns):
            low, high = (radians(self.parameters[f"PTCH_LIM_{which}_DEG"]) for which in ("MIN", "MAX"))
            return airspeed * sin(clamp(self._pitch, low, high))
        climb = (self.motion.position.z - self._altitude_z) / ALTITUDE_S
        most = min(self._climb_most, TAKEOFF_CLIMB if self._rolling else FAST)
        up, down = self.parameters["TECS_CLMB_MAX"], self.parameters["TECS_SINK_MAX"]
        return clamp(climb, -min(most, down), min(most, up))

    def _speed(self, now_ns: int) -> float:
        """Airspeed [m/s]."""
        low, high = self.parameters["AIRSPEED_MIN"], self.parameters["AIRSPEED_MAX"]
        if self.is_mode("GUIDED"):
            if self._fresh(self._throttle_ns, now_ns):
                return low + self._throttle * (high - low)
            if self._fresh(self._pitch_ns, now_ns):
                return low  # pitch without thrust: the speed collapses
        return self._airspeed

    @staticmethod
    def _fresh(since_ns: int, now_ns: int) -> bool:
        return since_ns >= 0 and (now_ns - since_ns) * 1e-9 < LAPSE_S

    # ------------------------------------------------------------------ failsafes

    def silence_limit_s(self) -> float:
        return self.parameters["FS_LONG_TIMEOUT"] if self.parameters["FS_GCS_ENABL"] else 0.0

    def ground_station_silence_s(self, now_ns: int) -> float:
        """ArduPlane counts from boot where it never heard the watched ground station [s]."""
        return super().ground_station_silence_s(now_ns) if self._ground_station_ns >= 0 else self.up_s(now_ns)

    def radio_limit_s(self) -> float:
        return self.parameters["FS_LONG_TIMEOUT"] if self.parameters["THR_FAILSAFE"] == 1 else 0.0

    def on_radio_lost(self, now_ns: int) -> None:
        self._long_event(now_ns, "type=2/reason=3")

    def on_silence(self, now_ns: int) -> None:
        self._long_event(now_ns, "type=3/reason=5")

    def _long_event(self, now_ns: int, what: str) -> None:
        self.say(dialect.MAV_SEVERITY_WARNING, f"Failsafe. Long event on: {what}")
        action = int(self.parameters["FS_LONG_ACTN"])
        if action == 2:
            self.request_mode(now_ns, M["FBWA"])
        elif action == 1 or self.mode not in KEEPS_ON_SILENCE:
            self.request_mode(now_ns, M["RTL"])

    def on_lost_position(self, now_ns: int) -> None:
        """ArduPlane reckons on by airspeed and heading: the mode stays."""

    def on_low_battery(self, now_ns: int, action: int) -> None:
        if action in (1, 2):
            self.request_mode(now_ns, M["RTL"])

    def on_fence(self, now_ns: int, action: int) -> None:
        if action in (1, 6, 7):  # RTL, or the fence's return point, which is home where none is set
            self.request_mode(now_ns, M["GUIDED" if action != 1 else "RTL"])
            self._centre = self.game_position(*self.home)

    def fly_to(self, now_ns: int, place: Place) -> None:
        self._course = None
        self._centre = self.game_of(place)
        self._seek(place.altitude_m, FAST)

    # ------------------------------------------------------------------ setpoints

    def _on_attitude_target(self, now_ns: int, packet: DialectPacket) -> None:
        m = packet.message
        if not self.is_mode("GUIDED"):
            self.counters["target_outside_guided"] += 1
            return
        w, x, y, z = m.q
        if not all(isfinite(value) for value in (w, x, y, z, m.thrust)):
            self.counters["target_refused"] += 1
            return
        used = m.type_mask ^ 0xFF  # 0x80 attitude as a whole; 1, 2: roll, pitch alone
        if used & 0x81:
            self._roll = atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
            self._roll_ns = now_ns
        if used & 0x82:
            self._pitch = asin(clamp(2.0 * (w * y - z * x), -1.0, 1.0))
            self._pitch_ns = now_ns
        if used & 0x40:
            self._throttle = clamp(m.thrust, 0.0, 1.0)
            self._throttle_ns = now_ns

    def _on_local_target(self, now_ns: int, packet: DialectPacket) -> None:
        """ArduPlane has no velocity targets."""
        self.counters["target_not_supported"] += 1

    def _on_global_target(self, now_ns: int, packet: DialectPacket) -> None:
        """Only the altitude is heeded, whatever else the mask says: a velocity mask is read as altitude 0."""
        m = packet.message
        if not self.is_mode("GUIDED"):
            self.counters["target_outside_guided"] += 1
        elif m.coordinate_frame not in ABOVE_HOME + ABSOLUTE or not isfinite(m.alt):
            self.say(dialect.MAV_SEVERITY_WARNING, "Invalid coord frame in SET_POSTION_TARGET_GLOBAL")
            self.counters["target_refused"] += 1
        elif m.type_mask & ALTITUDE_ONLY:
            altitude = m.alt + (self.home.altitude_m if m.coordinate_frame in ABOVE_HOME else 0.0)
            self._seek(altitude, FAST)

    # ------------------------------------------------------------------ commands

    def _do_guided_speed(self, now_ns: int, command: Command) -> int:
        if not self.is_mode("GUIDED"):
            return FAILED
        low, high = self.parameters["AIRSPEED_MIN"], self.parameters["AIRSPEED_MAX"]
        if command.p1 != 0.0 or not low <= command.p2 <= high or not isfinite(command.p3):
            return DENIED
        self._airspeed_target = command.p2
        self._acceleration = abs(command.p3) or FAST
        return ACCEPTED

    def _do_guided_altitude(self, now_ns: int, command: Command) -> int:
        if not self.is_mode("GUIDED"):
            return FAILED
        if command.z in (0.0, -1.0) or not isfinite(command.z) or not isfinite(command.p3):
            return DENIED
        if command.frame == dialect.MAV_FRAME_GLOBAL_RELATIVE_ALT:
            altitude = command.z + self.home.altitude_m
        elif command.frame == dialect.MAV_FRAME_GLOBAL:
            altitude = command.z
        else:
            return DENIED
        self._seek(altitude, abs(command.p3) or FAST)
        self._altitude_given = True
        return ACCEPTED

    def _do_guided_heading(self, now_ns: int, command: Command) -> int:
        if not self.is_mode("GUIDED"):
            return FAILED
        if not 0.0 <= command.p2 < 360.0 or not isfinite(command.p3):
            return DENIED
        if command.p1 == COURSE_OVER_GROUND:
            self._course = (Lateral.COURSE, radians(command.p2))
        elif command.p1 == HEADING:
            self._course = (Lateral.HEADING, radians(command.p2))
        else:
            return DENIED
        return ACCEPTED

    def _do_reposition(self, now_ns: int, command: Command) -> int:
        """Circle a point. A 43002 and a 43001 stay stronger until GUIDED is entered again."""
        place = self.place_of(command)
        if place is None:
            return DENIED
        changes = isfinite(command.p2) and int(command.p2) & dialect.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE
        if not changes and not self.is_mode("GUIDED"):
            return FAILED
        if self.request_mode(now_ns, M["GUIDED"]):
            return FAILED
        self._centre = self.game_of(place)
        if not self._altitude_given:
            self._seek(place.altitude_m, FAST)
        if isfinite(command.p3) and command.p3 > 0.0:
            self._radius = command.p3
            self._turn = -1.0 if command.p4 == 1.0 else 1.0
        return ACCEPTED

    def _do_change_speed(self, now_ns: int, command: Command) -> int:
        low, high = self.parameters["AIRSPEED_MIN"], self.parameters["AIRSPEED_MAX"]
        if command.p1 != 0.0 or not low <= command.p2 <= high:
            return FAILED
        self._airspeed_target = command.p2
        return ACCEPTED

    def _seek(self, altitude_m: float, climb_most: float) -> None:
        self._altitude_z = self.setup.frame.origin.altitude_m - altitude_m
        self._climb_most = climb_most


def _tan_deg(angle: float) -> float:
    return sin(radians(angle)) / max(1e-6, sin(radians(90.0 - angle)))
