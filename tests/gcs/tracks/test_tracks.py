"""Tracks from the field: what sensors and receivers say becomes what a game may fly on."""

from __future__ import annotations

import json
from math import cos, radians

import pytest

from gcs.tracks.from_mavlink import MavlinkReports
from gcs.tracks.from_text import AircraftReports, SbsReports, read_csv
from gcs.tracks.report import Corrections, Feed, Height, Report, mapping
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec, distance
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.paths import ROOT

ORIGIN = (47.397742, 8.545594, 488.0)
FLAGS = (
    dialect.ADSB_FLAGS_VALID_COORDS
    | dialect.ADSB_FLAGS_VALID_ALTITUDE
    | dialect.ADSB_FLAGS_VALID_HEADING
    | dialect.ADSB_FLAGS_VALID_VELOCITY
)
RECORDINGS = ROOT / "tests" / "field" / "recordings"


def heard(message, system: int = 1, component: int = 1, now: float = 100.0, reports=None) -> Report | None:
    """The report of a message as it comes from a wire."""
    (packet,) = Framer().feed(DialectSender(system, component).pack(message))
    return (reports or MavlinkReports()).take(packet, now)


def adsb(kind: int = 1, altitude_m: float = 588.0, age: int = 2):
    """Flying east at 40 m/s, 300 m north of the origin."""
    place = Frame(*ORIGIN).geodetic_from_ned(Vec(300.0, 0.0, -100.0))
    return dialect.MAVLink_adsb_vehicle_message(
        0x4CA7B3, round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7), kind,
        round(altitude_m * 1e3), 9000, 4000, 0, b"TEST1", 0, age, FLAGS, 0,
    )  # fmt: skip


def test_an_adsb_target_becomes_the_track_of_the_vehicle_it_is_mapped_to():
    report = heard(adsb())
    assert report is not None
    assert (report.t, report.number, report.above) == (98.0, "4CA7B3", Height.ELLIPSOID)
    feed = Feed(Frame(*ORIGIN), mapping(("4ca7b3=1",)), "adsb", Corrections(geoid_m=0.0))
    track = feed.track(report, 5_000)
    assert track is not None
    assert (track.id, track.stamp_ns, track.sensor) == (1, 5_000, "adsb")
    assert distance(Vec(*track.position), Vec(300.0, 0.0, -100.0)) < 0.1
    assert track.velocity == pytest.approx((0.0, 40.0, 0.0), abs=1e-9)


@pytest.mark.parametrize(
    ("message", "known", "height", "sigma"),
    [
        # On a day of 1033 hPa a pressure altitude lies 163 m below the true one (8.25 m a hPa).
        (adsb(kind=0), Corrections(), 100.0, 200.0),
        (adsb(kind=0), Corrections(qnh_hpa=1033.0), 263.0, 30.0),
        # The sea at Zurich lies 47 m above the ellipsoid.
        (adsb(kind=1), Corrections(), 100.0, 60.0),
        (adsb(kind=1), Corrections(geoid_m=47.0), 53.0, 30.0),
    ],
)
def test_a_height_is_worth_what_is_known_of_its_zero(message, known, height, sigma):
    report = heard(message)
    assert report is not None
    track = Feed(Frame(*ORIGIN), {"4CA7B3": 1}, "adsb", known).track(report, 5_000)
    assert track is not None
    assert -track.position[2] == pytest.approx(height, abs=1.0)
    assert track.covariance[2] == pytest.approx(sigma**2)
    assert track.covariance[0] == pytest.approx(30.0**2)


def test_the_own_position_of_any_autopilot_is_a_report_and_a_cameras_copy_is_none():
    place = dialect.MAVLink_global_position_int_message(
        7, 473_977_420, 85_455_940, 538_000, 0, 300, -400, 50, 0
    )
    report = heard(place, system=7)
    assert report is not None
    assert (report.number, report.above, report.velocity) == ("7", Height.SEA, Vec(3.0, -4.0, 0.5))
    assert heard(place, system=7, component=100) is None


def test_open_drone_id_is_known_by_its_uas_id_as_soon_as_that_is_heard():
    mac = list(bytes.fromhex("aabbccddeeff") + bytes(14))

    def where(direction: int = 9000, geodetic: float = 588.0):
        return dialect.MAVLink_open_drone_id_location_message(
            0, 0, mac, 2, direction, 1500, -100, 474_004_400, 85_455_940, 500.0, geodetic, 1, 50.0, 10,
            4, 4, 3, 0.0, 0,
        )  # fmt: skip

    reports = MavlinkReports()
    first = heard(where(), reports=reports)
    identity = dialect.MAVLink_open_drone_id_basic_id_message(0, 0, mac, 1, 2, b"1596A3".ljust(20, b"\0"))
    assert heard(identity, reports=reports) is None
    second, still, low = (heard(where(*x), reports=reports) for x in ((9000,), (36100,), (9000, -1000.0)))
    assert first is not None
    assert second is not None
    assert still is not None
    assert low is not None
    assert first.number == "AABBCCDDEEFF" + "00" * 14
    assert (second.number, second.above, second.altitude_m) == ("1596A3", Height.ELLIPSOID, 588.0)
    assert second.velocity == pytest.approx(Vec(0.0, 15.0, 1.0), abs=1e-9)
    assert second.sigma == pytest.approx(10.0 / 2.45)
    assert still.velocity is None
    assert (low.above, low.altitude_m) == (Height.PRESSURE, 500.0)


def test_a_recorded_flight_is_fed_where_it_flew_and_as_fast_as_it_moved():
    entries = list(read_tlog((RECORDINGS / "arducopter-4.5.6-guided.tlog").read_bytes()))
    reports, feed, tracks = MavlinkReports(), None, []
    for entry in entries:
        report = reports.take(entry.packet, entry.stamp_ns / NS_PER_S)
        if report is None:
            continue
        if feed is None and report.latitude_deg:
            feed = Feed(Frame(report.latitude_deg, report.longitude_deg, report.altitude_m), {"1": 1}, "x")
        if feed is not None and (track := feed.track(report, entry.stamp_ns)) is not None:
            tracks.append(track)
    assert len(tracks) > 500
    assert {track.id for track in tracks} == {1}
    worst = 0.0
    for before, after in zip(tracks, tracks[20:], strict=False):
        dt = (after.stamp_ns - before.stamp_ns) / NS_PER_S
        if 0.5 < dt < 4.0:
            gone = distance(Vec(*after.position), Vec(*before.position)) / dt
            worst = max(worst, gone)
    assert 3.0 < worst < 15.0  # what the story beside the recording flies: 5 m/s, climbs, a return


@pytest.mark.parametrize(
    ("reports", "fed"),
    [
        ([Report(0.0, "A", 0.0, 0.0, 0.0)], {"no position yet (0°, 0°)": 1}),
        ([Report(0.0, "A", -33.0, 151.0, 0.0)], {"farther than 500 km from the origin": 1}),
        ([Report(0.0, "B", 47.4, 8.5, 500.0)], {"not mapped: B": 1}),
        ([Report(t, "A", 47.4, 8.5, 500.0, Vec(60.0, 0.0, 0.0)) for t in (0.0, 1.0, 2.0)],
         {"fed": 1, "place repeated while it moves": 2}),
        ([Report(t, "A", 47.4, 8.5, 500.0, Vec(0.1, 0.0, 0.0)) for t in (0.0, 1.0, 2.0)], {"fed": 3}),
        ([Report(t, "A", 47.4 + t, 8.5, 500.0) for t in (0.2, 0.1)], {"fed": 1, "old": 1}),
    ],
)  # fmt: skip
def test_what_says_nothing_is_left_alone_and_counted(reports, fed):
    feed = Feed(Frame(*ORIGIN), {"A": 1}, "x")
    for report in reports:
        feed.track(report, NS_PER_S + round(report.t * NS_PER_S))
    assert dict(feed.counts) == fed


ROWS = """t,track,latitude_deg,longitude_deg,altitude_m,vn,ve,vd
0.5,radar-17,47.1,8.5,538,,,
0.0,radar-17,47,8.5,538,1,2,3
"""


@pytest.mark.parametrize(
    "content",
    [
        ROWS.encode(),
        b"\xef\xbb\xbf" + ROWS.encode(),
        ROWS.encode("utf-16"),
        ("# Zürich\n" + ROWS).encode("latin-1"),
        ROWS.replace("\n", "\r\n\r\n").encode(),
        ROWS.replace(",", " , ").encode(),
        ROWS.replace(".", ";").replace(",", "|").replace(";", ",").replace("|", ";").encode(),
        ROWS.replace(",", "\t").encode(),
        ROWS.replace("latitude_deg", "Lat")
        .replace("longitude_deg", "lng")
        .replace("track", "icao24")
        .encode(),
    ],
    ids=["plain", "mark", "utf-16", "latin-1", "crlf", "blanks", "semicolons", "tabs", "names"],
)
def test_a_table_is_read_as_people_write_it(tmp_path, content):
    file = tmp_path / "track.csv"
    file.write_bytes(content)
    one, two = read_csv(file)
    assert (one.t, one.number, one.latitude_deg, one.velocity) == (0.0, "RADAR-17", 47.0, Vec(1.0, 2.0, 3.0))
    assert (two.t, two.latitude_deg, two.velocity) == (0.5, 47.1, None)
    feed = Feed(Frame(*ORIGIN), mapping(("radar-17=1",)), "csv")
    unknown = feed.track(two, 1)
    assert unknown is not None
    assert unknown.covariance[3] > 1000.0  # nobody measured a velocity


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("t,track,latitude_deg,longitude_deg,altitude_m\n0,a,47,8,500\n1,a,nan,8,500\n",
         "line 3: latitude_deg: found 'nan', expected a finite number"),
        ("t,track,latitude_deg,longitude_deg,altitude_m\n0,a,,8,500\n", "line 2: latitude_deg: found ''"),
        ("t,track,latitude_deg,longitude_deg,altitude_m\n0,a,473977420,8,500\n", "expected −90 to 90 deg"),
        ("t,track,north,east\n0,a,1,2\n", "latitude_deg: found columns t, track, north, east, expected"),
        ("", "found no rows"),
        ("t,lat,lon,alt\n" + "".join(f"{1_780_000_000_000 + 100 * k},47,8,500\n" for k in range(9)),
         "t: found steps of 100, expected seconds"),
        ("t,lat,lon,alt,sigma\n0,47,8,500,-1\n", "sigma: found -1, expected zero or more"),
    ],
)  # fmt: skip
def test_a_table_that_cannot_be_is_refused_with_the_place(tmp_path, content, says):
    file = tmp_path / "track.csv"
    file.write_text(content)
    with pytest.raises(ConfigError) as refused:
        read_csv(file)
    assert says in str(refused.value)
    assert str(refused.value).startswith(str(file))


@pytest.mark.parametrize("pair", ["4CA7B3", "4CA7B3=", "=1", "a=0", "a=251", "a=x", "a=²"])
def test_a_bad_mapping_is_refused(pair):
    with pytest.raises(ConfigError, match="NUMBER=ID"):
        mapping((pair,))


def test_two_targets_cannot_be_one_vehicle():
    with pytest.raises(ConfigError, match="id 1 twice"):
        mapping(("a=1", "b=1"))


def sbs(kind: int, **cells: str) -> str:
    named = {"altitude": 11, "speed": 12, "course": 13, "lat": 14, "lon": 15, "climb": 16}
    row = [
        "MSG",
        str(kind),
        "1",
        "1",
        "4ca7b3",
        "1",
        "2026/11/25",
        "10:00:00.500",
        "2026/11/25",
        "10:00:00.600",
    ]
    row += [""] * 12
    for name, text in cells.items():
        row[named[name]] = text
    return ",".join(row) + "\r\n"


def test_lines_of_a_basestation_stream_carry_place_and_the_velocity_told_before():
    reader = SbsReports()
    assert reader.take(sbs(4, speed="100", course="90", climb="-600")) is None
    report = reader.take(sbs(3, altitude="1000", lat="47.4", lon="8.5"))
    assert report is not None
    assert (report.number, report.latitude_deg, report.above) == ("4CA7B3", 47.4, Height.PRESSURE)
    assert report.altitude_m == pytest.approx(304.8)
    assert report.velocity == pytest.approx(Vec(0.0, 51.444, 3.048), abs=1e-3)
    assert report.t == 1_795_600_800.5
    late = reader.take(sbs(3, altitude="1000", lat="47.4", lon="8.5"), now=report.t + 10.0)
    assert late is not None
    assert late.velocity is None  # what it told ten seconds ago says nothing of now
    for line in ("", "MSG,3", "SEL,,496,2286,4CA4E5,27215", sbs(3, lat="47.4"), "x" * 5000, "MSG," * 30):
        assert reader.take(line) is None


AIRCRAFT = {"now": 1_780_000_000.0, "aircraft": [
    {"hex": "4ca7b3", "lat": 47.4, "lon": 8.5, "alt_geom": 2000, "alt_baro": 1900, "gs": 50.0, "track": 180.0,
     "geom_rate": 600, "seen_pos": 1.5, "nac_p": 9},
    {"hex": "~2a1b", "lat": 47.5, "lon": 8.6, "alt_baro": 1900},
    {"hex": "000000", "alt_baro": "ground", "lat": 1, "lon": 1}, {"hex": "1"}, 7,
]}  # fmt: skip


def test_the_document_of_a_receiver_is_read_once_each_time_it_is_written():
    reader = AircraftReports()
    content = json.dumps(AIRCRAFT).encode()
    first, second = reader.take(content, "aircraft.json", 1_780_000_001.0)
    assert (first.number, first.above, second.above) == ("4CA7B3", Height.ELLIPSOID, Height.PRESSURE)
    assert first.t == pytest.approx(1_779_999_998.5)  # when the position was seen
    assert first.altitude_m == pytest.approx(609.6)
    assert first.velocity == pytest.approx(Vec(25.722 * cos(radians(180.0)), 0.0, -3.048), abs=1e-3)
    assert first.sigma == pytest.approx(30.0 / 2.45)
    assert list(reader.take(content, "aircraft.json", 1_780_000_002.0)) == []


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"aircraft": 3}', b"\xff\xfe"])
def test_what_is_no_document_of_a_receiver_is_refused(content):
    with pytest.raises(ConfigError, match=r"a\.json"):
        list(AircraftReports().take(content, "a.json", 0.0))
