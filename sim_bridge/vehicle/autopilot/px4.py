"""PX4 multicopter: OFFBOARD follows velocity targets for as long as they stream."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, isfinite, nan, sin

from onboard.core.math.vectors import ZERO, Vec, is_finite
from onboard.wire.geodesy import Geodetic
from onboard.wire.mavlink.dialect import DialectPacket, dialect
from onboard.wire.mavlink.modes import PX4_MODES
from sim_bridge.vehicle.autopilot import ardupilot, telemetry
from sim_bridge.vehicle.autopilot import default_parameters as tables
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, FAILED, LATER, Command
from sim_bridge.vehicle.autopilot.multicopter import Leg, Multicopter, Speeds
from sim_bridge.vehicle.autopilot.parameters import Parameters
from sim_bridge.vehicle.motion import Demand

M = PX4_MODES
BY_HAND = frozenset(M[name] for name in ("MANUAL", "ALTCTL", "POSCTL", "ACRO", "STABILIZED", "RATTITUDE"))
NOT_SIMULATED = frozenset(M[name] for name in ("READY", "MISSION", "FOLLOW", "PRECLAND"))
POSITIONAL = frozenset(M[name] for name in ("OFFBOARD", "HOLD", "RTL", "TAKEOFF", "POSCTL"))
STREAM_GAP_S = 0.5  # setpoints further apart than this are no stream: 2 Hz
STREAM_LONG_S = 1.0  # … that must have lasted so long before OFFBOARD may be entered
LOST_POSITION_S = 1.0
NO_POSITION, NO_VELOCITY, NO_ACCELERATION = 0x007, 0x038, 0x1C0
LOCAL, BODY = 1, 8  # MAV_FRAME

RATES = {number: hz for number, hz in ardupilot.RATES.items() if number in telemetry.OF_PX4} | {
    dialect.MAVLINK_MSG_ID_ESTIMATOR_STATUS: 1.0,
    dialect.MAVLINK_MSG_ID_WIND_COV: 1.0,
    dialect.MAVLINK_MSG_ID_ALTITUDE: 1.0,
    dialect.MAVLINK_MSG_ID_HOME_POSITION: 0.5,
}


class Px4Multicopter(Multicopter):
    """PX4 1.15 on a quadrotor."""

    autopilot_type = dialect.MAV_AUTOPILOT_PX4
    modes = M
    default_rates = RATES
    banner = ("PX4 v1.15.4 (simulated)",)
    version = 1 << 24 | 15 << 16 | 4 << 8 | 255
    refused_arming = LATER
    unknown_message = DENIED
    unknown_interval = FAILED
    starts_by_velocity = True
    armed_text = "Armed by external command"
    _stream_ns = -1  # since when setpoints stream; −1: they do not
    _setpoint_ns = -1  # of the last one
    _setpoint: tuple[Leg, Vec, Vec] = (Leg.HOLD, ZERO, ZERO)
    _link_lost = False
    _blind_ns = -1
    _battery_told = False

    def _new_parameters(self) -> Parameters:
        fast = self.setup.speed_max
        own = {
            "MAV_SYS_ID": float(self.system),
            "MPC_XY_VEL_MAX": max(12.0, fast),
            "MPC_Z_VEL_MAX_UP": max(3.0, fast),
            "MPC_Z_VEL_MAX_DN": max(1.5, fast),
        }
        return Parameters(tables.PX4, own | dict(self.setup.options.parameters), bytewise=True)

    def _message_handlers(self) -> dict[int, Callable[[int, DialectPacket], None]]:
        return super()._message_handlers() | {
            dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED: self._on_local_target,
            dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT: self._on_global_target,
        }

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        return super()._command_handlers() | {
            dialect.MAV_CMD_NAV_TAKEOFF: self._do_takeoff,
            dialect.MAV_CMD_NAV_LAND: lambda now, c: self._by_name(now, "LAND"),
            dialect.MAV_CMD_NAV_RETURN_TO_LAUNCH: lambda now, c: self._by_name(now, "RTL"),
            dialect.MAV_CMD_NAV_LOITER_UNLIM: lambda now, c: self._by_name(now, "HOLD"),
            dialect.MAV_CMD_DO_REPOSITION: self._do_reposition,
            dialect.MAV_CMD_DO_CHANGE_SPEED: self._do_change_speed,
        }

    def watched_ground_station(self, packet: DialectPacket) -> bool:
        """PX4 takes any ground station for the data link."""
        return bool(packet.message.type == dialect.MAV_TYPE_GCS)

    # ------------------------------------------------------------------ modes

    @property
    def first_mode(self) -> int:
        return M["HOLD"]

    @property
    def speeds(self) -> Speeds:
        p = self.parameters
        return Speeds(
            p["MPC_XY_CRUISE"],
            min(3.0, p["MPC_Z_VEL_MAX_UP"]),
            min(1.5, p["MPC_Z_VEL_MAX_DN"]),
            p["MPC_LAND_SPEED"],
        )

    @property
    def linger_s(self) -> float:
        return max(0.0, self.parameters["RTL_LAND_DELAY"])

    @property
    def idle_disarm_s(self) -> float:
        return max(0.0, self.parameters["COM_DISARM_PRFLT"])

    def set_mode_result(self, now_ns: int, command: Command) -> int:
        if not all(isfinite(p) and 0.0 <= p < 256.0 for p in (command.p1, command.p2, command.p3)):
            return LATER
        if not int(command.p1) & dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED:
            return LATER
        mode = int(command.p2) << 16 | int(command.p3) << 24
        if mode not in M.values():
            return LATER
        reason = self.request_mode(now_ns, mode)
        if reason:
            self.say(dialect.MAV_SEVERITY_CRITICAL, reason)
            return LATER
        return ACCEPTED

    def allows(self, now_ns: int, mode: int) -> str:
        if mode in NOT_SIMULATED:
            return "Switching to this mode is currently not available"
        if self.armed and mode in POSITIONAL and not self.positioned(now_ns):
            return "Switching mode denied: no valid position"
        if mode == M["OFFBOARD"] and not self._streaming(now_ns):
            return "Switching to Offboard is currently not available"
        return ""

    def enter(self, now_ns: int, mode: int) -> None:
        if self.landed and mode != M["TAKEOFF"]:
            self.fly(Leg.HOLD, now_ns)
        elif mode == M["RTL"]:
            self.fly_home(now_ns, self.parameters["RTL_RETURN_ALT"])
        elif mode == M["LAND"]:
            self.land_here(now_ns)
        elif mode == M["TAKEOFF"]:
            self._take_off_to(now_ns, self.parameters["MIS_TAKEOFF_ALT"])
        else:
            self.fly(Leg.HOLD, now_ns)

    def taken_off(self, now_ns: int) -> None:
        place = self.target
        self.request_mode(now_ns, M["HOLD"])
        self.target = place

    def why_not_armable(self, now_ns: int) -> str:
        if not self.positioned(now_ns) or not self.healthy(now_ns):
            return "Arming denied: Resolve system health failures first"[:50]
        return "Arming denied: low battery" if self.health.battery <= 0.0 else ""

    def guide(self, now_ns: int, dt: float) -> Demand:
        if self.is_mode("OFFBOARD"):
            leg, target, velocity = self._setpoint
            if leg == Leg.VELOCITY:
                self.fly_velocity(self._clipped(velocity), now_ns)
            elif leg == Leg.GOTO:
                self.fly(Leg.GOTO, now_ns, target)
                self.feed_forward = velocity
        return super().guide(now_ns, dt)

    # ------------------------------------------------------------------ failsafes

    def watch(self, now_ns: int) -> None:
        if self.is_mode("OFFBOARD") and not self._setpoints_fresh(now_ns):
            self.say(dialect.MAV_SEVERITY_CRITICAL, "Failsafe: Offboard signal lost")
            action = int(self.parameters["COM_OBL_RC_ACT"])
            self.escape(now_ns, {3: "RTL", 4: "LAND", 0: "POSCTL"}.get(action, "HOLD"))
        if not self.armed or self.landed:
            self._link_lost = False
            return
        self._watch_link(now_ns)
        self._watch_position(now_ns)
        self._watch_battery(now_ns)

    def _watch_link(self, now_ns: int) -> None:
        lost = self.ground_station_silence_s(now_ns) > self.parameters["COM_DL_LOSS_T"]
        if lost and not self._link_lost:
            self.say(dialect.MAV_SEVERITY_CRITICAL, "Connection to ground station lost")
            name = {1: "HOLD", 2: "RTL", 3: "LAND"}.get(int(self.parameters["NAV_DLL_ACT"]))
            if name is not None:
                self.escape(now_ns, name)
        self._link_lost = lost

    def _watch_position(self, now_ns: int) -> None:
        if self.positioned(now_ns):
            self._blind_ns = -1
        elif self._blind_ns < 0:
            self._blind_ns = now_ns
        elif (now_ns - self._blind_ns) * 1e-9 >= LOST_POSITION_S and self.mode in POSITIONAL:
            self.say(dialect.MAV_SEVERITY_CRITICAL, "Failsafe: position lost, landing")
            self.escape(now_ns, "LAND")

    def _watch_battery(self, now_ns: int) -> None:
        if self.health.battery > self.parameters["BAT_CRIT_THR"]:
            self._battery_told = False
        elif not self._battery_told:
            self._battery_told = True
            self.say(dialect.MAV_SEVERITY_CRITICAL, "Critical battery level")
            name = {2: "LAND", 3: "RTL"}.get(int(self.parameters["COM_LOW_BAT_ACT"]))
            if name is not None:
                self.escape(now_ns, name)

    # ------------------------------------------------------------------ setpoints

    def _streaming(self, now_ns: int) -> bool:
        """Whether setpoints have come at 2 Hz or more for more than a second."""
        if self._stream_ns < 0 or (now_ns - self._setpoint_ns) * 1e-9 > STREAM_GAP_S:
            return False
        return (now_ns - self._stream_ns) * 1e-9 > STREAM_LONG_S

    def _setpoints_fresh(self, now_ns: int) -> bool:
        return (now_ns - self._setpoint_ns) * 1e-9 <= self.parameters["COM_OF_LOSS_T"]

    def _on_local_target(self, now_ns: int, packet: DialectPacket) -> None:
        m = packet.message
        velocity = Vec(m.vx, m.vy, m.vz)
        position = Vec(m.x, m.y, m.z)
        if m.coordinate_frame == BODY:
            c, s = cos(self.motion.yaw), sin(self.motion.yaw)
            velocity = Vec(c * velocity.x - s * velocity.y, s * velocity.x + c * velocity.y, velocity.z)
            position = Vec(nan, nan, nan)  # PX4 has no positions in the body's frame
        elif m.coordinate_frame != LOCAL:
            self.counters["target_refused"] += 1
            return
        elif not m.type_mask & NO_POSITION and is_finite(position):
            position = self.game_from_local(position)
        self._take_setpoint(now_ns, m.type_mask, position, velocity)

    def _on_global_target(self, now_ns: int, packet: DialectPacket) -> None:
        m = packet.message
        altitude = m.alt + (self.home.altitude_m if m.coordinate_frame in ardupilot.ABOVE_HOME else 0.0)
        known = m.coordinate_frame in ardupilot.ABOVE_HOME + ardupilot.ABSOLUTE
        latitude, longitude = m.lat_int * 1e-7, m.lon_int * 1e-7
        if not known or abs(latitude) > 90.0 or abs(longitude) > 180.0 or not isfinite(altitude):
            self.counters["target_refused"] += 1
            return
        position = self.game_position(latitude, longitude, altitude)
        self._take_setpoint(now_ns, m.type_mask, position, Vec(m.vx, m.vy, m.vz))

    def _take_setpoint(self, now_ns: int, mask: int, position: Vec, velocity: Vec) -> None:
        with_position = not mask & NO_POSITION and is_finite(position)
        with_velocity = not mask & NO_VELOCITY and is_finite(velocity)
        if with_position:
            self._setpoint = (Leg.GOTO, position, velocity if with_velocity else ZERO)
        elif with_velocity:
            self._setpoint = (Leg.VELOCITY, ZERO, velocity)
        else:
            self.counters["target_refused"] += 1
            return
        if self._stream_ns < 0 or (now_ns - self._setpoint_ns) * 1e-9 > STREAM_GAP_S:
            self._stream_ns = now_ns
        self._setpoint_ns = now_ns

    def _clipped(self, v: Vec) -> Vec:
        """A velocity within MPC_XY_VEL_MAX and MPC_Z_VEL_MAX_…"""
        p = self.parameters
        most = p["MPC_XY_VEL_MAX"]
        flat = (v.x * v.x + v.y * v.y) ** 0.5
        k = most / flat if flat > most else 1.0
        return Vec(v.x * k, v.y * k, max(-p["MPC_Z_VEL_MAX_UP"], min(p["MPC_Z_VEL_MAX_DN"], v.z)))

    # ------------------------------------------------------------------ commands

    def _by_name(self, now_ns: int, name: str) -> int:
        return LATER if self.request_mode(now_ns, M[name]) else ACCEPTED

    def _take_off_to(self, now_ns: int, height: float) -> None:
        p = self.motion.position
        self.fly(Leg.TAKEOFF, now_ns, Vec(p.x, p.y, min(p.z, self.home_position.z - height)))

    def _do_takeoff(self, now_ns: int, command: Command) -> int:
        """Param 7 is an altitude above mean sea level; NaN: MIS_TAKEOFF_ALT above home."""
        if not self.landed or self.request_mode(now_ns, M["TAKEOFF"]):
            return LATER
        if isfinite(command.z):
            self._take_off_to(now_ns, command.z - self.home.altitude_m)
        return ACCEPTED

    def _do_reposition(self, now_ns: int, command: Command) -> int:
        here = self.place
        place = Geodetic(
            command.latitude_deg if isfinite(command.latitude_deg) else here.latitude_deg,
            command.longitude_deg if isfinite(command.longitude_deg) else here.longitude_deg,
            command.z if isfinite(command.z) else here.altitude_m,
        )
        if command.frame in ardupilot.ABOVE_HOME:
            place = place._replace(altitude_m=place.altitude_m + self.home.altitude_m)
        elif command.frame not in (-1, *ardupilot.ABSOLUTE):
            return UNSUPPORTED_FRAME
        if abs(place.latitude_deg) > 90.0 or abs(place.longitude_deg) > 180.0:
            return DENIED
        changes = isfinite(command.p2) and int(command.p2) & dialect.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE
        if not self.armed or self.landed or not (changes or self.is_mode("HOLD")):
            return LATER
        if self.request_mode(now_ns, M["HOLD"]):
            return LATER
        self.fly(Leg.GOTO, now_ns, self.game_position(*place))
        return ACCEPTED

    def _do_change_speed(self, now_ns: int, command: Command) -> int:
        if not isfinite(command.p2) or command.p2 <= 0.0:
            return DENIED
        self.parameters.put("MPC_XY_CRUISE", command.p2)
        return ACCEPTED


UNSUPPORTED_FRAME = 8  # MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME: newer than the dialect
