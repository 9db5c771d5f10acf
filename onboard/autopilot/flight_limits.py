"""What an autopilot itself lets its vehicle do, from its parameters: by old and new names.

Sources: ArduPilot's parameter lists of 4.5 and 4.7 (WPNAV_SPEED in cm/s became WP_SPD in m/s, ARSPD_FBW_MIN
AIRSPEED_MIN, LIM_ROLL_CD in hundredths of a degree ROLL_LIMIT_DEG, ANGLE_MAX likewise ATC_ANGLE_MAX, RTL_ALT
in cm RTL_ALT_M, ALT_HOLD_RTL in cm RTL_ALTITUDE), PX4's of 1.16.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, radians
from typing import NamedTuple

from onboard.wire.mavlink.modes import Kind


class FlightLimits(NamedTuple):
    """The autopilot's own limits; None where it has not said. Speeds are airspeeds for planes."""

    speed_min: float | None = None  # [m/s]
    speed_max: float | None = None  # [m/s]
    climb_max: float | None = None  # [m/s; up]
    sink_max: float | None = None  # [m/s; down]
    bank_max: float | None = None  # [rad] of planes; how far a multicopter leans
    cruise: float | None = None  # [m/s] of planes that fly no other speed under this agent
    coast: float | None = None  # [s] for which a multicopter flies on with its last velocity
    return_height: float | None = None  # [m] above home, of the way home; None: as high as it is, too
    loiter_radius: float | None = None  # [m] of planes


_CM, _DEG, _CDEG = 0.01, radians(1.0), radians(0.01)
Names = tuple[tuple[str, float], ...]  # a parameter and its unit in SI, the newest name first
NAMES: dict[Kind, dict[str, Names]] = {
    Kind.PX4_MULTICOPTER: {
        "speed_max": (("MPC_XY_VEL_MAX", 1.0),),
        "climb_max": (("MPC_Z_VEL_MAX_UP", 1.0),),
        "sink_max": (("MPC_Z_VEL_MAX_DN", 1.0),),
        "bank_max": (("MPC_TILTMAX_AIR", _DEG),),
        "coast": (("COM_OF_LOSS_T", 1.0),),
        "return_height": (("RTL_RETURN_ALT", 1.0),),
    },
    Kind.PX4_PLANE: {
        "cruise": (("FW_AIRSPD_TRIM", 1.0),),
        "climb_max": (("FW_T_CLMB_MAX", 1.0),),
        "sink_max": (("FW_T_SINK_MAX", 1.0),),
        "bank_max": (("FW_R_LIM", _DEG),),
        "return_height": (("RTL_RETURN_ALT", 1.0),),
        "loiter_radius": (("NAV_LOITER_RAD", 1.0),),
    },
    Kind.ARDUCOPTER: {
        "speed_max": (("WP_SPD", 1.0), ("WPNAV_SPEED", _CM)),
        "climb_max": (("WP_SPD_UP", 1.0), ("WPNAV_SPEED_UP", _CM)),
        "sink_max": (("WP_SPD_DN", 1.0), ("WPNAV_SPEED_DN", _CM)),
        "bank_max": (("ATC_ANGLE_MAX", _DEG), ("ANGLE_MAX", _CDEG)),
        "coast": (("GUID_TIMEOUT", 1.0),),
        "return_height": (("RTL_ALT_M", 1.0), ("RTL_ALT", _CM)),
    },
    Kind.ARDUPLANE: {
        "speed_min": (("AIRSPEED_MIN", 1.0), ("ARSPD_FBW_MIN", 1.0)),
        "speed_max": (("AIRSPEED_MAX", 1.0), ("ARSPD_FBW_MAX", 1.0)),
        "climb_max": (("TECS_CLMB_MAX", 1.0),),
        "sink_max": (("TECS_SINK_MAX", 1.0),),
        "bank_max": (("ROLL_LIMIT_DEG", _DEG), ("LIM_ROLL_CD", _CDEG)),
        "return_height": (("RTL_ALTITUDE", 1.0), ("ALT_HOLD_RTL", _CM)),
        "loiter_radius": (("WP_LOITER_RAD", 1.0),),
    },
}
"""Where each limit of each kind is read."""


def names_of(kind: Kind) -> tuple[str, ...]:
    """Return every name under which a kind's limits may be read."""
    return tuple(name for names in NAMES.get(kind, {}).values() for name, _ in names)


NEEDED = {
    Kind.PX4_MULTICOPTER: ("speed_max", "climb_max", "sink_max"),
    Kind.ARDUCOPTER: ("speed_max", "climb_max", "sink_max"),
    Kind.ARDUPLANE: ("speed_min", "speed_max"),
    Kind.PX4_PLANE: ("cruise",),
}
"""Limits without which no setpoint leaves, unless the configuration says them."""


def read_limits(kind: Kind, parameters: Mapping[str, float]) -> FlightLimits:
    """Return the limits that an autopilot's parameters give. What is not positive gives none."""
    found: dict[str, float] = {}
    for limit, names in NAMES.get(kind, {}).items():
        for name, unit in names:
            value = parameters.get(name)
            if limit == "loiter_radius" and value is not None:
                value = abs(value)  # a negative one circles to the left
            if value is not None and isfinite(value) and value > 0.0:
                found[limit] = value * unit
                break
    return FlightLimits(**found)


def unread(kind: Kind, limits: FlightLimits, configured: Mapping[str, float | None]) -> tuple[str, ...]:
    """Return the parameters that must yet be read before setpoints may leave, by their newest names.

    `configured` gives the configuration's own limits by the same names as `FlightLimits`.
    """
    return tuple(
        NAMES[kind][limit][0][0]
        for limit in NEEDED.get(kind, ())
        if getattr(limits, limit) is None and configured.get(limit) is None
    )


def still_wanted(kind: Kind, parameters: Mapping[str, float], names: list[str]) -> list[str]:
    """Return those of `names` still worth asking for: no second name of a limit that is known."""
    limits = read_limits(kind, parameters)
    settled = {
        name
        for limit, pairs in NAMES.get(kind, {}).items()
        if getattr(limits, limit) is not None
        for name, _ in pairs
    }
    return [name for name in names if name not in settled]
