"""An agent that hears real autopilots (tests/field/recordings) finds what the story beside each tells."""

from __future__ import annotations

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.core.events import Instant, LinkBytes, LinkFacts, Send, Started
from onboard.agent.core.machine import AgentCore, Facts
from onboard.core.math.constants import NS_PER_S
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.paths import RECORDINGS

STORIES = [
    ("arducopter-4.5.6-guided", "ArduCopter", ["STABILIZE", "GUIDED", "LOITER", "RTL"], 20.0),
    ("arduplane-4.5.6-guided", "ArduPlane", ["TAKEOFF", "GUIDED", "LOITER", "RTL"], 30.0),
]


@pytest.mark.parametrize(("name", "kind", "modes", "height"), STORIES)
def test_kind_modes_and_health_come_out_as_the_story_tells(
    name: str, kind: str, modes: list[str], height: float
) -> None:
    core = AgentCore(AgentConfig(id=1, dry_run=True), Facts(1, (LinkFacts("recording", stream=False),)))
    core.handle(Started(), Instant(0.0, 0))
    seen: list[str] = []
    first: dict[str, float] = {}  # what became good, and when [s]
    start = -1
    highest = 0.0
    sent = 0
    for entry in read_tlog((RECORDINGS / f"{name}.tlog").read_bytes()):
        start = entry.stamp_ns if start < 0 else start
        now = Instant((entry.stamp_ns - start) / NS_PER_S, entry.stamp_ns)
        effects = core.handle(LinkBytes(0, 0, entry.packet.raw), now)
        sent += sum(isinstance(effect, Send) for effect in effects)
        core.vehicle.foreign.clear()
        t = core.vehicle.look(now.s)
        if t.mode and (not seen or seen[-1] != t.mode):
            seen.append(t.mode)
        highest = max(highest, t.above_home_m)
        for good, holds in (
            ("found", core.vehicle.adapter is not None), ("armed", t.armed), ("fix", t.gps_fix >= 3),
            ("estimate", t.ekf_ok), ("home", core.vehicle.observer.home is not None),
        ):  # fmt: skip
            if holds:
                first.setdefault(good, now.s)
    assert core.vehicle.adapter is not None
    assert core.vehicle.adapter.kind.value == kind
    remaining = iter(seen)
    assert all(mode in remaining for mode in modes), seen
    assert {"found", "armed", "home"} <= set(first)
    assert first["found"] < 2.0
    assert first["armed"] > 20.0  # refused for many seconds
    if kind == "ArduPlane":  # the other one did not report its GPS and estimator
        assert first["fix"] < first["estimate"] < first["armed"]
    assert highest > 0.8 * height
    assert core.radio.causes["bad_crc"] == core.radio.causes["truncated"] == 0
    assert "autopilot_refused" not in core.journal.kinds
    assert sent == 0
