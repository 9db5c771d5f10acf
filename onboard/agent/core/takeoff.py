"""A ground start: arm and climb to a height, each kind of autopilot in its own way."""

from __future__ import annotations

from math import nan

from onboard.agent.core.vehicle_link import VehicleLink
from onboard.autopilot.base import Stage, Telemetry
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import CommandLong
from onboard.wire.mavlink.modes import Kind, custom_mode
from onboard.wire.retry import CommandRetry, RetryPolicy

RETRY = RetryPolicy(2.0)  # [s]
ON_GROUND = 1  # MAV_LANDED_STATE_ON_GROUND
REACHED = 0.9  # of the height
HALFWAY = 0.5  # … where the autopilot itself says that it is up


class TakeOff:
    """Brings one vehicle from the ground to `height` [m above home]."""

    def __init__(self, height: float) -> None:
        self.height = height
        self.climbing = False
        self._retry = CommandRetry(RETRY)

    def pending(self, t: Telemetry) -> bool:
        """Whether the vehicle is on the ground still, or on its way up."""
        return self.climbing or t.landed_state == ON_GROUND

    def step(self, now: float, vehicle: VehicleLink) -> bool:
        """Do what is due at `now` [s]; True while the vehicle is on its way up (send it no setpoints)."""
        t, adapter = vehicle.telemetry, vehicle.adapter
        if adapter is None:
            return False
        if t.landed_state == ON_GROUND and not self.climbing:
            self.climbing, self._retry = True, CommandRetry(RETRY)
        # A PX4 plane says by HOLD that it is up: it accepts a height ten metres off (NAV_FW_ALT_RAD).
        up = adapter.kind is Kind.PX4_PLANE and t.mode == "HOLD"
        share = HALFWAY if up else REACHED
        if self.climbing and t.landed_state != ON_GROUND and t.above_home_m >= share * self.height:
            self.climbing = False
        if not self.climbing:
            return False
        if adapter.kind is Kind.ARDUCOPTER:
            adapter.enter(now)
        armable = {Kind.ARDUPLANE: t.mode == "TAKEOFF", Kind.ARDUCOPTER: adapter.stage is Stage.ACTIVE}
        if not t.armed and armable.get(adapter.kind, True):
            adapter.arm(now)
        message = self._next(vehicle)
        if message is not None and self._retry.due(now):
            vehicle.radio.send(message._replace(confirmation=self._retry.tries - 1))
        return True

    def _next(self, vehicle: VehicleLink) -> CommandLong | None:
        t, adapter = vehicle.telemetry, vehicle.adapter
        assert adapter is not None
        if adapter.kind is Kind.ARDUPLANE:
            mode = custom_mode(Kind.ARDUPLANE, "TAKEOFF")
            if t.mode == "TAKEOFF" or mode is None:
                return None
            return commands.set_mode(vehicle.to, mode, px4=False)
        if not t.armed or t.landed_state != ON_GROUND:
            return None
        if adapter.kind is Kind.ARDUCOPTER:
            return commands.takeoff(vehicle.to, self.height) if adapter.stage is Stage.ACTIVE else None
        above_sea = t.altitude_m - t.above_home_m + self.height  # what PX4 wants
        return commands.takeoff(vehicle.to, above_sea, place=nan)  # where it stands: 0°, 0° would be a place
