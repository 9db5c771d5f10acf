"""The example that feeds tracks from the field does what its page says."""

from __future__ import annotations

import asyncio
import importlib.util
import os
import pty
import sys
import tty

import pytest

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec, distance
from onboard.runtime.bus_memory import MemoryBroker
from onboard.wire.bus.topics import TRACK
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.frames import Framer
from tests.support.paths import ROOT
from tests.support.real_time import until

FILE = ROOT / "examples" / "field-tracks" / "feed_tracks.py"
spec = importlib.util.spec_from_file_location("feed_tracks", FILE)
assert spec is not None
assert spec.loader is not None
feed_tracks = importlib.util.module_from_spec(spec)
sys.modules["feed_tracks"] = feed_tracks
spec.loader.exec_module(feed_tracks)

ORIGIN = (47.397742, 8.545594, 488.0)
FLAGS = (
    dialect.ADSB_FLAGS_VALID_COORDS
    | dialect.ADSB_FLAGS_VALID_ALTITUDE
    | dialect.ADSB_FLAGS_VALID_HEADING
    | dialect.ADSB_FLAGS_VALID_VELOCITY
)


def adsb_frame(icao: int, north_m: float) -> bytes:
    """The frame of an ADSB_VEHICLE that flies east at 40 m/s."""
    place = Frame(*ORIGIN).geodetic_from_ned(Vec(north_m, 0.0, -100.0))
    message = dialect.MAVLink_adsb_vehicle_message(
        icao, round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7), 1, 588_000, 9000, 4000, 0,
        b"TEST1", 0, 0, FLAGS, 0,
    )  # fmt: skip
    return DialectSender(1, 156).pack(message)


def adsb(icao: int, north_m: float):
    """The same as it comes from a wire."""
    (packet,) = Framer().feed(adsb_frame(icao, north_m))
    return packet.value


def test_an_adsb_target_becomes_the_track_of_the_vehicle_it_is_mapped_to():
    feed = feed_tracks.Feed(Frame(*ORIGIN), {"4CA7B3": 1}, "adsb")
    report = feed_tracks.from_adsb(adsb(0x4CA7B3, 300.0), 10.0)
    track = feed.track(report, 5_000)
    assert (track.id, track.stamp_ns, track.sensor) == (1, 5_000, "adsb")
    assert distance(Vec(*track.position), Vec(300.0, 0.0, -100.0)) < 0.1
    assert track.velocity == pytest.approx((0.0, 40.0, 0.0), abs=1e-9)


def test_a_number_that_is_not_mapped_is_counted_and_left_alone():
    feed = feed_tracks.Feed(Frame(*ORIGIN), {"4CA7B3": 1}, "adsb")
    assert feed.track(feed_tracks.from_adsb(adsb(0xABCDEF, 0.0), 0.0), 0) is None
    assert feed.counts == {"not mapped: ABCDEF": 1}


def test_a_csv_file_is_read_with_and_without_velocities(tmp_path):
    file = tmp_path / "track.csv"
    file.write_text(
        "t,track,latitude_deg,longitude_deg,altitude_m,vn,ve,vd\n"
        "0.0,radar-17,47.397742,8.545594,538,1,2,3\n0.5,radar-17,47.397743,8.545594,538,,,\n"
    )
    one, two = feed_tracks.read_csv(file)
    assert (one.number, one.velocity, two.velocity) == ("radar-17", Vec(1.0, 2.0, 3.0), None)
    feed = feed_tracks.Feed(Frame(*ORIGIN), {"radar-17": 1}, "csv")
    known, unknown = feed.track(one, 0), feed.track(two, 1)
    assert known.position == pytest.approx((0.0, 0.0, -50.0), abs=1e-6)
    assert unknown.covariance[3] > 1000.0  # nobody measured a velocity


@pytest.mark.parametrize("cell", ["nan", "far", ""])
def test_a_bad_cell_is_named_with_its_line(tmp_path, cell):
    file = tmp_path / "track.csv"
    file.write_text(f"t,track,latitude_deg,longitude_deg,altitude_m\n0,a,47,8,500\n1,a,{cell},8,500\n")
    with pytest.raises(ConfigError, match=r"track\.csv: line 3: latitude_deg: found .*finite number"):
        list(feed_tracks.read_csv(file))


@pytest.mark.parametrize("pair", ["4CA7B3", "4CA7B3=", "=1", "a=0", "a=251", "a=x"])
def test_a_bad_mapping_is_refused(pair):
    with pytest.raises(ConfigError, match="NUMBER=ID"):
        feed_tracks.mapping([pair])


@pytest.mark.real
async def test_an_adsb_receiver_on_a_serial_port_is_heard():
    """A receiver's line brings its bytes in pieces of any size."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    broker, feed = MemoryBroker(), feed_tracks.Feed(Frame(*ORIGIN), {"4CA7B3": 1}, "adsb")
    bus, ground = broker.connect(), broker.connect()
    tracks = []
    ground.subscribe(TRACK.key("g", 1), lambda sample: tracks.append(sample.payload), every=True)
    task = asyncio.create_task(feed_tracks.hear_adsb(feed, f"{os.ttyname(slave)},57600", bus, "g"))
    frames = b"".join(adsb_frame(0x4CA7B3, 300.0) for _ in range(20))
    await asyncio.sleep(0.1)
    for at in range(0, len(frames), 31):
        os.write(master, frames[at : at + 31])
        await asyncio.sleep(0.001)
    await until(lambda: len(tracks) == 20)
    task.cancel()
    os.close(master)
    os.close(slave)
