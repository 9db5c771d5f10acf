"""The table of vehicles as values: cells, grades and orders. Pure."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from math import dist, inf, isinf
from typing import Any, NamedTuple

from gcs.picture.terminal_text import cut
from gcs.picture.values import FateView, Picture, Presence, VehicleView
from onboard.wire.bus.messages import Health, Role, Severity, Triple


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


class Quarry(NamedTuple):
    """An evader that is in the game, where it is, and how far from who is after it."""

    id: int
    place: Triple  # [m; NED]
    away: float  # [m]


def quarries(picture: Picture) -> dict[int, Quarry]:
    """For everybody but evaders: the evader that it is after, as far as somebody says so, else the nearest
    one in the game. An evader is where its own state says, else its track."""
    at = evader_places(picture)
    if not at:
        return {}
    after = dict(picture.game.quarries)
    found = {}
    for vehicle in picture.vehicles:
        if vehicle.state is None or vehicle.role is Role.EVADER:
            continue
        here, told = vehicle.state.position, after.get(vehicle.id, 0)
        known = {told: at[told]} if told in at else at
        found[vehicle.id] = min(
            (Quarry(id, place, dist(place, here)) for id, place in known.items()), key=lambda one: one.away
        )
    return found


def evader_places(picture: Picture) -> dict[int, Triple]:
    """Where the evaders in the game are [m; NED], by id, as far as it is known."""
    evaders = {v.id: v.position for v in picture.vehicles if v.role is Role.EVADER}
    seen = {track.id: track.track.position for track in picture.tracks}
    at = {id: place for id in {*evaders, *picture.game.evaders} if (place := evaders.get(id) or seen.get(id))}
    out = {fate.id for fate in picture.game.fates if fate.out}
    return {id: at[id] for id in sorted(at) if id not in out} or at


def rows(picture: Picture, sort: str, descending: bool) -> list[Row]:
    """The table in the order asked for; equal ones by id. Unknown values come last either way."""
    ranked = []
    for told in _told(picture):
        value = _KEYS.get(sort, _KEYS["id"])(told)
        row = Row(told.vehicle.id, told.grade, _cells(told))
        ranked.append((value is None, value, row))
    known = [(v, row) for unknown, v, row in ranked if not unknown]
    known.sort(key=lambda pair: pair[0], reverse=descending)
    return [row for _, row in known] + [row for unknown, _, row in ranked if unknown]


class _Told(NamedTuple):
    """What a row is made of."""

    vehicle: VehicleView
    grade: Grade
    away: float | None  # from its quarry [m]
    after: int  # the evader that it is said to be after, where there are several; 0 = none
    fate: FateView | None  # of an evader that is out of the game

    @property
    def role(self) -> str:
        """`purs`; where there are several evaders whom it is after: `→12`."""
        if self.after:
            return f"→{self.after}"
        return ROLE_WORDS[self.vehicle.role] if self.vehicle.role else "?"

    @property
    def rule(self) -> str:
        """The rule in force; of an evader that is out of the game how."""
        return self.vehicle.rule.replace("_", " ") if self.fate is None else self.fate.words


def _told(picture: Picture) -> list[_Told]:
    graded, quarry, after = grades(picture), quarries(picture), dict(picture.game.quarries)
    out = {fate.id: fate for fate in picture.game.fates if fate.out}
    away = {id: one.away for id, one in quarry.items()}
    return [
        _Told(v, graded[v.id], away.get(v.id), after.get(v.id, 0), out.get(v.id)) for v in picture.vehicles
    ]


def _cells(told: _Told) -> tuple[str, ...]:
    vehicle = told.vehicle
    health, position = vehicle.health, vehicle.position
    return (
        str(vehicle.id),
        told.role,
        GRADE_WORDS[told.grade],
        vehicle.mode or "–",
        (health.stage.value.replace("_", " ") if health else "–"),
        f"{health.battery:.0%}" if health and health.battery >= 0 else "–",
        f"{health.link_quality:.0%}" if health and health.autopilot else "–",
        age(vehicle.age_s),
        f"{-position[2]:z.0f}" if position else "–",
        f"{vehicle.groundspeed:.1f}"[:4] if vehicle.state else "–",
        _metres(told.away),
        told.rule or "–",
    )


def _metres(away: float | None) -> str:
    return "–" if away is None else f"{away:.0f}" if away >= 100 else f"{away:.1f}"


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


_KEYS: dict[str, Callable[[_Told], Any]] = {
    "id": lambda told: told.vehicle.id,
    "role": lambda told: _sorted_role(told),
    "health": lambda told: int(told.grade),
    "battery": lambda told: _share(told.vehicle.health),
    "link": lambda told: told.vehicle.health.link_quality if told.vehicle.health else None,
    "age": lambda told: -told.vehicle.age_s if told.vehicle.age_s < inf else None,
    "height": lambda told: told.vehicle.position[2] if told.vehicle.position else None,
    "distance": lambda told: told.away,
}


def _sorted_role(told: _Told) -> str | None:
    """Pursuers of one evader stand together."""
    role = told.vehicle.role
    return None if role is None else f"{role.value} {told.after:03d}" if told.after else role.value


def _share(health: Health | None) -> float | None:
    return health.battery if health and health.battery >= 0 else None


def keyed_rows(picture: Picture) -> list[tuple[Row, dict[str, Any]]]:
    """The table by id, with what each row is sorted by under the columns' sort names; None: not known."""
    return [
        (Row(told.vehicle.id, told.grade, _cells(told)), {name: key(told) for name, key in _KEYS.items()})
        for told in _told(picture)
    ]


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
