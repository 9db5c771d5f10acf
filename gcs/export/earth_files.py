"""A run for maps and globes: KML 2.2 (Google Earth), GPX 1.1, CZML (Cesium).

Heights are above mean sea level in all three. CZML's are meant above the ellipsoid, which a run does not
know: over terrain a globe shows it off by the height of the geoid, some tens of metres.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any
from xml.etree import ElementTree as ET

from gcs.export.run_data import RunData
from gcs.export.ways import KINDS, Ruled, Way, iso, ruled, ways
from onboard.core.geometry.zones import ENDLESS
from onboard.core.math.vectors import Vec
from onboard.game import palette
from onboard.wire.bus.messages import Zone
from onboard.wire.geodesy import Frame

GX = "http://www.google.com/kml/ext/2.2"
KML = "http://www.opengis.net/kml/2.2"
ENDLESS_DRAWN_M = 500.0  # height of a zone without end on a globe
GPX = "http://www.topografix.com/GPX/1/1"


def as_kml(data: RunData) -> dict[str, bytes]:
    """One file: ways with instants, rules with the time that they were in force, targets, fence and zones."""
    found = ways(data)
    root = ET.Element("kml", {"xmlns": KML, "xmlns:gx": GX})
    document = ET.SubElement(root, "Document")
    _text(document, "name", data.name)
    for colour in sorted({way.colour for way in found}):
        style = ET.SubElement(document, "Style", {"id": _style(colour)})
        for what, width in (("IconStyle", None), ("LineStyle", "2")):
            part = ET.SubElement(style, what)
            _text(part, "color", f"ff{colour[5:7]}{colour[3:5]}{colour[1:3]}")
            if width is not None:
                _text(part, "width", width)
    for kind, said in KINDS.items():
        of_kind = [way for way in found if way.kind == kind]
        if of_kind:
            folder = ET.SubElement(document, "Folder")
            _text(folder, "name", said)
            for way in of_kind:
                _kml_way(folder, way)
    _kml_rules(document, data)
    _kml_still(document, data)
    return {"run.kml": _xml(root)}


def _kml_way(folder: ET.Element, way: Way) -> None:
    mark = ET.SubElement(folder, "Placemark")
    _text(mark, "name", way.name)
    _text(mark, "styleUrl", f"#{_style(way.colour)}")
    track = ET.SubElement(mark, "gx:Track")
    _text(track, "altitudeMode", "absolute")
    for spot in way.spots:
        _text(track, "when", iso(spot.stamp_ns))
    for spot in way.spots:
        _text(track, "gx:coord", f"{spot.longitude_deg:.8f} {spot.latitude_deg:.8f} {spot.altitude_m:.3f}")


def _kml_rules(document: ET.Element, data: RunData) -> None:
    folder = ET.SubElement(document, "Folder")
    _text(folder, "name", "decisions")
    _text(folder, "visibility", "0")
    for band in ruled(data):
        mark = ET.SubElement(folder, "Placemark")
        _text(mark, "name", f"{data.called(band.id)}: {band.rule}")
        _text(mark, "visibility", "0")
        _text(mark, "description", band.words)
        span = ET.SubElement(mark, "TimeSpan")
        _text(span, "begin", iso(band.begin_ns))
        _text(span, "end", iso(band.end_ns))
        _kml_point(mark, band.spot.longitude_deg, band.spot.latitude_deg, band.spot.altitude_m)


def _kml_still(document: ET.Element, data: RunData) -> None:
    """Targets, fence and zones, which do not move."""
    assert data.origin is not None
    frame = Frame(data.origin.latitude_deg, data.origin.longitude_deg, data.origin.altitude_m)
    for name, goal in data.named_targets():
        mark = ET.SubElement(document, "Placemark")
        _text(mark, "name", name)
        spot = frame.geodetic_from_ned(Vec(*goal))
        _kml_point(mark, spot.longitude_deg, spot.latitude_deg, spot.altitude_m)
    fence = data.setup.fence if data.setup is not None else None
    if fence is not None:
        mark = ET.SubElement(document, "Placemark")
        _text(mark, "name", f"fence, {fence.altitude_min:g} to {fence.altitude_max:g} m above the origin")
        line = ET.SubElement(mark, "LineString")
        _text(line, "altitudeMode", "absolute")
        _text(line, "coordinates", _kml_ring(frame, fence.polygon, fence.altitude_max))
    for zone in data.setup.zones if data.setup is not None else ():
        mark = ET.SubElement(document, "Placemark")
        _text(mark, "name", f"zone {zone.name}, {_levels(zone)}")
        area = ET.SubElement(mark, "Polygon")
        if zone.high < ENDLESS:
            _text(area, "extrude", "1")
            _text(area, "altitudeMode", "absolute")
        else:
            _text(area, "altitudeMode", "clampToGround")
        ring = ET.SubElement(ET.SubElement(area, "outerBoundaryIs"), "LinearRing")
        _text(ring, "coordinates", _kml_ring(frame, zone.polygon, zone.high if zone.high < ENDLESS else 0.0))


def _levels(zone: Zone) -> str:
    low = f"from {zone.low:g} m" if zone.low > -ENDLESS else "from the ground"
    return f"{low} up" + (f" to {zone.high:g} m above the origin" if zone.high < ENDLESS else " without end")


def _kml_ring(frame: Frame, polygon: tuple[tuple[float, float], ...], up: float) -> str:
    """The corners of a closed ring at a height above the origin [m]."""
    spots = [frame.geodetic_from_ned(Vec(n, e, -up)) for n, e in [*polygon, polygon[0]]]
    return " ".join(f"{s.longitude_deg:.8f},{s.latitude_deg:.8f},{s.altitude_m:.3f}" for s in spots)


def _kml_point(mark: ET.Element, longitude: float, latitude: float, altitude: float) -> None:
    point = ET.SubElement(mark, "Point")
    _text(point, "altitudeMode", "absolute")
    _text(point, "coordinates", f"{longitude:.8f},{latitude:.8f},{altitude:.3f}")


def _style(colour: str) -> str:
    return f"colour-{colour[1:]}"


def as_gpx(data: RunData) -> dict[str, bytes]:
    """One file: a track for each way, a waypoint where a rule took over."""
    found = ways(data)
    root = ET.Element("gpx", {"xmlns": GPX, "version": "1.1", "creator": "Apollonius"})
    metadata = ET.SubElement(root, "metadata")
    _text(metadata, "name", data.name)
    _text(metadata, "time", iso(data.t0_ns))
    for band in ruled(data):
        _gpx_spot(root, "wpt", band)
    for way in found:
        track = ET.SubElement(root, "trk")
        _text(track, "name", way.name)
        _text(track, "type", KINDS[way.kind])
        segment = ET.SubElement(track, "trkseg")
        for spot in way.spots:
            place = {"lat": f"{spot.latitude_deg:.8f}", "lon": f"{spot.longitude_deg:.8f}"}
            point = ET.SubElement(segment, "trkpt", place)
            _text(point, "ele", f"{spot.altitude_m:.3f}")
            _text(point, "time", iso(spot.stamp_ns))
    return {"run.gpx": _xml(root)}


def _gpx_spot(root: ET.Element, tag: str, band: Ruled) -> None:
    place = {"lat": f"{band.spot.latitude_deg:.8f}", "lon": f"{band.spot.longitude_deg:.8f}"}
    point = ET.SubElement(root, tag, place)
    _text(point, "ele", f"{band.spot.altitude_m:.3f}")
    _text(point, "time", iso(band.begin_ns))
    _text(point, "name", f"{band.id}: {band.rule}")
    _text(point, "desc", band.words)


def as_czml(data: RunData) -> dict[str, bytes]:
    """One file: each way moves through its time, with its rule and its setpoint; targets, fence and
    zones stand."""
    found = ways(data)
    begin = iso(min(way.spots[0].stamp_ns for way in found))
    end = iso(max(way.spots[-1].stamp_ns for way in found))
    clock = {"interval": f"{begin}/{end}", "currentTime": begin, "multiplier": 1}
    packets: list[dict[str, Any]] = [{"id": "document", "name": data.name, "version": "1.0", "clock": clock}]
    bands = ruled(data)
    packets += _czml_still(data)
    packets += [_packet(way, data, [band for band in bands if band.id == way.id]) for way in found]
    return {"run.czml": json.dumps(packets, separators=(",", ":"), ensure_ascii=False).encode()}


def _czml_still(data: RunData) -> list[dict[str, Any]]:
    """Targets as points, zones and fence as prisms."""
    assert data.origin is not None
    frame = Frame(data.origin.latitude_deg, data.origin.longitude_deg, data.origin.altitude_m)
    found: list[dict[str, Any]] = []
    for number, (name, goal) in enumerate(data.named_targets()):
        found.append({
            "id": f"target-{number}", "name": name,
            "position": {"cartographicDegrees": _degrees(frame, goal[0], goal[1], -goal[2])},
            "point": {"pixelSize": 12, "color": {"rgba": _rgba(palette.TARGET, 255)}},
            "label": {"text": name, "font": "12px sans-serif", "pixelOffset": {"cartesian2": [12, -12]}},
        })  # fmt: skip
    if data.setup is None:
        return found
    prisms = [(f"zone-{number}", zone.name, zone.polygon, (zone.low, zone.high), palette.ZONE)
              for number, zone in enumerate(data.setup.zones)]  # fmt: skip
    if data.setup.fence is not None:
        fence = data.setup.fence
        band = (fence.altitude_min, fence.altitude_max)
        prisms.append(("fence", "fence", fence.polygon, band, palette.FENCE))
    for id, name, polygon, (low, high), colour in prisms:
        low, high = max(low, 0.0), high if high < ENDLESS else ENDLESS_DRAWN_M
        corners = [value for n, e in polygon for value in _degrees(frame, n, e, low)]
        found.append({
            "id": id, "name": name,
            "polygon": {
                "positions": {"cartographicDegrees": corners}, "height": frame.origin.altitude_m + low,
                "extrudedHeight": frame.origin.altitude_m + high, "fill": id != "fence", "outline": True,
                "material": {"solidColor": {"color": {"rgba": _rgba(colour, 80)}}},
                "outlineColor": {"rgba": _rgba(colour, 255)},
            },
        })  # fmt: skip
    return found


def _degrees(frame: Frame, north: float, east: float, up: float) -> list[float]:
    spot = frame.geodetic_from_ned(Vec(north, east, -up))
    return [round(spot.longitude_deg, 8), round(spot.latitude_deg, 8), round(spot.altitude_m, 3)]


def _rgba(colour: palette.Colour, alpha: int) -> list[int]:
    return [*(int(colour.light[part : part + 2], 16) for part in (1, 3, 5)), alpha]


def _packet(way: Way, data: RunData, bands: list[Ruled]) -> dict[str, Any]:
    epoch_ns = way.spots[0].stamp_ns
    places: list[float] = []
    for spot in way.spots:
        at = round((spot.stamp_ns - epoch_ns) / 1e9, 3)
        places += [at, round(spot.longitude_deg, 8), round(spot.latitude_deg, 8), round(spot.altitude_m, 3)]
    colour = [int(way.colour[part : part + 2], 16) for part in (1, 3, 5)]
    own = way.kind == "states"
    solid = {"solidColor": {"color": {"rgba": [*colour, 255 if own else 110]}}}
    packet: dict[str, Any] = {
        "id": f"{way.kind}-{way.id}",
        "name": way.name,
        "availability": f"{iso(epoch_ns)}/{iso(way.spots[-1].stamp_ns)}",
        "position": {"epoch": iso(epoch_ns), "cartographicDegrees": places},
        "path": {"width": 2 if own else 1, "material": solid, "leadTime": 0},
    }
    if own:
        packet["point"] = {"pixelSize": 10, "color": {"rgba": [*colour, 255]}}
        texts: list[dict[str, str]] = [
            {"interval": f"{iso(band.begin_ns)}/{iso(band.end_ns)}", "string": f"{way.name} {band.rule}"}
            for band in bands
        ]
        packet["label"] = {"text": texts or way.name, "font": "12px sans-serif", "pixelOffset":
                           {"cartesian2": [12, -12]}, "fillColor": {"rgba": [*colour, 255]}}  # fmt: skip
        packet["properties"] = _setpoints(way, data, epoch_ns)
    return packet


def _setpoints(way: Way, data: RunData, epoch_ns: int) -> dict[str, Any]:
    """The setpoints of a vehicle as properties that change with time."""
    sent = data.setpoints.of(way.id)
    if not sent.rows:
        return {}
    seconds = ((sent["stamp_ns"] - epoch_ns) / 1e9).round(3).tolist()
    found = {}
    for name in ("v_north_m_s", "v_east_m_s", "v_down_m_s"):
        pairs = zip(seconds, sent[name].round(3).tolist(), strict=True)
        numbers = [value for pair in pairs for value in pair]
        found[f"setpoint_{name}"] = {"epoch": iso(epoch_ns), "number": numbers}
    return found


def _text(parent: ET.Element, tag: str, text: str) -> None:
    ET.SubElement(parent, tag).text = "".join(sign for sign in text if sign >= " " or sign in "\t\n")


def _xml(root: ET.Element) -> bytes:
    ET.indent(root, " ")
    found: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return found + b"\n"


WRITERS: dict[str, Callable[[RunData], dict[str, bytes]]] = {"kml": as_kml, "gpx": as_gpx, "czml": as_czml}
