"""Tells whether a vehicle that the agent has left to hold does hold, until somebody else moves it."""

from __future__ import annotations

from onboard.agent.core.journal import Journal
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.autopilot.base import Stage
from onboard.core.math.constants import NEVER
from onboard.core.safety.hold_watch import HoldLimits, HoldState, HoldWatch, of_plane
from onboard.core.safety.policy import Envelope

HOLDING = frozenset(("LOITER", "BRAKE", "HOLD", "POSHOLD"))
FRESH_S = 0.5


class HoldAlert:
    """Watches each hold from its mode's confirmation on."""

    def __init__(self, journal: Journal) -> None:
        self.lost = ""  # why it does not hold, until somebody moves it; "": it does, or is not left to hold
        self._journal = journal
        self._watch: HoldWatch | None = None
        self._left = False
        self._mode = ""

    def look(self, now: float, vehicle: VehicleLink, envelope: Envelope) -> None:
        """Look at the vehicle at `now` [s, monotonic], and say what has become of its hold."""
        t = vehicle.telemetry
        left = vehicle.stage is Stage.LEFT
        if left and not self._left and t.mode in HOLDING:
            limits = HoldLimits()
            if not envelope.hovers:
                limits = of_plane(envelope.turn_radius, envelope.speed_min, envelope.speed_max)
            self._watch, self._mode = HoldWatch(now, limits), t.mode
        self._left = left
        if self._watch is None:
            return
        if not left or t.mode != self._mode:
            self._end()
            return
        if not t.placed or now - t.position_at > FRESH_S:
            return
        airspeed = None if t.airspeed_at == NEVER or envelope.hovers else t.airspeed
        if self._watch.look(now, t.position, t.velocity, airspeed):
            here = f"{t.above_home_m:.1f} m above home, climbing {-t.velocity.z:z.1f} m/s"
            if self._watch.state is HoldState.HELD:
                self._journal.info("held", f"{t.mode} holds, {here}")
            else:
                self.lost = f"{t.mode} does not hold: {here}"
                self._journal.error("hold_lost", self.lost)

    def _end(self) -> None:
        if self.lost:
            self._journal.info("hold_over", "it is in other hands")
        self._watch, self.lost = None, ""
