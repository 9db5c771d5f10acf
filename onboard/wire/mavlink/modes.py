"""Kinds of autopilots and the names of their modes: `custom_mode` ↔ words."""

from __future__ import annotations

from onboard.wire.autopilot_kind import Kind as Kind
from onboard.wire.mavlink.dialect import dialect

_MULTICOPTERS = frozenset(
    (
        dialect.MAV_TYPE_QUADROTOR,
        dialect.MAV_TYPE_HEXAROTOR,
        dialect.MAV_TYPE_OCTOROTOR,
        dialect.MAV_TYPE_TRICOPTER,
        dialect.MAV_TYPE_DECAROTOR,
        dialect.MAV_TYPE_DODECAROTOR,
        dialect.MAV_TYPE_COAXIAL,
    )
)
_VTOLS = frozenset(range(19, 26))  # MAV_TYPE_VTOL_…: their names changed over time, their numbers did not


def kind_of(autopilot: int, vehicle_type: int) -> Kind:
    """Return the kind by HEARTBEAT.autopilot (MAV_AUTOPILOT) and HEARTBEAT.type (MAV_TYPE)."""
    if autopilot == dialect.MAV_AUTOPILOT_PX4:
        multicopter, plane, vtol = Kind.PX4_MULTICOPTER, Kind.PX4_PLANE, Kind.PX4_VTOL
    elif autopilot == dialect.MAV_AUTOPILOT_ARDUPILOTMEGA:
        multicopter, plane, vtol = Kind.ARDUCOPTER, Kind.ARDUPLANE, Kind.ARDUPLANE_VTOL
    else:
        return Kind.UNKNOWN
    if vehicle_type in _MULTICOPTERS:
        return multicopter
    if vehicle_type == dialect.MAV_TYPE_FIXED_WING:
        return plane
    return vtol if vehicle_type in _VTOLS else Kind.UNKNOWN


def _px4(main: int, sub: int = 0) -> int:
    return main << 16 | sub << 24


PX4_MODES = {
    "MANUAL": _px4(1),
    "ALTCTL": _px4(2),
    "POSCTL": _px4(3),
    "READY": _px4(4, 1),
    "TAKEOFF": _px4(4, 2),
    "HOLD": _px4(4, 3),
    "MISSION": _px4(4, 4),
    "RTL": _px4(4, 5),
    "LAND": _px4(4, 6),
    "FOLLOW": _px4(4, 8),
    "PRECLAND": _px4(4, 9),
    "ACRO": _px4(5),
    "OFFBOARD": _px4(6),
    "STABILIZED": _px4(7),
    "RATTITUDE": _px4(8),
}

ARDUCOPTER_MODES = {
    "STABILIZE": 0,
    "ACRO": 1,
    "ALT_HOLD": 2,
    "AUTO": 3,
    "GUIDED": 4,
    "LOITER": 5,
    "RTL": 6,
    "CIRCLE": 7,
    "LAND": 9,
    "DRIFT": 11,
    "SPORT": 13,
    "FLIP": 14,
    "AUTOTUNE": 15,
    "POSHOLD": 16,
    "BRAKE": 17,
    "THROW": 18,
    "AVOID_ADSB": 19,
    "GUIDED_NOGPS": 20,
    "SMART_RTL": 21,
    "FLOWHOLD": 22,
    "FOLLOW": 23,
    "ZIGZAG": 24,
    "SYSTEMID": 25,
    "AUTOROTATE": 26,
    "AUTO_RTL": 27,
    "TURTLE": 28,
}

ARDUPLANE_MODES = {
    "MANUAL": 0,
    "CIRCLE": 1,
    "STABILIZE": 2,
    "TRAINING": 3,
    "ACRO": 4,
    "FBWA": 5,
    "FBWB": 6,
    "CRUISE": 7,
    "AUTOTUNE": 8,
    "AUTO": 10,
    "RTL": 11,
    "LOITER": 12,
    "TAKEOFF": 13,
    "AVOID_ADSB": 14,
    "GUIDED": 15,
    "INITIALISING": 16,
    "QSTABILIZE": 17,
    "QHOVER": 18,
    "QLOITER": 19,
    "QLAND": 20,
    "QRTL": 21,
    "QAUTOTUNE": 22,
    "QACRO": 23,
    "THERMAL": 24,
    "LOITER_ALT_QLAND": 25,
}

MODES: dict[Kind, dict[str, int]] = {
    Kind.PX4_MULTICOPTER: PX4_MODES,
    Kind.PX4_PLANE: PX4_MODES,
    Kind.PX4_VTOL: PX4_MODES,
    Kind.ARDUCOPTER: ARDUCOPTER_MODES,
    Kind.ARDUPLANE: ARDUPLANE_MODES,
    Kind.ARDUPLANE_VTOL: ARDUPLANE_MODES,
    Kind.UNKNOWN: {},
}
_NAMES = {kind: {number: name for name, number in table.items()} for kind, table in MODES.items()}


def mode_name(kind: Kind, custom_mode: int) -> str:
    """Return the mode in the autopilot's own words; `mode N` for one that is not in the table."""
    return _NAMES[kind].get(custom_mode) or f"mode {custom_mode}"


def custom_mode(kind: Kind, name: str) -> int | None:
    """Return the number of a mode, None where this kind of autopilot has no mode of that name."""
    return MODES[kind].get(name)
