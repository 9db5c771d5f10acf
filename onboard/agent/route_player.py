"""A tracker's part: a timed route, flown from the moment the vehicle is under control. It needs no game.

The route's origin is that of a setup, where there is one, else the autopilot's home.
"""

from __future__ import annotations

from pathlib import Path

from onboard.agent import policy_from_config as limits
from onboard.agent.bus_view import Table
from onboard.agent.command_book import Orders
from onboard.agent.config import AgentConfig
from onboard.agent.game_player import Acting
from onboard.agent.journal import Journal
from onboard.agent.readiness import vehicle_lacks
from onboard.agent.vehicle_link import Craft
from onboard.autopilot.base import Stage
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.core.route.choice import TrackMemory
from onboard.game.route_file import load_route
from onboard.pilot.pilot import PilotDecision
from onboard.pilot.route_pilot import ORDERS, TrackPilot
from onboard.pilot.setup import Own
from onboard.runtime.protocols import Clock
from onboard.wire.bus.messages import LimitsMessage, Member
from onboard.wire.geodesy import Frame


class Tracking(Acting):
    """Follows one route, once. Raises ConfigError for a route or strategy that is none."""

    def __init__(
        self, config: AgentConfig, clock: Clock, craft: Craft, table: Table, orders: Orders, journal: Journal
    ) -> None:
        super().__init__(config, clock, craft, table, orders, journal)
        route = load_route(Path(config.route))
        if config.strategy not in ORDERS:
            names = ", ".join(name for name in ORDERS if name)
            raise ConfigError(f"strategy: found '{config.strategy}', expected one of: {names}")
        self.route = route
        self.done = False
        self._pilot_of_route = TrackPilot(
            route.waypoints, route.limits, route.nominal, config.track_ahead_s, config.strategy
        )
        self._track: TrackMemory | None = None
        self._begun_ns = -1
        self._placed = False

    @property
    def engaged(self) -> bool:
        """Whether the vehicle knows where its route lies."""
        return self._placed

    @property
    def late(self) -> bool:
        """A tracker waits for no master."""
        return False

    @property
    def over(self) -> bool:
        """Whether the route is flown."""
        return self.done

    def lacks(self, now: float, connected: bool) -> tuple[str, ...]:
        """What is missing before the route can begin."""
        lacks = vehicle_lacks(now, self._craft, self.policy)
        if not self._placed:
            lacks.append("a home position for the route's origin")
        return tuple(lacks)

    def game_time(self, wall_ns: int) -> float:
        """Seconds since the route's start."""
        return (wall_ns - self._begun_ns) / NS_PER_S if self._begun_ns >= 0 else 0.0

    def _follow(self, wall_ns: int) -> None:
        """Find the origin, once."""
        craft, home = self._craft, self._craft.observer.home
        if self._placed or craft.hovers is None:
            return
        setup = self._table.setup
        if setup is not None:
            o = setup.origin
            craft.observer.frame = Frame(o.latitude_deg, o.longitude_deg, o.altitude_m)
        elif home is not None:
            craft.observer.frame = Frame(home.latitude_deg, home.longitude_deg, home.altitude_m)
        else:
            return
        e = self.route.limits
        member = Member(
            id=self.config.id, role=self.config.role, speed=e.speed_max, start=(0.0, 0.0, 0.0),
            limits=LimitsMessage(*e),
        )  # fmt: skip
        envelope = limits.envelope_of(self.config, member, craft.hovers)
        self.policy = limits.policy_of(self.config, setup, craft.hovers)._replace(envelope=envelope)
        self._placed = True
        last = self.route.waypoints[-1]
        count = len(self.route.waypoints)
        self._journal.info("route", f"{self.route.name}: {count} waypoints in {last.time:.0f} s")

    def _near(self) -> bool:
        return not self.done

    def _on(self, now: float, wall_ns: int) -> bool:
        if self.done or (self._begun_ns < 0 and self._craft.stage is not Stage.ACTIVE):
            return False
        if self._begun_ns < 0:
            self._begun_ns = wall_ns
            self._journal.info("route", f"{self.route.name} begins")
        return True

    def _decide(self, now: float, wall_ns: int, own: Own) -> PilotDecision | None:
        leg = self._track.leg if self._track is not None else 1
        time = self.game_time(wall_ns)
        thought, self._track, finished = self._pilot_of_route.step(time, own, self._track)
        if self._track.leg != leg:
            late = time - self.route.waypoints[leg].time
            text = f"{leg} passed, {late:+.1f} s off its time"
            self._journal.info("waypoint", text, thought.level, thought.module)
        if finished:
            self.done = True
            self._journal.info("route", f"{self.route.name} flown")
        return thought
