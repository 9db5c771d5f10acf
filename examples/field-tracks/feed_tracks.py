"""Feeds tracks from the field into a game: from ADS-B messages on a MAVLink link, or from a CSV file.

    python feed_tracks.py --origin 47.3977,8.5456,488 --map 4CA7B3=1 --mavlink udpin://0.0.0.0:14560
    python feed_tracks.py --origin 47.3977,8.5456,488 --map radar-17=1 --csv track.csv

Foreign track numbers (an ICAO address in hexadecimal, or what the CSV file calls `track`) become vehicle
ids by --map NUMBER=ID; what is not mapped is counted and left alone. CSV columns:
t,track,latitude_deg,longitude_deg,altitude_m[,vn,ve,vd][,sigma]; it is played at the speed of its `t`.
"""

from __future__ import annotations

import argparse
import asyncio
import csv
import sys
from collections import Counter
from collections.abc import Hashable, Iterator
from math import isfinite
from pathlib import Path
from typing import NamedTuple

from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO, Vec
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.clock import RealClock
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Bus
from onboard.wire.bus.messages import Track
from onboard.wire.bus.topics import DEFAULT_GAME, TRACK
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.frames import PeerFramers
from onboard.wire.mavlink.values import AdsbVehicle

ADSB_SIGMA = 30.0  # [m] what a position of a small ADS-B transmitter is worth, unless told


class Report(NamedTuple):
    """One measurement in the terms of its source."""

    t: float  # [s] of the source's own clock
    number: str  # the source's name of the track
    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level
    velocity: Vec | None  # [m/s; ground, NED]
    sigma: float  # [m]


class Feed:
    """Turns foreign reports into tracks of a game; plain, so that a test needs no socket."""

    def __init__(self, frame: Frame, ids: dict[str, int], sensor: str) -> None:
        self.counts: Counter[str] = Counter()
        self._frame = frame
        self._ids = ids
        self._sensor = sensor

    def track(self, report: Report, stamp_ns: int) -> Track | None:
        """The track of a report at a wall instant; None (and one more in `counts`) where there is none."""
        id = self._ids.get(report.number)
        if id is None:
            self.counts[f"not mapped: {report.number}"] += 1
            return None
        self.counts["fed"] += 1
        place = self._frame.ned_from_geodetic(report.latitude_deg, report.longitude_deg, report.altitude_m)
        p = report.sigma * report.sigma
        v = 4.0 if report.velocity is not None else 1e4  # a velocity nobody measured is worth little
        return Track(
            id, stamp_ns, tuple(place), tuple(report.velocity or ZERO), (p, p, p, v, v, v), self._sensor
        )


def from_adsb(value: AdsbVehicle, t: float) -> Report | None:
    """The report of an ADSB_VEHICLE message received at `t`; None without a valid position."""
    if not value.position_valid:
        return None
    velocity = value.velocity if value.velocity_valid else None
    return Report(
        t - value.age_s, f"{value.icao:06X}", value.latitude_deg, value.longitude_deg, value.altitude_m,
        velocity, ADSB_SIGMA,
    )  # fmt: skip


def read_csv(path: Path) -> Iterator[Report]:
    """Reports of a CSV file, in order. Raises ConfigError naming file, line and column."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    for line, row in enumerate(rows, start=2):

        def cell(
            name: str, otherwise: float | None = None, row: dict[str, str] = row, line: int = line
        ) -> float:
            text = row.get(name)
            if text in (None, "") and otherwise is not None:
                return otherwise
            try:
                value = float(text or "")
            except ValueError:
                value = float("nan")
            if not isfinite(value):
                raise ConfigError(f"{path}: line {line}: {name}: found {text!r}, expected a finite number")
            return value

        moving = all(row.get(name) for name in ("vn", "ve", "vd"))
        velocity = Vec(cell("vn"), cell("ve"), cell("vd")) if moving else None
        yield Report(
            cell("t"), row.get("track") or "",
            cell("latitude_deg"), cell("longitude_deg"), cell("altitude_m"),
            velocity, cell("sigma", 5.0),
        )  # fmt: skip


def options(arguments: list[str]) -> argparse.Namespace:
    """The command line."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--origin", required=True, help="LAT,LON,ALT of the game frame [deg, deg, m MSL]")
    parser.add_argument("--map", action="append", default=[], metavar="NUMBER=ID", help="may be repeated")
    parser.add_argument("--game", default=DEFAULT_GAME)
    parser.add_argument("--bus", default=None, help="Zenoh endpoint")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--mavlink", help="link URL to hear ADSB_VEHICLE on")
    source.add_argument("--csv", type=Path, help="file to play")
    return parser.parse_args(arguments)


def mapping(pairs: list[str]) -> dict[str, int]:
    """NUMBER=ID pairs. Raises ConfigError."""
    ids = {}
    for pair in pairs:
        number, _, id = pair.partition("=")
        if not number or not id.isdigit() or not 1 <= int(id) <= 250:
            raise ConfigError(f"--map: found '{pair}', expected NUMBER=ID with an id from 1 to 250")
        ids[number] = int(id)
    return ids


def origin(text: str) -> Frame:
    """LAT,LON,ALT. Raises ConfigError."""
    try:
        latitude, longitude, altitude = (float(part) for part in text.split(","))
    except ValueError:
        raise ConfigError(f"--origin: found '{text}', expected LAT,LON,ALT") from None
    return Frame(latitude, longitude, altitude)


async def play_csv(feed: Feed, path: Path, bus: Bus, game: str) -> None:
    """Play a file at the speed of its own clock."""
    clock = RealClock()
    began_ns, first = clock.wall_ns(), None
    for report in read_csv(path):
        first = report.t if first is None else first
        stamp_ns = began_ns + round((report.t - first) * NS_PER_S)
        await asyncio.sleep(max(0.0, (stamp_ns - clock.wall_ns()) / NS_PER_S))
        publish(feed.track(report, stamp_ns), bus, game)


async def hear_adsb(feed: Feed, url: str, bus: Bus, game: str) -> None:
    """Feed what arrives on a link, until ended."""
    clock, framers = RealClock(), PeerFramers()
    link = await open_link(url)

    def arrived(data: bytes, peer: Hashable) -> None:
        for packet in framers.feed(peer, data):
            value = packet.value
            if isinstance(value, AdsbVehicle):
                stamp_ns = clock.wall_ns() - round(value.age_s * NS_PER_S)
                report = from_adsb(value, stamp_ns / NS_PER_S)
                if report is not None:
                    publish(feed.track(report, stamp_ns), bus, game)

    link.receive(arrived)
    try:
        while True:
            await asyncio.sleep(10.0)
            heard = ", ".join(f"{cause} {n}" for cause, n in feed.counts.items())
            print(heard or "nothing heard", file=sys.stderr)
    finally:
        link.close()


def publish(track: Track | None, bus: Bus, game: str) -> None:
    """Put a track on the bus."""
    if track is not None:
        bus.publish(TRACK.key(game, track.id), TRACK.encode(track), TRACK.delivery)


async def main(arguments: list[str]) -> None:
    """Run until the file or the patience ends."""
    given = options(arguments)
    sensor = "csv" if given.csv else "adsb"
    feed = Feed(origin(given.origin), mapping(given.map), sensor)
    bus = await open_zenoh(given.bus)
    try:
        if given.csv:
            await play_csv(feed, given.csv, bus, given.game)
        else:
            await hear_adsb(feed, given.mavlink, bus, given.game)
    finally:
        await bus.close()
    print(", ".join(f"{cause} {n}" for cause, n in feed.counts.items()), file=sys.stderr)


if __name__ == "__main__":
    try:
        asyncio.run(main(sys.argv[1:]))
    except ConfigError as error:
        sys.exit(f"feed_tracks: {error}")
    except KeyboardInterrupt:
        sys.exit(130)
