"""When alerts are raised, as `gcs.toml` says it: by the supervisor's own thresholds where both judge."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from onboard.config.bounds import Distance, Duration, GpsFix, Share
from onboard.config.strict import StrictConfig, demand
from onboard.core.safety.policy import Policy

SUPERVISOR = Policy()  # what both judge, they judge by the same thresholds and functions
ClearAt = Annotated[float, Meta(ge=1, le=1000, description="1 or more")]


class Thresholds(StrictConfig, frozen=True):
    """When alerts are raised; each clears at the value beside it or at the one the rule states."""

    state_stale_s: Duration = SUPERVISOR.telemetry_age  # own state older than this
    telemetry_stale_s: Duration = SUPERVISOR.telemetry_age  # the autopilot's, as the agent reports it
    heartbeat_stale_s: Duration = SUPERVISOR.heartbeat_age  # the autopilot's heartbeat, likewise
    track_stale_s: Duration = 1.0  # the evader's track older than this, in a running game
    battery_low: Share = 0.30  # share left: go home
    battery_critical: Share = SUPERVISOR.battery  # the supervisor acts
    battery_margin: Share = 0.03  # above the limit, to clear
    gps_fix: GpsFix = SUPERVISOR.gps_fix  # the least, as MAVLink counts it: 3 = in space
    link_low: Share = 0.70  # share of expected telemetry that arrives
    link_margin: Share = 0.10  # above the limit, to clear
    clock_offset_s: Duration = 0.05  # an agent's clock against the master's
    clock_unready_s: Duration = 0.2  # an agent is not ready beyond this
    fence_near_m: Distance = SUPERVISOR.fence_margin  # nearer than this to a wall, floor or ceiling
    fence_clear_m: Distance = 2.0  # beyond the limit, to clear
    separation_clear: ClearAt = 1.15  # clears at this multiple of the separation
    confirm_s: Duration = 2.0  # a command not confirmed by then

    def __post_init__(self) -> None:
        demand(self.battery_critical <= self.battery_low, "battery_critical", self.battery_critical,
               f"at most battery_low = {self.battery_low:g}")  # fmt: skip
