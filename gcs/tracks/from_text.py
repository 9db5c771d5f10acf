"""Reports in texts of receivers and files: CSV, SBS (BaseStation) lines, JSON of ADS-B receivers. Pure."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from math import cos, isfinite, radians, sin
from pathlib import Path
from typing import Any

import msgspec

from gcs.tracks.report import Height, Report, named
from onboard.config.strict import ConfigError
from onboard.config.table_file import Row, demand_seconds, read_table
from onboard.config.undecodable import UNDECODABLE
from onboard.core.math.vectors import Vec

FOOT, KNOT = 0.3048, 1852.0 / 3600.0  # [m], [m/s]
ADSB_SIGMA = 30.0  # [m] where the receiver does not state it
EPU = {11: 3.0, 10: 10.0, 9: 30.0, 8: 92.6, 7: 185.2, 6: 555.6}  # [m, 95 %] by NACp (DO-260B)
FRESH_S = 5.0  # a velocity older than this says nothing of a position
ALIASES = {
    "t": ("time", "timestamp", "t_s", "time_s"),
    "track": ("id", "icao", "icao24", "hex", "number", "name"),
    "latitude_deg": ("latitude", "lat", "lat_deg"),
    "longitude_deg": ("longitude", "lon", "lng", "long", "lon_deg"),
    "altitude_m": ("altitude", "alt", "alt_m", "altitude_msl_m", "geoaltitude"),
    "vn": ("v_north_m_s",), "ve": ("v_east_m_s",), "vd": ("v_down_m_s",),
    "sigma": ("sigma_m",),
}  # fmt: skip
NEEDED = ("t", "latitude_deg", "longitude_deg", "altitude_m")


def read_csv(path: Path) -> list[Report]:
    """Reports of a table, in the order of their time. Columns (or usual names for them):
    `t,track,latitude_deg,longitude_deg,altitude_m[,vn,ve,vd][,sigma]` in s, deg, m above mean sea level, m/s.

    Raises ConfigError naming file, line and column.
    """
    found = sorted((_row(row) for row in read_table(path, ALIASES, NEEDED)), key=lambda report: report.t)
    demand_seconds(path, [report.t for report in found])
    return found


def _row(row: Row) -> Report:
    moving = all(row.cells.get(name) for name in ("vn", "ve", "vd"))
    velocity = Vec(row.number("vn"), row.number("ve"), row.number("vd")) if moving else None
    latitude, longitude = row.number("latitude_deg"), row.number("longitude_deg")
    for name, value, most in (("latitude_deg", latitude, 90.0), ("longitude_deg", longitude, 180.0)):
        if abs(value) > most:
            raise ConfigError(f"{row.place}: {name}: found {value:g}, expected −{most:g} to {most:g} deg")
    sigma = row.number("sigma", 5.0)
    if sigma < 0.0:
        raise ConfigError(f"{row.place}: sigma: found {sigma:g}, expected zero or more [m]")
    return Report(row.number("t"), named(row.cells.get("track", "")), latitude, longitude,
                  row.number("altitude_m"), velocity, sigma)  # fmt: skip


class SbsReports:
    """Lines of a BaseStation (SBS-1) stream, as receivers serve it on port 30003.

    Positions (MSG 2, 3) get the velocity that the same target told last (MSG 4).
    """

    def __init__(self) -> None:
        self._velocities: dict[str, tuple[float, Vec]] = {}

    def take(self, line: str, now: float | None = None) -> Report | None:
        """The report of a line; its instant is `now` [s], or what the line says. None for any other line."""
        cells = [cell.strip() for cell in line.split(",")]
        if len(cells) < 17 or cells[0] != "MSG":
            return None
        number, t = named(cells[4]), _line_time(cells) if now is None else now
        if t is None or not number:
            return None
        if cells[1] == "4" and (velocity := _velocity(cells[12], cells[13], cells[16])) is not None:
            if number in self._velocities or len(self._velocities) < 4096:
                self._velocities[number] = (t, velocity)
            return None
        altitude, latitude, longitude = map(_number, (cells[11], cells[14], cells[15]))
        if cells[1] not in ("2", "3") or altitude is None or latitude is None or longitude is None:
            return None
        told = self._velocities.get(number)
        moving = told[1] if told is not None and t - told[0] <= FRESH_S else None
        return Report(t, number, latitude, longitude, altitude * FOOT, moving, ADSB_SIGMA,
                      Height.PRESSURE)  # fmt: skip


def _line_time(cells: list[str]) -> float | None:
    """When the message was generated [s since the epoch]; receivers write it without a zone."""
    text = f"{cells[6]} {cells[7]}"
    for form in ("%Y/%m/%d %H:%M:%S.%f", "%Y/%m/%d %H:%M:%S"):
        try:
            return datetime.strptime(text, form).replace(tzinfo=UTC).timestamp()
        except ValueError:
            continue
    return None


class AircraftReports:
    """The document that dump1090, readsb and their kin rewrite every second (`aircraft.json`)."""

    def __init__(self) -> None:
        self._now = 0.0

    def take(self, content: bytes, name: str, now: float) -> Iterator[Report]:
        """The reports of a document read at `now` [s since the epoch]; none where it is the last one still.

        Raises ConfigError for one that is no such document.
        """
        try:
            document = msgspec.json.decode(content)
        except UNDECODABLE as error:
            raise ConfigError(f"{name}: {error}, expected the JSON of an ADS-B receiver") from None
        aircraft = document.get("aircraft") if isinstance(document, dict) else None
        if not isinstance(aircraft, list):
            raise ConfigError(f"{name}: found no list `aircraft`, expected the JSON of an ADS-B receiver")
        written = _number(document.get("now"))
        if written is not None and written == self._now:
            return
        self._now = now if written is None else written
        offset = 0.0 if written is None or abs(now - written) > FRESH_S else now - written
        for entry in aircraft:
            report = _aircraft(entry, now - offset) if isinstance(entry, dict) else None
            if report is not None:
                yield report


def _aircraft(entry: dict[str, Any], now: float) -> Report | None:
    latitude, longitude = _number(entry.get("lat")), _number(entry.get("lon"))
    geometric, barometric = _number(entry.get("alt_geom")), _number(entry.get("alt_baro"))
    altitude = barometric if geometric is None else geometric
    if latitude is None or longitude is None or altitude is None:
        return None
    climb = entry.get("geom_rate", entry.get("baro_rate", 0.0))
    velocity = _velocity(entry.get("gs"), entry.get("track"), climb)
    epu = EPU.get(entry.get("nac_p", 0) if isinstance(entry.get("nac_p", 0), int) else 0)
    sigma = ADSB_SIGMA if epu is None else epu / 2.45  # 95 % of a plane's normal distribution
    t = now - (_number(entry.get("seen_pos")) or 0.0)
    return Report(t, named(str(entry.get("hex", ""))), latitude, longitude, altitude * FOOT, velocity, sigma,
                  Height.PRESSURE if geometric is None else Height.ELLIPSOID)  # fmt: skip


def _velocity(speed_kt: Any, course_deg: Any, climb_ft_min: Any) -> Vec | None:
    speed, course, climb = _number(speed_kt), _number(course_deg), _number(climb_ft_min)
    if speed is None or course is None:
        return None
    v, a = speed * KNOT, radians(course)
    return Vec(v * cos(a), v * sin(a), -(climb or 0.0) * FOOT / 60.0)


def _number(cell: Any) -> float | None:
    try:
        value = float(cell)
    except (TypeError, ValueError):
        return None
    return value if isfinite(value) else None
