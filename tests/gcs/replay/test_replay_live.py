"""A live station beside its own recording: the same picture, alert for alert, on virtual time."""

from __future__ import annotations

import asyncio
from pathlib import Path

from gcs.picture.values import Picture
from gcs.recording.shell import StationRecorder
from gcs.replay.player import Player
from gcs.replay.source import open_run
from gcs.station import Station, StationSetup
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.loop import virtual_clock
from onboard.wire.bus import topics
from onboard.wire.bus.messages import CommandKind
from tests.support.chase_messages import EPOCH_NS, chase
from tests.support.virtual_time import virtual


@virtual
async def test_a_replay_shows_what_the_live_station_showed(tmp_path: Path) -> None:
    clock = virtual_clock()
    broker = MemoryBroker()
    station = Station(broker.connect(), clock, StationSetup("field"), new_id=lambda: "hold-1")
    recorder = StationRecorder(station, tmp_path)
    agents = broker.connect()
    shown: list[Picture] = []

    async def look() -> None:
        while True:
            await asyncio.sleep(0.513)  # never on the grid of the alerts
            shown.append(station.picture())

    async with asyncio.TaskGroup() as tasks:
        running = [tasks.create_task(task) for task in (station.run(), recorder.run(), look())]
        began_ns = clock.wall_ns()
        for item in chase(20.0):
            place = topics.TOPICS.find(item.key)
            flown_ns = item.stamp_ns - EPOCH_NS
            if place is None or ("/vehicles/2/" in item.key and 8 * NS_PER_S < flown_ns < 11 * NS_PER_S):
                continue
            ahead = began_ns + flown_ns - clock.wall_ns()
            if ahead > 0:
                await asyncio.sleep(ahead / NS_PER_S)
            agents.publish(item.key, item.payload, place.topic.delivery)
            if flown_ns > 9.2 * NS_PER_S and not station.picture().commands:
                station.command(CommandKind.HOLD, (1, 2, 3))
                station.acknowledge("")
        await asyncio.sleep(1.0)
        for task in running:
            task.cancel()

    player = Player(open_run(tmp_path))
    compared = 0
    for picture in shown:
        if player.start_ns <= picture.now_ns <= player.end_ns:
            player.seek(picture.now_ns)
            replayed = player.picture()
            assert replayed.alerts == picture.alerts
            assert replayed == picture
            compared += 1
    assert compared > 30
    everything = {alert.name for picture in shown for alert in picture.alerts}
    assert "lost:2" in everything, "there was an alert to compare"
    assert any(alert.acknowledged for picture in shown for alert in picture.alerts)
    assert shown[-1].commands
