"""Route files (`configs/routes/*.toml`): timed waypoints, checked against what the vehicle can fly.

Positions are `[north, east, height]` in metres of the game frame, times in seconds since the
start of the route.
"""

from __future__ import annotations

from math import asin, degrees, radians
from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config import strict as config
from onboard.config.strict import ConfigError
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import Vec, distance
from onboard.core.route.tracking import Waypoint


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Base of all parts of a route file: frozen and strict."""


class WaypointSpec(Part, frozen=True, kw_only=True):
    """One waypoint."""

    position: tuple[float, float, float]
    time: float


class RouteSpec(Part, frozen=True, kw_only=True):
    """A route file."""

    name: str
    waypoints: tuple[WaypointSpec, ...]
    nominal: float  # [m/s; air] of straight flight
    speed_min: float  # [m/s; air] of the vehicle
    speed_max: float
    pitch_min_deg: float = -20.0
    pitch_max_deg: float = 20.0
    ground: float = 0.0  # height of the ground [m]
    description: str = ""


class Route(NamedTuple):
    """A route as flown."""

    name: str
    waypoints: tuple[Waypoint, ...]
    nominal: float  # [m/s; air]
    limits: VehicleLimits


def load_route(path: Path) -> Route:
    """Read and check a route file. Raises ConfigError with file, key, found and expected."""
    return check_route(config.read(path, RouteSpec), str(path))


def check_route(spec: RouteSpec, name: str) -> Route:
    """Demand what types cannot say: waypoints above ground, times that the vehicle can meet."""

    def demand(ok: bool, key: str, found: object, expected: str) -> None:
        if not ok:
            raise ConfigError(f"{name}: {key}: found {found}, expected {expected}")

    low, high = spec.speed_min, spec.speed_max
    demand(0 < low <= high, "speed_min", f"{low:g} with speed_max {high:g}", "0 < min ≤ max")
    demand(low <= spec.nominal <= high, "nominal", f"{spec.nominal:g}", f"{low:g} to {high:g} m/s")
    pitch = (spec.pitch_min_deg, spec.pitch_max_deg)
    demand(-90 <= pitch[0] <= 0 <= pitch[1] <= 90, "pitch_min_deg",
           f"{pitch[0]:g} with pitch_max_deg {pitch[1]:g}", "−90 ≤ min ≤ 0 ≤ max ≤ 90")  # fmt: skip
    points = spec.waypoints
    demand(len(points) >= 2, "waypoints", f"{len(points)}", "a start and at least one more")
    for index, point in enumerate(points):
        at = f"waypoints[{index}]"
        height = point.position[2]
        demand(height > spec.ground, f"{at}.position", f"height {height:g} m",
               f"above the ground at {spec.ground:g} m")  # fmt: skip
        if index == 0:
            demand(point.time >= 0, f"{at}.time", f"{point.time:g}", "zero or more [s]")
            continue
        before = points[index - 1]
        since = point.time - before.time
        demand(since > 0, f"{at}.time", f"{point.time:g} s", f"later than {before.time:g} s")
        far = distance(vec(before), vec(point))
        demand(far > 0, f"{at}.position", "the place of the waypoint before", "another place")
        pace = f"{far:.0f} m in {since:g} s ({far / since:.1f} m/s)"
        soonest, latest = far / high, far / low
        demand(since >= soonest, f"{at}.time", f"unreachable: {pace}",
               f"at least {soonest:.1f} s at speed_max = {high:g} m/s")  # fmt: skip
        demand(since <= latest, f"{at}.time", f"unreachable: {pace}",
               f"at most {latest:.1f} s at speed_min = {low:g} m/s")  # fmt: skip
        climb = degrees(asin(max(-1.0, min(1.0, (height - before.position[2]) / far))))
        demand(pitch[0] <= climb <= pitch[1], f"{at}.position", f"unreachable: a climb of {climb:.1f} deg",
               f"{pitch[0]:g} to {pitch[1]:g} deg")  # fmt: skip
    limits = VehicleLimits(low, high, radians(pitch[0]), radians(pitch[1]))
    return Route(spec.name, tuple(Waypoint(vec(p), p.time) for p in points), spec.nominal, limits)


def vec(point: WaypointSpec) -> Vec:
    """A waypoint's place in the game frame: height becomes down."""
    north, east, height = point.position
    return Vec(north, east, -height)
