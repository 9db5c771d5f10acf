"""Into which mode a vehicle is left: a chain for each kind, purpose and state of the throttle stick.

What the autopilot refuses, or does not answer, gives way to the next mode of the chain. A mode that needs a
pilot's throttle stick (ArduCopter's LOITER sinks where it lies low) is asked for only while the stick is seen
in the middle: RC_CHANNELS not older than 2 s, the throttle within THR_DZ of mid. Channel counts and the
receiver's health bit do not tell: both look well where no pilot is (recorded on ArduCopter 4.5.6).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from onboard.autopilot.base import ReleaseMode, Telemetry
from onboard.autopilot.parameters import gcs_failsafe
from onboard.autopilot.pilot_hands import FLOWN_BY_HAND, throttle
from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.modes import Kind

GPS_3D = 3
CONTINUE_PILOTED = 16  # FS_OPTIONS: the GCS failsafe leaves pilots' modes alone, BRAKE among them

Chain = tuple[str, ...]
HOLD, RETURN, LAND, DEPART = ReleaseMode.HOLD, ReleaseMode.RETURN, ReleaseMode.LAND, ReleaseMode.DEPART

COPTER_WITH_STICK: dict[ReleaseMode, Chain] = {
    HOLD: ("LOITER", "BRAKE", "RTL", "LAND"),
    RETURN: ("RTL", "LAND"),
    LAND: ("LAND", "RTL"),
    DEPART: ("LOITER", "RTL", "LAND"),  # a pilot is there to fly it on
}
COPTER_WITHOUT_STICK: dict[ReleaseMode, Chain] = {
    HOLD: ("BRAKE", "RTL", "LAND"),
    RETURN: ("RTL", "LAND"),
    LAND: ("LAND", "RTL"),
    DEPART: ("RTL", "LAND"),
}
COPTER_BROUGHT_HOME: Chain = ("BRAKE", "RTL", "LAND")  # departing, where the GCS failsafe then acts
PLANE: dict[ReleaseMode, Chain] = {
    HOLD: ("LOITER", "RTL"),
    RETURN: ("RTL", "LOITER"),
    LAND: ("RTL", "LOITER"),  # how it lands is its mission's business
    DEPART: ("RTL", "LOITER"),
}
PX4: dict[ReleaseMode, Chain] = {
    HOLD: ("HOLD", "RTL", "LAND"),
    RETURN: ("RTL", "LAND"),
    LAND: ("LAND", "RTL"),
    DEPART: ("HOLD", "RTL", "LAND"),
}
WITHOUT_POSITION: dict[Kind, Chain] = {
    Kind.ARDUCOPTER: ("LAND",),  # as its own FS_EKF_ACTION 1
    Kind.ARDUPLANE: ("CIRCLE",),  # by bank alone, as its own short failsafe
    Kind.PX4_MULTICOPTER: ("LAND",),  # which it turns into its own descent
    Kind.PX4_PLANE: ("LAND",),
}
"""Whatever the purpose, where the vehicle does not know its place: modes that need none."""


class Release(NamedTuple):
    """What there is to know for leaving a vehicle."""

    kind: Kind
    parameters: Mapping[str, float]  # the autopilot's, as far as read
    system: int  # MAVLink system id that the agent's heartbeats carry
    hold_mode: str = ""  # configured; "": none


def stick_centred(now: float, telemetry: Telemetry, parameters: Mapping[str, float]) -> bool:
    """Return whether a pilot's throttle stick is seen in the middle; what is unknown counts as no stick."""
    stick, dead_zone = throttle(now, telemetry, parameters), parameters.get("THR_DZ")
    if stick is None or dead_zone is None:
        return False
    return abs(stick.pulse - 0.5 * (stick.least + stick.most)) <= dead_zone


def positioned(telemetry: Telemetry) -> bool:
    """Return whether the autopilot knows where it is; what it does not report counts as good."""
    blind = telemetry.gps_at != NEVER and telemetry.gps_fix < GPS_3D
    return not blind and (telemetry.ekf_at == NEVER or telemetry.ekf_ok)


def chain(purpose: ReleaseMode, now: float, telemetry: Telemetry, release: Release) -> Chain:
    """Return the modes to ask for, the first first, in the autopilot's words; never empty."""
    kind = release.kind
    if not positioned(telemetry):
        return WITHOUT_POSITION[kind]
    if kind is Kind.ARDUPLANE:
        return PLANE[purpose]
    stick = kind is not Kind.ARDUCOPTER or stick_centred(now, telemetry, release.parameters)
    if kind is Kind.ARDUCOPTER:
        found = (COPTER_WITH_STICK if stick else COPTER_WITHOUT_STICK)[purpose]
        if purpose is DEPART and not stick and _brought_home(release):
            found = COPTER_BROUGHT_HOME
    else:
        found = PX4[purpose]
    wished = release.hold_mode
    if purpose is HOLD and wished and (stick or wished not in FLOWN_BY_HAND[kind]):
        found = (wished, *(mode for mode in found if mode != wished))
    return found


def _brought_home(release: Release) -> bool:
    """Whether an ArduCopter in BRAKE comes home by itself once the agent's heartbeats end."""
    options = release.parameters.get("FS_OPTIONS")
    if options is None or round(options) & CONTINUE_PILOTED:
        return False
    return gcs_failsafe(release.kind, release.parameters, release.system) is None
