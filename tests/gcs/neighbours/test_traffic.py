"""Opponents' tracks for other programs: read back by pymavlink, by pytak and by plain geometry."""

from __future__ import annotations

import asyncio
import re
from contextlib import AsyncExitStack
from datetime import datetime
from math import radians, tan
from xml.etree import ElementTree as ET

import pymap3d
import pytak
import pytest
from msgspec.structs import replace
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs.neighbours.teller import Teller, cot_link, teller
from gcs.neighbours.traffic import OLD_S, adsb, callsign, cot
from gcs.settings import NeighbourSettings
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Member, Role
from onboard.wire.mavlink.frames import Sender
from tests.support.bus_stages import free_port
from tests.support.real_time import until
from tests.support.sample_messages import START_NS, Tower, setup, track


def seen(velocity: tuple[float, float, float] = (3.0, -4.0, -1.5), age_s: float = 0.0) -> Tower:
    """A game whose evader is known by a track 300 m north, 400 m west, 60 m above the origin."""
    tower = Tower()
    tower.hear(setup(2))
    tower.hear(
        track(1, position=(300.0, -400.0, -60.0), velocity=velocity, covariance=(4.0, 4.0, 9.0, 1, 1, 1))
    )
    if age_s:
        tower.wait(age_s)
    return tower


def read_back(frames: list[bytes]) -> list:
    parser = mavlink.MAVLink(None)
    return parser.parse_buffer(b"".join(frames))


def test_a_ground_station_reads_where_the_evader_is_and_where_it_flies() -> None:
    tower = seen()
    origin = tower.picture.game.setup.origin
    sender = Sender(254, mavlink.MAV_COMP_ID_ADSB)
    (told,) = read_back([sender.pack(report) for report in adsb(tower.picture)])
    assert told.get_type() == "ADSB_VEHICLE"
    place = pymap3d.ned2geodetic(
        300.0, -400.0, -60.0, origin.latitude_deg, origin.longitude_deg, origin.altitude_m
    )
    assert told.lat * 1e-7 == pytest.approx(place[0], abs=2e-7)
    assert told.lon * 1e-7 == pytest.approx(place[1], abs=2e-7)
    assert told.altitude * 1e-3 == pytest.approx(place[2], abs=0.05)
    assert told.altitude_type == mavlink.ADSB_ALTITUDE_TYPE_PRESSURE_QNH  # above mean sea level
    assert tan(radians(told.heading / 100.0)) == pytest.approx(-4.0 / 3.0, abs=1e-3)
    assert 270.0 < told.heading / 100.0 < 360.0  # north-west
    assert told.hor_velocity == 500
    assert told.ver_velocity == 150  # climbs
    assert told.callsign == "EVADER1"
    assert told.emitter_type == mavlink.ADSB_EMITTER_TYPE_UAV
    assert told.tslc == 0
    asked = (
        mavlink.ADSB_FLAGS_VALID_COORDS | mavlink.ADSB_FLAGS_VALID_ALTITUDE | mavlink.ADSB_FLAGS_VALID_HEADING
        | mavlink.ADSB_FLAGS_VALID_VELOCITY | mavlink.ADSB_FLAGS_VALID_CALLSIGN
    )  # fmt: skip
    assert told.flags & asked == asked
    assert not told.flags & mavlink.ADSB_FLAGS_VALID_SQUAWK
    assert 0x900000 <= told.ICAO_address <= 0x9FFFFF  # no state's, and no test obstacle of MAVProxy's


@pytest.mark.parametrize(
    "velocity", [(900.0, 0.0, 0.0), (0.0, 0.0, -900.0), (0.0, 0.0, 0.0), (-1e-9, -1e-12, 0.0)]
)
def test_whatever_a_sensor_claims_fits_the_wire(velocity: tuple[float, float, float]) -> None:
    sender = Sender(254, mavlink.MAV_COMP_ID_ADSB)
    (told,) = read_back([sender.pack(report) for report in adsb(seen(velocity).picture)])
    assert 0 <= told.heading < 36000


def test_an_old_track_is_told_with_its_age_and_then_no_more() -> None:
    assert [round(report.age_s) for report in adsb(seen(age_s=3.0).picture)] == [3]
    tower = seen(age_s=OLD_S + 0.1)
    assert adsb(tower.picture) == []
    assert cot(tower.picture) == []
    assert adsb(Tower().picture) == []  # nor before the origin is known


def test_an_event_of_cursor_on_target_says_what_is_known_and_takes_no_side() -> None:
    tower = seen()
    (event,) = cot(tower.picture)
    root = ET.fromstring(event)
    assert root.tag == "event"
    assert root.get("version") == "2.0"
    atoms = root.get("type").split("-")
    assert atoms[:3] == ["a", "u", "A"]  # an atom, unknown, in the air: neither friend nor foe
    times = [datetime.fromisoformat(root.get(name)) for name in ("start", "time", "stale")]
    assert times == sorted(times)
    assert (times[2] - times[1]).total_seconds() == 10.0
    assert times[0].timestamp() == pytest.approx(START_NS / NS_PER_S, abs=0.001)
    point = root.find("point")
    assert float(point.get("ce")) == pytest.approx(2.0 * 8.0**0.5, abs=0.1)
    assert float(point.get("le")) == pytest.approx(6.0)
    assert root.find("detail/track").get("course") == "306.9"
    assert root.find("detail/contact").get("callsign") == "EVADER1"
    later = ET.fromstring(cot(seen().picture)[0])
    assert later.get("uid") == root.get("uid")  # one mark that moves


def test_names_fit_their_fields() -> None:
    picture = seen().picture
    assert callsign(picture, 1) == "EVADER1"
    assert callsign(picture, 250) == "TRACK250"
    tower = Tower()
    roster = tuple(Member(id, Role.EVADER, 10.0, (0.0, 0.0, 0.0)) for id in range(1, 251))
    tower.hear(replace(setup(2), roster=roster))
    names = [callsign(tower.picture, id) for id in (1, 12, 99, 100, 120, 129, 250)]
    assert len({*names}) == len(names), "evader 12 and evader 120 are two"
    assert max(map(len, names)) <= 8


@pytest.mark.parametrize(
    "wrong",
    ["", "udp:1.2.3.4:1", "udp://:8087", "udp://host", "tls://host:8089", "udp://h:99999", "udp://h:8/x"],
)
def test_an_address_that_is_none_is_told(wrong: str) -> None:
    with pytest.raises(
        ConfigError, match=re.escape(f"neighbours.cot: found {wrong!r}, expected udp://HOST:PORT")
    ):
        cot_link(wrong)


@pytest.mark.real
async def test_pytak_hears_the_events_and_pymavlink_the_reports_on_real_sockets() -> None:
    cot_port, adsb_port = free_port(), free_port()
    events: asyncio.Queue = asyncio.Queue()
    heard = []

    class Frames(asyncio.DatagramProtocol):
        def datagram_received(self, data: bytes, addr: object) -> None:
            heard.extend(mavlink.MAVLink(None).parse_buffer(data) or [])

    loop = asyncio.get_running_loop()
    wire, _ = await loop.create_datagram_endpoint(Frames, local_addr=("127.0.0.1", adsb_port))
    reader, _writer = await pytak.protocol_factory({"COT_URL": f"udp+broadcast://127.0.0.1:{cot_port}"})
    worker = pytak.RXWorker(events, {"COT_URL": "udp://127.0.0.1"}, reader)
    settings = NeighbourSettings(adsb=(f"udpout://127.0.0.1:{adsb_port}",), cot=f"udp://127.0.0.1:{cot_port}")
    tower = seen()
    tower.fly(1.0, 2)
    tower.hear(track(1))
    picture = tower.picture
    async with AsyncExitStack() as stack:
        made = await teller(lambda: picture, settings, stack)
        assert isinstance(made, Teller)
        reading = asyncio.create_task(worker.run(1))
        telling = asyncio.create_task(made.run())
        await until(lambda: len(heard) >= 2)
        async with asyncio.timeout(60.0):
            event = await events.get()
        telling.cancel()
        reading.cancel()
        await asyncio.gather(telling, reading, return_exceptions=True)
    wire.close()
    assert [message.get_type() for message in heard[:2]] == ["HEARTBEAT", "ADSB_VEHICLE"]
    assert heard[0].type == mavlink.MAV_TYPE_ADSB
    assert {m.get_srcSystem() for m in heard} == {2}, "aboard the pursuer, for that is what is looked at"
    assert {m.get_srcComponent() for m in heard} == {mavlink.MAV_COMP_ID_ADSB}
    assert ET.fromstring(event).get("uid") == "apollonius.test.track.1"
