"""Recordings of real autopilots: every message decodes, and the counts are pymavlink's own."""

from __future__ import annotations

from collections import Counter

import pytest
from pymavlink import mavutil

from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.tlog import Entry, read_tlog
from onboard.wire.mavlink.values import CommandAck, GlobalPosition, Heartbeat, StatusText, SysStatus, Version
from tests.support.paths import RECORDINGS

HERE = RECORDINGS
STORIES = [
    ("arduplane-4.5.6-guided", 10_777, Kind.ARDUPLANE),
    ("arducopter-4.5.6-guided", 7_587, Kind.ARDUCOPTER),
]


def entries(name: str) -> list[Entry]:
    causes: Counter[str] = Counter()
    found = list(read_tlog((HERE / f"{name}.tlog").read_bytes(), causes))
    assert not causes
    return found


@pytest.mark.parametrize(("name", "count", "kind"), STORIES)
def test_every_message_decodes_and_the_counts_are_pymavlinks(name: str, count: int, kind: Kind) -> None:
    ours = entries(name)
    theirs: Counter[str] = Counter()
    reader = mavutil.mavlink_connection(str(HERE / f"{name}.tlog"))
    stamps = []
    while (message := reader.recv_msg()) is not None:
        theirs[message.get_type()] += 1
        stamps.append(message._timestamp)
    assert len(ours) == count == theirs.total()
    assert Counter(entry.packet.name for entry in ours) == theirs
    assert [entry.stamp_ns / 1e9 for entry in ours] == pytest.approx(stamps, abs=1e-6)


@pytest.mark.parametrize(("name", "count", "kind"), STORIES)
def test_the_story_is_read_as_it_was_flown(name: str, count: int, kind: Kind) -> None:
    autopilot = [e.packet for e in entries(name) if (e.packet.system, e.packet.component) == (1, 1)]
    values = [value for packet in autopilot if (value := packet.value) is not None]

    hearts = [value for value in values if isinstance(value, Heartbeat)]
    assert {heart.kind for heart in hearts} == {kind}
    modes = list(dict.fromkeys(heart.mode for heart in hearts))
    told = {
        Kind.ARDUPLANE: ["INITIALISING", "MANUAL", "TAKEOFF", "GUIDED", "LOITER", "RTL"],
        Kind.ARDUCOPTER: ["STABILIZE", "GUIDED", "LOITER", "RTL"],
    }
    assert modes == told[kind]
    assert [heart.armed for heart in hearts][:: len(hearts) - 1] == [False, True]

    version = next(value for value in values if isinstance(value, Version))
    assert version.flight[:3] == (4, 5, 6)
    health = [value.pre_arm_ok for value in values if isinstance(value, SysStatus)]
    assert health[0] is False
    assert health[-1] is True
    assert any("V4.5.6" in value.text for value in values if isinstance(value, StatusText))
    high = max(value.above_home_m for value in values if isinstance(value, GlobalPosition))
    assert (80 < high < 150) if kind is Kind.ARDUPLANE else (18 < high < 40)
    answers = [value for value in values if isinstance(value, CommandAck)]
    denied = [(answer.command, answer.result) for answer in answers if answer.result]
    assert denied == ([(43002, 2), (43001, 2), (43000, 2)] if kind is Kind.ARDUPLANE else [(400, 4)] * 9)


@pytest.mark.parametrize(("name", "count", "kind"), STORIES)
def test_a_byte_stream_in_any_chunks_gives_the_same_packets(name: str, count: int, kind: Kind) -> None:
    frames = [entry.packet.raw for entry in entries(name)]
    stream = b"".join(frames)
    framer = Framer()
    got = []
    at, size = 0, 1
    while at < len(stream):
        got += framer.feed(stream[at : at + size])
        at, size = at + size, size % 613 + 1
    assert [packet.raw for packet in got] == frames
    assert not framer.causes
