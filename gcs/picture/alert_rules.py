"""What is worth an alert: rules over the picture, each with what to do. Pure.

A rule sees the picture and `in_force(name)`: once an alert is raised, its threshold for clearing is wider
(hysteresis), so that a value that hovers at the limit does not flap.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isinf

from gcs.picture.alerts import Finding
from gcs.picture.thresholds import Thresholds
from gcs.picture.trouble_rules import troubles
from gcs.picture.values import LegState, Picture, Presence, VehicleView
from onboard.core.math.vectors import Vec, distance
from onboard.core.safety import fence as fences
from onboard.core.safety.policy import Cause
from onboard.core.safety.words import CAUSES
from onboard.wire.bus.messages import (
    SCHEMA,
    AgentStage,
    CommandKind,
    Fence,
    Phase,
    Role,
    Severity,
    SupervisorAction,
    Triple,
)

InForce = Callable[[str], bool]
GUIDED_MODES = frozenset({"GUIDED", "OFFBOARD"})
ACTIVE = frozenset({Phase.STAGING, Phase.READY, Phase.RUNNING})
ERROR, WARNING = Severity.ERROR, Severity.WARNING
NO_ALERT = frozenset({SupervisorAction.OK, SupervisorAction.CLIP})
BAD_S = 5.0  # a bad message is an alert for so long




def rules(picture: Picture, in_force: InForce, limits: Thresholds, version: str) -> Iterator[Finding]:
    """Everything that is wrong at this instant. `version` is the station's own."""
    yield from _station(picture)
    yield from _game(picture, limits)
    yield from _commands(picture, limits)
    yield from _separation(picture, in_force, limits)
    playing = picture.game.phase in ACTIVE
    roster = picture.game.setup.roster if picture.game.setup and playing else ()
    members, tracked = {member.id for member in roster}, {member.id for member in roster if member.tracked}
    for vehicle in picture.vehicles:
        if vehicle.presence is Presence.EXPECTED:
            if playing and vehicle.id not in tracked:
                yield _missing(vehicle)
        elif vehicle.presence is Presence.LOST:
            yield _lost(vehicle)
        else:
            yield from _link(vehicle, in_force, limits)
            yield from _autopilot(vehicle, in_force, limits)
            yield from _supervisor(vehicle)
            yield from _fence(picture, vehicle, in_force, limits)
            yield from _identity(vehicle, version)
            if members and vehicle.id not in members:
                yield _stranger(vehicle)
            yield from troubles(vehicle)


def _station(picture: Picture) -> Iterator[Finding]:
    if picture.bad_age_s < BAD_S:
        said = ", ".join(f"{n} {cause.replace('_', ' ')}" for cause, n in picture.dropped)
        yield Finding(
            "dropped", 0, WARNING, f"messages dropped here: {said}",
            "something on the bus speaks badly: see who in the detail of each vehicle",
        )  # fmt: skip


def _game(picture: Picture, limits: Thresholds) -> Iterator[Finding]:
    game = picture.game
    if game.two_masters:
        yield Finding(
            "two_masters", 0, ERROR, "two masters claim this game",
            "stop one of them: two programs run games under one name",
        )  # fmt: skip
    if game.phase in ACTIVE and game.master_age_s > (game.master.lease_s if game.master else 2.0):
        name = game.master.name if game.master else ""
        lead = f", lead on with --take-over {name}" if name and game.phase is Phase.RUNNING else ""
        yield Finding(
            "no_master", 0, WARNING,
            f"the game's master{f' {name}' if name else ''} is silent{_since(game.master_age_s)}",
            f"nobody referees: restart the master{lead} or abort",
        )  # fmt: skip
    if game.phase is Phase.RUNNING and game.setup is not None:
        heard = {track.id: track.age_s for track in picture.tracks}
        out = {fate.id for fate in game.fates if fate.out}
        several = sum(member.role is Role.EVADER for member in game.setup.roster) > 1
        for member in game.setup.roster:
            age = heard.get(member.id, float("inf"))
            if member.role is Role.EVADER and age > limits.track_stale_s and member.id not in out:
                whom = f"evader {member.id}" if several else "the evader"
                yield Finding(
                    "track_stale", member.id, WARNING, f"no track of {whom}{_since(age)}",
                    "check the sensor: pursuers fly on prediction, then hold", 0.5,
                )  # fmt: skip


def _since(age_s: float) -> str:
    return "" if isinf(age_s) else f" for {age_s:.0f} s"


def _commands(picture: Picture, limits: Thresholds) -> Iterator[Finding]:
    for command in picture.commands:
        late = [leg.id for leg in command.legs if leg.open and leg.took_s > limits.confirm_s]
        if late:
            names = ", ".join(map(str, late))
            yield Finding(
                f"unconfirmed_{command.kind.value}", 0,
                ERROR if command.kind is CommandKind.ABORT else WARNING,
                f"{command.kind.value} not confirmed by {names}",
                "still being repeated; take over with the pilot's transmitter if it is urgent",
                detail=command.command_id,
            )  # fmt: skip
        refused = [leg for leg in command.legs if leg.state is LegState.REFUSED]
        if refused and picture.now_ns - command.issued_ns < 10_000_000_000:
            reasons = "; ".join(f"{leg.id}: {leg.reason or 'no reason given'}" for leg in refused)
            yield Finding(
                f"refused_{command.kind.value}", 0, WARNING, f"{command.kind.value} refused by {reasons}",
                "mend the reason and command again", detail=command.command_id,
            )  # fmt: skip


def _missing(vehicle: VehicleView) -> Finding:
    return Finding(
        "missing", vehicle.id, WARNING, f"vehicle {vehicle.id} is in the game and was never heard",
        "start its agent, or check that it joined this bus and this game", 3.0,
    )  # fmt: skip


def _stranger(vehicle: VehicleView) -> Finding:
    return Finding(
        "stranger", vehicle.id, WARNING, f"vehicle {vehicle.id} is here and not in this game",
        "keep it away, or start the game with it in the scenario", 2.0,
    )  # fmt: skip


def _lost(vehicle: VehicleView) -> Finding:
    return Finding(
        "lost", vehicle.id, ERROR, f"vehicle {vehicle.id} is lost: silent from all sources",
        "look for it, keep others away; its autopilot's failsafe acts on its own",
    )  # fmt: skip


def _link(vehicle: VehicleView, in_force: InForce, limits: Thresholds) -> Iterator[Finding]:
    name = f"vehicle {vehicle.id}"
    spoke_since = vehicle.state_age_s - vehicle.age_s > 0.2  # else it is silent, which is another matter
    if vehicle.state is not None and vehicle.state_age_s > limits.state_stale_s and spoke_since:
        yield Finding(
            "stale", vehicle.id, WARNING, f"{name} lives, but its position is old",
            "its autopilot or its link to the agent is silent: check the wiring", 0.2,
        )  # fmt: skip
    health = vehicle.health
    if health is None:
        return
    limit = limits.link_low + (limits.link_margin if in_force(f"link:{vehicle.id}") else 0.0)
    silent = health.telemetry_age_s > limits.telemetry_stale_s
    silent = silent or health.heartbeat_age_s > limits.heartbeat_stale_s
    if health.autopilot and health.link_quality < limit and not silent:
        yield Finding(
            "link", vehicle.id, WARNING, f"{name} gets {health.link_quality:.0%} of its telemetry",
            "bring it closer, or check antennas and interference", 1.0,
        )  # fmt: skip
    if health.autopilot and silent:
        yield Finding(
            "autopilot_silent", vehicle.id, ERROR, f"{name}'s autopilot is silent",
            "check the link between agent and autopilot; the autopilot's failsafe acts",
        )  # fmt: skip
    limit = limits.clock_offset_s * (0.7 if in_force(f"clock:{vehicle.id}") else 1.0)
    if abs(health.clock_offset_s) > limit:
        unready = abs(health.clock_offset_s) > limits.clock_unready_s
        yield Finding(
            "clock", vehicle.id, ERROR if unready else WARNING,
            f"{name}'s clock is off by {health.clock_offset_s:+.2f} s",
            "synchronise its clock (chrony, NTP): t₀ and tracks depend on it", 1.0,
        )  # fmt: skip
    if vehicle.missed_events > 0:
        yield Finding(
            "missed_events", vehicle.id, WARNING, f"{vehicle.missed_events} events of {name} did not arrive",
            "the log here has gaps: the vehicle's own log has them", 2.0,
        )  # fmt: skip


def _autopilot(vehicle: VehicleView, in_force: InForce, limits: Thresholds) -> Iterator[Finding]:
    name = f"vehicle {vehicle.id}"
    health = vehicle.health
    if health is None:
        return
    if health.battery >= 0.0:
        margin = limits.battery_margin if in_force(f"battery:{vehicle.id}") else 0.0
        if health.battery < limits.battery_low + margin:
            critical = health.battery < limits.battery_critical
            yield Finding(
                "battery", vehicle.id, ERROR if critical else WARNING,
                f"{name}'s battery is at {health.battery:.0%}",
                "land it now" if critical else "bring it home soon: return", 1.0,
            )  # fmt: skip
    if health.hold_lost:
        yield Finding(
            "hold_lost", vehicle.id, ERROR, f"{name} was left to hold, and {health.hold_lost}",
            f"take it by hand, or `return {vehicle.id}`, `land {vehicle.id}`",
        )  # fmt: skip
    if health.stage is AgentStage.HANDED_OVER:
        yield Finding(
            "handed_over", vehicle.id, WARNING,
            f"{name} is flown by its own failsafe" if health.failsafe else f"{name} is in its pilot's hands",
            f"look why; only then `resume {vehicle.id}`" if health.failsafe
            else "the strategy is out of it; `resume` when the pilot gives it back",
        )  # fmt: skip
    elif health.stage is AgentStage.ACTING and vehicle.mode not in GUIDED_MODES:
        yield Finding(
            "mode", vehicle.id, ERROR, f"{name} acts, but its autopilot is in {vehicle.mode or 'no mode'}",
            "it does not follow: enter GUIDED / OFFBOARD, or hold", 1.0,
        )  # fmt: skip
    if health.autopilot and (not health.ekf_ok or health.gps_fix < limits.gps_fix):
        yield Finding(
            "estimate", vehicle.id, ERROR, f"{name}'s autopilot does not trust its position",
            "do not start; in flight: hold and let the pilot take over", 1.0,
        )  # fmt: skip


def _supervisor(vehicle: VehicleView) -> Iterator[Finding]:
    if vehicle.decision is None or vehicle.decision_age_s >= 1.0:
        return
    action, why = vehicle.decision.supervisor, vehicle.decision.reason
    if action not in NO_ALERT and why != CAUSES[Cause.ORDER]:
        reason = f": {why}" if why else ""
        yield Finding(
            "supervisor", vehicle.id, WARNING,
            f"vehicle {vehicle.id}'s supervisor orders {action.value}{reason}",
            "it keeps the vehicle safe; mend the cause, then `resume`", 0.2,
        )  # fmt: skip


def _identity(vehicle: VehicleView, version: str) -> Iterator[Finding]:
    name = f"vehicle {vehicle.id}"
    if vehicle.double_id:
        yield Finding(
            "double_id", vehicle.id, ERROR, f"two agents speak as vehicle {vehicle.id}",
            "stop one of them at once and give it an id of its own",
        )  # fmt: skip
    if vehicle.schema_age_s < 5.0:
        yield Finding(
            "schema", vehicle.id, ERROR, f"{name} speaks another schema than {SCHEMA}: not understood",
            "install the same version on every vehicle and here",
        )  # fmt: skip
    health = vehicle.health
    if health is not None and health.version and version and health.version != version:
        yield Finding(
            "version", vehicle.id, WARNING, f"{name} runs version {health.version}, this station {version}",
            "install the same version everywhere before the game", 1.0,
        )  # fmt: skip


def _fence(
    picture: Picture, vehicle: VehicleView, in_force: InForce, limits: Thresholds
) -> Iterator[Finding]:
    fence = picture.game.setup.fence if picture.game.setup else None
    if fence is None or vehicle.position is None:
        return
    room = room_inside(Vec(*vehicle.position), fence)
    name = f"vehicle {vehicle.id}"
    if room < (0.2 * limits.fence_clear_m if in_force(f"fence_crossed:{vehicle.id}") else 0.0):
        yield Finding(
            "fence_crossed", vehicle.id, ERROR, f"{name} is outside the geofence by {max(0.0, -room):.0f} m",
            "hold or return it; watch that it turns back",
        )  # fmt: skip
        return
    extra = limits.fence_clear_m if in_force(f"fence_near:{vehicle.id}") else 0.0
    if room < limits.fence_near_m + extra:
        yield Finding(
            "fence_near", vehicle.id, WARNING, f"{name} is {max(0.0, room):.0f} m from the geofence",
            "its supervisor turns it back; hold it if it goes on",
        )  # fmt: skip


def room_inside(position: Vec, fence: Fence) -> float:
    """Distance to the nearest wall, floor or ceiling of a fence [m]; negative outside."""
    up = -position.z
    flat = fences.depth(position.x, position.y, fence.polygon) if len(fence.polygon) >= 3 else float("inf")
    return min(flat, up - fence.altitude_min, fence.altitude_max - up)


def _separation(picture: Picture, in_force: InForce, limits: Thresholds) -> Iterator[Finding]:
    keep = picture.game.setup.rules.separation if picture.game.setup else 0.0
    if keep <= 0.0:
        return
    wide = keep * limits.separation_clear
    for side in (Role.PURSUER, Role.EVADER):
        flying = sorted(
            (v.position, v.id) for v in picture.vehicles
            if v.position is not None and v.role is side and v.presence is Presence.PRESENT
        )  # fmt: skip
        yield from _too_near(flying, keep, wide, in_force)


def _too_near(
    flying: list[tuple[Triple, int]], keep: float, wide: float, in_force: InForce
) -> Iterator[Finding]:
    """Pairs of one side that are nearer than `keep` [m], or not yet `wide` apart again; places ascending."""
    for index, (place, own) in enumerate(flying):
        for other_place, other in flying[index + 1 :]:
            if other_place[0] - place[0] > wide:
                break
            low, high = min(own, other), max(own, other)
            d = distance(Vec(*place), Vec(*other_place))
            if d < (wide if in_force(f"separation:{low}:{high}") else keep):
                yield Finding(
                    "separation", low, ERROR, f"vehicles {low} and {high} are {d:.1f} m apart",
                    f"they must keep {keep:g} m: hold one of them", detail=str(high),
                )  # fmt: skip
