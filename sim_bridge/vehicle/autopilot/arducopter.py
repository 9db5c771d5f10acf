"""ArduCopter: GUIDED follows velocity targets and stops by itself when they cease."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, isfinite, sin

from onboard.core.math.vectors import ZERO, Vec, is_finite
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import DialectPacket, dialect
from onboard.wire.mavlink.modes import ARDUCOPTER_MODES
from sim_bridge.vehicle.autopilot import default_parameters as tables
from sim_bridge.vehicle.autopilot.ardupilot import ABOVE_HOME, ABSOLUTE, RADIO_S, ArduPilot, Place
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, FAILED, Command
from sim_bridge.vehicle.autopilot.generations import ADDED, renamed
from sim_bridge.vehicle.autopilot.multicopter import Leg, Multicopter, Speeds
from sim_bridge.vehicle.autopilot.parameters import Parameters
from sim_bridge.vehicle.autopilot.resting import AWAKE, until
from sim_bridge.vehicle.motion import Demand

M = ARDUCOPTER_MODES
CM = 0.01
PILOTED = frozenset(  # not flown by the autopilot: BRAKE too
    M[name]
    for name in ("STABILIZE", "ACRO", "ALT_HOLD", "LOITER", "POSHOLD", "SPORT", "DRIFT", "FLOWHOLD", "BRAKE")
)
BY_STICK = frozenset(  # the throttle stick is the climb rate: at the bottom they sink
    M[name]
    for name in ("STABILIZE", "ACRO", "ALT_HOLD", "LOITER", "POSHOLD", "SPORT", "DRIFT", "FLOWHOLD", "CIRCLE")
)
BLOCKABLE = (
    "STABILIZE", "ACRO", "ALT_HOLD", "AUTO", "GUIDED", "LOITER", "CIRCLE", "DRIFT", "SPORT", "FLIP",
    "AUTOTUNE", "POSHOLD", "BRAKE", "THROW", "AVOID_ADSB", "GUIDED_NOGPS", "SMART_RTL", "FLOWHOLD", "FOLLOW",
    "ZIGZAG", "SYSTEMID", "AUTOROTATE", "AUTO_RTL", "TURTLE",
)  # fmt: skip
POSITIONAL = frozenset(
    M[name]
    for name in ("AUTO", "GUIDED", "LOITER", "RTL", "CIRCLE", "DRIFT", "POSHOLD", "BRAKE", "FOLLOW", "ZIGZAG")
)
NOT_SIMULATED = frozenset(
    M[name]
    for name in (
        "FLIP", "AUTOTUNE", "THROW", "AVOID_ADSB", "GUIDED_NOGPS", "SMART_RTL", "SYSTEMID", "AUTOROTATE",
        "AUTO_RTL", "TURTLE",
    )
)  # fmt: skip
NOT_ARMABLE = frozenset(M[name] for name in ("RTL", "LAND", "BRAKE", "AUTO", "CIRCLE", "DRIFT"))
USER_TAKEOFF = frozenset(M[name] for name in ("GUIDED", "LOITER", "ALT_HOLD", "POSHOLD"))
# type_mask: a set bit ignores the field; one bit of a group ignores the group
NO_POSITION, NO_VELOCITY, NO_ACCELERATION, FORCE_SET, NO_YAW = 0x007, 0x038, 0x1C0, 0x200, 0x400
LOCAL, LOCAL_OFFSET, BODY, BODY_OFFSET = 1, 7, 8, 9  # MAV_FRAME
RC_CONTINUE_GUIDED = 4  # FS_OPTIONS: the transmitter's loss does not end GUIDED
CONTINUE_PILOTED = 16  # FS_OPTIONS: the ground station's silence does not end a mode flown by hand


class ArduCopter(Multicopter, ArduPilot):
    """ArduCopter 4.5 on a quadrotor: modes, failsafes, targets and commands."""

    modes = M
    blockable = BLOCKABLE
    recovered = "Cleared"
    starts_by_velocity = False
    armed_text = "Arming motors"
    _target_ns = 0  # of the last velocity target

    def _new_parameters(self) -> Parameters:
        options = self.setup.options
        key = Kind.ARDUCOPTER, options.firmware
        own = {"SYSID_THISMAV": self.system, "SCHED_LOOP_RATE": 400}
        table = tables.ARDUCOPTER + ADDED.get(key, ())
        return Parameters(table, own | dict(options.parameters), bytewise=False, aliases=renamed(*key))

    @property
    def banner(self) -> tuple[str, ...]:
        return f"ArduCopter V{self.version_name} (simulated)", "Frame: QUAD/PLUS"

    def _message_handlers(self) -> dict[int, Callable[[int, DialectPacket], None]]:
        return super()._message_handlers() | {
            dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED: self._on_local_target,
            dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT: self._on_global_target,
        }

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        return super()._command_handlers() | {
            dialect.MAV_CMD_NAV_TAKEOFF: self._do_takeoff,
            dialect.MAV_CMD_NAV_LAND: lambda now, c: self._by_command(now, "LAND"),
            dialect.MAV_CMD_DO_REPOSITION: self._do_reposition,
            dialect.MAV_CMD_DO_CHANGE_SPEED: self._do_change_speed,
        }

    # ------------------------------------------------------------------ modes

    @property
    def first_mode(self) -> int:
        if self.landed:
            return M["STABILIZE"]
        return M["LOITER"] if self._stick_climb() == 0.0 else M["BRAKE"]

    def _stick_climb(self) -> float:
        """Climb rate that the pilot's throttle stick asks for [m/s, up]."""
        p = self.parameters
        share = self.transmitter.climb_share(1e-3 * p["THR_DZ"])
        down = p["PILOT_SPEED_DN"] or p["PILOT_SPEED_UP"]
        return share * CM * (p["PILOT_SPEED_UP"] if share > 0.0 else down)

    @property
    def speeds(self) -> Speeds:
        p = self.parameters
        level, up, down = CM * p["WPNAV_SPEED"], CM * p["WPNAV_SPEED_UP"], CM * p["WPNAV_SPEED_DN"]
        return Speeds(level, up, down, CM * p["LAND_SPEED"])

    @property
    def linger_s(self) -> float:
        return 1e-3 * self.parameters["RTL_LOIT_TIME"]

    @property
    def idle_disarm_s(self) -> float:
        return self.parameters["DISARM_DELAY"]

    def allows(self, now_ns: int, mode: int) -> str:
        if mode in NOT_SIMULATED:
            return "not simulated"
        if self.armed and mode in POSITIONAL and not self.positioned(now_ns):
            return "requires position"
        return "init failed" if self.armed and mode == M["AUTO"] else ""

    def enter(self, now_ns: int, mode: int) -> None:
        if mode == M["RTL"] and not self.landed:
            self.fly_home(now_ns, CM * self.parameters["RTL_ALT"])
        elif mode == M["LAND"] and not self.landed:
            self.land_here(now_ns)
        else:
            self.fly(Leg.HOLD, now_ns)

    def taken_off(self, now_ns: int) -> None:
        """GUIDED keeps the place that the take-off has reached."""

    def why_not_armable(self, now_ns: int) -> str:
        if not self.positioned(now_ns) or not self.healthy(now_ns):
            return "Arm: Need Position Estimate"
        if self.health.battery <= 0.0:
            return "Arm: Battery 1 low voltage failsafe"
        if self._failsafe:
            return "Arm: GCS failsafe on"
        return f"Arm: {self.mode_name} mode not armable" if self.mode in NOT_ARMABLE else ""

    # ------------------------------------------------------------------ failsafes

    def guide(self, now_ns: int, dt: float) -> Demand:
        if self.leg == Leg.VELOCITY and (now_ns - self._target_ns) * 1e-9 > self.parameters["GUID_TIMEOUT"]:
            self.fly(Leg.HOLD, now_ns)
        if self.mode in BY_STICK and not self.landed:
            climb = self._stick_climb()
            if climb != 0.0:
                self.fly_by_stick(now_ns, climb)
            elif self.leg == Leg.STICK:
                self.fly(Leg.HOLD, now_ns)
        return super().guide(now_ns, dt)

    def steady_until(self, now_ns: int) -> int:
        if self.leg != Leg.VELOCITY or self.mode in BY_STICK:
            return AWAKE
        return until(self._target_ns, self.parameters["GUID_TIMEOUT"])

    def silence_limit_s(self) -> float:
        return self.parameters["FS_GCS_TIMEOUT"] if self.parameters["FS_GCS_ENABLE"] else 0.0

    def on_silence(self, now_ns: int) -> None:
        if self._told_on_ground(now_ns, "GCS"):
            return
        if self.mode in PILOTED and int(self.parameters["FS_OPTIONS"]) & CONTINUE_PILOTED:
            self.say(dialect.MAV_SEVERITY_WARNING, "GCS Failsafe - Continuing Pilot Control")
            return
        self.say(dialect.MAV_SEVERITY_WARNING, "GCS Failsafe")
        action = int(self.parameters["FS_GCS_ENABLE"])
        if action == 2 and self.is_mode("AUTO"):
            return
        self.escape(now_ns, {5: "LAND", 7: "BRAKE"}.get(action, "RTL"))

    def _told_on_ground(self, now_ns: int, which: str) -> bool:
        """Act on a failsafe that finds the vehicle on the ground: it disarms, and says so."""
        if not self.landed:
            return False
        if self.armed:
            self.say(dialect.MAV_SEVERITY_WARNING, f"{which} Failsafe - Disarming")
            self.disarm(now_ns)
        else:
            self.say(dialect.MAV_SEVERITY_WARNING, f"{which} Failsafe")
        return True

    def radio_limit_s(self) -> float:
        return RADIO_S if self.parameters["FS_THR_ENABLE"] else 0.0

    def on_radio_lost(self, now_ns: int) -> None:
        if self._told_on_ground(now_ns, "Radio"):
            return
        if self.is_mode("GUIDED") and int(self.parameters["FS_OPTIONS"]) & RC_CONTINUE_GUIDED:
            self.say(dialect.MAV_SEVERITY_WARNING, "Radio Failsafe - Continuing Guided Mode")
            return
        self.say(dialect.MAV_SEVERITY_WARNING, "Radio Failsafe")
        self.escape(now_ns, {3: "LAND", 7: "BRAKE"}.get(int(self.parameters["FS_THR_ENABLE"]), "RTL"))

    def on_lost_position(self, now_ns: int) -> None:
        action = int(self.parameters["FS_EKF_ACTION"])
        if self._ekf_failsafe or not action or not (self.mode in POSITIONAL or action == 3):
            return
        self._ekf_failsafe = True
        name = "ALT_HOLD" if action == 2 else "LAND"
        self.say(dialect.MAV_SEVERITY_CRITICAL, "EKF variance")
        self.say(dialect.MAV_SEVERITY_CRITICAL, f"EKF Failsafe: changed to {name} Mode")
        self.escape(now_ns, name)

    def on_low_battery(self, now_ns: int, action: int) -> None:
        if action in (1, 2, 3, 4, 7):
            self.say(dialect.MAV_SEVERITY_WARNING, "Battery Failsafe")
            self.escape(now_ns, {1: "LAND", 7: "BRAKE"}.get(action, "RTL"))

    def on_fence(self, now_ns: int, action: int) -> None:
        if action:
            self.escape(now_ns, {2: "LAND", 4: "BRAKE"}.get(action, "RTL"))

    def fly_to(self, now_ns: int, place: Place) -> None:
        self.fly(Leg.GOTO, now_ns, self.game_of(place))

    # ------------------------------------------------------------------ setpoints

    def _on_local_target(self, now_ns: int, packet: DialectPacket) -> None:
        m = packet.message
        if not self.is_mode("GUIDED"):
            self.counters["target_outside_guided"] += 1
            return
        if m.coordinate_frame not in (LOCAL, LOCAL_OFFSET, BODY, BODY_OFFSET):
            self._stop(now_ns)
            return
        position, velocity = Vec(m.x, m.y, m.z), Vec(m.vx, m.vy, m.vz)
        if m.coordinate_frame in (BODY, BODY_OFFSET):
            position, velocity = self._turned(position), self._turned(velocity)
        here = self.motion.position
        if m.coordinate_frame == LOCAL:
            if not m.type_mask & NO_POSITION and is_finite(position):
                position = self.game_from_local(position)
        else:
            position = Vec(here.x + position.x, here.y + position.y, here.z + position.z)
        turn = self.motion.yaw if m.coordinate_frame in (BODY, BODY_OFFSET) else 0.0
        self._follow(now_ns, m.type_mask, position, velocity, m.yaw + turn)

    def _on_global_target(self, now_ns: int, packet: DialectPacket) -> None:
        m = packet.message
        if not self.is_mode("GUIDED"):
            self.counters["target_outside_guided"] += 1
            return
        altitude = m.alt + (self.home.altitude_m if m.coordinate_frame in ABOVE_HOME else 0.0)
        latitude, longitude = m.lat_int * 1e-7, m.lon_int * 1e-7
        wants_place = not m.type_mask & NO_POSITION
        sane = isfinite(altitude) and abs(latitude) <= 90.0 and abs(longitude) <= 180.0
        if m.coordinate_frame not in ABOVE_HOME + ABSOLUTE or (wants_place and not sane):
            self._stop(now_ns)
            return
        position = self.game_position(latitude, longitude, altitude) if wants_place else ZERO
        self._follow(now_ns, m.type_mask, position, Vec(m.vx, m.vy, m.vz), m.yaw)

    def _follow(self, now_ns: int, mask: int, position: Vec, velocity: Vec, yaw: float) -> None:
        """A target in the frame of motion, as far as the mask says."""
        forced = mask & FORCE_SET and not mask & NO_ACCELERATION
        with_position = not mask & NO_POSITION
        with_velocity = not mask & NO_VELOCITY
        values = (position if with_position else ZERO, velocity if with_velocity else ZERO)
        if forced or not (with_position or with_velocity) or not all(is_finite(v) for v in values):
            self._stop(now_ns)
        elif self.landed:
            self.counters["target_on_ground"] += 1
        elif with_position:
            self.fly(Leg.GOTO, now_ns, position)
            self.feed_forward = values[1]
        else:
            self._target_ns = now_ns
            looks = not mask & NO_YAW and isfinite(yaw)
            self.fly_velocity(velocity, now_ns, yaw if looks else None)

    def _stop(self, now_ns: int) -> None:
        """What ArduCopter does with a target it does not understand."""
        self.counters["target_refused"] += 1
        if not self.landed:
            self.fly(Leg.HOLD, now_ns)

    def _turned(self, v: Vec) -> Vec:
        """From the body's heading to north–east."""
        c, s = cos(self.motion.yaw), sin(self.motion.yaw)
        return Vec(c * v.x - s * v.y, s * v.x + c * v.y, v.z)

    # ------------------------------------------------------------------ commands

    def _do_takeoff(self, now_ns: int, command: Command) -> int:
        if command.frame not in (-1, *ABOVE_HOME):
            return DENIED
        if not (self.armed and self.landed and self.mode in USER_TAKEOFF and isfinite(command.z)):
            return FAILED
        if command.z <= self.height:
            return FAILED
        p = self.motion.position
        self.fly(Leg.TAKEOFF, now_ns, Vec(p.x, p.y, self.home_position.z - command.z))
        return ACCEPTED

    def _do_reposition(self, now_ns: int, command: Command) -> int:
        place = self.place_of(command)
        if place is None:
            return DENIED
        changes = isfinite(command.p2) and int(command.p2) & dialect.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE
        if not changes and not self.is_mode("GUIDED"):
            return FAILED
        if self.landed or self.request_mode(now_ns, M["GUIDED"]):
            return FAILED
        self.fly(Leg.GOTO, now_ns, self.game_of(place))
        return ACCEPTED

    def _do_change_speed(self, now_ns: int, command: Command) -> int:
        if not isfinite(command.p2) or command.p2 <= 0.0:
            return FAILED
        self.parameters.put("WPNAV_SPEED", command.p2 / CM)
        return ACCEPTED
