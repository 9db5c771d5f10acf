"""Logs: ours are read whole by pymavlink's own reader, and a cut one as far as it goes."""

from __future__ import annotations

import io
from collections import Counter
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink import mavutil

from onboard.core.math.vectors import Vec
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.dialect import dialect_packet
from onboard.wire.mavlink.frames import Sender
from onboard.wire.mavlink.tlog import TlogWriter, read_tlog

START_NS = 1_700_000_000_123_456_000


def log(count: int) -> bytes:
    file = io.BytesIO()
    writer, sender = TlogWriter(file), Sender(2, 191)
    for k in range(count):
        target = commands.VelocityTarget(Target(2), k * 0.05, Vec(k, 1, 0))
        writer.write(START_NS + k * 50_000_000, sender.pack(target))
    return file.getvalue()


def test_pymavlinks_own_reader_reads_ours(tmp_path: Path) -> None:
    (tmp_path / "flight.tlog").write_bytes(log(40))
    reader = mavutil.mavlink_connection(str(tmp_path / "flight.tlog"))
    seen = []
    while (message := reader.recv_msg()) is not None:
        seen.append((message.get_type(), round(message.vx)))
    assert seen == [("SET_POSITION_TARGET_LOCAL_NED", k) for k in range(40)]


def test_what_was_written_comes_back_to_the_microsecond() -> None:
    entries = list(read_tlog(log(40)))
    assert [entry.stamp_ns for entry in entries] == [START_NS + k * 50_000_000 for k in range(40)]
    assert [dialect_packet(entry.packet.raw).message.vx for entry in entries] == list(range(40))


def test_a_cut_log_gives_all_that_is_whole() -> None:
    data = log(10)
    size = len(data) // 10
    for cut in range(len(data)):
        assert len(list(read_tlog(data[:cut]))) >= cut // (size + 1) - 1
    causes: Counter[str] = Counter()
    assert len(list(read_tlog(data[: -size // 2], causes))) == 9
    assert causes["garbage_bytes"] > 0


@settings(max_examples=100, deadline=None)
@given(at=st.integers(0, 500), junk=st.binary(min_size=1, max_size=60))
def test_damage_costs_at_most_the_frames_it_touches(at: int, junk: bytes) -> None:
    data = log(12)
    damaged = data[:at] + junk + data[at + len(junk) :]
    left = [entry.packet.raw for entry in read_tlog(damaged)]
    touched = len(junk) // (len(data) // 12) + 2
    assert len(left) >= 12 - touched
