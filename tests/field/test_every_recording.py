"""Every recording of a real autopilot, asked what the world would ask of today's agent beside it.

The frames of the autopilot alone are fed to an agent to whom nobody has given an order; what the recorded
agent and other stations sent is left out. pymavlink's own parser and table of modes are the second opinion.
"""

from __future__ import annotations

from collections import Counter
from functools import cache
from itertools import pairwise
from math import hypot
from pathlib import Path
from typing import NamedTuple

import pytest
from pymavlink import mavutil

from onboard.agent.config import AgentConfig
from onboard.agent.core.events import AnyEffect, Instant, LinkBytes, LinkFacts, Send, Started, Tick
from onboard.agent.core.machine import AgentCore, Facts
from onboard.core.math.constants import NS_PER_S
from onboard.wire.mavlink.dialect import dialect, dialect_packet
from onboard.wire.mavlink.frames import Framer, marked_signed
from onboard.wire.mavlink.signing import MemoryStore, Signing
from onboard.wire.mavlink.tlog import STAMP, Entry, read_tlog
from tests.support.paths import RECORDINGS
from tests.support.recorded import recorded

EXCERPTS = sorted((RECORDINGS / "excerpts").glob("*.tlog"))
FILES = [*EXCERPTS, *sorted(RECORDINGS.glob("*.tlog"))]  # the whole ones are in onboard/agent/test_recordings
MOVES = frozenset({"SET_POSITION_TARGET_LOCAL_NED", "SET_ATTITUDE_TARGET", "COMMAND_INT", "SET_MODE"})
ASKS = frozenset({  # commands that only ask for words
    dialect.MAV_CMD_SET_MESSAGE_INTERVAL, dialect.MAV_CMD_REQUEST_MESSAGE,
    dialect.MAV_CMD_GET_MESSAGE_INTERVAL,
})  # fmt: skip


@cache
def entries(path: Path) -> list[Entry]:
    return list(read_tlog(path.read_bytes()))


class Beside(NamedTuple):
    """What today's agent did beside a recording."""

    core: AgentCore
    sent: Counter[str]  # messages by name, orders of the vehicle alone
    modes: list[str]
    heard: int


def beside(path: Path) -> Beside:
    """An agent with the recorded vehicle's id, without master or order, hears the autopilot."""
    found = entries(path)
    system = next(e.packet.system for e in found if e.packet.component == 1 and e.packet.name == "HEARTBEAT")
    core = AgentCore(AgentConfig(id=system), Facts(1, (LinkFacts("recording", stream=False),)))
    core.handle(Started(), Instant(0.0, found[0].stamp_ns))
    sent, modes, heard = Counter[str](), list[str](), 0

    def did(effects: list[AnyEffect]) -> None:
        for effect in effects:
            if isinstance(effect, Send):
                message = dialect_packet(effect.frame).message
                asks = message.get_type() == "COMMAND_LONG" and message.command in ASKS
                sent[message.get_type()] += not asks

    for entry in found:
        if entry.packet.component != 1:
            continue
        heard += 1
        now = Instant((entry.stamp_ns - found[0].stamp_ns) / NS_PER_S, entry.stamp_ns)
        while core.next_deadline() <= now.s:
            at = max(core.next_deadline(), 0.0)
            did(core.handle(Tick(), Instant(at, found[0].stamp_ns + round(at * NS_PER_S))))
        did(core.handle(LinkBytes(0, 0, entry.packet.raw), now))
        mode = core.vehicle.look(now.s).mode
        if mode and (not modes or modes[-1] != mode):
            modes.append(mode)
    return Beside(core, sent, modes, heard)


def second_opinion(path: Path) -> list[str]:
    """The modes that pymavlink reads from the autopilot's heartbeats, in its own words."""
    modes: list[str] = []
    for entry in entries(path):
        if entry.packet.component == 1 and entry.packet.name == "HEARTBEAT":
            mode = mavutil.mode_string_v10(dialect_packet(entry.packet.raw).message)
            if not modes or modes[-1] != mode:
                modes.append(mode)
    return modes


HOLD, OFFBOARD = 50593792, 393216  # PX4's custom modes
SAME = {"LOITER": "HOLD"}  # pymavlink's word for PX4's AUTO.LOITER


@pytest.mark.parametrize("path", EXCERPTS, ids=lambda path: path.stem)
def test_nothing_is_sent_that_nobody_asked_for_and_the_modes_are_those_that_were(path: Path) -> None:
    found = beside(path)
    assert found.heard > 100
    assert found.sent["HEARTBEAT"] > 5  # it is awake
    orders = {name: n for name, n in found.sent.items() if n and name in {*MOVES, "COMMAND_LONG"}}
    assert orders == {}
    theirs = second_opinion(path)
    kind = found.core.vehicle.look(0.0).kind.value
    if kind.startswith("PX4"):
        theirs = [SAME.get(mode, mode) for mode in theirs]
    assert found.modes == theirs
    assert not {"second_autopilot", "autopilot_refused"} & set(found.core.journal.kinds)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_frame_is_read_as_pymavlink_reads_it_also_in_pieces(path: Path) -> None:
    data = path.read_bytes()
    frames, at = [], 0
    while at + STAMP.size < len(data):  # the log's own layout, read without any framer
        at += STAMP.size
        length = data[at + 1] + (12 + 13 * (data[at + 2] & 1) if data[at] == 0xFD else 8)
        frames.append(data[at : at + length])
        at += length
    parser = dialect.MAVLink(None)
    parser.robust_parsing = True
    theirs = [m.get_type() for m in parser.parse_buffer(b"".join(frames)) or []]
    ours, causes, stream = [], Counter[str](), b"".join(frames)
    framer = Framer(causes=causes)
    for start in range(0, len(stream), 97):
        ours += [packet.name for packet in framer.feed(stream[start : start + 97])]
    unknown = [name for name in theirs if name.startswith(("UNKNOWN", "BAD_DATA"))]
    assert ours == [name for name in theirs if name not in unknown]
    assert set(causes) <= {"unknown_id", "garbage_bytes"} if unknown else not causes


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_where_it_is_follows_from_how_it_moved(path: Path) -> None:
    """Position against integrated velocity, fix by fix; a lost GPS lets a few of them jump."""
    fixes = [
        (e.stamp_ns / NS_PER_S, e.packet.value) for e in entries(path)
        if e.packet.component == 1 and e.packet.name == "GLOBAL_POSITION_INT" and e.packet.value is not None
        and e.packet.value.latitude_deg
    ]  # fmt: skip
    errors = []
    for (t0, a), (t1, b) in pairwise(fixes):
        dt = t1 - t0
        if 0.02 < dt < 1.0:
            north = (b.latitude_deg - a.latitude_deg) * 111_200.0
            errors.append(abs(north - 0.5 * dt * (a.velocity.x + b.velocity.x)))
    assert len(errors) > 20
    assert sorted(errors)[int(0.9 * len(errors))] < 3.0


def test_all_that_was_recorded_is_here() -> None:
    assert len(FILES) == 27


# ------------------------------------------------------------------ what single recordings tell


def mode_at(name: str, number: int) -> float:
    """When the autopilot first told a mode [s]."""
    return next(beat.t for beat in recorded(name).beats() if beat.mode == number)


def test_the_old_agent_took_the_vehicle_from_its_pilot_within_a_second_or_so() -> None:
    """Beside the same frames today's sends nothing: the first test of this page."""
    record = recorded("copter-restart-takes-from-pilot")
    first = next(m for _, m in record.asked("COMMAND_LONG") if m.command == dialect.MAV_CMD_DO_SET_MODE)
    assert first.param2 == 4  # GUIDED
    assert 0.5 < mode_at("copter-restart-takes-from-pilot", 4) < 2.0


def test_a_signed_flight_is_read_without_its_key_and_refused_with_a_wrong_one() -> None:
    found = entries(RECORDINGS / "excerpts" / "copter-signed.tlog")
    marked = [entry for entry in found if marked_signed(entry.packet.raw)]
    assert {entry.packet.component for entry in marked} == {1, 191}
    assert len(marked) > 0.95 * len(found)
    wrong = Framer(signing=Signing(bytes(32), MemoryStore()))
    assert [p for entry in marked for p in wrong.feed(entry.packet.raw, entry.stamp_ns)] == []
    assert wrong.causes == {"signature_wrong": len(marked)}


def test_targets_take_px4_out_of_hold_within_a_second_or_two_though_nobody_chose_offboard() -> None:
    """What an agent without an order must never send: the first test of this page."""
    record = recorded("px4-default-params-kill-posctl")
    first = record.asked("SET_POSITION_TARGET_LOCAL_NED")[0][0]
    assert record.beats()[0].mode == HOLD
    assert 0.0 < mode_at("px4-default-params-kill-posctl", OFFBOARD) - first < 2.5


@pytest.mark.parametrize("name", ["px4-hold-resume-pilot-return-ctrlc", "px4-mavsdk-adapter"])
def test_a_vehicle_handed_back_in_hold_keeps_its_height_and_place(name: str) -> None:
    record = recorded(name)
    (begin, end), *_ = [
        (a.t, b.t) for a, b in zip(record.changes(), record.changes()[1:], strict=False)
        if a.mode == HOLD and b.t - a.t > 5.0
    ]  # fmt: skip
    heights = [height for _, height in record.heights(begin + 3.0, end)]
    assert max(heights) - min(heights) < 2.0
    speeds = [hypot(m.vx, m.vy) * 0.01 for t, m in record.own("GLOBAL_POSITION_INT") if begin + 4.0 < t < end]
    assert max(speeds) < 1.0


@pytest.mark.parametrize("name", ["px4-2v1-evader", "px4-capture-1v1-pursuer", "copter-capture-1v1"])
def test_a_real_autopilot_flew_what_it_was_told(name: str) -> None:
    record = recorded(name)
    wanted = [(t, m) for t, m in record.asked("SET_POSITION_TARGET_LOCAL_NED") if hypot(m.vx, m.vy) > 1.0]
    flown = record.own("GLOBAL_POSITION_INT")
    errors = []
    for t, target in wanted:
        after = next((m for at, m in flown if 0.7 <= at - t <= 1.3), None)
        if after is not None:
            errors.append(hypot(after.vx * 0.01 - target.vx, after.vy * 0.01 - target.vy))
    assert len(errors) > 20
    assert sorted(errors)[len(errors) // 2] < 1.0


def test_a_planes_lost_gps_is_believed_within_a_second() -> None:
    record = recorded("plane-agent2-restart-gpsloss-abort")
    lost = next((t for t, m in record.own("GPS_RAW_INT") if m.fix_type < 3), None)
    assert lost is not None
    path = RECORDINGS / "excerpts" / "plane-agent2-restart-gpsloss-abort.tlog"
    core = AgentCore(AgentConfig(id=2), Facts(1, (LinkFacts("recording", stream=False),)))
    core.handle(Started(), Instant(0.0, 0))
    seen = -1.0
    start = entries(path)[0].stamp_ns
    for entry in entries(path):
        now = Instant((entry.stamp_ns - start) / NS_PER_S, entry.stamp_ns)
        if entry.packet.component == 1:
            core.handle(LinkBytes(0, 0, entry.packet.raw), now)
            if seen < 0.0 and now.s > lost - 0.1 and 0 <= core.vehicle.look(now.s).gps_fix < 3:
                seen = now.s
    assert 0.0 <= seen - lost < 1.0  # one odd sample decides nothing
