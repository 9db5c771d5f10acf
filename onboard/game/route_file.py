"""Route files (`configs/routes/*.toml`): timed waypoints, checked against what the vehicle can fly.

Positions are `[north, east, height]` in metres of the game frame, times in seconds since the
start of the route.
"""

from __future__ import annotations

from math import asin, degrees, radians
from pathlib import Path
from typing import Annotated, NamedTuple

from msgspec import Meta

from onboard.config import strict as config
from onboard.config.bounds import Coordinate, Duration, PositiveSpeed
from onboard.config.names import Title
from onboard.config.strict import StrictConfig, demand
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import Vec, clamp, distance
from onboard.core.route.tracking import Waypoint


class WaypointSpec(StrictConfig, frozen=True):
    """One waypoint."""

    position: tuple[Coordinate, Coordinate, Coordinate]  # north, east, height [m]
    time: Duration  # since the start of the route [s]


Waypoints = Annotated[
    tuple[WaypointSpec, ...],
    Meta(min_length=2, max_length=10_000, description="a start and at least one more, at most 10 000"),
]
Descent = Annotated[float, Meta(ge=-90, le=0, description="an angle in [−90, 0] deg")]
Climb = Annotated[float, Meta(ge=0, le=90, description="an angle in [0, 90] deg")]


class RouteSpec(StrictConfig, frozen=True):
    """A route file."""

    name: Title
    waypoints: Waypoints
    nominal: PositiveSpeed  # [m/s; air] of straight flight
    speed_min: PositiveSpeed  # [m/s; air] of the vehicle
    speed_max: PositiveSpeed  # [m/s; air]
    pitch_min_deg: Descent = -20.0  # of the steepest descent [deg]
    pitch_max_deg: Climb = 20.0  # of the steepest climb [deg]
    ground: Coordinate = 0.0  # height of the ground [m]
    description: str = ""

    def __post_init__(self) -> None:
        low, high = self.speed_min, self.speed_max
        demand(low <= high, "speed_min", f"{low:g} with speed_max {high:g}", "0 < min ≤ max")
        demand(low <= self.nominal <= high, "nominal", f"{self.nominal:g}", f"{low:g} to {high:g} m/s")
        for index, point in enumerate(self.waypoints):
            height = point.position[2]
            demand(height > self.ground, f"waypoints[{index}].position", f"height {height:g} m",
                   f"above the ground at {self.ground:g} m")  # fmt: skip
        for index in range(1, len(self.waypoints)):
            self._demand_reachable(index)

    def _demand_reachable(self, index: int) -> None:
        """Raise FieldError unless the vehicle can fly from the waypoint before `index` to it in its time."""
        at, point, before = f"waypoints[{index}]", self.waypoints[index], self.waypoints[index - 1]
        low, high = self.speed_min, self.speed_max
        since = point.time - before.time
        demand(since > 0, f"{at}.time", f"{point.time:g} s", f"later than {before.time:g} s")
        far = distance(vec(before), vec(point))
        demand(far > 0, f"{at}.position", "the place of the waypoint before", "another place")
        pace = f"{far:.0f} m in {since:g} s ({far / since:.1f} m/s)"
        demand(since >= far / high, f"{at}.time", f"unreachable: {pace}",
               f"at least {far / high:.1f} s at speed_max = {high:g} m/s")  # fmt: skip
        demand(since <= far / low, f"{at}.time", f"unreachable: {pace}",
               f"at most {far / low:.1f} s at speed_min = {low:g} m/s")  # fmt: skip
        rise = point.position[2] - before.position[2]
        climb = degrees(asin(clamp(rise / far, -1.0, 1.0)))
        demand(self.pitch_min_deg <= climb <= self.pitch_max_deg, f"{at}.position",
               f"unreachable: a climb of {climb:.1f} deg",
               f"{self.pitch_min_deg:g} to {self.pitch_max_deg:g} deg")  # fmt: skip


class Route(NamedTuple):
    """A route as flown."""

    name: str  # title of the file
    waypoints: tuple[Waypoint, ...]  # in the order of their times
    nominal: float  # [m/s; air]
    limits: VehicleLimits  # of the vehicle
    description: str = ""  # what it is for


def load_route(path: Path) -> Route:
    """Read a route file: waypoints above ground, times that the vehicle can meet. Raises ConfigError."""
    return route_of(config.read(path, RouteSpec))


def route_of(spec: RouteSpec) -> Route:
    """The route that a file's contents describe."""
    pitch_min, pitch_max = radians(spec.pitch_min_deg), radians(spec.pitch_max_deg)
    limits = VehicleLimits(spec.speed_min, spec.speed_max, pitch_min, pitch_max)
    waypoints = tuple(Waypoint(vec(p), p.time) for p in spec.waypoints)
    return Route(spec.name, waypoints, spec.nominal, limits, spec.description)


def vec(point: WaypointSpec) -> Vec:
    """A waypoint's place in the game frame [m; NED]: height becomes down."""
    north, east, height = point.position
    return Vec(north, east, -height)
