"""What ArduCopter and ArduPlane share: refusals, the watched ground station, places of commands."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from math import hypot, isfinite
from typing import ClassVar, NamedTuple

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Firmware
from onboard.wire.mavlink.dialect import DialectPacket, dialect
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, FAILED, Command
from sim_bridge.vehicle.autopilot.health import CURRENT_FLYING
from sim_bridge.vehicle.autopilot.resting import (
    AWAKE,
    BATTERY_LEVELS,
    ardupilot_level,
    drained_ns,
    until,
)

VERSIONS = {Firmware.OLDER: (4, 4, 4), Firmware.RECORDED: (4, 5, 6), Firmware.NEWER: (4, 7, 0)}
GUIDED_POINT, GUIDED_ALTITUDE = 2, 3  # MISSION_ITEM.current: not of a mission, to be flown to at once
FENCE_HEIGHT, FENCE_CIRCLE = 1, 2  # bits of FENCE_TYPE
PREARM_EVERY_S = 30.0
EKF_PATIENCE_S = 1.0
RADIO_S = 0.5  # from channels that have gone to the failsafe, where no parameter names it
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
    dialect.MAVLINK_MSG_ID_RC_CHANNELS: 2.0,
}


class Place(NamedTuple):
    """A place given by a command."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level


class ArduPilot(Autopilot):
    """What ArduCopter and ArduPlane do alike: modes by number, the watched ground station, failsafes."""

    autopilot_type = dialect.MAV_AUTOPILOT_ARDUPILOTMEGA
    versions = VERSIONS
    default_rates = RATES
    refused_arming = FAILED
    unknown_message = FAILED
    unknown_interval = DENIED
    _failsafe = False  # the ground station's silence has been acted upon
    _radio_failsafe = False  # the transmitter's loss has been acted upon
    _ekf_bad_ns = -1  # since when the estimator has no position; −1: it has
    _ekf_failsafe = False
    _battery_low_ns = -1  # since when the voltage is below the present level's; −1: it is not
    _battery_level = 0  # acted upon: 0 none, 1 low, 2 critical; it never falls
    _fence_breached = False
    _prearm_ns = -1
    _levelled: tuple[tuple[float, ...], float] = ((), 0.0)  # `battery_level`, and for what it was reckoned
    blockable: ClassVar[tuple[str, ...]]  # modes by their bits in FLTMODE_GCSBLOCK
    recovered: ClassVar[str]  # what is said of a failsafe that is over

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        return super()._command_handlers() | {
            dialect.MAV_CMD_NAV_LOITER_UNLIM: lambda now, c: self._by_command(now, "LOITER"),
            dialect.MAV_CMD_NAV_RETURN_TO_LAUNCH: lambda now, c: self._by_command(now, "RTL"),
        }

    def _message_handlers(self) -> dict[int, Callable[[int, DialectPacket], None]]:
        return super()._message_handlers() | {
            dialect.MAVLINK_MSG_ID_MISSION_ITEM: self._on_mission_item,
            dialect.MAVLINK_MSG_ID_MISSION_ITEM_INT: self._on_mission_item,
        }

    @property
    def critical(self) -> bool:
        return self._failsafe or self._radio_failsafe or self._ekf_failsafe or self._battery_level > 0

    def watched_ground_station(self, packet: DialectPacket) -> bool:
        """ArduPilot watches one system id (from 4.7 on a range), whatever its component, a gimbal's too."""
        first = int(self.parameters["SYSID_MYGCS"])
        last = int(self.parameters["MAV_GCS_SYSID_HI"]) if "MAV_GCS_SYSID_HI" in self.parameters else 0
        return first <= packet.system <= max(first, last)

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
        name = next(name for name, number in self.modes.items() if number == mode)
        blocked = name in self.blockable and int(self.parameters["FLTMODE_GCSBLOCK"]) >> (
            self.blockable.index(name)
        )
        refused = "GCS entry disabled (FLTMODE_GCSBLOCK)" if blocked & 1 else ""
        reason = refused or self.request_mode(now_ns, mode)
        if reason:
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
        self._watch_ground_station(now_ns)
        self._watch_radio(now_ns)
        if self.armed and not self.landed:
            self._watch_estimator(now_ns)
            self._watch_battery(now_ns)
            self._watch_fence(now_ns)

    def watched_until(self, now_ns: int) -> int:
        h = self.health
        troubled = self._failsafe or self._radio_failsafe or self._ekf_failsafe or self.transmitter.silent
        if troubled or self._ekf_bad_ns >= 0 or self._battery_low_ns >= 0 or h.faults:
            return AWAKE
        if self.parameters["FENCE_ENABLE"]:
            return AWAKE
        rest = drained_ns(now_ns, h.battery, self.battery_level(), h.drain_rate)
        limit = self.silence_limit_s()
        return min(rest, until(now_ns, limit - self.ground_station_silence_s(now_ns))) if limit else rest

    def battery_level(self) -> float:
        """The charge, 0…1, down to which no battery level beyond the one acted upon is reached."""
        key = (self.parameters.changes, self.health.sag, self._battery_level)
        if key != self._levelled[0]:
            full = self.setup.options.battery_s * CURRENT_FLYING / 3.6  # [mAh]
            level = ardupilot_level(self.parameters, self.health.sag, full, self._battery_level)
            self._levelled = (key, level)
        return self._levelled[1]

    @abstractmethod
    def on_silence(self, now_ns: int) -> None:
        """The watched ground station has fallen silent."""

    @abstractmethod
    def silence_limit_s(self) -> float:
        """Time for which the watched ground station may be silent [s]; 0 = for ever."""

    @abstractmethod
    def radio_limit_s(self) -> float:
        """Time after the transmitter's loss until the failsafe acts [s]; 0 = never."""

    @abstractmethod
    def on_radio_lost(self, now_ns: int) -> None:
        """The transmitter that was heard is heard no more."""

    @abstractmethod
    def fly_to(self, now_ns: int, place: Place) -> None:
        """Follow a guided point."""

    @abstractmethod
    def on_lost_position(self, now_ns: int) -> None:
        """The estimator has had no position for a while."""

    @abstractmethod
    def on_low_battery(self, now_ns: int, action: int) -> None:
        """Act on a battery as the parameter BATT_FS_LOW_ACT or BATT_FS_CRT_ACT, `action`, says."""

    @abstractmethod
    def on_fence(self, now_ns: int, action: int) -> None:
        """Act on a crossed fence as the parameter FENCE_ACTION, `action`, says."""

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
            self.say(dialect.MAV_SEVERITY_WARNING, f"GCS Failsafe {self.recovered}")

    def _watch_radio(self, now_ns: int) -> None:
        limit = self.radio_limit_s()
        lost = limit > 0.0 and self.transmitter.lost(now_ns - round(limit * NS_PER_S))
        if lost and not self._radio_failsafe:
            self._radio_failsafe = True
            self.on_radio_lost(now_ns)
        elif self._radio_failsafe and not lost:
            self._radio_failsafe = False
            self.say(dialect.MAV_SEVERITY_WARNING, f"Radio Failsafe {self.recovered}")

    def _watch_estimator(self, now_ns: int) -> None:
        if self.positioned(now_ns):
            self._ekf_bad_ns = -1
            if self._ekf_failsafe:
                self._ekf_failsafe = False
                self.say(dialect.MAV_SEVERITY_CRITICAL, "EKF Failsafe Cleared")
        elif self._ekf_bad_ns < 0:
            self._ekf_bad_ns = now_ns
        elif (now_ns - self._ekf_bad_ns) * 1e-9 >= EKF_PATIENCE_S:
            self.on_lost_position(now_ns)

    def _watch_battery(self, now_ns: int) -> None:
        """Voltage or charge below a level for BATT_LOW_TIMER; levels never fall again before a reboot."""
        p, h = self.parameters, self.health
        if h.battery > self.battery_level():
            self._battery_low_ns = -1
            return
        used = (1.0 - h.battery) * self.setup.options.battery_s * CURRENT_FLYING / 3.6  # [mAh]
        left = p["BATT_CAPACITY"] - used
        level = 0
        for number, voltage, reserve in BATTERY_LEVELS:
            volt, charge = p[voltage], p[reserve]
            if (volt > 0.0 and h.voltage < volt) or (charge > 0.0 and left < charge):
                level = number
        if h.battery <= 0.0:
            level = max(level, 1)
        if level <= self._battery_level:
            self._battery_low_ns = -1
            return
        if self._battery_low_ns < 0:
            self._battery_low_ns = now_ns
        if (now_ns - self._battery_low_ns) * 1e-9 < p["BATT_LOW_TIMER"]:
            return
        self._battery_level = level
        self._battery_low_ns = -1
        word, which = ("low", "LOW") if level == 1 else ("critical", "CRT")
        self.say(dialect.MAV_SEVERITY_WARNING, f"Battery 1 is {word} {h.voltage:.2f}V used {used:.0f} mAh")
        self.on_low_battery(now_ns, int(p[f"BATT_FS_{which}_ACT"]))

    def _watch_fence(self, now_ns: int) -> None:
        p = self.parameters
        if not p["FENCE_ENABLE"]:
            self._fence_breached = False
            return
        home, here, kinds = self.game_position(*self.home), self.motion.position, int(p["FENCE_TYPE"])
        far = hypot(here.x - home.x, here.y - home.y) > p["FENCE_RADIUS"] and kinds & FENCE_CIRCLE
        high = self.height > p["FENCE_ALT_MAX"] and kinds & FENCE_HEIGHT
        breached = bool(far or high)
        if breached and not self._fence_breached:
            self.say(dialect.MAV_SEVERITY_NOTICE, "Fence Breached")
            self.on_fence(now_ns, int(p["FENCE_ACTION"]))
        self._fence_breached = breached

    def _on_mission_item(self, now_ns: int, packet: DialectPacket) -> None:
        """MISSION_ITEM(_INT): current = 2 is a guided point, 3 a guided altitude; others find no room."""
        m = packet.message
        whole = m.get_type() == "MISSION_ITEM_INT"
        x, y = (m.x * 1e-7, m.y * 1e-7) if whole else (m.x, m.y)
        if m.current not in (GUIDED_POINT, GUIDED_ALTITUDE) or not self.is_mode("GUIDED") or self.landed:
            result = dialect.MAV_MISSION_ERROR
        else:
            if m.current == GUIDED_ALTITUDE:
                x, y = self.place.latitude_deg, self.place.longitude_deg
            asked = Command(0, 0.0, 0.0, 0.0, 0.0, x, y, m.z, m.frame, packet.system, packet.component)
            place = self.place_of(asked)
            if place is None:
                result = dialect.MAV_MISSION_UNSUPPORTED_FRAME
            else:
                self.fly_to(now_ns, place)
                result = dialect.MAV_MISSION_ACCEPTED
        self.emit(
            dialect.MAVLink_mission_ack_message(packet.system, packet.component, result, m.mission_type)
        )
