"""`gcs tracks`: puts what sensors of the field see on the bus, on the keys that the simulated sensor uses."""

from __future__ import annotations

import asyncio
import sys
import urllib.request
from collections import Counter
from collections.abc import Callable, Coroutine, Hashable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple
from urllib.error import URLError

from gcs.settings import Settings
from gcs.tracks.from_mavlink import MavlinkReports
from gcs.tracks.from_text import AircraftReports, SbsReports, read_csv
from gcs.tracks.report import Corrections, Feed, Report
from onboard.config.printable import printable
from onboard.config.strict import ConfigError
from onboard.config.table_file import text_of
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.clock import RealClock
from onboard.runtime.link_urls import parse_link
from onboard.runtime.links import open_link
from onboard.runtime.off_loop import off_loop
from onboard.runtime.protocols import Bus
from onboard.wire.bus.messages import Setup
from onboard.wire.bus.topics import SETUP, TRACK, Dispatcher
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.frames import PeerFramers

TELL_S = 10.0  # between two lines about what is heard
POLL_S = 0.5  # receivers rewrite their document every second
ANSWER_S = 5.0  # for a document of a receiver on the network
DOCUMENT_MAX = 1 << 24  # [bytes]
LINE_MAX = 1024  # [bytes] of an SBS line


class Wanted(NamedTuple):
    """What is to be fed."""

    source: str
    ids: dict[str, int]  # number of a target → vehicle
    origin: tuple[float, float, float] | None  # [deg, deg, m]; None: the game's, once its setup is heard
    known: Corrections


def origin_of(text: str) -> tuple[float, float, float] | None:
    """LAT,LON,ALT in deg, deg and m above mean sea level; None for "". Raises ConfigError."""
    if not text:
        return None
    try:
        latitude, longitude, altitude = (float(part) for part in text.split(","))
        Frame(latitude, longitude, altitude)
    except ValueError:
        raise ConfigError(f"--origin: found '{text}', expected LAT,LON,ALT in deg, deg, m") from None
    return latitude, longitude, altitude


async def run(settings: Settings, wanted: Wanted) -> int:
    """Feed until the source ends or one is interrupted; exit code 1 where nothing was fed.

    Raises ConfigError.
    """
    zenoh = Path(settings.bus.zenoh) if settings.bus.zenoh else None
    play = _source(wanted.source)
    bus = await open_zenoh(settings.bus.endpoint or None, config_file=zenoh)
    try:
        frame = Frame(*(wanted.origin or await _game_origin(bus, settings.game)))
        feed = Feed(frame, wanted.ids, wanted.source, wanted.known)

        def take(report: Report, stamp_ns: int) -> None:
            track = feed.track(report, stamp_ns)
            if track is not None:
                bus.publish(TRACK.key(settings.game, track.id), TRACK.encode(track), TRACK.delivery)

        telling = asyncio.create_task(_tell(feed))
        try:
            await play(take)
        finally:
            telling.cancel()
            print(_heard(feed), file=sys.stderr, flush=True)
    finally:
        await bus.close()
    return 0 if feed.counts["fed"] else 1


Take = Callable[[Report, int], None]  # (report, wall instant it is of [ns since the epoch])
Play = Callable[[Take], Coroutine[Any, Any, None]]


def _source(name: str) -> Play:
    """What plays a source, by its scheme or its ending; files are read here. Raises ConfigError."""
    path, scheme = Path(name), name.partition("://")[0].lower()
    if scheme in ("http", "https"):
        return lambda take: _poll(lambda: _fetch(name), name, take)
    if scheme == "sbs":
        host, _, port = name.removeprefix("sbs://").rpartition(":")
        if not host or not port.isdecimal():
            raise ConfigError(f"source: found '{name}', expected sbs://HOST:PORT, e.g. sbs://127.0.0.1:30003")
        return lambda take: _sbs(host.strip("[]"), int(port), take)
    if path.suffix.lower() == ".csv":
        reports = read_csv(path)
        return lambda take: _play(reports, take)
    if path.suffix.lower() in (".sbs", ".txt"):
        reader = SbsReports()
        found = [report for line in text_of(path).splitlines() if (report := reader.take(line)) is not None]
        return lambda take: _play(sorted(found, key=lambda report: report.t), take)
    if path.suffix.lower() == ".json":
        list(AircraftReports().take(text_of(path).encode(), name, 0.0))  # what is wrong is told at once
        return lambda take: _poll(lambda: text_of(path).encode(), name, take)
    try:
        parse_link(name)
    except ConfigError as error:
        raise ConfigError(
            f"source: {error}; or sbs://HOST:PORT, http://…/aircraft.json, a file ending in .csv, "
            ".json or .sbs"
        ) from None
    return lambda take: _mavlink(name, take)


async def _play(reports: list[Report], take: Take) -> None:
    """Play reports at the speed of their own clock, from now on."""
    clock = RealClock()
    began_ns = clock.wall_ns()
    for report in reports:
        stamp_ns = began_ns + round((report.t - reports[0].t) * NS_PER_S)
        await asyncio.sleep(max(0.0, (stamp_ns - clock.wall_ns()) / NS_PER_S))
        take(report, stamp_ns)


async def _mavlink(url: str, take: Take) -> None:
    """Take what arrives on a link, until cancelled."""
    clock, reader = RealClock(), MavlinkReports()
    link = await open_link(url)
    framers = PeerFramers()

    def arrived(data: bytes, peer: Hashable) -> None:
        now = clock.wall_ns() / NS_PER_S
        for packet in framers.feed(peer, data):
            report = reader.take(packet, now)
            if report is not None:
                take(report, round(report.t * NS_PER_S))

    link.receive(arrived)
    try:
        await asyncio.Event().wait()
    finally:
        link.close()


async def _sbs(host: str, port: int, take: Take) -> None:
    """Take the lines that a receiver serves, over and over where it goes away, until cancelled."""
    clock, reader = RealClock(), SbsReports()
    while True:
        with suppress(OSError, asyncio.IncompleteReadError, ValueError):  # ValueError: a line too long
            stream, writer = await asyncio.open_connection(host, port, limit=LINE_MAX)
            try:
                while line := await stream.readline():
                    now_ns = clock.wall_ns()
                    report = reader.take(line.decode("ascii", errors="replace"), now_ns / NS_PER_S)
                    if report is not None:
                        take(report, now_ns)
            finally:
                writer.close()
        await asyncio.sleep(POLL_S)


async def _poll(read: Callable[[], bytes], name: str, take: Take) -> None:
    """Read a receiver's document again and again, until cancelled. Reading is done off the loop."""
    clock, reader = RealClock(), AircraftReports()
    while True:
        with suppress(ConfigError):  # it is being rewritten, or the receiver is away for a moment
            content = await off_loop(read)
            for report in reader.take(content, name, clock.wall_ns() / NS_PER_S):
                take(report, round(report.t * NS_PER_S))
        await asyncio.sleep(POLL_S)


def _fetch(url: str) -> bytes:
    try:
        with urllib.request.urlopen(url, timeout=ANSWER_S) as answer:
            content: bytes = answer.read(DOCUMENT_MAX)
            return content
    except (URLError, OSError, ValueError) as error:
        raise ConfigError(f"{url}: {error}") from None


async def _game_origin(bus: Bus, game: str) -> tuple[float, float, float]:
    """The origin of the game that is played, once a master has told it."""
    print(f"gcs: waits for the setup of game {game} (or give --origin)", file=sys.stderr, flush=True)
    heard: asyncio.Queue[Setup] = asyncio.Queue()
    hear = Dispatcher(Counter()).on(SETUP, heard.put_nowait)
    subscription = bus.subscribe(SETUP.key(game), hear)
    try:
        setup = await heard.get()
        return setup.origin.latitude_deg, setup.origin.longitude_deg, setup.origin.altitude_m
    finally:
        subscription.close()


async def _tell(feed: Feed) -> None:
    while True:
        await asyncio.sleep(TELL_S)
        print(_heard(feed), file=sys.stderr, flush=True)


def _heard(feed: Feed) -> str:
    """What was heard so far, in a line."""
    parts = [f"{cause} {n}" for cause, n in feed.counts.most_common(12)]
    return printable(f"gcs: {', '.join(parts) or 'nothing heard'}")
