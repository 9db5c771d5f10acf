"""The thinker of a tracker: follows a timed route by the knowledge base of 3.6 and says why."""

from __future__ import annotations

from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import norm, sub
from onboard.core.route.choice import Fix, TrackMemory, TrackRule, follow, fresh
from onboard.core.route.tracking import Setting, Strategy, Waypoint
from onboard.core.strategy.knowledge import Level, Module
from onboard.pilot.pilot import PilotDecision
from onboard.pilot.setup import Own

ORDERS = {
    "": Strategy.CHOOSE,
    "choose": Strategy.CHOOSE,
    "point-by-point": Strategy.POINT_BY_POINT,
    "pursuit": Strategy.PURSUIT,
    "straight": Strategy.STRAIGHT,
}
"""Strategies of a tracker by name; the knowledge base chooses where none is ordered."""


class TrackPilot:
    """Thinks for one vehicle on one route. Raises KeyError for an unknown strategy."""

    def __init__(
        self,
        route: tuple[Waypoint, ...],
        limits: VehicleLimits,
        nominal: float,
        ahead: float,
        strategy: str = "",
    ) -> None:
        self.route = route
        self.strategy = strategy or "choose"
        self._setting = Setting(limits, nominal, ahead, ORDERS[strategy])

    def step(
        self, time: float, own: Own, memory: TrackMemory | None
    ) -> tuple[PilotDecision, TrackMemory, bool]:
        """Decide at `time` [s since the route's start]; also gives whether the route is done.

        The own wind is the momentary estimate."""
        before = fresh() if memory is None else memory
        step = follow(self.route, self._setting, before, Fix(time, own.position, own.velocity, own.wind))
        chosen = step.rule is not TrackRule.FIXED
        velocity = step.steering.velocity
        thought = PilotDecision(
            decides=True,
            velocity=velocity,
            level=(Level.TACTICAL if chosen else Level.EXECUTIVE).name.lower(),
            module=(Module.INTELLIGENT if chosen else Module.GEOMETRIC).name.lower(),
            strategy=step.strategy.name.lower().replace("_", "-"),
            rule=step.rule.name.lower(),
            aim=step.steering.aim,
            time=step.steering.time,
            miss=step.situation.deviation,
            sigma=0.0,
            predictor="",
            lacks=(),
            own=Vehicle(own.position, sub(own.velocity, own.wind), norm(velocity)),
            others=(),
            rho=0.0,
        )
        return thought, step.memory, step.finished
