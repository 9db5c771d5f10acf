"""Run folders made of a made-up chase: `recording.mcap`, `vehicle-<id>.tlog`, the files beside them."""

from __future__ import annotations

import json
from pathlib import Path

from gcs.recording.recorder import Recorder
from gcs.recording.tlog import TlogRecorder
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.wire.bus import messages, topics
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.chase_messages import EPOCH_NS, Item, chase, setup

SILENT = range(EPOCH_NS + 8 * NS_PER_S, EPOCH_NS + 11 * NS_PER_S)  # vehicle 2 says nothing: an alert
SCENARIO = """
name = "a chase"
[evader]
position = [0.0, 0.0, 50.0]
speed = 12.0
target = [400.0, 100.0, 60.0]
[[pursuers]]
position = [260.0, -45.0, 40.0]
speed = 9.0
[[pursuers]]
position = [260.0, 45.0, 44.0]
speed = 9.0
[parameters]
R = 5.0
rho = 10.0
"""


def flight(duration_s: float = 24.0) -> list[Item]:
    """A chase with a capture, a command, an event and an alert."""
    flown = chase(duration_s)
    return [item for item in flown if not ("/vehicles/2/" in item.key and item.stamp_ns in SILENT)]


def make_run(folder: Path, items: list[Item] | None = None, *, recording: bool = True) -> Path:
    """Write a run folder."""
    folder.mkdir(exist_ok=True)
    flown = flight() if items is None else items
    if recording:
        recorder = Recorder(folder / "recording.mcap", "field")
        for item in flown:
            recorder.record(*item)
        recorder.close()
    (folder / "scenario.toml").write_text(SCENARIO, encoding="utf-8")
    summary = {"verdict": "captured", "vehicles": [{"id": 1, "link": {"sent": 5, "lost": 0}}, {"id": 2}]}
    (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    (folder / "timing.json").write_text('{"decision": {"p50_ms": 0.2}, "steps": 480}', encoding="utf-8")
    return folder


def make_tlogs(folder: Path, items: list[Item] | None = None) -> Path:
    """Add the telemetry logs that an autopilot's messages of the same flight would have left."""
    logs = TlogRecorder(folder)
    origin = setup("field", 2).origin
    frame = Frame(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)
    senders: dict[int, DialectSender] = {}
    for item in flight() if items is None else items:
        place = topics.TOPICS.find(item.key)
        if place is None or place.topic is not topics.STATE:
            continue
        state = topics.STATE.decode(item.payload, {})  # type: ignore[arg-type]
        assert state is not None
        sender = senders.setdefault(state.id, DialectSender(state.id, 1))
        for message in _telemetry(state, frame):
            logs.datagram(sender.pack(message), state.id, item.stamp_ns)
    logs.close()
    return folder


def _telemetry(state: messages.State, frame: Frame) -> list[object]:
    spot = frame.geodetic_from_ned(Vec(*state.position))
    boot_ms = (state.stamp_ns - EPOCH_NS) // 1_000_000 + 1000
    place = dialect.MAVLink_global_position_int_message(
        boot_ms,
        round(spot.latitude_deg * 1e7),
        round(spot.longitude_deg * 1e7),
        round(spot.altitude_m * 1e3),
        round(-state.position[2] * 1e3),
        *(round(v * 100) for v in state.velocity),
        0,
    )
    air = dialect.MAVLink_vfr_hud_message(state.airspeed, state.airspeed, 0, 50, spot.altitude_m, 0.0)
    return [place, air]
