"""From a sensor's own terms to tracks of a game. Pure."""

from __future__ import annotations

from collections import Counter
from enum import Enum
from typing import NamedTuple

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import ZERO, Vec, norm
from onboard.wire.bus.messages import Track
from onboard.wire.geodesy import Frame

PRESSURE_SIGMA = 200.0  # [m] of a height that assumes 1013.25 hPa: 20 hPa are 163 m
QNH_SIGMA = 30.0  # [m] of one that was corrected by the air pressure of the day
ELLIPSOID_SIGMA = 60.0  # [m] of a height above the ellipsoid: the sea lies up to 100 m beside it
UNMEASURED = 1e4  # [m²/s²] variance of a velocity that nobody measured
MEASURED = 4.0  # [m²/s²] of one that a sensor gives
FAR_M = 500_000.0  # farther from the origin than this nothing plays
STILL = 1.0  # [m/s] what moves faster does not stay in one place
NUMBERS_MAX = 4096  # targets remembered, and counted by name


class Height(Enum):
    """What an altitude is above."""

    SEA = "mean sea level"
    PRESSURE = "the standard atmosphere's 1013.25 hPa"
    ELLIPSOID = "the ellipsoid of WGS-84"


class Report(NamedTuple):
    """One measurement in the terms of its source."""

    t: float  # [s] of the source's own clock
    number: str  # the source's name of the target, in capitals
    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above what `above` says
    velocity: Vec | None = None  # [m/s; ground, NED]
    sigma: float = 5.0  # [m] of the position, one sigma an axis
    above: Height = Height.SEA


class Corrections(NamedTuple):
    """What a person knows better than the source."""

    qnh_hpa: float | None = None  # air pressure of the day at mean sea level
    geoid_m: float | None = None  # mean sea level above the ellipsoid at the field (47 m in Zurich)


class Feed:
    """Turns reports into tracks of a game. What it leaves alone is counted, by cause, in `counts`.

    `ids` maps the source's numbers onto vehicles. A height that nobody corrects is passed on with the error
    that it may have.
    """

    def __init__(
        self, frame: Frame, ids: dict[str, int], sensor: str, known: Corrections | None = None
    ) -> None:
        self.counts: Counter[str] = Counter()
        self._frame, self._ids, self._sensor = frame, ids, sensor
        self._known = known or Corrections()
        self._last: dict[str, tuple[int, float, float, float]] = {}

    def track(self, report: Report, stamp_ns: int) -> Track | None:
        """The track of a report at a wall instant [ns since the epoch]; None for one that is left alone."""
        id = self._ids.get(report.number)
        if id is None:
            known = len(self.counts) < NUMBERS_MAX
            self.counts[f"not mapped: {report.number}" if known else "not mapped: others"] += 1
            return None
        here = (report.latitude_deg, report.longitude_deg, report.altitude_m)
        cause = self._unfit(report, stamp_ns, here)
        if cause:
            self.counts[cause] += 1
            return None
        altitude, vertical = self._height(report)
        place = self._frame.ned_from_geodetic(*here[:2], altitude)
        if not norm(place) < FAR_M:
            self.counts["farther than 500 km from the origin"] += 1
            return None
        self._last[report.number] = (stamp_ns, *here)
        self.counts["fed"] += 1
        sigma, high = report.sigma, max(report.sigma, vertical)
        v = UNMEASURED if report.velocity is None else MEASURED
        p, h = sigma * sigma, high * high
        moving = report.velocity or ZERO
        return Track(id, stamp_ns, (place.x, place.y, place.z), (moving.x, moving.y, moving.z),
                     (p, p, h, v, v, v), self._sensor)  # fmt: skip

    def _unfit(self, report: Report, stamp_ns: int, here: tuple[float, float, float]) -> str:
        """Why a report says nothing new or nothing at all; "" for a good one."""
        if report.latitude_deg == 0.0 and report.longitude_deg == 0.0:
            return "no position yet (0°, 0°)"
        last = self._last.get(report.number)
        if last is None:
            return "" if len(self._last) < NUMBERS_MAX else "too many targets"
        if stamp_ns <= last[0]:
            return "old"
        moves = report.velocity is not None and norm(report.velocity) > STILL
        return "place repeated while it moves" if moves and here == last[1:] else ""

    def _height(self, report: Report) -> tuple[float, float]:
        """Altitude above mean sea level and the least sigma of it [m], as well as they are known."""
        known, altitude = self._known, report.altitude_m
        if report.above is Height.PRESSURE:
            if known.qnh_hpa is None:
                return altitude, PRESSURE_SIGMA
            return altitude + 44330.77 * (1.0 - (1013.25 / known.qnh_hpa) ** 0.190263), QNH_SIGMA
        if report.above is Height.ELLIPSOID:
            return (altitude, ELLIPSOID_SIGMA) if known.geoid_m is None else (altitude - known.geoid_m, 0.0)
        return altitude, 0.0


def mapping(pairs: tuple[str, ...]) -> dict[str, int]:
    """NUMBER=ID pairs; numbers in capitals, for one receiver writes 4ca7b3 and another 4CA7B3.

    Raises ConfigError.
    """
    ids: dict[str, int] = {}
    for pair in pairs:
        number, _, id = pair.rpartition("=")
        if not number or not (id.isascii() and id.isdecimal()) or not 1 <= int(id) <= 250:
            raise ConfigError(f"--map: found '{pair}', expected NUMBER=ID with an id from 1 to 250")
        if int(id) in ids.values():
            raise ConfigError(f"--map: found id {id} twice, expected one number for each vehicle")
        ids[named(number)] = int(id)
    return ids


def named(number: str) -> str:
    """A target's number as it is compared."""
    return number.strip().upper()
