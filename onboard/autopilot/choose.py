"""Which adapter flies which autopilot, and why some are refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from onboard.autopilot.arduplane import ArduPlaneAdapter
from onboard.autopilot.base import Adapter, Envelope, Refusal
from onboard.autopilot.mavsdk import Child, Courier, MavsdkAdapter
from onboard.autopilot.parameters import gcs_failsafe
from onboard.autopilot.velocity import VelocityAdapter
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import Heartbeat

SCHEMES = {
    "auto": tuple(Kind),
    "velocity": (Kind.PX4_MULTICOPTER, Kind.ARDUCOPTER),
    "mavsdk": (Kind.PX4_MULTICOPTER, Kind.ARDUCOPTER),
    "arduplane": (Kind.ARDUPLANE,),
    "arduplane-plain": (Kind.ARDUPLANE,),
}

_WHY_NOT = {
    Kind.PX4_PLANE: "PX4 fixed wing ignores velocity targets, and takes attitude targets without keeping "
    "altitude and airspeed: use an ArduPlane or a multicopter",
    Kind.PX4_VTOL: "PX4 VTOL: what a velocity target means changes with its transition",
    Kind.ARDUPLANE_VTOL: "ArduPlane VTOL: its modes and its idea of holding change with its transition",
}


def adapter_for(
    heartbeat: Heartbeat,
    to: Target,
    *,
    scheme: str = "auto",
    envelope: Envelope | None = None,
    parameters: Mapping[str, float] | None = None,
    may_arm: bool = False,
    hold_mode: str = "",
    mavsdk_url: str = "",
    launch: Callable[..., Courier] = Child,
) -> Adapter | Refusal:
    """The adapter for an autopilot by its heartbeat, or the reason why there is none.

    `scheme` (configuration) is `auto` or must fit. `parameters` are the autopilot's, as far as read: the
    plain variant of ArduPlane is refused unless they show that the GCS failsafe watches this agent.
    `mavsdk_url` is the connection that MAVSDK opens for itself, besides the agent's link; `launch` starts its
    child process with the arguments given.
    """
    kind = heartbeat.kind
    if kind in _WHY_NOT:
        return Refusal(_WHY_NOT[kind])
    if kind is Kind.UNKNOWN:
        return Refusal(
            f"unknown autopilot (autopilot {heartbeat.autopilot}, vehicle type {heartbeat.vehicle_type}): "
            "expected a PX4 multicopter, an ArduCopter or an ArduPlane"
        )
    if kind not in SCHEMES.get(scheme, ()):
        fitting = [name for name, kinds in SCHEMES.items() if kind in kinds]
        return Refusal(f"{kind.value} cannot be flown by {scheme}: expected {', '.join(fitting)}")
    limits = envelope or Envelope()
    if scheme == "mavsdk":
        if not MavsdkAdapter.available():
            return Refusal("MAVSDK is not installed: pip install 'apollonius[mavsdk]'")
        if not mavsdk_url:
            return Refusal("mavsdk needs a connection of its own: give its URL")
        return MavsdkAdapter(kind, to, limits, mavsdk_url, may_arm=may_arm, launch=launch)
    if kind is not Kind.ARDUPLANE:
        return VelocityAdapter(kind, to, limits, may_arm=may_arm, hold_mode=hold_mode)
    plain = scheme == "arduplane-plain"
    if plain:
        finding = gcs_failsafe(kind, parameters or {}, to.system)
        if finding is not None:
            return Refusal(
                f"the course command of arduplane-plain never lapses, and {finding.text}: {finding.remedy}"
            )
    return ArduPlaneAdapter(to, limits, may_arm=may_arm, plain=plain)
