"""The autopilot's parameters that matter to this agent: which are read, and which defeat a failsafe."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from onboard.wire.mavlink.modes import Kind

Parameters = Mapping[str, float]


class Finding(NamedTuple):
    """One parameter that is not as it should be."""

    severity: str  # warning | error: what a failsafe needs is an error
    name: str
    text: str  # what was found
    remedy: str


WANTED: dict[Kind, tuple[str, ...]] = {
    Kind.PX4_MULTICOPTER: (
        "COM_OF_LOSS_T",
        "COM_OBL_RC_ACT",
        "NAV_DLL_ACT",
        "COM_RC_OVERRIDE",
        "GF_ACTION",
        "MPC_XY_VEL_MAX",
        "MPC_Z_VEL_MAX_UP",
        "MPC_Z_VEL_MAX_DN",
    ),
    Kind.ARDUCOPTER: (
        "FS_GCS_ENABLE",
        "SYSID_MYGCS",
        "FENCE_ENABLE",
        "GUID_TIMEOUT",
        "WP_SPD",
        "WPNAV_SPEED",
        "WP_SPD_UP",
        "WPNAV_SPEED_UP",
        "WP_SPD_DN",
        "WPNAV_SPEED_DN",
        "FS_OPTIONS",
        "THR_DZ",
        "RCMAP_THROTTLE",
        "RC3_MIN",
        "RC3_MAX",
    ),
    Kind.ARDUPLANE: (
        "FS_GCS_ENABL",
        "SYSID_MYGCS",
        "FS_LONG_ACTN",
        "FENCE_ENABLE",
        "AIRSPEED_MIN",
        "AIRSPEED_MAX",
        "ARSPD_FBW_MIN",
        "ARSPD_FBW_MAX",
        "ROLL_LIMIT_DEG",
        "LIM_ROLL_CD",
        "TECS_CLMB_MAX",
        "TECS_SINK_MAX",
    ),
}
"""What to read at the start; names of older versions included, so some will not be answered."""


def gcs_failsafe(kind: Kind, parameters: Parameters, system: int) -> Finding | None:
    """Return why the autopilot would not act when this agent's heartbeat (from `system`) falls silent.

    None where it acts.
    """
    if kind is Kind.PX4_MULTICOPTER:
        return None  # it watches the setpoints themselves: COM_OF_LOSS_T
    name = "FS_GCS_ENABL" if kind is Kind.ARDUPLANE else "FS_GCS_ENABLE"
    if name not in parameters:
        return Finding("error", name, f"{name} is not known", f"read it, and set {name} to 1")
    if parameters[name] == 0:
        return Finding("error", name, f"{name} is 0: no GCS failsafe", f"set {name} to 1")
    watched = parameters.get("SYSID_MYGCS")
    if watched != system:
        found = "not known" if watched is None else f"{watched:.0f}"
        text = f"SYSID_MYGCS is {found}: the failsafe does not watch this agent"
        return Finding("error", "SYSID_MYGCS", text, f"set SYSID_MYGCS to {system}")
    if kind is Kind.ARDUPLANE and parameters.get("FS_LONG_ACTN") == 0:
        text = "FS_LONG_ACTN is 0: in GUIDED the plane flies on"
        return Finding("error", "FS_LONG_ACTN", text, "set FS_LONG_ACTN to 1 (return)")
    return None


def findings(kind: Kind, parameters: Parameters, system: int) -> tuple[Finding, ...]:
    """Return all that a preflight check should say of an autopilot's parameters."""
    found: list[Finding] = []
    failsafe = gcs_failsafe(kind, parameters, system)
    if failsafe is not None:
        found.append(failsafe)
    if kind is Kind.PX4_MULTICOPTER:
        loss = parameters.get("COM_OF_LOSS_T")
        if loss is None or loss > 2.0:
            text = "COM_OF_LOSS_T is not known" if loss is None else f"COM_OF_LOSS_T is {loss:g} s"
            found.append(Finding("error", "COM_OF_LOSS_T", text, "set COM_OF_LOSS_T to 1"))
        if parameters.get("COM_OBL_RC_ACT") == 7:
            text = "COM_OBL_RC_ACT is 7: nothing happens when setpoints end"
            found.append(Finding("error", "COM_OBL_RC_ACT", text, "set COM_OBL_RC_ACT to 3 (return)"))
        if parameters.get("GF_ACTION") in (None, 0):
            text = "the autopilot's own fence takes no action"
            found.append(Finding("warning", "GF_ACTION", text, "set GF_ACTION to 2 (hold) or 3 (return)"))
        return tuple(found)
    if not parameters.get("FENCE_ENABLE"):
        text = "the autopilot's own fence is off"
        found.append(Finding("warning", "FENCE_ENABLE", text, "set FENCE_ENABLE to 1 and upload a fence"))
    timeout = parameters.get("GUID_TIMEOUT")
    if kind is Kind.ARDUCOPTER and timeout is not None and timeout > 3.0:
        text = f"GUID_TIMEOUT is {timeout:g} s: it flies on that long after the last setpoint"
        found.append(Finding("warning", "GUID_TIMEOUT", text, "set GUID_TIMEOUT to 1"))
    return tuple(found)
