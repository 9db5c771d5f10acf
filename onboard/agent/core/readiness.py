"""What an agent still lacks before it can play, in words a person can act on."""

from __future__ import annotations

from onboard.agent.core.bus_view import BusView
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.autopilot.health import Thresholds, read
from onboard.core.math.constants import NEVER
from onboard.core.safety.policy import Policy
from onboard.wire.bus.messages import Role

MASTER_S = 5.0  # a master silent for longer counts as lacking


def vehicle_lacks(now: float, vehicle: VehicleLink, policy: Policy) -> list[str]:
    """What is missing of the vehicle itself."""
    lacks: list[str] = []
    t = vehicle.telemetry
    if vehicle.adapter is None:
        others = sorted(vehicle.heard_systems)
        heard = f" (heard: system {', '.join(map(str, others))})" if others else ""
        return [f"an autopilot: {vehicle.refusal}" if vehicle.refusal else f"an autopilot{heard}"]
    fresh = now - t.position_at <= policy.telemetry_age
    limits = Thresholds(
        heartbeat_age=policy.heartbeat_alone if fresh else policy.heartbeat_age,
        telemetry_age=policy.telemetry_age,
        battery_min=policy.battery,
    )
    health = read(now, t, limits)
    lacks += [*health.lacks, *health.faults]
    if vehicle.unread:
        lacks.append(unread_words(vehicle.unread))
    if not t.armed:
        lacks.append("an armed vehicle")
    return lacks


def unread_words(names: tuple[str, ...]) -> str:
    """What is missing while the autopilot's limits are not known, and what a person can do."""
    return f"the autopilot's limits: {', '.join(names)} not read (or set [envelope] in the configuration)"


def why_no_order(vehicle: VehicleLink, *, takes: bool) -> str:
    """Why an order from the ground cannot be obeyed, in words; "" if it can. `takes`: it takes control."""
    if vehicle.adapter is None:
        return vehicle.refusal or "no autopilot"
    if vehicle.unread and takes:
        return f"lacks {unread_words(vehicle.unread)}"
    return ""


def lacking(
    now: float, vehicle: VehicleLink, bus: BusView, policy: Policy, role: Role, why_not: str
) -> tuple[str, ...]:
    """What is missing at `now` [s, monotonic]; `why_not`: why the setup at hand was refused."""
    lacks = vehicle_lacks(now, vehicle, policy)
    if not bus.connected:
        lacks.append("the bus")
    if bus.setup is None:
        lacks.append("a game's setup")
    elif why_not:
        lacks.append(f"a setup that fits: {why_not}")
    if bus.master_at == NEVER or now - bus.master_at > MASTER_S:
        lacks.append("a master")
    elif not bus.clock.ready:
        lacks.append(f"a clock that agrees with the master's ({bus.clock.offset_s * 1e3:+.0f} ms)")
    if role is Role.EVADER and bus.setup is not None and not bus.briefed:
        lacks.append("the evader's brief")
    return tuple(lacks)
