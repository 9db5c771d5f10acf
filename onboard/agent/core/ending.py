"""The end of an agent's life: its vehicle is left in a mode that the autopilot holds alone."""

from __future__ import annotations

from math import inf

from onboard.agent.core.flight import Flight
from onboard.agent.core.journal import Journal
from onboard.agent.core.schedule import EARLY_S, Grid
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.autopilot.base import Stage
from onboard.wire.bus.messages import Severity

LEAVE_S = 1.4  # to leave the vehicle in a mode it can hold alone
LEAVE_STEP_S = 0.05


class Ending:
    """Leaves one vehicle through the supervisor, as far as it is the agent's to leave."""

    def __init__(self, vehicle: VehicleLink, flight: Flight, journal: Journal, *, mute: bool) -> None:
        self.begun = False
        self.complete = False
        self._vehicle, self._flight, self._journal, self._mute = vehicle, flight, journal, mute
        self._grid = Grid(LEAVE_STEP_S)
        self._until = inf

    @property
    def at(self) -> float:
        """When the next step is due [s, monotonic]; inf once all is done."""
        return self._grid.at

    def begin(self, now: float) -> None:
        """Leave the vehicle, if it is this agent's or on its way out of its hands."""
        self.begun = True
        ours = self._vehicle.stage in (Stage.ACTIVE, Stage.ENTERING, Stage.LEAVING)
        if self._mute or not ours:
            self._journal.info("stopped", "the vehicle was not under this agent's control")
            self._end()
            return
        self._until = now + LEAVE_S
        self._grid.start(now)
        self._grid.due(now)
        self._step(now)

    def due(self, now: float) -> None:
        """Do what is due."""
        if self._grid.due(now):
            self._step(now)

    def _step(self, now: float) -> None:
        if now < self._until - EARLY_S and self._vehicle.stage is not Stage.LEFT:
            self._flight.leave(now)
            if self._vehicle.stage in (Stage.ACTIVE, Stage.ENTERING, Stage.LEAVING):
                return
        left = self._vehicle.stage is Stage.LEFT
        text = f"vehicle left in {self._vehicle.telemetry.mode}" + ("" if left else ", unconfirmed")
        self._journal.say(Severity.INFO if left else Severity.ERROR, "stopped", text)
        self._end()

    def _end(self) -> None:
        self._grid.stop()
        self.complete = True
