"""One vehicle in words: what it does and why. Pure."""

from __future__ import annotations

from math import atan2, degrees, hypot

from gcs.console.status_line import spans
from gcs.console.vehicle_table import GRADE_WORDS, STYLES, age, grades, quarries
from gcs.picture.current import current
from gcs.picture.knowledge import goals_of
from gcs.picture.team import part_in_words, part_of
from gcs.picture.values import Picture, VehicleView
from onboard.core.math.vectors import Vec, distance, dot, norm, scale, sub
from onboard.game import sides
from onboard.game.knowledge_words import goal_in_words
from onboard.wire.bus.messages import LinkLock, Role, SupervisorAction

Line = tuple[str, str]  # text, style
LOCKS: dict[LinkLock, Line] = {
    LinkLock.SIGNED: ("autopilot link locked: signed", ""),
    LinkLock.OPEN: ("autopilot link open: no key", "dim"),
    LinkLock.SILENT: ("autopilot link: key set, nothing heard", "dim"),
    LinkLock.REFUSED: ("autopilot link: signatures refused", "bold red"),
}


def detail(picture: Picture, selected: int | None, hidden: frozenset[str] = frozenset()) -> list[Line]:
    """Lines about the selected vehicle, the most important first; what is no longer fed says its age.

    Of alerts those in `hidden` alone, which are shown nowhere else.
    """
    known = picture.vehicle(selected) if selected is not None else None
    picture = current(picture)
    vehicle = picture.vehicle(selected) if selected is not None else None
    if vehicle is None or known is None:
        return [("no vehicle selected", "dim")]
    grade = grades(picture)[vehicle.id]
    role = vehicle.role.value if vehicle.role else "role unknown"
    armed = "armed" if vehicle.armed else "disarmed"
    kind = vehicle.health.autopilot if vehicle.health else None
    lines = [
        (f"{vehicle.id} {role}: {GRADE_WORDS[grade]}, heard {age(vehicle.age_s)} s ago", STYLES[grade]),
        (f"{vehicle.mode}, {armed}, {kind.value if kind else ''}" if vehicle.mode else "mode unknown", ""),
    ]
    lines += _last(known, vehicle)
    if vehicle.health is not None and vehicle.health.lacks:
        lines.append((f"waits for {', '.join(vehicle.health.lacks)}", "yellow"))
    lines += _side(picture, vehicle)
    lines += _part(picture, vehicle)
    lines += _goal(picture, vehicle)
    lines += _decision(vehicle)
    lines += _distances(picture, vehicle)
    lines += _prospect(picture, vehicle)
    lines += _motion(vehicle)
    lines += _health(vehicle)
    alerts = [a.text for a in picture.alerts if a.id == vehicle.id and a.name in hidden]
    lines[2:2] = [(f"alert: {text}", "yellow") for text in alerts]
    return lines


def _last(known: VehicleView, now: VehicleView) -> list[Line]:
    """What was last known of a vehicle and is no longer told, with its age."""
    lines = []
    if known.state is not None and now.state is None:
        north, east, down = known.state.position
        ago = f"{age(known.state_age_s)} s ago"
        lines.append((f"last at N {north:z.1f} E {east:z.1f} up {-down:z.1f} m, {ago}", "bold"))
    if known.mode and not now.mode:
        lines.append((f"last mode {known.mode}, {age(_mode_age(known))} s ago", ""))
    battery_told = now.health is not None and now.health.battery >= 0
    if known.health is not None and known.health.battery >= 0 and not battery_told:
        told = known.health_age_s + min(known.health.telemetry_age_s, known.health.heartbeat_age_s)
        lines.append((f"last battery {known.health.battery:.0%}, {age(told)} s ago", ""))
    return lines


def _mode_age(known: VehicleView) -> float:
    """How old the last word on an autopilot's mode is [s]."""
    if known.health is None or known.health_age_s >= known.state_age_s:
        return known.state_age_s
    return known.health_age_s + known.health.heartbeat_age_s


def _side(picture: Picture, vehicle: VehicleView) -> list[Line]:
    """How the game ended for an evader; of several evaders who is after which."""
    game = picture.game
    fate = game.fate_of(vehicle.id)
    if fate is not None:
        return [(f"{'out of the game: ' if fate.out else ''}{fate.words}", "bold")]
    after, hunters = game.quarry_of(vehicle.id), game.hunters_of(vehicle.id)
    if after is not None:
        return [(f"after evader {after}", "bold")]
    return [(f"after it: {spans(list(hunters))}", "bold")] if hunters else []


def _part(picture: Picture, vehicle: VehicleView) -> list[Line]:
    plan = picture.game.plan
    part = part_of(plan, vehicle.id)
    return [] if plan is None or part is None else [(part_in_words(plan, part), "bold")]


def _goal(picture: Picture, vehicle: VehicleView) -> list[Line]:
    """What the team is after against an evader: at the evader, and at those who are after it."""
    found = goals_of(picture.game)
    only = next(iter(found)) if len(found) == 1 and len(picture.game.evaders) == 1 else 0
    if vehicle.role is Role.EVADER:
        goal, whose = found.get(vehicle.id), "the pursuers' goal"
    else:
        goal, whose = found.get(picture.game.quarry_of(vehicle.id) or only), "the team's goal"
    return [(f"{whose}: {goal_in_words(goal)}", "")] if goal is not None else []


def _decision(vehicle: VehicleView) -> list[Line]:
    decision = vehicle.decision
    if decision is None:
        return [("no decision reported", "dim")]
    north, east, down = decision.aim
    lines = [
        (f"rule {decision.rule.replace('_', ' ')}", "bold"),
        (f"{decision.level.value}, {decision.module.value}, {decision.strategy}", ""),
        (f"aim N {north:z.0f} E {east:z.0f} up {-down:z.0f} m", ""),
        (f"in {decision.time_to_aim:.1f} s, predicted miss {decision.miss:.1f} m", ""),
    ]
    if decision.supervisor is not SupervisorAction.OK:
        lines.append((f"supervisor: {decision.supervisor.value}: {decision.reason}", "bold yellow"))
    if decision.predictor:
        lines.append((f"predictor {decision.predictor}, σ {decision.predictor_sigma:.1f} m", ""))
    return lines


def _distances(picture: Picture, vehicle: VehicleView) -> list[Line]:
    if vehicle.state is None:
        return []
    here = Vec(*vehicle.state.position)
    lines = []
    quarry = quarries(picture).get(vehicle.id)
    if quarry is not None:
        line = sub(Vec(*quarry.place), here)
        away = norm(line)
        closing = dot(Vec(*vehicle.state.velocity), scale(line, 1.0 / away)) if away > 0.0 else 0.0
        named = f" {quarry.id}" if len(sides.evaders(picture.roles)) > 1 else ""
        lines.append((f"evader{named} {away:.1f} m, closing {closing:+z.1f} m/s", ""))
    others = [
        (distance(here, Vec(*o.position)), o)
        for o in picture.vehicles
        if o.id != vehicle.id and o.position is not None and o.role is not Role.EVADER
    ]
    if others:
        away, nearest = min(others, key=lambda pair: pair[0])
        word = "nearest pursuer" if vehicle.role is Role.EVADER else "nearest mate"
        lines.append((f"{word} {nearest.id}: {away:.1f} m", ""))
    goals = picture.game.targets_of(vehicle.id) if vehicle.role is Role.EVADER else ()
    if goals:
        each = ", ".join(f"{distance(here, Vec(*goal)):.1f}" for goal in goals)
        lines.append((f"target{'s' if len(goals) > 1 else ''} {each} m away", ""))
    return lines


def _prospect(picture: Picture, vehicle: VehicleView) -> list[Line]:
    after = picture.game.quarry_of(vehicle.id)
    if vehicle.role is not Role.EVADER and len(picture.assessments) > 1 and after is None:
        return []  # nobody says whom it is after
    only = picture.assessments[0].evader if len(picture.assessments) == 1 else 0
    found = picture.assessment_of(vehicle.id if vehicle.role is Role.EVADER else after or only)
    if found is None:
        return []
    if vehicle.role is Role.EVADER:
        who = ", ".join(f"{p.id} in {p.time_s:.0f} s" for p in found.prospects if p.intercepts)
        free = f"widest gap {degrees(found.largest_gap):.0f}°"
        if found.encircled:
            free = "encircled (no free ray; no proof of capture)"
        return [(f"{free}; its course is met by {who or 'nobody'}", "")]
    for prospect in found.prospects:
        if prospect.id == vehicle.id:
            meets = f"can intercept in {prospect.time_s:.1f} s" if prospect.intercepts else "cannot intercept"
            return [(f"{meets}{', denies the target' if prospect.denies_target else ''}", "")]
    return []


def _motion(vehicle: VehicleView) -> list[Line]:
    state = vehicle.state
    if state is None:
        return []
    north, east, down = state.position
    v_north, v_east, v_down = state.velocity
    course = degrees(atan2(v_east, v_north)) % 360
    speed = f"{hypot(v_north, v_east):.1f} m/s to {course:.0f}°"
    lines = [
        (f"at N {north:z.1f} E {east:z.1f} up {-down:z.1f} m", ""),
        (f"{speed}, climb {-v_down:+z.1f}, air {state.airspeed:.1f}", ""),
    ]
    wind = hypot(state.wind[0], state.wind[1])
    if wind > 0.05:
        source = (degrees(atan2(state.wind[1], state.wind[0])) + 180) % 360
        lines.append((f"wind {wind:.1f} m/s from {source:.0f}°", ""))
    return lines


def _health(vehicle: VehicleView) -> list[Line]:
    health = vehicle.health
    if health is None:
        return [("no health reported", "dim")]
    battery = f"{health.battery:.0%}" if health.battery >= 0 else "unknown"
    lines = [
        (f"battery {battery}, link {health.link_quality:.0%}, GPS fix {health.gps_fix}", ""),
        (f"telemetry {health.telemetry_rate_hz:.0f} Hz, setpoints {health.setpoint_rate_hz:.0f} Hz", ""),
        (f"state here {vehicle.state_rate_hz:.0f} Hz, clock {health.clock_offset_s * 1e3:+z.0f} ms", ""),
        LOCKS[health.link_lock],
        (f"version {health.version}", ""),
    ]
    dropped = {**health.counters, **{f"here {cause}": n for cause, n in vehicle.dropped}}
    told = ", ".join(f"{cause} {n}" for cause, n in sorted(dropped.items()) if n)
    if told:
        lines.append((f"counters: {told}", "dim"))
    return lines
