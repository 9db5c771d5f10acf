"""PX4 whatever it flies: modes, failsafes, targets, commands.

As PX4 1.16.0 was recorded (tests/field): the intended mode outlives a failsafe, orders of a mode are
acknowledged twice, heartbeats keep their second but after such an order, texts go to ground stations only.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from math import cos, hypot, isfinite, nan, sin
from typing import ClassVar, NamedTuple

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec, is_finite
from onboard.game.scenario import Firmware
from onboard.wire.geodesy import Geodetic
from onboard.wire.mavlink.dialect import DialectPacket, dialect
from onboard.wire.mavlink.modes import PX4_MODES
from sim_bridge.vehicle.autopilot import ardupilot, failsafes, telemetry
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, FAILED, LATER, Command
from sim_bridge.vehicle.autopilot.failsafes import Condition, Latches, stronger
from sim_bridge.vehicle.autopilot.generations import renamed
from sim_bridge.vehicle.autopilot.parameters import Parameter, Parameters
from sim_bridge.vehicle.autopilot.px4_streams import FULL_RATES
from sim_bridge.vehicle.autopilot.resting import AWAKE, FOR_EVER, px4_rest
from sim_bridge.vehicle.autopilot.setup import Setup

M = PX4_MODES
BY_HAND = frozenset(M[name] for name in ("MANUAL", "ALTCTL", "POSCTL", "ACRO", "STABILIZED", "RATTITUDE"))
NOT_SIMULATED = frozenset(M[name] for name in ("READY", "MISSION", "FOLLOW", "PRECLAND"))
POSITIONAL = frozenset(M[name] for name in ("OFFBOARD", "HOLD", "RTL", "TAKEOFF", "POSCTL"))
LOST_POSITION_S = 5.0  # for which the estimator reckons on without satellites
BEAT_AFTER_ORDER_NS = 40_000_000  # from the second acknowledgement of a mode's order
STATION_HEARD_S = 10.0  # for which a link counts as a ground station's after its heartbeat
NO_POSITION, NO_VELOCITY, NO_ACCELERATION, NO_YAW = 0x007, 0x038, 0x1C0, 0x400
LOCAL, BODY = 1, 8  # MAV_FRAME
UNSUPPORTED_FRAME = 8  # MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME: newer than the dialect

VERSIONS = {Firmware.OLDER: (1, 15, 4), Firmware.RECORDED: (1, 16, 0), Firmware.NEWER: (1, 18, 0)}
RATES = {number: hz for number, hz in ardupilot.RATES.items() if number in telemetry.OF_PX4} | {
    dialect.MAVLINK_MSG_ID_ESTIMATOR_STATUS: 1.0,
    dialect.MAVLINK_MSG_ID_WIND_COV: 1.0,
    dialect.MAVLINK_MSG_ID_ALTITUDE: 1.0,
    dialect.MAVLINK_MSG_ID_HOME_POSITION: 0.5,
}


class Setpoint(NamedTuple):
    """The latest target: where to be and how fast to move, as far as its mask says so."""

    position: Vec | None  # [m; NED, frame of motion]
    velocity: Vec | None  # [m/s; NED]
    yaw: float | None = None  # [rad]


class Px4(Autopilot):
    """What PX4 does alike for every vehicle: modes, failsafes, targets, commands."""

    autopilot_type = dialect.MAV_AUTOPILOT_PX4
    modes = M
    default_rates = RATES
    full_rates = FULL_RATES
    versions = VERSIONS
    table: ClassVar[tuple[Parameter, ...]]  # of parameters as delivered
    refused_arming = LATER
    unknown_message = DENIED
    unknown_interval = FAILED
    _setpoint_ns = -NS_PER_S * 3600  # of the last setpoint; long ago: there was none
    _setpoint = Setpoint(None, None)
    _in_failsafe = False
    _signal_lost = False
    _blind_ns = -1  # since when the estimator has no position; −1: it has
    _blind_told = False
    _beat_ns = 0  # when the heartbeat that follows an order is due; 0: none is

    def __init__(self, setup: Setup, now_ns: int) -> None:
        self._latches = Latches()
        self._intended = M["HOLD"]  # the mode that a person or a companion chose
        self.modes_by_number = {number: name for name, number in M.items()}
        super().__init__(setup, now_ns)
        self._intended = self.mode

    def reboot(self, now_ns: int) -> None:
        self._latches.forget()
        self._intended = self.first_mode
        self._in_failsafe = False
        super().reboot(now_ns)

    @property
    def banner(self) -> tuple[str, ...]:
        return (f"PX4 v{self.version_name} (simulated)",)

    def say(self, severity: int, text: str) -> None:
        """Queue a STATUSTEXT where a ground station is heard: PX4 sends texts to nobody else."""
        heard = self._any_station_ns
        if heard >= 0 and (self._last_step_ns - heard) * 1e-9 <= STATION_HEARD_S:
            super().say(severity, text)
        else:
            self.counters["text_unsent"] += 1

    def _heartbeat(self, now_ns: int) -> None:
        """PX4 keeps its second: a change of mode or arming is told by the next heartbeat that is due."""
        if now_ns >= self._heartbeat_ns:
            super()._heartbeat(now_ns)

    def _change(self, now_ns: int, mode: int) -> None:
        """A person or a companion chooses a mode: it is intended from now on, and failsafes are released."""
        self._intended = mode
        self._latches.release()
        self._switch(now_ns, mode)

    def _switch(self, now_ns: int, mode: int) -> None:
        self.mode = mode
        self.enter(now_ns, mode)

    def request_mode(self, now_ns: int, mode: int) -> str:
        """Change the mode where it may be entered; gives the reason where it may not, else ""."""
        reason = self.allows(now_ns, mode)
        if not reason and (mode != self.mode or mode != self._intended):
            self._change(now_ns, mode)
        return reason

    @abstractmethod
    def own_parameters(self) -> dict[str, float]:
        """The parameters that fit the scenario's vehicle, and its table's names."""

    @abstractmethod
    def go_to(self, now_ns: int, place: Vec) -> None:
        """Fly to a place and stay there [m; NED, frame of motion]."""

    @abstractmethod
    def take_off_to(self, now_ns: int, place: Vec) -> None:
        """Climb to a place [m; NED, frame of motion]."""

    def _new_parameters(self) -> Parameters:
        options = self.setup.options
        key = self.setup.kind, options.firmware
        own = {"MAV_SYS_ID": float(self.system)} | self.own_parameters() | dict(options.parameters)
        return Parameters(self.table, own, bytewise=True, aliases=renamed(*key))

    def _message_handlers(self) -> dict[int, Callable[[int, DialectPacket], None]]:
        return super()._message_handlers() | {
            dialect.MAVLINK_MSG_ID_MISSION_ITEM: self._on_mission_item,
            dialect.MAVLINK_MSG_ID_MISSION_ITEM_INT: self._on_mission_item,
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
        }

    def watched_ground_station(self, packet: DialectPacket) -> bool:
        """PX4 takes any ground station for the data link."""
        return bool(packet.message.type == dialect.MAV_TYPE_GCS)

    def _on_mission_item(self, now_ns: int, packet: DialectPacket) -> None:
        """No upload is under way: refused, guided points (current = 2) too."""
        kind = packet.message.mission_type
        error = dialect.MAV_MISSION_ERROR
        self.emit(dialect.MAVLink_mission_ack_message(packet.system, packet.component, error, kind))

    # ------------------------------------------------------------------ modes

    @property
    def first_mode(self) -> int:
        return M["HOLD"]

    def set_mode_result(self, now_ns: int, command: Command) -> int:
        """Result of a DO_SET_MODE, which PX4 acknowledges as accepted first and then by its result."""
        self.emit(
            dialect.MAVLink_command_ack_message(
                dialect.MAV_CMD_DO_SET_MODE, ACCEPTED, 0, 0, command.system, command.component
            )
        )
        result = self._set_mode(now_ns, command)
        if result == ACCEPTED:
            self._beat_ns = now_ns + BEAT_AFTER_ORDER_NS
        return result

    def _set_mode(self, now_ns: int, command: Command) -> int:
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
        if mode == M["OFFBOARD"] and not self._setpoints_fresh(now_ns):
            return "Switching to mode 'Offboard' is currently not possible"
        return ""

    def why_not_armable(self, now_ns: int) -> str:
        if not self.positioned(now_ns) or not self.healthy(now_ns):
            return "Arming denied: Resolve system health failures first"
        return "Arming denied: low battery" if self.health.battery <= 0.0 else ""

    # ------------------------------------------------------------------ failsafes

    @property
    def critical(self) -> bool:
        return self._in_failsafe

    def watch(self, now_ns: int) -> None:
        """Choose the mode: what a person intends, or what the strongest failsafe wants in its place.

        The intended mode outlives a failsafe: when setpoints return, OFFBOARD does so by itself.
        """
        if self._beat_ns and now_ns >= self._beat_ns:
            self._beat_ns = 0
            self.emit(telemetry.heartbeat(self, now_ns))
        wanted = self._fallback(now_ns)
        if self.armed and not self.landed:
            for text in self._latches.look(self._conditions(now_ns), now_ns):
                self.say(dialect.MAV_SEVERITY_CRITICAL, text)
            wanted = stronger(wanted, self._latches.action(now_ns, self.parameters["COM_FAIL_ACT_T"]))
        else:
            self._latches.forget()
        if wanted == "TERMINATE":
            self.armed = False
        self._in_failsafe = bool(wanted)
        mode = M.get(wanted, self.mode) if wanted else self._intended
        if mode != self.mode:
            self._switch(now_ns, mode)

    def watched_until(self, now_ns: int) -> int:
        calm = self.mode == self._intended and self._blind_ns < 0 and not self.transmitter.silent
        if not calm or self._in_failsafe or self._signal_lost or self._latches.latched or self.health.faults:
            return AWAKE
        streams_ns = self._setpoint_ns if self.is_mode("OFFBOARD") else FOR_EVER
        silence_s = self.ground_station_silence_s(now_ns)
        rest = px4_rest(self.parameters, self.health, now_ns, silence_s, streams_ns)
        return min(rest, self._beat_ns or FOR_EVER)

    def _fallback(self, now_ns: int) -> str:
        """The mode in which it flies while the intended one has not what it needs; "" where it has."""
        blind = self._blind(now_ns)
        by_hand = self.modes_by_number.get(self._intended, "") in ("POSCTL", "ALTCTL", "STABILIZED")
        wanted = ""
        if self._intended == M["OFFBOARD"] and not self._setpoints_fresh(now_ns):
            if not self._signal_lost:
                self._signal_lost = True
                self.say(dialect.MAV_SEVERITY_CRITICAL, "Failsafe: Offboard signal lost")
            action = int(self.parameters["COM_OBL_RC_ACT"])
            wanted = failsafes.OFFBOARD_LOSS.get(action, "HOLD")
        else:
            self._signal_lost = False
        if blind and self.armed and not self.landed:
            if wanted == "POSCTL" or (not wanted and self._intended == M["POSCTL"]):
                wanted = "ALTCTL"
            elif wanted not in ("ALTCTL", "STABILIZED") and not by_hand:
                if not self._blind_told:
                    self.say(dialect.MAV_SEVERITY_CRITICAL, "Failsafe: position lost, landing")
                wanted = "LAND"
        self._blind_told = blind
        return wanted

    def _blind(self, now_ns: int) -> bool:
        """Whether the estimator has had no position for longer than it can reckon on."""
        if self.positioned(now_ns):
            self._blind_ns = -1
            return False
        if self._blind_ns < 0:
            self._blind_ns = now_ns
        return (now_ns - self._blind_ns) * 1e-9 >= LOST_POSITION_S

    def _conditions(self, now_ns: int) -> list[Condition]:
        """What latches a failsafe."""
        p, charge = self.parameters, self.health.battery
        home, here = self.game_position(*self.home), self.motion.position
        flat, high = p["GF_MAX_HOR_DIST"], p["GF_MAX_VER_DIST"]
        outside = 0.0 < flat < hypot(here.x - home.x, here.y - home.y) or 0.0 < high < self.height
        silent = self.ground_station_silence_s(now_ns) > p["COM_DL_LOSS_T"]
        excepted = int(p["COM_RCL_EXCEPT"]) & {M["HOLD"]: 2, M["OFFBOARD"]: 4}.get(self._intended, 0)
        deaf = self.transmitter.lost(now_ns) and not excepted
        act = int(p["COM_LOW_BAT_ACT"])
        return [
            Condition("geofence", outside, failsafes.GEOFENCE.get(int(p["GF_ACTION"]), ""),
                      "Geofence violation"),
            Condition("link", silent, failsafes.LINK.get(int(p["NAV_DLL_ACT"]), ""),
                      "Connection to ground station lost"),
            Condition("sticks", deaf, failsafes.LINK.get(int(p["NAV_RCL_ACT"]), ""),
                      "Manual control signal lost"),
            Condition("low battery", charge <= p["BAT_LOW_THR"], "", "Low battery level"),
            Condition("critical battery", charge <= p["BAT_CRIT_THR"], {2: "LAND", 3: "RTL"}.get(act, ""),
                      "Critical battery level"),
            Condition("emergency battery", charge <= p["BAT_EMERGEN_THR"],
                      {2: "LAND", 3: "LAND"}.get(act, ""), "Emergency battery level"),
        ]  # fmt: skip

    # ------------------------------------------------------------------ setpoints

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
            self.say(
                dialect.MAV_SEVERITY_CRITICAL,
                f"SET_POSITION_TARGET_LOCAL_NED coordinate frame {m.coordinate_frame} unsupported",
            )
            return
        elif not m.type_mask & NO_POSITION and is_finite(position):
            position = self.game_from_local(position)
        yaw = m.yaw if m.coordinate_frame == LOCAL else nan
        self._take_setpoint(now_ns, m.type_mask, position, velocity, yaw)

    def _on_global_target(self, now_ns: int, packet: DialectPacket) -> None:
        m = packet.message
        altitude = m.alt + (self.home.altitude_m if m.coordinate_frame in ardupilot.ABOVE_HOME else 0.0)
        known = m.coordinate_frame in ardupilot.ABOVE_HOME + ardupilot.ABSOLUTE
        latitude, longitude = m.lat_int * 1e-7, m.lon_int * 1e-7
        if not known or abs(latitude) > 90.0 or abs(longitude) > 180.0 or not isfinite(altitude):
            self.counters["target_refused"] += 1
            return
        position = self.game_position(latitude, longitude, altitude)
        self._take_setpoint(now_ns, m.type_mask, position, Vec(m.vx, m.vy, m.vz), m.yaw)

    def _take_setpoint(self, now_ns: int, mask: int, position: Vec, velocity: Vec, yaw: float) -> None:
        with_position = not mask & NO_POSITION and is_finite(position)
        with_velocity = not mask & NO_VELOCITY and is_finite(velocity)
        if not with_position and not with_velocity:
            self.counters["target_refused"] += 1
            return
        looks = not mask & NO_YAW and isfinite(yaw)
        self._setpoint = Setpoint(
            position if with_position else None, velocity if with_velocity else None, yaw if looks else None
        )
        self._setpoint_ns = now_ns

    # ------------------------------------------------------------------ commands

    def _by_name(self, now_ns: int, name: str) -> int:
        return LATER if self.request_mode(now_ns, M[name]) else ACCEPTED

    def _place_of(self, command: Command, altitude_m: float) -> Geodetic:
        """The place of a command; what is NaN is here, or at `altitude_m` above mean sea level."""
        here = self.place
        return Geodetic(
            command.latitude_deg if isfinite(command.latitude_deg) else here.latitude_deg,
            command.longitude_deg if isfinite(command.longitude_deg) else here.longitude_deg,
            command.z if isfinite(command.z) else altitude_m,
        )

    def _do_takeoff(self, now_ns: int, command: Command) -> int:
        """Climb to param 7, an altitude above mean sea level, at the latitude and longitude; NaN: here.

        Without an altitude MIS_TAKEOFF_ALT above home. It is accepted in the air too. A place far away
        (0°, 0° of a field left out) is accepted as well, and never reached: the vehicle stays on the ground.
        """
        if self.request_mode(now_ns, M["TAKEOFF"]):
            return LATER
        place = self._place_of(command, self.home.altitude_m + self.parameters["MIS_TAKEOFF_ALT"])
        if abs(place.latitude_deg) > 90.0 or abs(place.longitude_deg) > 180.0:
            return DENIED
        self.take_off_to(now_ns, self.game_position(*place))
        return ACCEPTED

    def _do_reposition(self, now_ns: int, command: Command) -> int:
        place = self._place_of(command, self.place.altitude_m)
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
        self.go_to(now_ns, self.game_position(*place))
        return ACCEPTED
