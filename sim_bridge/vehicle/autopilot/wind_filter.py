"""The wind that a simulated autopilot tells: its own estimate, not the world's."""

from __future__ import annotations

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO, scale, sub
from onboard.game.scenario import WINGED, Kind
from sim_bridge.vehicle.motion import Air, Motion
from sim_bridge.vehicle.wind.estimate import (
    ARDUPILOT,
    EVERY,
    ON_GROUND,
    PX4,
    Errors,
    Lean,
    Sensed,
    begun,
    estimated,
    estimated_by_drag,
    wind_of,
)

EVERY_NS = round(EVERY * NS_PER_S)


class WindFilter:
    """The estimate of one autopilot, brought on every `EVERY` seconds of flight.

    Without `errors` it is the mean wind itself, as in still air.
    """

    def __init__(self, kind: Kind, errors: Errors | None) -> None:
        self.wind = ZERO  # [m/s; NED, where the air moves to]
        self._winged = kind in WINGED
        self._trust = PX4 if kind in (Kind.PX4, Kind.PX4_PLANE) else ARDUPILOT
        self._errors = errors
        self.estimate = ON_GROUND  # where there are errors
        self._due_ns = -1  # −1: not begun
        self._velocity = ZERO  # [m/s] at the last update

    @property
    def still(self) -> bool:
        """Whether it knows the wind, and needs no steps for it."""
        return self._errors is None

    def step(self, now_ns: int, motion: Motion, air: Air, landed: bool) -> None:
        """Take the vehicle's `motion`; of `air` an estimate knows nothing but what it starts with."""
        if self._errors is None:
            self.wind = air.wind
            return
        if self._due_ns < 0:
            self._due_ns, self._velocity = now_ns, motion.velocity
            self.estimate = ON_GROUND if landed else begun(air.wind, self._errors)
        if now_ns < self._due_ns:
            return
        self._due_ns += EVERY_NS
        if not landed and self._winged:
            sensed = Sensed(motion.velocity, motion.airspeed, motion.yaw)
            self.estimate = estimated(self.estimate, self._trust, self._errors, sensed)
        elif not landed:
            acceleration = scale(sub(motion.velocity, self._velocity), 1.0 / EVERY)
            lean = Lean(motion.roll, motion.pitch, motion.yaw, motion.velocity, acceleration)
            self.estimate = estimated_by_drag(self.estimate, self._errors, lean)
        self._velocity = motion.velocity
        self.wind = wind_of(self.estimate)
