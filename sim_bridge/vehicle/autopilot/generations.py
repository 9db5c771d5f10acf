"""Parameter names and commands that changed between generations of firmware.

The simulation reads its parameters under the names of ArduPilot 4.5 and PX4 1.16, which were recorded;
a vehicle of another generation is delivered with that generation's names and units.
Sources: release notes of ArduPilot 4.7 and PX4 1.18 (both beta), documentation of ArduPilot 4.4.
"""

from __future__ import annotations

from onboard.game.scenario import Firmware, Kind
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.autopilot.parameters import INT16, REAL32, Parameter, Renamed

_COPTER_NEWER = {
    "SYSID_THISMAV": Renamed("MAV_SYSID"),
    "SYSID_MYGCS": Renamed("MAV_GCS_SYSID"),
    "WPNAV_SPEED": Renamed("WP_SPD", 0.01),
    "WPNAV_SPEED_UP": Renamed("WP_SPD_UP", 0.01),
    "WPNAV_SPEED_DN": Renamed("WP_SPD_DN", 0.01),
    "ANGLE_MAX": Renamed("ATC_ANGLE_MAX", 0.01, REAL32),
    "RTL_ALT": Renamed("RTL_ALT_M", 0.01, REAL32),
}
_PLANE_NEWER = {name: _COPTER_NEWER[name] for name in ("SYSID_THISMAV", "SYSID_MYGCS")}
_PLANE_OLDER = {
    "AIRSPEED_MIN": Renamed("ARSPD_FBW_MIN"),
    "AIRSPEED_MAX": Renamed("ARSPD_FBW_MAX"),
    "AIRSPEED_CRUISE": Renamed("TRIM_ARSPD_CM", 100.0),
    "ROLL_LIMIT_DEG": Renamed("LIM_ROLL_CD", 100.0),
    "PTCH_LIM_MAX_DEG": Renamed("LIM_PITCH_MAX", 100.0),
    "PTCH_LIM_MIN_DEG": Renamed("LIM_PITCH_MIN", 100.0),
    "RTL_ALTITUDE": Renamed("ALT_HOLD_RTL", 100.0),
}
_PX4_NEWER = {"COM_RC_OVERRIDE": Renamed("MAN_OVERRIDE_SPD", 1.0, REAL32)}

RENAMED: dict[tuple[Kind, Firmware], dict[str, Renamed]] = {
    (Kind.ARDUCOPTER, Firmware.NEWER): _COPTER_NEWER,
    (Kind.ARDUPLANE, Firmware.NEWER): _PLANE_NEWER,
    (Kind.ARDUPLANE, Firmware.OLDER): _PLANE_OLDER,
    (Kind.PX4, Firmware.NEWER): _PX4_NEWER,
    (Kind.PX4_PLANE, Firmware.NEWER): _PX4_NEWER,
}
"""By kind and generation: recorded name → that generation's."""

_GONE = frozenset((dialect.MAV_CMD_GET_HOME_POSITION, dialect.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES))
REMOVED: dict[tuple[Kind, Firmware], frozenset[int]] = {
    (Kind.PX4, Firmware.NEWER): _GONE,
    (Kind.PX4_PLANE, Firmware.NEWER): _GONE,
}
"""Commands that a generation answers with UNSUPPORTED."""

ADDED: dict[tuple[Kind, Firmware], tuple[Parameter, ...]] = {
    (Kind.ARDUCOPTER, Firmware.NEWER): (Parameter("MAV_GCS_SYSID_HI", 0.0, INT16),),
    (Kind.ARDUPLANE, Firmware.NEWER): (Parameter("MAV_GCS_SYSID_HI", 0.0, INT16),),
}
"""Parameters that a generation has besides: MAV_GCS_SYSID_HI ends a range of watched ground stations."""


def renamed(kind: Kind, firmware: Firmware) -> dict[str, Renamed]:
    """The names that differ from the recorded ones."""
    return RENAMED.get((kind, firmware), {})
