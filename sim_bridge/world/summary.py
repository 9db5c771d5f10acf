"""What a run leaves in figures: `summary.json`. Virtual time only, no paths, no wall clock."""

from __future__ import annotations

import msgspec

from onboard.game.scenario import Scenario


class VehicleSummary(msgspec.Struct, frozen=True, kw_only=True):
    """What a run leaves in figures of one vehicle."""

    id: int
    role: str
    autopilot: str
    stage: str  # of its agent, at the end
    mode: str  # of its autopilot, at the end
    smallest_distance: float | None  # of a pursuer to the evader [m]
    telemetry_rate_hz: float  # the last while it acted
    setpoint_rate_hz: float
    counters: dict[str, int]  # the agent's: what it did, and drops by cause
    link: dict[str, int]  # the link's, impairment included
    events: int


class EvaderSummary(msgspec.Struct, frozen=True, kw_only=True):
    """How the game of one of several evaders ended."""

    id: int
    verdict: str  # captured | arrived | denied | escaped | aborted
    time: float  # since t₀ [s]
    captor: int  # id, 0 = nobody
    smallest_distance: float | None  # [m]


class Summary(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What a run leaves in figures."""

    scenario: str
    scenario_hash: str
    seed: int
    mode: str  # fast | real
    verdict: str  # captured | arrived | denied | escaped | aborted | none
    reason: str
    time: float  # of the verdict, since t₀ [s]
    captor: int  # id, 0 = nobody
    smallest_distance: float | None  # [m]
    expected: str  # the paper's verdict for this scenario, "" = it has none
    tracks_measured: int
    tracks_dropped: int
    vehicles: tuple[VehicleSummary, ...]
    evaders: tuple[EvaderSummary, ...] = ()  # of several


def kept(distance: float | None) -> float | None:
    """A distance for the summary: None where there is none."""
    return None if distance is None or distance < 0.0 or distance > 1e12 else round(distance, 6)


def reached(scenario: Scenario) -> str:
    """The paper's verdict in the words of an outcome, "" where the paper says nothing."""
    expect = scenario.expect
    if expect is None:
        return ""
    if not expect.escapes:
        return "captured"
    return "arrived" if expect.reaches else "escaped"
