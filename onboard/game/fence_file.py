"""Fences from the tools of the field: QGroundControl's plans, MAVProxy's and ArduPilot's fence files, KML.

A game's fence is one polygon that the vehicles stay in. What a file holds besides (a second fence, zones to
keep out of, holes) is refused, never left out in silence. Latitudes and longitudes in degrees.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import cos, pi, sin
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import msgspec

from onboard.config.strict import FILE_MAX, ConfigError
from onboard.config.undecodable import UNDECODABLE
from onboard.core.math.vectors import Vec
from onboard.wire.geodesy import Frame

Corners = tuple[tuple[float, float], ...]
FORMS = "a QGroundControl .plan, a fence of MAVProxy or Mission Planner, or a KML file"
FAR = 100e3  # [m] from the origin: another place on Earth
CIRCLE = 36  # corners of a circle's polygon, which lies inside it
RETURN_POINT, STAY_IN, KEEP_OUT, CIRCLE_IN, CIRCLE_OUT = range(5000, 5005)  # MAV_CMD_NAV_FENCE_…


class Out(NamedTuple):
    """An area to keep out of, by latitude and longitude [deg]."""

    corners: Corners  # of a circle its middle alone
    radius: float = 0.0  # [m]; 0: a polygon


class GeoFence(NamedTuple):
    """One fence by latitude and longitude [deg]."""

    corners: Corners
    origin: str  # what kind of file it was
    outs: tuple[Out, ...] = ()  # what to keep out of within it


def read_fence(path: Path) -> GeoFence:
    """Read a fence. Raises ConfigError, one line: what was found, and what was expected."""
    try:
        with path.open("rb") as file:
            data = file.read(FILE_MAX + 1)
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    if len(data) > FILE_MAX:
        raise ConfigError(f"{path}: found more than {FILE_MAX} bytes, expected {FORMS}")
    try:
        fence = _read(data)
    except _RefusalError as error:
        raise ConfigError(f"{path}: {error}") from None
    for latitude, longitude in (*fence.corners, *(place for out in fence.outs for place in out.corners)):
        if not -90.0 < latitude < 90.0 or not -180.0 <= longitude <= 180.0:
            found = f"latitude {latitude:g}, longitude {longitude:g}"
            raise ConfigError(f"{path}: found {found}, expected degrees on Earth (exchanged?)")
    return fence


def polygon_in(fence: GeoFence, frame: Frame, name: str) -> Corners:
    """The fence's corners [m; north, east] in a game frame. Raises ConfigError for one far from it."""
    return places_in(fence.corners, frame, name)


def places_in(corners: Corners, frame: Frame, name: str) -> Corners:
    """Places by latitude and longitude [deg] in a game frame [m; north, east].

    Raises ConfigError for those far from it.
    """
    found = [
        frame.ned_from_geodetic(latitude, longitude, frame.origin.altitude_m)
        for latitude, longitude in corners
    ]
    far = max(abs(place.x) + abs(place.y) for place in found)
    if far > FAR:
        raise ConfigError(
            f"{name}: found a fence {far / 1e3:.0f} km from flight.origin, expected it around the game"
        )
    return tuple((round(place.x, 3), round(place.y, 3)) for place in found)


class _RefusalError(Exception):
    """Why a file is no fence for a game."""


def _refused(found: str, expected: str) -> _RefusalError:
    return _RefusalError(f"found {found}, expected {expected}")


def _read(data: bytes) -> GeoFence:
    head = data.lstrip(b"\xef\xbb\xbf \t\r\n")
    if head.startswith(b"{"):
        return _plan(head)
    if head.startswith(b"<"):
        return GeoFence(_kml(head), "KML")
    if head.startswith(b"PK"):
        raise _refused("a zipped file", "the KML inside it (unzip the KMZ)")
    try:
        lines = [line.split("#", 1)[0].split() for line in head.decode("utf-8").splitlines()]
    except UnicodeDecodeError:
        raise _refused("no text", FORMS) from None
    rows = [line for line in lines if line]
    if rows and rows[0][:2] == ["QGC", "WPL"]:
        return _waypoints(rows[1:])
    return GeoFence(_points(rows), "fence points")


def _one(found: Sequence[Corners]) -> Corners:
    """The one fence to stay in."""
    if len(found) != 1:
        raise _refused(f"{len(found)} fences to stay in" if found else "no fence", "one fence to stay in")
    if len(found[0]) < 3:
        raise _refused(f"a fence of {len(found[0])} corners", "three or more")
    return found[0]


def _circle(latitude: float, longitude: float, radius: float) -> Corners:
    if not radius > 0.0 or not -90.0 < latitude < 90.0:
        raise _refused(f"a circle of {radius:g} m at latitude {latitude:g}", "a positive radius on Earth")
    frame = Frame(latitude, longitude, 0.0)
    turns = [2.0 * pi * k / CIRCLE for k in range(CIRCLE)]
    places = [frame.geodetic_from_ned(Vec(radius * cos(t), radius * sin(t), 0.0)) for t in turns]
    return tuple((place.latitude_deg, place.longitude_deg) for place in places)


# ---------------------------------------------------------------------- QGroundControl


class _PlanPolygon(msgspec.Struct):
    polygon: tuple[tuple[float, float], ...]
    inclusion: bool = True


class _Round(msgspec.Struct):
    center: tuple[float, float]
    radius: float


class _PlanCircle(msgspec.Struct):
    circle: _Round
    inclusion: bool = True


class _GeoFence(msgspec.Struct):
    polygons: list[_PlanPolygon] = []
    circles: list[_PlanCircle] = []
    polygon: list[tuple[float, float]] = []  # of version 1


class _Plan(msgspec.Struct):
    geoFence: _GeoFence | None = None  # noqa: N815  (QGroundControl's word)


def _plan(data: bytes) -> GeoFence:
    try:
        plan = msgspec.json.decode(data, type=_Plan)
    except UNDECODABLE as error:
        raise _refused(f"no plan: {' '.join(str(error).split())}", "a QGroundControl .plan") from None
    fence = plan.geoFence or _GeoFence()
    areas = [area.polygon for area in fence.polygons if area.inclusion]
    areas += [_circle(*one.circle.center, one.circle.radius) for one in fence.circles if one.inclusion]
    areas += [tuple(fence.polygon)] if fence.polygon else []
    outs = [Out(area.polygon) for area in fence.polygons if not area.inclusion]
    outs += [Out((one.circle.center,), one.circle.radius) for one in fence.circles if not one.inclusion]
    return GeoFence(_one(areas), "QGroundControl plan", tuple(outs))


# ---------------------------------------------------------------------- MAVProxy, Mission Planner


def _points(rows: list[list[str]]) -> Corners:
    """Lines of latitude and longitude: the return point, then the polygon, whose last corner is its first."""
    points = [_numbers(row, 2) for row in rows]
    if len(points) < 5:
        ring_form = "a return point and a polygon, the first corner again at its end"
        raise _refused(f"{len(points)} points", ring_form if points else FORMS)
    _, *ring = points
    if ring[0] != ring[-1]:
        raise _refused(
            "a polygon that is not closed", "a return point first, and the first corner again at the end"
        )
    return tuple((row[0], row[1]) for row in ring[:-1])


def _waypoints(rows: list[list[str]]) -> GeoFence:
    """The items of a fence as today's MAVProxy saves them, each with its polygon's count of corners."""
    areas: list[Corners] = []
    corners: list[tuple[float, float]] = []
    kept_out: list[tuple[float, float]] = []
    outs: list[Out] = []
    for row in rows:
        number, _, _, command, count, *_, latitude, longitude, _, _ = _numbers(row, 12)
        if command == STAY_IN:
            corners.append((latitude, longitude))
            if len(corners) == count:
                areas.append(tuple(corners))
                corners = []
        elif command == CIRCLE_IN:
            areas.append(_circle(latitude, longitude, count))
        elif command == KEEP_OUT:
            kept_out.append((latitude, longitude))
            if len(kept_out) == count:
                outs.append(Out(tuple(kept_out)))
                kept_out = []
        elif command == CIRCLE_OUT:
            outs.append(Out(((latitude, longitude),), count))
        elif command != RETURN_POINT and number > 0:
            raise _refused(f"command {command:g}", "items of a fence (5000 to 5004)")
    if corners or kept_out:
        raise _refused("a polygon with fewer corners than it says", "a whole fence")
    return GeoFence(_one(areas), "fence items", tuple(outs))


def _numbers(row: list[str], count: int) -> list[float]:
    try:
        found = [float(cell) for cell in row]
    except ValueError:
        found = []
    if len(found) != count:
        raise _refused(f"'{' '.join(row)[:40]}'", f"{count} numbers a line, or {FORMS}")
    return found


# ---------------------------------------------------------------------- KML


def _kml(data: bytes) -> Corners:
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise _refused("a document type with entities", "plain KML")
    try:
        root = ElementTree.fromstring(data)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise _refused(f"no XML: {error}", "a KML file") from None
    polygons = _named(root, "Polygon")
    holes = sum(len(_named(polygon, "innerBoundaryIs")) for polygon in polygons)
    if holes:
        raise _refused(f"{holes} holes", "a polygon without any")
    rings = [ring for polygon in polygons for ring in _named(polygon, "coordinates")]
    if not polygons:
        rings = [ring for line in _named(root, "LineString") for ring in _named(line, "coordinates")]
    areas = [_ring(ring.text or "") for ring in rings]
    if not polygons and any(area[0] != area[-1] for area in areas if area):
        raise _refused("a line that is not closed", "a polygon")
    return _one([area[:-1] if area and area[0] == area[-1] else area for area in areas])


def _named(element: Any, name: str) -> list[Any]:
    """Elements of a name, whatever their namespace."""
    return [one for one in element.iter() if one.tag.rpartition("}")[2] == name]


def _ring(text: str) -> Corners:
    """KML's coordinates: longitude,latitude[,altitude], with blanks between corners."""
    corners = []
    for word in re.sub(r"\s*,\s*", ",", text).split():
        cells = [cell for cell in word.split(",") if cell]
        longitude, latitude, *_ = _numbers([*cells, "0"][:3], 3)
        corners.append((latitude, longitude))
    return tuple(corners)
