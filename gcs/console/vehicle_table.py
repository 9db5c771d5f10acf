"""The table of vehicles as values: cells, grades and orders. Pure."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from math import inf, isinf
from typing import Any, NamedTuple

from gcs.picture.terminal_text import cut
from gcs.picture.values import Picture, Presence, VehicleView
from onboard.core.math.vectors import Vec, distance
from onboard.wire.bus.messages import Role, Severity


class Grade(IntEnum):
    """How a vehicle is, worst first."""

    LOST = 0
    ERROR = 1
    WARN = 2
    EXPECTED = 3
    OK = 4


GRADE_WORDS = {
    Grade.LOST: "LOST", Grade.ERROR: "ERROR", Grade.WARN: "warn", Grade.EXPECTED: "absent", Grade.OK: "ok",
}  # fmt: skip
ROLE_WORDS = {Role.EVADER: "evad", Role.PURSUER: "purs", Role.TRACKER: "trak"}
STYLES = {
    Grade.LOST: "bold magenta",
    Grade.ERROR: "bold red",
    Grade.WARN: "yellow",
    Grade.EXPECTED: "dim",
    Grade.OK: "green",
}


class Column(NamedTuple):
    """One column: its sort name ("" = not sortable), heading and width (negative: to the right)."""

    sort: str
    heading: str
    width: int


COLUMNS = (
    Column("id", "id", -3),
    Column("role", "role", 4),
    Column("health", "health", 6),
    Column("", "mode", 8),
    Column("", "stage", 8),
    Column("battery", "batt", -4),
    Column("link", "link", -4),
    Column("age", "age", -4),
    Column("height", "hgt", -4),
    Column("", "m/s", -4),
    Column("distance", "to ev", -5),
    Column("", "rule", 0),  # the rest
)


SPARED = ("stage", "m/s")  # columns that a narrow table leaves out, so that rules are not cut
RULE_WIDTH = 27  # the longest rule of the paper's strategies, and a little


class Row(NamedTuple):
    """One vehicle of the table."""

    id: int
    grade: Grade
    cells: tuple[str, ...]


def grades(picture: Picture) -> dict[int, Grade]:
    """Each vehicle's grade: its presence and the alerts in force about it."""
    found = {}
    for vehicle in picture.vehicles:
        grade = Grade.OK
        if vehicle.presence is Presence.LOST:
            grade = Grade.LOST
        elif vehicle.presence is Presence.EXPECTED:
            grade = Grade.EXPECTED
        found[vehicle.id] = grade
    worst = {Severity.ERROR: Grade.ERROR, Severity.WARNING: Grade.WARN}
    for alert in picture.alerts:
        if alert.id in found and alert.severity in worst:
            found[alert.id] = min(found[alert.id], worst[alert.severity])
    return found


def evader_position(picture: Picture) -> Vec | None:
    """Where the evader is: by its own state, else by its track."""
    for vehicle in picture.vehicles:
        if vehicle.role is Role.EVADER and vehicle.position is not None:
            return Vec(*vehicle.position)
    roster = picture.game.setup.roster if picture.game.setup else ()
    evaders = {member.id for member in roster if member.role is Role.EVADER}
    for track in picture.tracks:
        if track.id in evaders:
            return Vec(*track.track.position)
    return None


def rows(picture: Picture, sort: str, descending: bool) -> list[Row]:
    """The table in the order asked for; equal ones by id. Unknown values come last either way."""
    graded = grades(picture)
    evader = evader_position(picture)
    ranked = []
    for vehicle in picture.vehicles:
        value = _KEYS.get(sort, _KEYS["id"])(vehicle, graded[vehicle.id], evader)
        row = Row(vehicle.id, graded[vehicle.id], _cells(vehicle, graded[vehicle.id], evader))
        ranked.append((value is None, value, row))
    known = [(v, row) for unknown, v, row in ranked if not unknown]
    known.sort(key=lambda pair: pair[0], reverse=descending)
    return [row for _, row in known] + [row for unknown, _, row in ranked if unknown]


def _cells(vehicle: VehicleView, grade: Grade, evader: Vec | None) -> tuple[str, ...]:
    health = vehicle.health
    position = vehicle.position
    return (
        str(vehicle.id),
        ROLE_WORDS[vehicle.role] if vehicle.role else "?",
        GRADE_WORDS[grade],
        vehicle.mode or "–",
        (health.stage.value.replace("_", " ") if health else "–"),
        f"{health.battery:.0%}" if health and health.battery >= 0 else "–",
        f"{health.link_quality:.0%}" if health and health.autopilot else "–",
        age(vehicle.age_s),
        f"{-position[2]:z.0f}" if position else "–",
        f"{vehicle.groundspeed:.1f}"[:4] if vehicle.state else "–",
        _to_evader(vehicle, evader),
        vehicle.rule.replace("_", " ") or "–",
    )


def _to_evader(vehicle: VehicleView, evader: Vec | None) -> str:
    d = _distance(vehicle, evader)
    return "–" if d is None else f"{d:.0f}" if d >= 100 else f"{d:.1f}"


def _distance(vehicle: VehicleView, evader: Vec | None) -> float | None:
    if evader is None or vehicle.position is None or vehicle.role is Role.EVADER:
        return None
    return distance(Vec(*vehicle.position), evader)


def age(seconds: float) -> str:
    """An age in four characters or fewer."""
    if isinf(seconds):
        return "–"
    if seconds < 0.95:
        return "<1"  # a figure that flickers tells nothing, and costs a slow line dear
    if seconds < 9.95:
        return f"{seconds:.1f}"
    if seconds < 600:
        return f"{seconds:.0f}"
    return f"{min(seconds / 60, 999):.0f}m"


_KEYS: dict[str, Callable[[VehicleView, Grade, Vec | None], Any]] = {
    "id": lambda v, g, e: v.id,
    "role": lambda v, g, e: v.role.value if v.role else None,
    "health": lambda v, g, e: int(g),
    "battery": lambda v, g, e: v.health.battery if v.health and v.health.battery >= 0 else None,
    "link": lambda v, g, e: v.health.link_quality if v.health else None,
    "age": lambda v, g, e: -v.age_s if v.age_s < inf else None,
    "height": lambda v, g, e: v.position[2] if v.position else None,
    "distance": lambda v, g, e: _distance(v, e),
}


def sort_values(picture: Picture) -> dict[int, dict[str, Any]]:
    """What each vehicle is sorted by, by the columns' sort names; None where it is not known."""
    graded, evader = grades(picture), evader_position(picture)
    return {
        v.id: {name: key(v, graded[v.id], evader) for name, key in _KEYS.items()} for v in picture.vehicles
    }


def columns(width: int) -> tuple[Column, ...]:
    """The columns that a table of this width has."""
    whole = sum(abs(column.width) + 1 for column in COLUMNS) - 1 + RULE_WIDTH
    return tuple(column for column in COLUMNS if width >= whole or column.heading not in SPARED)


def line(cells: tuple[str, ...], width: int) -> str:
    """Cells set in columns, exactly `width` wide; what does not fit ends in "…"."""
    parts = []
    shown = columns(width)
    for column, cell in zip(COLUMNS, cells, strict=True):
        size = abs(column.width)
        if column not in shown:
            continue
        if size == 0:
            parts.append(cell)
        elif column.width < 0:
            parts.append(cell[:size].rjust(size))
        else:
            parts.append(cell[:size].ljust(size))
    return cut(" ".join(parts), width).ljust(width)


def heading(sort: str, descending: bool, width: int) -> str:
    """The table's headings; the sorted column is marked."""
    mark = "▾" if descending else "▴"
    cells = []
    for column in COLUMNS:
        cell = column.heading
        if column.sort == sort:
            cell = cell[: abs(column.width) - 1] + mark
        cells.append(cell)
    return line(tuple(cells), width)


def column_at(x: int, width: int) -> Column | None:
    """The column under a character of the heading of a table of this width."""
    start = 0
    for column in columns(width):
        end = start + abs(column.width) if column.width else 10_000
        if start <= x <= end:
            return column
        start = end + 1
    return None
