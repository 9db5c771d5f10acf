"""What each value of a failsafe's parameter makes the vehicle do: tables of ArduCopter, ArduPlane and PX4.

Sources: ArduPilot's parameter references of 4.5 and 4.7, PX4's of 1.16 and 1.18; without sticks PX4 sank at
0.8 m/s in Position mode (recorded).
"""

from __future__ import annotations

from typing import NamedTuple


class Ending(NamedTuple):
    """What an action comes to."""

    words: str
    ends: bool  # on the ground, or (a plane) over home; False: in the air until something else ends it
    bad: bool = False  # it falls, or needs a pilot at once


RETURNS, LANDS = Ending("returns", True), Ending("lands where it is", True)
HOVERS, LOITERS = Ending("hovers", False), Ending("circles", False)
NOTHING = Ending("does nothing", False)
COPTER_GCS = {
    1: RETURNS, 2: RETURNS, 3: RETURNS._replace(words="returns by the way it came"),
    4: RETURNS._replace(words="returns by the way it came, or lands"), 5: LANDS,
    6: RETURNS._replace(words="flies its landing sequence, or returns"),
    7: HOVERS._replace(words="brakes and hovers"),
}  # fmt: skip
"""FS_GCS_ENABLE and FS_THR_ENABLE of ArduCopter; 7 lands only where it cannot brake."""
COPTER_BATTERY = {
    0: NOTHING, 1: LANDS, 2: RETURNS, 3: COPTER_GCS[3], 4: COPTER_GCS[4],
    5: Ending("stops its motors and falls", True, bad=True), 6: COPTER_GCS[6], 7: COPTER_GCS[7],
}  # fmt: skip
"""BATT_FS_LOW_ACT and BATT_FS_CRT_ACT of ArduCopter."""
COPTER_EKF = {
    0: Ending("only reports", False, bad=True), 1: LANDS, 3: LANDS,
    2: Ending("goes to ALT_HOLD, which needs a stick: without one it sinks", False, bad=True),
}  # fmt: skip
"""FS_EKF_ACTION of ArduCopter."""
PLANE_LONG = {
    0: Ending("flies on", False, bad=True), 1: RETURNS, 2: Ending("glides down where it is", True, bad=True),
    3: Ending("opens its parachute", True), 4: Ending("flies its mission", True),
    5: Ending("lands by itself", True),
}  # fmt: skip
"""FS_LONG_ACTN of ArduPlane."""
PLANE_BATTERY = {
    0: NOTHING, 1: RETURNS, 2: Ending("flies its landing sequence", True),
    3: Ending("ends the flight and falls", True, bad=True), 5: PLANE_LONG[3],
}  # fmt: skip
PX4_OFFBOARD = {
    0: Ending("goes to Position mode, which needs sticks: without them it sinks and drifts", False, bad=True),
    1: Ending("goes to Altitude mode, which needs sticks: without them it drifts and sinks", False, bad=True),
    2: Ending("goes to Manual mode, which needs sticks: without them it falls", False, bad=True),
    3: RETURNS, 4: LANDS, 5: HOVERS._replace(words="holds its place"),
    6: Ending("terminates: it stops its motors and falls", True, bad=True),
    7: Ending("disarms: it stops its motors and falls", True, bad=True),
}  # fmt: skip
"""COM_OBL_RC_ACT of PX4. Without sticks it sank at 0.8 m/s in Position mode (recorded)."""
PX4_RC = {
    0: NOTHING, 1: HOVERS._replace(words="holds its place"), 2: RETURNS, 3: LANDS,
    5: PX4_OFFBOARD[6], 6: PX4_OFFBOARD[7],
}  # fmt: skip
"""NAV_RCL_ACT."""
PX4_BATTERY = {
    0: NOTHING._replace(words="only warns"), 1: RETURNS, 2: LANDS,
    3: Ending("returns when critical, lands in an emergency", True),
}  # fmt: skip
"""COM_LOW_BAT_ACT."""
COPTER_FENCE = {
    0: "only reports", 1: "returns, or lands", 2: "lands", 3: "returns by the way it came, or lands",
    4: "brakes, or lands", 5: "returns by the way it came, or lands",
}  # fmt: skip
PLANE_FENCE = {
    0: "only reports", 1: "returns", 2: "goes to the fence's return point in GUIDED",
    3: "goes to the fence's return point in GUIDED, with the pilot's throttle", 4: "returns",
    5: "goes to the fence's return point in AUTO", 6: "circles", 7: "lands by itself, or returns",
}  # fmt: skip
"""FENCE_ACTION."""
GF_ACTION = {
    0: "does nothing", 1: "only warns", 2: "holds its place", 3: "returns", 4: "terminates and falls",
    5: "lands",
}  # fmt: skip
