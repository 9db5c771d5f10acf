"""An agent that hears real autopilots (tests/field/recordings) finds what the story beside each tells."""

from __future__ import annotations

import pytest

from onboard.agent.agent import Agent
from onboard.agent.config import AgentConfig
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.links import memory_pair
from onboard.runtime.loop import virtual_clock
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.paths import RECORDINGS
from tests.support.virtual_time import virtual

STORIES = [
    ("arducopter-4.5.6-guided", "ArduCopter", ["STABILIZE", "GUIDED", "LOITER", "RTL"], 20.0),
    ("arduplane-4.5.6-guided", "ArduPlane", ["TAKEOFF", "GUIDED", "LOITER", "RTL"], 30.0),
]


@pytest.mark.parametrize(("name", "kind", "modes", "height"), STORIES)
@virtual
async def test_kind_modes_and_health_come_out_as_the_story_tells(
    name: str, kind: str, modes: list[str], height: float
) -> None:
    clock, broker = virtual_clock(), MemoryBroker()
    near, far = memory_pair("recording")
    config = AgentConfig(id=1, dry_run=True)
    lines: list[str] = []
    agent = Agent(config, clock, [near], broker.connect("agent"), nonce=1, log=lines.append)
    agent.radio.open(agent._hear)
    seen: list[str] = []
    first: dict[str, float] = {}  # what became good, and when [s]
    start = -1
    highest = 0.0
    for entry in read_tlog((RECORDINGS / f"{name}.tlog").read_bytes()):
        start = entry.stamp_ns if start < 0 else start
        due = entry.stamp_ns - start
        if due > clock.monotonic_ns():
            clock.advance_to(due)
        agent.radio._arrived(0, entry.packet.raw, "autopilot")
        agent.craft.foreign.clear()
        t = agent.craft.look(agent.now)
        if t.mode and (not seen or seen[-1] != t.mode):
            seen.append(t.mode)
        highest = max(highest, t.above_home_m)
        for good, holds in (
            ("found", agent.craft.adapter is not None), ("armed", t.armed), ("fix", t.gps_fix >= 3),
            ("estimate", t.ekf_ok), ("home", agent.craft.observer.home is not None),
        ):  # fmt: skip
            if holds:
                first.setdefault(good, clock.monotonic_ns() / 1e9)
    assert agent.craft.adapter is not None
    assert agent.craft.adapter.kind.value == kind
    remaining = iter(seen)
    assert all(mode in remaining for mode in modes), seen
    assert {"found", "armed", "home"} <= set(first)
    assert first["found"] < 2.0
    assert first["armed"] > 20.0  # refused for many seconds
    if kind == "ArduPlane":  # the other one did not report its GPS and estimator
        assert first["fix"] < first["estimate"] < first["armed"]
    assert highest > 0.8 * height
    assert agent.radio.causes["bad_crc"] == agent.radio.causes["truncated"] == 0
    assert "autopilot_refused" not in agent.journal.kinds
    assert far.counters().get("sent", 0) == 0
