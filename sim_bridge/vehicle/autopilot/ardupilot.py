"""What ArduCopter and ArduPlane share: refusals, the watched ground station, places of commands."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from math import isfinite
from typing import NamedTuple

from onboard.core.math.vectors import Vec
from onboard.wire.mavlink.dialect import DialectPacket, dialect
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, FAILED, Command

VERSION = 4 << 24 | 5 << 16 | 6 << 8 | 255  # 4.5.6, release
PREARM_EVERY_S = 30.0
EKF_PATIENCE_S = 1.0
ABSOLUTE = (dialect.MAV_FRAME_GLOBAL, dialect.MAV_FRAME_GLOBAL_INT)
ABOVE_HOME = (dialect.MAV_FRAME_GLOBAL_RELATIVE_ALT, dialect.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT)

RATES = {
    dialect.MAVLINK_MSG_ID_ATTITUDE: 4.0,
    dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: 4.0,
    dialect.MAVLINK_MSG_ID_LOCAL_POSITION_NED: 4.0,
    dialect.MAVLINK_MSG_ID_VFR_HUD: 2.0,
    dialect.MAVLINK_MSG_ID_SYS_STATUS: 1.0,
    dialect.MAVLINK_MSG_ID_GPS_RAW_INT: 1.0,
    dialect.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: 1.0,
    dialect.MAVLINK_MSG_ID_EKF_STATUS_REPORT: 1.0,
    dialect.MAVLINK_MSG_ID_BATTERY_STATUS: 0.5,
    dialect.MAVLINK_MSG_ID_WIND: 1.0,
    dialect.MAVLINK_MSG_ID_SYSTEM_TIME: 1.0,
    dialect.MAVLINK_MSG_ID_MISSION_CURRENT: 0.5,
}


class Place(NamedTuple):
    """A place given by a command."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level


class ArduPilot(Autopilot):
    """What ArduCopter and ArduPlane do alike: modes by number, the watched ground station, failsafes."""

    autopilot_type = dialect.MAV_AUTOPILOT_ARDUPILOTMEGA
    version = VERSION
    default_rates = RATES
    refused_arming = FAILED
    unknown_message = FAILED
    unknown_interval = DENIED
    _failsafe = False  # the ground station's silence has been acted upon
    _ekf_bad_ns = -1  # since when the estimator has no position; −1: it has
    _battery_told = False
    _prearm_ns = -1

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        return super()._command_handlers() | {
            dialect.MAV_CMD_NAV_LOITER_UNLIM: lambda now, c: self._by_command(now, "LOITER"),
            dialect.MAV_CMD_NAV_RETURN_TO_LAUNCH: lambda now, c: self._by_command(now, "RTL"),
        }

    def watched_ground_station(self, packet: DialectPacket) -> bool:
        """ArduPilot watches one system id, whatever its component: an agent's only if told to."""
        return packet.system == int(self.parameters["SYSID_MYGCS"])

    def set_mode_result(self, now_ns: int, command: Command) -> int:
        if not (isfinite(command.p1) and int(command.p1) & dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED):
            return DENIED
        mode = int(command.p2) if isfinite(command.p2) else -1
        return self.by_number(now_ns, mode)

    def by_number(self, now_ns: int, mode: int) -> int:
        """Enter a mode; the result and, where it is refused, the reason as text."""
        if mode not in self.modes.values():
            self.say(dialect.MAV_SEVERITY_WARNING, f"No such mode {mode}")
            return FAILED
        reason = self.request_mode(now_ns, mode)
        if reason:
            name = next(name for name, number in self.modes.items() if number == mode)
            self.say(dialect.MAV_SEVERITY_WARNING, f"Mode change to {name} failed: {reason}")
            return FAILED
        return ACCEPTED

    def place_of(self, command: Command) -> Place | None:
        """The place of a command in its frame; None where it is not acceptable."""
        latitude, longitude, z = command.latitude_deg, command.longitude_deg, command.z
        if not (isfinite(latitude) and isfinite(longitude) and isfinite(z)):
            return None
        if not (-90.0 <= latitude <= 90.0 and -180.0 <= longitude <= 180.0):
            return None
        if command.frame in ABSOLUTE:
            return Place(latitude, longitude, z)
        if command.frame in ABOVE_HOME:
            return Place(latitude, longitude, z + self.home.altitude_m)
        return None

    def game_of(self, place: Place) -> Vec:
        """A place in the frame of motion [m; NED]."""
        return self.game_position(*place)

    def watch(self, now_ns: int) -> None:
        self._watch_prearm(now_ns)
        if self.armed and not self.landed:
            self._watch_ground_station(now_ns)
            self._watch_estimator(now_ns)
            self._watch_battery(now_ns)
        else:
            self._failsafe = False

    @abstractmethod
    def on_silence(self, now_ns: int) -> None:
        """The watched ground station has fallen silent."""

    @abstractmethod
    def silence_limit_s(self) -> float:
        """Time for which the watched ground station may be silent [s]; 0 = for ever."""

    @abstractmethod
    def on_lost_position(self, now_ns: int) -> None:
        """The estimator has had no position for a while."""

    @abstractmethod
    def on_low_battery(self, now_ns: int, action: int) -> None:
        """Act on a low battery as the parameter BATT_FS_LOW_ACT, `action`, says."""

    def _by_command(self, now_ns: int, name: str) -> int:
        return FAILED if self.request_mode(now_ns, self.modes[name]) else ACCEPTED

    def _watch_prearm(self, now_ns: int) -> None:
        if self.armed or self.up_s(now_ns) < 0.5 * self.setup.options.ready_s:
            return
        reason = self.why_not_armable(now_ns)
        if reason and (self._prearm_ns < 0 or (now_ns - self._prearm_ns) * 1e-9 >= PREARM_EVERY_S):
            self._prearm_ns = now_ns
            self.say(dialect.MAV_SEVERITY_CRITICAL, reason.replace("Arm:", "PreArm:", 1))

    def _watch_ground_station(self, now_ns: int) -> None:
        limit = self.silence_limit_s()
        silent = limit > 0.0 and self.ground_station_silence_s(now_ns) > limit
        if silent and not self._failsafe:
            self._failsafe = True
            self.on_silence(now_ns)
        elif self._failsafe and not silent:
            self._failsafe = False
            self.say(dialect.MAV_SEVERITY_WARNING, "GCS Failsafe Cleared")

    def _watch_estimator(self, now_ns: int) -> None:
        if self.positioned(now_ns):
            self._ekf_bad_ns = -1
        elif self._ekf_bad_ns < 0:
            self._ekf_bad_ns = now_ns
        elif (now_ns - self._ekf_bad_ns) * 1e-9 >= EKF_PATIENCE_S:
            self.on_lost_position(now_ns)

    def _watch_battery(self, now_ns: int) -> None:
        if self.health.voltage >= self.parameters["BATT_LOW_VOLT"] and self.health.battery > 0.0:
            self._battery_told = False
        elif not self._battery_told:
            self._battery_told = True
            self.say(dialect.MAV_SEVERITY_WARNING, f"Battery 1 is low {self.health.voltage:.2f}V used")
            self.on_low_battery(now_ns, int(self.parameters["BATT_FS_LOW_ACT"]))
