"""The autopilot's parameters that matter to this agent: which are read, and which defeat a failsafe."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from onboard.autopilot.flight_limits import names_of
from onboard.wire.mavlink.modes import Kind

Parameters = Mapping[str, float]


PX4 = (Kind.PX4_MULTICOPTER, Kind.PX4_PLANE)


class Finding(NamedTuple):
    """What an autopilot's parameters amount to, of one thing."""

    severity: str  # info: as it should be | warning | error: what a failsafe needs is an error
    name: str  # of the parameter, or of what happens
    text: str  # what was found
    remedy: str


ALIASES: tuple[tuple[str, ...], ...] = (
    ("MAV_GCS_SYSID", "SYSID_MYGCS"),
    ("RTL_ALT_FINAL_M", "RTL_ALT_FINAL"),
    ("ARMING_SKIPCHK", "ARMING_CHECK"),
    ("MAN_OVERRIDE_SPD", "COM_RC_OVERRIDE"),
)
"""Names of one thing in several generations of firmware, the newest first; limits: `flight_limits`.

Sources: ArduPilot's list of renamed parameters (4.6 to 4.7), PX4's release notes of 1.18."""

_WANTED: dict[Kind, tuple[str, ...]] = {
    Kind.PX4_MULTICOPTER: (
        "COM_OBL_RC_ACT",
        "NAV_DLL_ACT",
        "COM_RC_OVERRIDE",
        "GF_ACTION",
    ),
    Kind.PX4_PLANE: (
        "COM_OBL_RC_ACT",
        "NAV_DLL_ACT",
        "COM_RC_OVERRIDE",
        "GF_ACTION",
    ),
    Kind.ARDUCOPTER: (
        "FS_GCS_ENABLE",
        "MAV_GCS_SYSID",
        "SYSID_MYGCS",
        "FENCE_ENABLE",
        "FS_OPTIONS",
        "THR_DZ",
        "RCMAP_THROTTLE",
        "RC3_MIN",
        "RC3_MAX",
    ),
    Kind.ARDUPLANE: (
        "FS_GCS_ENABL",
        "MAV_GCS_SYSID",
        "SYSID_MYGCS",
        "FS_LONG_ACTN",
        "FENCE_ENABLE",
    ),
}
WANTED = {kind: tuple(dict.fromkeys((*names, *names_of(kind)))) for kind, names in _WANTED.items()}
"""What to read at the start, limits too; names of older versions included, so some will not be answered."""

_BATTERIES = tuple(
    f"{battery}_{what}"
    for battery in ("BATT", "BATT2")
    for what in (
        "MONITOR",
        "FS_LOW_ACT",
        "LOW_VOLT",
        "LOW_MAH",
        "LOW_TIMER",
        "FS_CRT_ACT",
        "CRT_VOLT",
        "CRT_MAH",
    )
)
_ARDUPILOT = ("MAV_GCS_SYSID_HI", *_BATTERIES, "FENCE_ACTION", "ARMING_CHECK", "ARMING_SKIPCHK")
_PX4 = (
    "COM_OF_LOSS_T",
    "COM_LOW_BAT_ACT",
    "NAV_RCL_ACT",
    "COM_RCL_EXCEPT",
    "COM_RC_IN_MODE",
    "MAN_OVERRIDE_SPD",
    "RTL_LAND_DELAY",
    "GF_MAX_HOR_DIST",
    "COM_ARM_WO_GPS",
)
CHECKED: dict[Kind, tuple[str, ...]] = {
    Kind.PX4_MULTICOPTER: _PX4,
    Kind.PX4_PLANE: _PX4,
    Kind.ARDUCOPTER: (*_ARDUPILOT, "FS_GCS_TIMEOUT", "RTL_ALT_FINAL_M", "RTL_ALT_FINAL", "FS_THR_ENABLE",
                      "FS_EKF_ACTION"),
    Kind.ARDUPLANE: (
        *_ARDUPILOT, "FS_LONG_TIMEOUT", "RTL_AUTOLAND", "THR_FAILSAFE", "FS_SHORT_ACTN", "ARMING_REQUIRE",
    ),
}  # fmt: skip
"""What the preflight check reads besides."""


def either(parameters: Parameters, newest: str) -> tuple[str, float | None]:
    """Return a parameter of several names, by the newest: the name that was answered, and its value."""
    names = next((names for names in ALIASES if names[0] == newest), (newest,))
    known = next((name for name in names if name in parameters), None)
    return (names[-1], None) if known is None else (known, parameters[known])


def gcs_failsafe(kind: Kind, parameters: Parameters, system: int) -> Finding | None:
    """Return why the autopilot would not act when this agent's heartbeat (from `system`) falls silent.

    None where it acts.
    """
    if kind in PX4:
        return None  # it watches the setpoints themselves: COM_OF_LOSS_T
    name = "FS_GCS_ENABL" if kind is Kind.ARDUPLANE else "FS_GCS_ENABLE"
    if name not in parameters:
        return Finding("error", name, f"{name} is not known", f"read it, and set {name} to 1")
    if parameters[name] == 0:
        return Finding("error", name, f"{name} is 0: no GCS failsafe", f"set {name} to 1")
    if kind is Kind.ARDUPLANE and parameters[name] == 3:
        return Finding("error", name, f"{name} is 3: no GCS failsafe but in AUTO", f"set {name} to 1")
    watching, watched = either(parameters, "MAV_GCS_SYSID")
    last = parameters.get("MAV_GCS_SYSID_HI", 0.0)
    if watched is None or not watched <= system <= max(watched, last):
        found = "not known" if watched is None else f"{watched:.0f}"
        text = f"{watching} is {found}: the failsafe does not watch this agent"
        return Finding("error", watching, text, f"set {watching} to {system}")
    if last > watched:
        text = (
            f"systems {watched:.0f} to {last:.0f} are watched: a heartbeat of another one of them keeps the "
            "failsafe quiet when this agent dies"
        )
        return Finding("error", "MAV_GCS_SYSID_HI", text, "set MAV_GCS_SYSID_HI to 0")
    if kind is Kind.ARDUPLANE and parameters.get("FS_LONG_ACTN") == 0:
        text = "FS_LONG_ACTN is 0: in GUIDED the plane flies on"
        return Finding("error", "FS_LONG_ACTN", text, "set FS_LONG_ACTN to 1 (return)")
    return None
