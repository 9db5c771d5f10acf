"""A team's plan between real processes over Zenoh: its planner is killed, and the next one takes it over."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import psutil
import pytest

from onboard.runtime.bus_zenoh import open_zenoh
from onboard.wire.bus.team_messages import PartReason, TeamPlan, TeamRole
from onboard.wire.bus.topics import DEFAULT_GAME, PLAN, TOPICS
from tests.support.bus_stages import Heard
from tests.support.real_time import slowness, until
from tests.support.sim_bridge_process import descendants, free_port, started, well_known_ports

pytestmark = [
    pytest.mark.real,
    pytest.mark.game,
    pytest.mark.timeout(240),
    pytest.mark.xdist_group("well-known ports"),
]
GAME = """
name = "guarded for real"
[evader]
position = [0, 0]
speed = 5
target = [2000, 0]
[[pursuers]]
position = [330, 60]
speed = 4
strategy = "team"
[[pursuers]]
position = [300, -70]
speed = 4
strategy = "team"
[parameters]
R = 2.0
rho = 6.0
horizon = {horizon}
target_known = true
[flight]
height = 120
ready_s = 2.0
prediction = "constant-velocity"
"""
FIRST, NEXT = 2, 3


def plans(heard: Heard) -> list[TeamPlan]:
    """What was planned, in order."""
    drops: Counter[str] = Counter()
    found = [TOPICS.heard(sample.key, sample.payload, drops) for sample in heard.samples]
    return [one.message for one in found if one is not None and isinstance(one.message, TeamPlan)]


def agent(pid: int, id: int) -> psutil.Process:
    """The process of one vehicle's agent."""
    name = f"agent-{id}.toml"
    return next(p for p in descendants(pid) if any(word.endswith(name) for word in p.cmdline()))


async def test_the_planner_is_killed_and_the_next_process_goes_on_from_its_plan(tmp_path: Path) -> None:
    scenario = tmp_path / "guarded.toml"
    scenario.write_text(GAME.format(horizon=60.0 * min(4.0, slowness())), encoding="utf-8")
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    runs = ("--no-report", "--runs", tmp_path / "runs", "--bus", endpoint)
    with well_known_ports(), started("fly", scenario, *runs) as child:
        bus = await open_zenoh(endpoint)
        try:
            heard = Heard(bus, PLAN.key(DEFAULT_GAME, "*"))
            await until(lambda: len([p for p in plans(heard) if p.id == FIRST]) >= 3, 60.0)
            before = plans(heard)[-1]
            assert {part.role for part in before.parts} <= {TeamRole.GOALKEEPER, TeamRole.CHASER}
            first = agent(child.pid, FIRST)
            first.kill()
            gone = len(heard.samples)
            await until(lambda: any(p.id == NEXT for p in plans(heard)[gone:]), 10.0)
            taken = next(p for p in plans(heard)[gone:] if p.id == NEXT)
            parts = {part.id: part for part in taken.parts}
            assert (parts[FIRST].role, parts[FIRST].reason) == (TeamRole.RESERVE, PartReason.LOST)
            assert parts[NEXT].role is not TeamRole.RESERVE
            assert taken.t > before.t
        finally:
            await bus.close()
