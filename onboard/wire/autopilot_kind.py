"""The kinds of autopilots, as MAVLink heartbeats tell them apart and as agents report them on the bus."""

from __future__ import annotations

from enum import Enum


class Kind(Enum):
    """What an autopilot's heartbeat says it is."""

    PX4_MULTICOPTER = "PX4 multicopter"
    PX4_PLANE = "PX4 fixed wing"
    PX4_VTOL = "PX4 VTOL"
    ARDUCOPTER = "ArduCopter"
    ARDUPLANE = "ArduPlane"
    ARDUPLANE_VTOL = "ArduPlane VTOL"
    UNKNOWN = "unknown"


GUIDED_MODE = {
    Kind.PX4_MULTICOPTER: "OFFBOARD",
    Kind.PX4_PLANE: "OFFBOARD",
    Kind.ARDUCOPTER: "GUIDED",
    Kind.ARDUPLANE: "GUIDED",
}
"""The mode in which a companion's setpoints count, in the autopilot's words."""
