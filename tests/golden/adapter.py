"""Everything of the product that the guard calls: a module that moves needs an edit here and nowhere else."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

SIM_BRIDGE = (sys.executable, "-m", "sim_bridge.cli")  # the command `sim-bridge`
RECORDING = "recording.mcap"  # in a run folder: the bus
SUMMARY = "summary.json"  # in a run folder: the game in figures
FED = 1  # id of the vehicle whose autopilot is a recording
EPOCH_NS = 1_767_225_600_000_000_000  # where virtual time begins [ns]: seconds are counted from here


class Sent(NamedTuple):
    """A datagram that an agent sent to its autopilot."""

    at_ns: int  # virtual wall time
    data: bytes


class SpatialRow(NamedTuple):
    """How a compiled game of the spatial campaign went."""

    verdict: str
    time: float  # of the verdict [s]
    smallest: float  # distance of any pursuer to the evader [m]
    reversals: int  # of the course that the evader flew
    decided_reversals: int  # of the course that the evader decided on
    lowest: float  # height of any aircraft [m]


def sent_beside(scenario_file: Path, frames: Sequence[tuple[int, bytes]], after_s: float = 3.0) -> list[Sent]:
    """What the evader's agent sends to its autopilot in a game on virtual time in which that autopilot is
    a recording: `frames` are (time since the game's beginning [ns], frame). The other vehicles are simulated.
    The game goes on for `after_s` without a frame, and the agents end as at SIGTERM."""
    from onboard.game.scenario import load
    from onboard.runtime.links import memory_pair
    from onboard.runtime.loop import run_virtual, virtual_clock
    from sim_bridge.rehearsal import Rehearsal

    async def play() -> list[Sent]:
        clock = virtual_clock()
        agent_end, recording_end = memory_pair("recording")
        sent: list[Sent] = []
        recording_end.receive(lambda data, peer: sent.append(Sent(clock.wall_ns(), bytes(data))))
        game = Rehearsal(load(scenario_file), clock)
        game.links[FED] = agent_end  # type: ignore[assignment]  # in place of the simulated autopilot
        async with game:
            for due_ns, frame in frames:
                wait_ns = due_ns - clock.monotonic_ns()
                if wait_ns > 0:
                    await asyncio.sleep(wait_ns / 1e9)
                recording_end.send(frame)
            await asyncio.sleep(after_s)
            await game.land_agents()
        return sent

    return run_virtual(play())


def spatial_rows(name: str, seeds: Sequence[int]) -> dict[tuple[int, str], SpatialRow]:
    """The compiled games of a shipped spatial scenario: by seed and way of the evader's flying."""
    from sim_bridge.campaign.spatial_campaign import play_seed
    from sim_bridge.campaign.spatial_draw import spatial
    from sim_bridge.campaign.spatial_game import Evasion

    scenario = spatial(name)
    rows: dict[tuple[int, str], SpatialRow] = {}
    for seed in seeds:
        for evasion in Evasion:
            p = play_seed(scenario, seed, evasion)
            rows[seed, evasion.name.lower()] = SpatialRow(
                p.verdict.name.lower(), float(p.time), float(p.smallest), p.reversals, p.decided_reversals,
                float(p.play.envelope.lowest),
            )  # fmt: skip
    return rows
