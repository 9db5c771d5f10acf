"""The recorded requests put to our personalities, and both sides' answers compared.

`python -m tests.support.personality_comparison docs/personalities.md` writes the tables into the page.
"""

from __future__ import annotations

import sys
from bisect import bisect_right
from collections.abc import Callable
from functools import cache
from math import atan2, degrees, hypot
from pathlib import Path
from typing import Any, NamedTuple

from onboard.core.math.constants import NS_PER_S
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import dialect_packet
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.flown_autopilot import FlownAutopilot
from tests.support.paths import RECORDINGS

FILES = {Kind.ARDUCOPTER: "arducopter-4.5.6-guided.tlog", Kind.ARDUPLANE: "arduplane-4.5.6-guided.tlog"}
# When the recorded ones were ready [s since boot]: the position estimate and the pre-arm bit.
READY = {Kind.ARDUCOPTER: (41.4, 23.5), Kind.ARDUPLANE: (20.5, 21.0)}
BEGIN, END = "<!-- begin {} -->", "<!-- end {} -->"
COMPANION = 191


class Stream:
    """What one side sent: (time since boot [s], message), in order."""

    def __init__(self, heard: list[tuple[float, Any]]) -> None:
        self.heard = heard
        self.by_name: dict[str, list[tuple[float, Any]]] = {}
        for t, m in heard:
            self.by_name.setdefault(m.get_type(), []).append((t, m))

    def at(self, name: str, t: float) -> Any:
        """The latest message of a kind at a time."""
        entries = self.by_name[name]
        return entries[bisect_right(entries, t, key=lambda entry: entry[0]) - 1][1]

    def between(self, name: str, start: float, end: float) -> list[Any]:
        return [m for t, m in self.by_name.get(name, []) if start <= t < end]

    def rate(self, name: str, start: float, end: float) -> float:
        """Messages a second."""
        return len(self.between(name, start, end)) / (end - start)


class Comparison(NamedTuple):
    """One recording: what was asked, what the real one answered, what ours answers."""

    kind: Kind
    requests: list[tuple[float, Any]]
    real: Stream
    ours: Stream


@cache
def compared(kind: Kind) -> Comparison:
    """Play a recording's requests to our personality, at the recorded times."""
    entries = list(read_tlog((RECORDINGS / FILES[kind]).read_bytes()))
    zero = entries[0].stamp_ns
    timed = [((e.stamp_ns - zero) / NS_PER_S, e.packet) for e in entries]
    requests = [(t, dialect_packet(p.raw).message) for t, p in timed if p.component == COMPANION]
    real = Stream([(t, dialect_packet(p.raw).message) for t, p in timed if p.component == 1])
    ready, healthy = READY[kind]
    flown = FlownAutopilot(kind, airborne=False, ready_s=ready, healthy_share=healthy / ready)
    for t, message in requests:
        flown.forward(t - flown.now_ns / NS_PER_S)
        flown.send(message)
    flown.forward(timed[-1][0] - flown.now_ns / NS_PER_S)
    return Comparison(kind, requests, real, Stream([(t / NS_PER_S, m) for t, m in flown.heard]))


# ---------------------------------------------------------------------- acknowledgements

RESULTS = ("accepted", "later", "denied", "unsupported", "failed")


def results(stream: Stream) -> list[tuple[int, int]]:
    """(command, result) of all acknowledgements, in order."""
    return [(m.command, m.result) for _, m in stream.by_name["COMMAND_ACK"]]


def _words(message: Any) -> str:
    name = message.get_type()
    if name == "COMMAND_LONG":
        p = (message.param1, message.param2, message.param7)
        return f"{message.command} ({p[0]:g}, {p[1]:g})" + (f", p7 {p[2]:g}" if p[2] else "")
    p = (message.param1, message.param2, message.param3)
    return f"{message.command} ({p[0]:g}, {p[1]:g}, {p[2]:.3g}), z {message.z:g}, frame {message.frame}"


def acknowledgements(c: Comparison) -> list[tuple[str, list[int], list[int]]]:
    """(request, real results, our results): equal requests together, in the order of their first."""
    commands = [m for _, m in c.requests if m.get_type() in ("COMMAND_LONG", "COMMAND_INT")]
    rows: dict[str, tuple[list[int], list[int]]] = {}
    for message, (_, theirs), (_, own) in zip(commands, results(c.real), results(c.ours), strict=True):
        row = rows.setdefault(_words(message), ([], []))
        row[0].append(theirs)
        row[1].append(own)
    return [(words, *row) for words, row in rows.items()]


def _told(values: list[int]) -> str:
    parts: list[tuple[int, int]] = []
    for value in values:
        parts = (
            [*parts[:-1], (value, parts[-1][1] + 1)]
            if parts and parts[-1][0] == value
            else [*parts, (value, 1)]
        )
    return ", then ".join(f"{n} × {RESULTS[v]}" if n > 1 else RESULTS[v] for v, n in parts)


# ---------------------------------------------------------------------- kinds of messages

NOT_OURS = {
    "AHRS": "internals of the estimator",
    "AHRS2": "internals of the estimator",
    "AIRSPEED_AUTOCAL": "internals of the airspeed sensor",
    "AOA_SSA": "internals of the estimator",
    "MEMINFO": "hardware",
    "MISSION_ITEM_REACHED": "no missions",
    "NAV_CONTROLLER_OUTPUT": "internals of the navigation",
    "POSITION_TARGET_GLOBAL_INT": "internals of the navigation",
    "POWER_STATUS": "hardware",
    "RAW_IMU": "raw sensors",
    "SCALED_IMU2": "raw sensors",
    "SCALED_IMU3": "raw sensors",
    "SCALED_PRESSURE": "raw sensors",
    "SCALED_PRESSURE2": "raw sensors",
    "SERVO_OUTPUT_RAW": "no servos",
    "SIMSTATE": "the other simulator's own",
    "TIMESYNC": "ours answers, and never asks by itself",
    "VIBRATION": "raw sensors",
}
NOT_THEIRS = {
    "BATTERY_STATUS": "sent by default",
    "EKF_STATUS_REPORT": "sent by default",
    "EXTENDED_SYS_STATE": "sent by default: MAVSDK waits for it",
    "GPS_RAW_INT": "sent by default",
    "MISSION_CURRENT": "sent by default",
    "RC_CHANNELS": "sent by default",
    "SYSTEM_TIME": "sent by default",
}


def only(c: Comparison) -> tuple[list[str], list[str]]:
    """Names of the messages that only the real one, and only ours sends."""
    theirs, own = set(c.real.by_name), set(c.ours.by_name)
    return sorted(theirs - own), sorted(own - theirs)


# ---------------------------------------------------------------------- motion


class Figure(NamedTuple):
    """One quantity of the flight, on both sides."""

    what: str
    unit: str
    real: float
    ours: float
    within: float
    why: str  # where it differs


def _course(stream: Stream, t: float) -> float:
    m = stream.at("LOCAL_POSITION_NED", t)
    return degrees(atan2(m.vy, m.vx)) % 360.0


def _stopping(stream: Stream, since: float) -> float:
    """Seconds from the last target until slower than 0.5 m/s."""
    return next(
        t - since for t, m in stream.by_name["LOCAL_POSITION_NED"] if t > since and hypot(m.vx, m.vy) < 0.5
    )


def _steepest(stream: Stream, start: float, end: float) -> float:
    return max(abs(degrees(m.roll)) for m in stream.between("ATTITUDE", start, end))


def _last(c: Comparison, name: str, before: float = 1e9) -> float:
    return max(t for t, m in c.requests if m.get_type() == name and t < before)


def figures(c: Comparison) -> list[Figure]:
    """The quantities compared, each with how near they must be and why they are not equal."""

    def both(what: str, unit: str, of: Callable[[Stream], float], within: float, why: str = "") -> Figure:
        return Figure(what, unit, of(c.real), of(c.ours), within, why)

    def local(t: float, axis: str) -> Callable[[Stream], float]:
        return lambda s: float(getattr(s.at("LOCAL_POSITION_NED", t), axis))

    if c.kind == Kind.ARDUCOPTER:
        end = _last(c, "SET_POSITION_TARGET_LOCAL_NED", 80.0)
        return [
            both(
                "height 12 s after take-off to 20 m",
                "m",
                lambda s: -s.at("LOCAL_POSITION_NED", 54.0).z,
                3.0,
                "our climb starts without spinning up",
            ),
            both("north at the end of (5, 0, 0)", "m/s", local(62.0, "vx"), 0.2),
            both("east at the end of (0, 5, 0)", "m/s", local(70.0, "vy"), 0.2),
            both("north at the end of (−3, 3, −1)", "m/s", local(78.0, "vx"), 0.2),
            both("down at the end of (−3, 3, −1)", "m/s", local(78.0, "vz"), 0.2),
            both("north 2.5 s into silence", "m/s", local(end + 2.5, "vx"), 0.2),
            both(
                "from the last target to a stop",
                "s",
                lambda s: _stopping(s, end),
                1.0,
                "the real one brakes within its jerk limit",
            ),
            both("north at the end of mask 0x9C7 (2, 0, 0)", "m/s", local(89.0, "vx"), 0.2),
            both(
                "level speed 3 s after LOITER",
                "m/s",
                lambda s: hypot(local(92.5, "vx")(s), local(92.5, "vy")(s)),
                0.3,
            ),
        ]
    return [
        both(
            "course 15 s after 43002 to 90°",
            "°",
            lambda s: _course(s, 65.2),
            5.0,
            "the real loop is soft (GUIDED_P 5000)",
        ),
        both("airspeed 14 s after 43000 to 26 m/s", "m/s", lambda s: s.at("VFR_HUD", 80.0).airspeed, 0.8),
        both(
            "height 24 s after 43001 to 120 m",
            "m",
            lambda s: s.at("GLOBAL_POSITION_INT", 85.0).relative_alt * 1e-3,
            1.0,
        ),
        both("steepest bank under roll-only attitude", "°", lambda s: _steepest(s, 71.0, 80.4), 2.0),
        both(
            "bank 2 s into the silence of roll",
            "°",
            lambda s: degrees(s.at("ATTITUDE", _last(c, "SET_ATTITUDE_TARGET") + 2.0).roll),
            1.0,
        ),
        both(
            "course 8 s after the last roll, 3 s of velocity targets to the east among them",
            "°",
            lambda s: _course(s, 88.3),
            5.0,
            "the real loop is soft",
        ),
        both("course 8 s after DO_REPOSITION", "°", lambda s: _course(s, 96.3), 3.0),
        both(
            "height 8 s after DO_REPOSITION to 110 m",
            "m",
            lambda s: s.at("GLOBAL_POSITION_INT", 96.3).relative_alt * 1e-3,
            1.5,
        ),
    ]


# ---------------------------------------------------------------------- modes


def modes(stream: Stream) -> list[tuple[int, bool]]:
    """(custom_mode, armed) in order, each change once; ArduPilot's INITIALISING left out."""
    told: list[tuple[int, bool]] = []
    for _, m in stream.by_name["HEARTBEAT"]:
        state = (m.custom_mode, bool(m.base_mode & 128))
        if m.custom_mode != 16 and (not told or told[-1] != state):
            told.append(state)
    return told


# ---------------------------------------------------------------------- the page


def tables() -> dict[str, str]:
    """The generated parts of docs/personalities.md."""
    out = {}
    for kind in FILES:
        c = compared(kind)
        rows = ["| request | real | ours |", "|---|---|---|"]
        rows += [f"| {words} | {_told(real)} | {_told(own)} |" for words, real, own in acknowledgements(c)]
        out[f"{kind.value} results"] = "\n".join(rows)
        rows = ["| quantity | real | ours | why they differ |", "|---|---|---|---|"]
        rows += [
            f"| {f.what} | {f.real:.1f} {f.unit} | {f.ours:.1f} {f.unit} | {f.why} |" for f in figures(c)
        ]
        out[f"{kind.value} flight"] = "\n".join(rows)
        theirs, own = only(c)
        rows = ["| message | sent by | why |", "|---|---|---|"]
        rows += [f"| {name} | the real one only | {NOT_OURS[name]} |" for name in theirs]
        rows += [f"| {name} | ours only | {NOT_THEIRS[name]} |" for name in own]
        out[f"{kind.value} messages"] = "\n".join(rows)
    return out


def filled(page: str) -> str:
    """The page with its generated parts replaced."""
    for name, table in tables().items():
        begin, end = BEGIN.format(name), END.format(name)
        head, rest = page.split(begin)
        page = f"{head}{begin}\n{table}\n{end}{rest.split(end, 1)[1]}"
    return page


if __name__ == "__main__":
    path = Path(sys.argv[1])
    path.write_text(filled(path.read_text()))
