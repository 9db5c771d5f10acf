"""Which adapter flies which autopilot, and why some are refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import pi
from types import MappingProxyType
from typing import NamedTuple

from onboard.autopilot.arduplane import ArduPlaneEncoder
from onboard.autopilot.base import Adapter, Refusal
from onboard.autopilot.guided import GuidedAdapter
from onboard.autopilot.mavsdk import Child, Courier, MavsdkAdapter, MavsdkEncoder
from onboard.autopilot.parameters import gcs_failsafe
from onboard.autopilot.px4_plane import Px4PlaneEncoder
from onboard.autopilot.velocity import GUIDED, VelocityEncoder
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.modes import MODES, Kind
from onboard.wire.mavlink.values import Heartbeat

SCHEMES = {
    "auto": tuple(Kind),
    "velocity": (Kind.PX4_MULTICOPTER, Kind.ARDUCOPTER),
    "mavsdk": (Kind.PX4_MULTICOPTER, Kind.ARDUCOPTER),
    "arduplane": (Kind.ARDUPLANE,),
    "arduplane-plain": (Kind.ARDUPLANE,),
    "px4-plane": (Kind.PX4_PLANE,),
    "px4-plane-course": (Kind.PX4_PLANE,),
}

_WHY_NOT = {
    Kind.PX4_VTOL: "PX4 VTOL: what a velocity target means changes with its transition",
    Kind.ARDUPLANE_VTOL: "ArduPlane VTOL: its modes and its idea of holding change with its transition",
}


class AdapterOptions(NamedTuple):
    """What the configuration says of the way to fly."""

    scheme: str = "auto"  # a key of `SCHEMES`
    may_arm: bool = False  # whether the adapter may ever arm
    hold_mode: str = ""  # a multicopter's mode to hold in, in its autopilot's words; "": the adapter's
    mavsdk_url: str = ""  # the connection that MAVSDK opens for itself, beside the agent's link
    bank_max: float = pi / 4  # [rad] of a plane
    launch: Callable[..., Courier] = Child  # starts MAVSDK's child process with the arguments given


def adapter_for(
    heartbeat: Heartbeat,
    to: Target,
    options: AdapterOptions = AdapterOptions(),  # noqa: B008  (frozen)
    parameters: Mapping[str, float] = MappingProxyType({}),
) -> Adapter | Refusal:
    """Return the adapter for an autopilot by its heartbeat, or the reason why there is none.

    `parameters` are the autopilot's, as far as read: the plain variant of ArduPlane is refused unless they
    show that the GCS failsafe watches this agent.
    """
    kind = heartbeat.kind
    reason = _refusal(heartbeat, options)
    if reason:
        return Refusal(reason)
    if options.scheme == "mavsdk":
        encoder = MavsdkEncoder(kind, to)
        return MavsdkAdapter(
            to, encoder, options.mavsdk_url, may_arm=options.may_arm, launch=options.launch,
            parameters=parameters,
        )  # fmt: skip
    if kind is Kind.PX4_PLANE:
        ahead = Px4PlaneEncoder(to, course=options.scheme == "px4-plane-course")
        return GuidedAdapter(to, ahead, may_arm=options.may_arm, parameters=parameters)
    if kind is not Kind.ARDUPLANE:
        velocity = VelocityEncoder(kind, to, options.hold_mode)
        return GuidedAdapter(to, velocity, may_arm=options.may_arm, parameters=parameters)
    plain = options.scheme == "arduplane-plain"
    finding = gcs_failsafe(kind, parameters, to.system) if plain else None
    if finding is not None:
        return Refusal(
            f"the course command of arduplane-plain never lapses, and {finding.text}: {finding.remedy}"
        )
    rolls = ArduPlaneEncoder(to, options.bank_max, plain=plain)
    return GuidedAdapter(to, rolls, may_arm=options.may_arm, parameters=parameters)


def _refusal(heartbeat: Heartbeat, options: AdapterOptions) -> str:
    """Why this autopilot is not flown as configured; "" where it is."""
    kind, scheme = heartbeat.kind, options.scheme
    if kind in _WHY_NOT:
        return _WHY_NOT[kind]
    if kind is Kind.UNKNOWN:
        return (
            f"unknown autopilot (autopilot {heartbeat.autopilot}, vehicle type {heartbeat.vehicle_type}): "
            "expected a PX4 multicopter or fixed wing, an ArduCopter or an ArduPlane"
        )
    if kind not in SCHEMES.get(scheme, ()):
        fitting = [name for name, kinds in SCHEMES.items() if kind in kinds]
        return f"{kind.value} cannot be flown by {scheme}: expected {', '.join(fitting)}"
    if scheme == "mavsdk" and not MavsdkAdapter.available():
        return "MAVSDK is not installed: pip install 'apollonius[mavsdk]'"
    if scheme == "mavsdk" and not options.mavsdk_url:
        return "mavsdk needs a connection of its own: give its URL"
    hold = options.hold_mode
    if hold and kind in GUIDED and (hold not in MODES[kind] or hold == GUIDED[kind]):
        names = ", ".join(name for name in MODES[kind] if name != GUIDED[kind])
        return f"hold_mode '{hold}' is no mode in which {kind.value} flies alone: expected one of {names}"
    return ""
