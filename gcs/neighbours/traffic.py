"""Opponents' tracks as other programs of the field draw them: MAVLink's ADS-B, Cursor-on-Target. Pure.

Only tracks leave, never own vehicles: ground stations hear those from their autopilots.
"""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from math import atan2, degrees, sqrt
from xml.etree import ElementTree as ET

from gcs.picture.values import Picture, TrackView
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.wire.bus.messages import Role
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.values import AdsbVehicle

OLD_S = 5.0  # a track that was silent for longer is not told any more
ICAO_BASE = 0x9FF000  # of a block that no state has; MAVProxy takes those from 0xA00000 on for test obstacles
STALE_S = 10.0  # after which a display of Cursor-on-Target lets a mark fade
COT_TYPE = "a-u-A"  # an atom of unknown affiliation in the air: what it is, is not known here


def located(picture: Picture) -> list[tuple[TrackView, Frame]]:
    """The fresh tracks and the frame that they are in; none before the game's origin is known."""
    setup = picture.game.setup
    if setup is None:
        return []
    frame = Frame(setup.origin.latitude_deg, setup.origin.longitude_deg, setup.origin.altitude_m)
    return [(track, frame) for track in picture.tracks if track.age_s <= OLD_S]


def callsign(picture: Picture, id: int) -> str:
    """A name of eight characters at most: `EVADER1`, `EVAD120`, `TRACK7`; no two have one name."""
    setup = picture.game.setup
    roster = setup.roster if setup is not None else ()
    evaders = {member.id for member in roster if member.role is Role.EVADER}
    word = "TRACK" if id not in evaders else "EVADER" if id < 100 else "EVAD"
    return f"{word}{id}"[:8]


def adsb(picture: Picture) -> list[AdsbVehicle]:
    """What ADSB_VEHICLE says of each track; heights above mean sea level."""
    found = []
    for view, frame in located(picture):
        place = frame.geodetic_from_ned(Vec(*view.track.position))
        found.append(
            AdsbVehicle(
                icao=ICAO_BASE + view.id,
                callsign=callsign(picture, view.id),
                latitude_deg=place.latitude_deg,
                longitude_deg=place.longitude_deg,
                altitude_m=place.altitude_m,
                geometric=False,
                velocity=Vec(*view.track.velocity),
                age_s=view.age_s,
                position_valid=True,
                velocity_valid=True,
            )
        )
    return found


def cot(picture: Picture, kind: str = COT_TYPE) -> list[bytes]:
    """An event of Cursor-on-Target (version 2.0) for each track, affiliation unknown.

    `hae` is the height above mean sea level: the geoid is not known here. `ce` and `le` are two sigmas of
    what the sensor states.
    """
    found = []
    for view, frame in located(picture):
        track = view.track
        place = frame.geodetic_from_ned(Vec(*track.position))
        north, east, _ = track.velocity
        told = ET.Element("event", {
            "version": "2.0", "uid": f"apollonius.{picture.game.name}.track.{view.id}", "type": kind,
            "how": "m-f", "time": _instant(picture.now_ns), "start": _instant(track.stamp_ns),
            "stale": _instant(picture.now_ns, STALE_S),
        })  # fmt: skip
        level = 2.0 * sqrt(max(0.0, track.covariance[0] + track.covariance[1]))
        ET.SubElement(told, "point", {
            "lat": f"{place.latitude_deg:.7f}", "lon": f"{place.longitude_deg:.7f}",
            "hae": f"{place.altitude_m:.2f}", "ce": f"{level:.1f}",
            "le": f"{2.0 * sqrt(max(0.0, track.covariance[2])):.1f}",
        })  # fmt: skip
        detail = ET.SubElement(told, "detail")
        ET.SubElement(detail, "contact", {"callsign": callsign(picture, view.id)})
        ET.SubElement(detail, "track", {
            "course": f"{degrees(atan2(east, north)) % 360.0:.1f}",
            "speed": f"{sqrt(north * north + east * east):.2f}",
        })  # fmt: skip
        ET.SubElement(detail, "remarks").text = f"track {view.id} of game {picture.game.name}"
        found.append(ET.tostring(told, encoding="utf-8", xml_declaration=True))
    return found


def _instant(at_ns: int, later_s: float = 0.0) -> str:
    """Time as CoT writes it: UTC with milliseconds."""
    at = datetime.fromtimestamp(at_ns // NS_PER_S, UTC) + timedelta(seconds=later_s)
    return f"{at:%Y-%m-%dT%H:%M:%S}.{at_ns % NS_PER_S // 1_000_000:03d}Z"
