"""The recorder beside a station: run folders, telemetry logs, and a full disk as an alert."""

from __future__ import annotations

import asyncio
import threading
from collections import Counter
from pathlib import Path

import pytest
from pymavlink import mavutil

from gcs.recording.file import OsFile
from gcs.recording.reader import Recording
from gcs.recording.shell import StationRecorder
from gcs.recording.tlog import TlogRecorder
from gcs.station import Station, StationSetup
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.file_writer import FileWriter
from onboard.runtime.links import memory_pair
from onboard.runtime.loop import virtual_clock
from onboard.runtime.run_folder import new_run
from onboard.wire.bus import topics
from onboard.wire.bus.topics import Delivery
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.chase_messages import EPOCH_NS, chase
from tests.support.virtual_time import virtual


def heartbeat(sender: DialectSender) -> bytes:
    return sender.pack(dialect.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3))


def test_each_vehicles_frames_land_in_its_own_log_and_pymavlink_reads_it(tmp_path: Path) -> None:
    logs = TlogRecorder(tmp_path)
    one, two = DialectSender(1, 1), DialectSender(2, 1)
    for second in range(10):
        at_ns = EPOCH_NS + second * NS_PER_S
        logs.datagram(heartbeat(one), "a", at_ns)
        logs.datagram(heartbeat(two) + heartbeat(two), "b", at_ns + 1000)
        logs.datagram(b"noise", "c", at_ns)
    logs.close()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["vehicle-1.tlog", "vehicle-2.tlog"]
    reader = mavutil.mavlink_connection(str(tmp_path / "vehicle-2.tlog"))
    stamps = []
    while (message := reader.recv_match()) is not None:
        assert (message.get_type(), message.get_srcSystem()) == ("HEARTBEAT", 2)
        stamps.append(message._timestamp)
    assert len(stamps) == 20
    assert stamps[0] == pytest.approx(EPOCH_NS / NS_PER_S, abs=1e-3)
    assert logs.causes["garbage_bytes"] == 50


def test_a_log_that_exists_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "vehicle-1.tlog").write_bytes(b"mine")
    logs = TlogRecorder(tmp_path)
    logs.datagram(heartbeat(DialectSender(1, 1)), "a", EPOCH_NS)
    logs.close()
    assert (tmp_path / "vehicle-1.tlog").read_bytes() == b"mine"
    assert len(list(read_tlog((tmp_path / "vehicle-1-2.tlog").read_bytes()))) == 1


def test_a_full_disk_stops_a_log_and_room_continues_it_without_a_gap(tmp_path: Path) -> None:
    room = 100
    taken = bytearray()

    def write(_descriptor: int, data: bytes) -> int:
        fits = data[: max(0, room - len(taken))]
        if not fits:
            raise OSError(28, "No space left on device")
        taken.extend(fits)
        return len(fits)

    logs = TlogRecorder(tmp_path, write=write)
    sender = DialectSender(1, 1)
    for second in range(10):
        logs.datagram(heartbeat(sender), "a", EPOCH_NS + second * NS_PER_S)
    assert logs.trouble == "no space left on device"
    assert len(taken) == 100
    room = 10_000
    logs.tick(EPOCH_NS + 20 * NS_PER_S)
    assert logs.trouble == ""
    causes: Counter[str] = Counter()
    assert len(list(read_tlog(bytes(taken), causes))) == 10
    assert not causes


@virtual
async def test_a_station_with_a_recorder_records_bus_journal_and_links(tmp_path: Path) -> None:
    clock = virtual_clock()
    broker = MemoryBroker()
    station = Station(broker.connect(), clock, StationSetup("field"))
    vehicle, ground = memory_pair("radio")
    folder = new_run(tmp_path, "field", station.now_ns())
    recorder = StationRecorder(station, folder, [ground])
    agent = broker.connect()
    published = 0
    async with asyncio.TaskGroup() as tasks:
        running = [tasks.create_task(station.run()), tasks.create_task(recorder.run())]
        await asyncio.sleep(0.1)
        sender = DialectSender(2, 1)
        for item in chase(2.0, story=False):
            if item.key.split("/")[2] != "gcs":
                agent.publish(item.key, item.payload, topics.TOPICS.find(item.key).topic.delivery)  # type: ignore[union-attr]
                published += 1
            if published % 20 == 0:
                vehicle.send(heartbeat(sender))
                await asyncio.sleep(0.02)
        station.acknowledge("")
        await asyncio.sleep(1.0)
        for task in running:
            task.cancel()
    entries = list(Recording(folder / "recording.mcap").entries())
    on_bus = [entry for entry in entries if entry.key.split("/")[2] != "gcs"]
    assert len(on_bus) == published
    assert entries[-1].key == "apollonius/field/gcs/acknowledged"
    assert len(list(read_tlog((folder / "vehicle-2.tlog").read_bytes()))) > 5


class Plug(OsFile):
    """A disk that can be full."""

    full = False

    def write_at(self, data: memoryview, offset: int) -> int:
        if Plug.full:
            raise OSError(28, "No space left on device")
        return super().write_at(data, offset)


@virtual
async def test_a_full_disk_is_an_alert_of_the_station_until_there_is_room(tmp_path: Path) -> None:
    clock = virtual_clock()
    broker = MemoryBroker()
    station = Station(broker.connect(), clock, StationSetup("field"))
    station.open()
    recorder = StationRecorder(station, tmp_path, opener=Plug)
    Plug.full = True
    agent = broker.connect()
    for item in chase(1.0, state_only=True):
        agent.publish(item.key, item.payload, Delivery.LATEST)
    for _ in range(10):
        await asyncio.sleep(0.2)
        recorder.tick()
    alerts = {alert.name: alert for alert in station.picture().alerts}
    assert "no space left on device" in alerts["recorder"].text
    assert "make room" in alerts["recorder"].advice
    Plug.full = False
    for _ in range(20):
        await asyncio.sleep(0.2)
        recorder.tick()
    assert "recorder" not in {alert.name for alert in station.picture().alerts}
    recorder.close()
    states = [e for e in Recording(tmp_path / "recording.mcap").entries() if e.key.endswith("state")]
    assert len(states) == 60, "nothing lost"
    station.close()


def test_run_folders_never_collide_and_bad_places_are_named(tmp_path: Path) -> None:
    first, second = (new_run(tmp_path, "a/b", EPOCH_NS) for _ in range(2))
    assert (first.name, second.name) == ("20251009T085320Z-a-b", "20251009T085320Z-a-b-2")
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="not a directory"):
        new_run(tmp_path / "file", "g", EPOCH_NS)


@virtual
async def test_a_frozen_disk_is_an_alert_holds_nobody_up_and_loses_nothing(tmp_path: Path) -> None:
    clock = virtual_clock()
    loop_thread, thawed = threading.get_ident(), threading.Event()

    class Frozen(OsFile):
        """While it is frozen the loop's thread would lose 5 s in it, and any other waits."""

        def write_at(self, data: memoryview, offset: int) -> int:
            if threading.get_ident() == loop_thread:
                clock.advance_to(clock.monotonic_ns() + 5 * NS_PER_S)
            else:
                assert thawed.wait(60.0)
            return super().write_at(data, offset)

    broker = MemoryBroker()
    station = Station(broker.connect(), clock, StationSetup("field"))
    station.open()
    writer = FileWriter()
    recorder = StationRecorder(station, tmp_path, opener=Frozen, writer=writer)
    agent = broker.connect()
    states = list(chase(5.0, state_only=True))
    late = 0.0
    for turn in range(50):
        due = clock.monotonic_ns() + NS_PER_S // 10
        for item in states[turn * len(states) // 50 : (turn + 1) * len(states) // 50]:
            agent.publish(item.key, item.payload, Delivery.LATEST)
        await asyncio.sleep(0.1)
        recorder.tick()
        late = max(late, (clock.monotonic_ns() - due) / NS_PER_S)
    assert late < 0.01
    assert recorder.status().trouble == "the disk does not answer"
    assert "recorder" in {alert.name for alert in station.picture().alerts}
    thawed.set()
    for _ in range(5):
        assert writer.flush(60.0)
        await asyncio.sleep(0.2)
        recorder.tick()
    assert recorder.status().trouble == ""
    recorder.close()
    kept = [e for e in Recording(tmp_path / "recording.mcap").entries() if e.key.endswith("state")]
    assert len(kept) == len(states)
    station.close()
