"""A run as GeoJSON (RFC 7946): ways as lines with their instants, target, fence.

Places are longitude, latitude and the height above mean sea level, where the RFC means the ellipsoid: a run
does not know the geoid.
"""

from __future__ import annotations

import json
from typing import Any

from gcs.export.run_data import RunData
from gcs.export.ways import iso, ruled, ways
from onboard.core.geometry.zones import ENDLESS
from onboard.core.math.vectors import Vec
from onboard.wire.geodesy import Frame

Feature = dict[str, Any]


def as_geojson(data: RunData) -> dict[str, bytes]:
    """One collection of features; `times` of a way has an instant for each of its places."""
    found: list[Feature] = []
    for way in ways(data):
        places = [_place(s.longitude_deg, s.latitude_deg, s.altitude_m) for s in way.spots]
        told = {
            "name": way.name, "id": way.id, "kind": way.kind, "stroke": way.colour,
            "times": [iso(spot.stamp_ns) for spot in way.spots],
        }  # fmt: skip
        shape = {"type": "LineString", "coordinates": places if len(places) > 1 else places * 2}
        found.append(_feature(shape, told))
    for band in ruled(data):
        spot = band.spot
        place = _place(spot.longitude_deg, spot.latitude_deg, spot.altitude_m)
        told = {
            "name": f"{data.called(band.id)}: {band.rule}", "id": band.id, "kind": "rule", "rule": band.rule,
            "begin": iso(band.begin_ns), "end": iso(band.end_ns), "description": band.words,
        }  # fmt: skip
        found.append(_feature({"type": "Point", "coordinates": place}, told))
    found += _still(data)
    collection = {"type": "FeatureCollection", "features": found}
    text = json.dumps(collection, ensure_ascii=False, separators=(",", ":"))
    return {"run.geojson": text.encode()}


def _still(data: RunData) -> list[Feature]:
    """Targets, fence and zones, which do not move. Rings run against the clock, as the RFC asks."""
    if data.origin is None:
        return []
    frame = Frame(data.origin.latitude_deg, data.origin.longitude_deg, data.origin.altitude_m)

    def at(north: float, east: float, down: float) -> list[float]:
        spot = frame.geodetic_from_ned(Vec(north, east, down))
        return _place(spot.longitude_deg, spot.latitude_deg, spot.altitude_m)

    found: list[Feature] = []
    for (name, goal), whose in zip(data.named_targets(), data.targets, strict=True):
        place = {"type": "Point", "coordinates": at(*goal)}
        told = {"name": name, "kind": "target"} | ({"evader": whose.evader} if whose.evader else {})
        found.append(_feature(place, told))
    if data.setup is None:
        return found
    prisms = [(zone.name, "zone", zone.polygon, zone.low, zone.high) for zone in data.setup.zones]
    if data.setup.fence is not None:
        fence = data.setup.fence
        prisms.append(("fence", "fence", fence.polygon, fence.altitude_min, fence.altitude_max))
    for name, kind, corners, low, high in prisms:
        around = zip(corners, [*corners[1:], corners[0]], strict=True)
        twice = sum(n0 * e1 - n1 * e0 for (n0, e0), (n1, e1) in around)  # > 0: from north to east
        ring = corners[::-1] if twice > 0.0 else corners
        up = next((level for level in (high, low) if abs(level) < ENDLESS), 0.0)
        places = [at(north, east, -up) for north, east in [*ring, ring[0]]]
        levels = {"floor_m": low, "ceiling_m": high}
        about = {"name": name, "kind": kind} | {
            key: level for key, level in levels.items() if abs(level) < ENDLESS
        }
        found.append(_feature({"type": "Polygon", "coordinates": [places]}, about))
    return found


def _place(longitude: float, latitude: float, altitude: float) -> list[float]:
    return [round(longitude, 8), round(latitude, 8), round(altitude, 3)]


def _feature(shape: dict[str, Any], told: dict[str, Any]) -> Feature:
    return {"type": "Feature", "geometry": shape, "properties": told}
