"""What the page shows beside the scene, as plain data for JSON. Pure.

`hello` once, `field` when the setup changes, `board` some times a second for all browsers, `detail` of the
vehicle that one browser has selected. Texts are data: the page sets them as text, never as markup.
"""

from __future__ import annotations

from math import degrees, isfinite
from typing import Any

from gcs.console.command_parser import HELP_LINES, SORTS, WHOM
from gcs.console.detail import detail as detail_lines
from gcs.console.status_line import SIGNS, clock, log_lines, prospects_in_words, situation_in_words, spans
from gcs.console.vehicle_table import COLUMNS, GRADE_WORDS, Grade, keyed_rows
from gcs.page.frames import HEAD, ROLES, TRACK, VEHICLE
from gcs.picture.current import current
from gcs.picture.knowledge import arcs, goals_of, told
from gcs.picture.several import named, verdict_in_words
from gcs.picture.team import band_in_words
from gcs.picture.values import AssessmentView, CommandView, GameView, GoalView, Picture, VehicleView
from onboard.core.geometry.zones import ENDLESS
from onboard.game import palette
from onboard.game.knowledge_words import goal_in_words
from onboard.wire.bus.messages import CommandKind, Role, Setup, SupervisorAction
from onboard.wire.bus.team_messages import TeamPlan

Document = dict[str, Any]
LOG_MOST = 200  # lines of the event log on the page
HELP = {
    "id": "MAVLink system id", "role": "evader, pursuer (of several evaders: whose) or tracker",
    "health": "worst of presence and alerts",
    "mode": "the autopilot's mode", "stage": "what the agent does with the vehicle", "batt": "battery",
    "link": "telemetry received of what is expected", "age": "since the last message of the agent [s]",
    "hgt": "height above the origin [m]", "m/s": "speed over ground",
    "to ev": "distance to the evader [m]; of several to the one that it is after, else to the nearest",
    "rule": "the rule in force, or what the supervisor does instead; of an evader that is out: how",
}  # fmt: skip


LABELS = {
    "batt": "battery",
    "age": "age [s]",
    "hgt": "height [m]",
    "m/s": "speed [m/s]",
    "to ev": "distance [m]",
}


def colours() -> Document:
    """The palette: the same as of console and pictures."""

    def both(colour: palette.Colour) -> list[str]:
        return [colour.light, colour.dark]

    return {
        "ink": both(palette.INK), "faint": both(palette.FAINT), "paper": both(palette.PAPER),
        "grid": both(palette.GRID), "evaders": [both(colour) for colour in palette.EVADERS],
        "pursuers": [both(colour) for colour in palette.PURSUERS],
        "target": both(palette.TARGET), "capture": both(palette.CAPTURE), "safety": both(palette.SAFETY),
        "fence": both(palette.FENCE), "zone": both(palette.ZONE),
        "apollonius": both(palette.APOLLONIUS), "force": both(palette.FORCE),
        "cone": both(palette.CONE), "rules": dict(palette.RULES), "other_rules": list(palette.OTHER_RULES),
        "actions": {name: both(colour) for name, colour in palette.ACTIONS.items()},
    }  # fmt: skip


def hello(title: str, *, steers: bool, version: str, map: Document | None = None) -> Document:
    """What a browser learns first: who this is, what it may do, how frames are laid out; the user's map."""
    return {
        "what": "hello", "title": title, "steers": steers, "version": version, "palette": colours(),
        "frame": {"head": HEAD.size, "vehicle": list(VEHICLE), "track": list(TRACK)},
        "roles": [role.value if role else "" for role in ROLES],
        "grades": [GRADE_WORDS[grade] for grade in Grade],
        "columns": [
            {"name": name, "label": LABELS.get(name, name), "sort": c.sort, "help": HELP[name]}
            for c in COLUMNS
            for name in (c.heading,)
        ],
        "orders": [kind.value for kind in CommandKind], "sorts": list(SORTS),
        "help": [list(line) for line in HELP_LINES], "whom": WHOM, "map": map,
    }  # fmt: skip


def field(picture: Picture) -> Document:
    """The game's ground: origin, fence, target, distances; empty lists and nulls where not told."""
    game, setup = picture.game, picture.game.setup
    found: Document = {
        "what": "field", "game": game.name, "scenario": "", "origin": None, "fence": None, "zones": [],
        "roster": [],
        "targets": targets(game.targets),
        "capture": None, "safety": None,
        "planar": False, "flat": False, "horizon": None,
    }  # fmt: skip
    if setup is None:
        return found
    rules = setup.rules
    found |= {
        "scenario": setup.scenario, "capture": _number(rules.R), "safety": _number(rules.rho),
        "planar": bool(rules.planar), "flat": setup.flat, "horizon": _number(rules.horizon),
        "origin": [setup.origin.latitude_deg, setup.origin.longitude_deg, setup.origin.altitude_m],
        "roster": [
            {"id": m.id, "role": m.role.value, "start": list(m.start), "speed": m.speed,
             "strategy": m.strategy}
            for m in setup.roster
        ],
    }  # fmt: skip
    return found | limits(setup)


def targets(goals: tuple[GoalView, ...]) -> list[Document]:
    """Targets with their names, and whose they are."""
    return [
        {"evader": goal.evader, "name": name, "place": list(place)}
        for goal, (name, place) in zip(goals, named(goals), strict=True)
    ]


def limits(setup: Setup | None) -> Document:
    """Fence and zones; a zone without end up or down has null there."""
    fence = setup.fence if setup is not None else None
    return {
        "fence": None if fence is None else {
            "polygon": [list(corner) for corner in fence.polygon],
            "floor": fence.altitude_min, "ceiling": fence.altitude_max,
        },
        "zones": [
            {
                "name": zone.name, "polygon": [list(corner) for corner in zone.polygon],
                "floor": zone.low if zone.low > -ENDLESS else None,
                "ceiling": zone.high if zone.high < ENDLESS else None,
            }
            for zone in (setup.zones if setup is not None else ())
        ],
    }  # fmt: skip


def trails(picture: Picture) -> Document:
    """Where everybody came from, as far as it is kept: for a browser that comes later, or after a jump."""
    found = {str(v.id): [list(p) for p in v.trail] for v in picture.vehicles if v.trail}
    tracks = {str(t.id): [list(p) for p in t.trail] for t in picture.tracks if t.trail}
    return {"what": "trails", "vehicles": found, "tracks": tracks}


def board(picture: Picture, status: str) -> Document:
    """Tables, alerts, log, clock and assessment at one instant."""
    now = current(picture)
    roles = {vehicle.id: vehicle.role.value if vehicle.role else "" for vehicle in now.vehicles}
    after = dict(now.game.quarries)
    table = [
        {
            "id": row.id, "grade": int(row.grade), "role": roles[row.id],
            "cells": [
                _role(roles[row.id], after.get(row.id)) or cell if column.heading == "role" else cell
                for column, cell in zip(COLUMNS, row.cells, strict=True)
            ],
            "keys": {name: _number(value) for name, value in keys.items()},
        }
        for row, keys in keyed_rows(now)
    ]  # fmt: skip
    return {
        "what": "board", "now_ms": picture.now_ns // 1_000_000, "utc": clock(picture.now_ns),
        "status": status,
        "game": _game(picture.game), "vehicles": table, "alerts": _alerts(picture),
        "commands": [_command(command) for command in picture.commands[-6:]],
        "log": [line[0][0] for line in log_lines(picture)[-LOG_MOST:]],
        "situation": _situation(picture), "aims": [_aim(v) for v in now.vehicles if v.decision is not None],
        "wind": _wind(now), "knowledge": _knowledge(picture.game),
    }  # fmt: skip


def detail(picture: Picture, selected: int | None) -> Document:
    """The selected vehicle in words, and its decision's shapes."""
    found: Document = {"what": "detail", "id": selected, "lines": [], "decision": None}
    if selected is None or picture.vehicle(selected) is None:
        return found
    found["lines"] = [list(line) for line in detail_lines(picture, selected)]
    vehicle = current(picture).vehicle(selected)
    judged = picture.assessment_of(selected)
    if judged is not None and (judged.word or judged.why):
        found["lines"].append([": ".join(filter(None, (judged.word, judged.why))), "bold"])
    decision = vehicle.decision if vehicle else None
    if decision is not None:
        found["decision"] = {
            "rule": decision.rule, "sentence": sentence(vehicle), "aim": list(decision.aim),
            "time": _number(decision.time_to_aim), "miss": _number(decision.miss),
            "cones": [list(cone) for cone in decision.cones],
            "circles": [list(circle) for circle in decision.circles],
            "velocity": list(decision.velocity), "setpoint": list(decision.setpoint),
        }  # fmt: skip
    return found


def sentence(vehicle: VehicleView | None) -> str:
    """The rule and why, in a sentence."""
    decision = vehicle.decision if vehicle is not None else None
    if vehicle is None or decision is None:
        return ""
    if decision.supervisor not in (SupervisorAction.OK, SupervisorAction.CLIP):
        why = f", because {decision.reason}" if decision.reason else ""
        return f"The supervisor says {decision.supervisor.value}{why}."
    rule = decision.rule.replace("_", " ")
    level = f"{decision.level.value} level, " if decision.level.value else ""
    meets = f" in {decision.time_to_aim:.0f} s" if 0.0 < decision.time_to_aim < 1e4 else ""
    miss = f"; predicted miss {decision.miss:.1f} m" if 0.0 <= decision.miss < 1e5 else ""
    clipped = "; the supervisor brought it within the limits"
    clipped = clipped if decision.supervisor is SupervisorAction.CLIP else ""
    who = f"Strategy {decision.strategy} ({level}rule “{rule}”)"
    part = f" As {decision.reason}." if decision.reason and not clipped else ""
    return f"{who} aims at the marked place{meets}{miss}{clipped}.{part}"


def _role(role: str, after: int | None) -> str:
    """`pursuer`; where there are several evaders whom it is after: `after 12`."""
    return f"after {after}" if role and after else role


def _game(game: GameView) -> Document:
    outcome = game.outcome
    return {
        "name": game.name, "scenario": game.setup.scenario if game.setup else "",
        "phase": game.phase.value if game.phase else "", "reason": game.reason, "clock": game.clock,
        "time": _number(game.time_s), "t0_ms": game.t0_ns // 1_000_000,
        "outcome": None if outcome is None else {
            "verdict": outcome.verdict.value, "captor": outcome.captor, "time": outcome.time,
            "smallest": _number(outcome.smallest_distance), "reason": outcome.reason,
            "words": verdict_in_words(outcome),
        },
        "quarries": [list(pair) for pair in game.quarries],
        "out": [{"id": fate.id, "word": fate.verdict.value} for fate in game.fates if fate.out],
        "plan": _plan(game.plan),
    }  # fmt: skip


def _plan(plan: TeamPlan | None) -> Document | None:
    if plan is None:
        return None
    parts = [{"id": part.id, "role": part.role.value} for part in plan.parts]
    return {"words": band_in_words(plan), "parts": parts}


def _knowledge(game: GameView) -> list[Document]:
    """Of each evader the team's goal and why, what holds with its strength, and arcs to draw."""
    found: dict[int, Document] = {
        id: {"evader": id, "goal": goal_in_words(goal), "lines": [], "arcs": []}
        for id, goal in goals_of(game).items()
    }
    after = dict(game.quarries)
    for word in game.knowledge:
        one = found.setdefault(word.quarry, {"evader": word.quarry, "goal": goal_in_words(word.goal)})
        one["lines"] = [
            {"words": edge.words, "strength": _number(edge.strength)} for edge in told(word, after)
        ]
        one["arcs"] = [
            {"source": arc.source, "from": list(arc.ends[0]), "to": list(arc.ends[1]), "words": arc.words,
             "strength": arc.strength}
            for arc in arcs(word, after)
        ]  # fmt: skip
    return [found[id] for id in sorted(found)]


def _alerts(picture: Picture) -> list[Document]:
    return [
        {
            "name": a.name, "id": a.id, "severity": a.severity.value, "sign": SIGNS[a.severity],
            "text": a.text, "advice": a.advice, "since": clock(a.raised_ns), "acknowledged": a.acknowledged,
        }
        for a in picture.alerts
    ]  # fmt: skip


def _command(command: CommandView) -> Document:
    waiting = [leg.id for leg in command.legs if leg.open]
    return {
        "id": command.command_id, "kind": command.kind.value, "sender": command.sender,
        "issued_ms": command.issued_ns // 1_000_000, "confirmed": command.confirmed,
        "waiting": spans(waiting) if waiting else "",
        "legs": [
            {"id": leg.id, "state": leg.state.words, "open": leg.open, "reason": leg.reason, "mode": leg.mode,
             "took": _number(leg.took_s)}
            for leg in command.legs
        ],
    }  # fmt: skip


def _situation(picture: Picture) -> Document | None:
    """What is judged of each evader in the game, and all of it in words."""
    if not picture.assessments:
        return None
    only = picture.assessments[0]
    return {
        "words": _go(only) if only.alone else situation_in_words(picture, whole=True),
        "evaders": [_assessment(found) for found in picture.assessments],
    }


def _assessment(found: AssessmentView) -> Document:
    return {
        "evader": found.evader, "captured": found.captured,
        "encircled": found.encircled, "gaps": [list(gap) for gap in found.gaps],
        "largest_gap_deg": degrees(found.largest_gap), "target_denied": found.target_denied,
        "prospects": [
            {"id": p.id, "intercepts": p.intercepts, "time": _number(p.time_s), "denies": p.denies_target}
            for p in found.prospects
        ],
    }  # fmt: skip


def _go(found: AssessmentView) -> str:
    """Go or no-go, and the odds; the bound and the band in words where there are no odds."""
    if not found.word:
        return prospects_in_words(found, whole=True)
    return f"{found.word}: {found.why if found.captured is None else prospects_in_words(found, whole=True)}"


def _aim(vehicle: VehicleView) -> Document:
    decision = vehicle.decision
    assert decision is not None
    return {
        "id": vehicle.id, "evader": vehicle.role is Role.EVADER, "rule": decision.rule,
        "aim": list(decision.aim),
        "supervisor": decision.supervisor.value, "level": decision.level.value,
    }  # fmt: skip


def _wind(picture: Picture) -> list[float] | None:
    """The mean of the winds that vehicles report now [m/s; where it blows to]."""
    winds = [vehicle.state.wind for vehicle in picture.vehicles if vehicle.state is not None]
    if not winds:
        return None
    return [sum(wind[axis] for wind in winds) / len(winds) for axis in range(3)]


def _number(value: Any) -> Any:
    """The value, or None for a float that JSON does not have."""
    return None if isinstance(value, float) and not isfinite(value) else value
