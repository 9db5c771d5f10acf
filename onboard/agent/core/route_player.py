"""A tracker's part: a timed route, flown from the moment the vehicle is under control. It needs no game.

The route's origin is that of a setup, where there is one, else the autopilot's home.
"""

from __future__ import annotations

from onboard.agent.config import AgentConfig
from onboard.agent.core import policy_from_config as limits
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.events import Instant
from onboard.agent.core.journal import Journal
from onboard.agent.core.part import PartState, Way
from onboard.agent.core.readiness import vehicle_lacks
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.autopilot.base import Stage
from onboard.autopilot.flight_limits import FlightLimits
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.states import Mate
from onboard.core.route.choice import TrackMemory
from onboard.core.safety.policy import Policy
from onboard.core.strategy.knowledge import Decision
from onboard.game.route_file import Route
from onboard.pilot.pilot import PilotDecision, Question
from onboard.pilot.route_pilot import ORDERS, TrackPilot
from onboard.pilot.setup import Own, Side
from onboard.wire.bus.messages import LimitsMessage, Member
from onboard.wire.geodesy import Frame


class RoutePlayer:
    """Follows one route, once; see `part.Part`. Raises ConfigError for a strategy that is none."""

    def __init__(
        self, config: AgentConfig, route: Route, vehicle: VehicleLink, bus: BusView, journal: Journal
    ) -> None:
        if config.strategy not in ORDERS:
            names = ", ".join(name for name in ORDERS if name)
            raise ConfigError(f"strategy: found '{config.strategy}', expected one of: {names}")
        self.config = config
        self.route = route
        self.side = Side.PURSUER
        self.policy = limits.policy_of(config, None, True)
        self.strategy = config.strategy
        self._vehicle, self._bus, self._journal = vehicle, bus, journal
        self._pilot = TrackPilot(
            route.waypoints, route.limits, route.nominal, config.track_ahead_s, config.strategy
        )
        self._track: TrackMemory | None = None
        self._begun_ns = -1
        self._limits = FlightLimits()  # the autopilot's, that the policy keeps
        self._placed = False  # the vehicle knows where its route lies
        self._done = False

    def follow(self, now: Instant) -> None:
        """Find the origin, once; begin when the vehicle is under control."""
        hovers = self._vehicle.hovers
        if hovers is not None and not self._vehicle.unread:
            if not self._placed:
                self._place(hovers)
            elif self._vehicle.limits != self._limits:
                self.policy = self._policy_of(hovers)
        ready = self._placed and not self._done
        if ready and self._begun_ns < 0 and self._vehicle.stage is Stage.ACTIVE:
            self._begun_ns = now.wall_ns
            self._journal.info("route", f"{self.route.name} begins")

    def state(self, wall_ns: int) -> PartState:
        """Where the route stands."""
        begun = self._begun_ns >= 0
        return PartState(
            engaged=self._placed, near=not self._done, on=begun and not self._done, over=self._done
        )

    def let_in(self) -> None:
        """Nothing to do: a route has no beginning to be missed."""

    def withdraw(self) -> None:
        """Nothing to do."""

    def approach(self, now: Instant, own: Own) -> Way | None:
        """A route begins where the vehicle is."""
        return None

    def place_s(self, now: Instant) -> float:
        """A route waits for no place."""
        return 0.0

    def ask(self, now: Instant, own: Own) -> Question | PilotDecision:
        """The route's own rules decide: nobody needs to be asked."""
        leg = self._track.leg if self._track is not None else 1
        time = self.time(now.wall_ns)
        decision, self._track, finished = self._pilot.step(time, own, self._track)
        if self._track.leg != leg:
            late = time - self.route.waypoints[leg].time
            text = f"{leg} passed, {late:+.1f} s off its time"
            self._journal.info("waypoint", text, decision.level, decision.module)
        if finished:
            self._done = True
            self._journal.info("route", f"{self.route.name} flown")
        return decision

    def conclude(self, question: Question, decision: Decision) -> PilotDecision:
        """Never called: a route asks no strategy."""
        raise AssertionError("a route asks no strategy")

    def obstacles(self, now: float) -> tuple[Mate, ...]:
        """Nobody's."""
        return ()

    def lacks(self, now: Instant) -> tuple[str, ...]:
        """What is missing before the route can begin."""
        lacks = vehicle_lacks(now.s, self._vehicle, self.policy)
        if not self._placed:
            lacks.append("a home position for the route's origin")
        return tuple(lacks)

    def time(self, wall_ns: int) -> float:
        """Seconds since the route's start."""
        return (wall_ns - self._begun_ns) / NS_PER_S if self._begun_ns >= 0 else 0.0

    def train(self, wall_ns: int) -> None:
        """A route has nothing to learn."""

    def _place(self, hovers: bool) -> None:
        vehicle, setup, home = self._vehicle, self._bus.setup, self._vehicle.observer.home
        if setup is not None:
            o = setup.origin
            vehicle.observer.frame = Frame(o.latitude_deg, o.longitude_deg, o.altitude_m)
        elif home is not None:
            vehicle.observer.frame = Frame(home.latitude_deg, home.longitude_deg, home.altitude_m)
        else:
            return
        self.policy = self._policy_of(hovers)
        self._placed = True
        last, count = self.route.waypoints[-1], len(self.route.waypoints)
        self._journal.info("route", f"{self.route.name}: {count} waypoints in {last.time:.0f} s")

    def _policy_of(self, hovers: bool) -> Policy:
        """The supervisor's policy with the limits of route, configuration and autopilot."""
        e, own = self.route.limits, self._vehicle.limits
        self._limits = own
        member = Member(
            id=self.config.id, role=self.config.role, speed=e.speed_max, start=(0.0, 0.0, 0.0),
            limits=LimitsMessage(*e),
        )  # fmt: skip
        envelope = limits.envelope_of(self.config, member, hovers, own)
        return limits.policy_of(self.config, self._bus.setup, hovers, own)._replace(envelope=envelope)
