"""The tracking comparison: one route, many seeds, four ways to fly it, on the aircraft as flown.

J = mean deviation at the waypoints / 10 m + mean |time error| / 1 s, fixed in advance. The deviation is the
distance at the closest approach to a waypoint, the time error its instant less the waypoint's.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import sqrt
from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from onboard.core.math.vectors import add, distance, sub, yaw_of
from onboard.core.route.choice import Fix, follow, fresh
from onboard.core.route.tracking import Setting, Strategy, Waypoint, pseudo_target
from onboard.game.route_file import Route
from onboard.game.scenario import WindSpec
from onboard.runtime.progress import Tell, over, part, silent
from sim_bridge.campaign.compiled import register
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.campaign.plane_in_wind import (
    Climate,
    blown,
    climate_of,
    command_for,
    drawn_wind,
    fly,
    gust_at,
    gust_tick,
    launched,
    wind_at,
)
from sim_bridge.draws import Key, Purpose, key_of
from sim_bridge.vehicle.flight import KERNELS as FLIGHT
from sim_bridge.vehicle.flight.aircraft import named, within
from sim_bridge.vehicle.flight.plane import PlaneModel, PlaneState, start_state, trimmed
from sim_bridge.vehicle.wind import KERNELS as WIND
from sim_bridge.vehicle.wind.dryden import gust_noise

CONTROL_EVERY = 5  # samples between two decisions: 20 Hz
OVERTIME = 90.0  # [s] after the last waypoint's instant at which a flight ends at the latest
AHEAD = {"nose": 6.0, "slip": 15.0, "coordinated": 6.0}  # [s] how far pursuit looks ahead, by path model
WAYS = {
    "Strategy 1 (30)": Strategy.POINT_BY_POINT,
    "Strategy 2 (31)": Strategy.PURSUIT,
    "intelligent module": Strategy.CHOOSE,
    "straight flight": Strategy.STRAIGHT,
}
KERNELS = (
    *FLIGHT,
    *WIND,
    "onboard.core.geometry.apollonius",
    "onboard.core.route.tracking",
    "onboard.core.route.choice",
    "sim_bridge.campaign.plane_in_wind",
)

Array = NDArray[np.float64]


class Tracked(NamedTuple):
    """How a flight along a route went."""

    passed: int  # waypoints
    pursuing: float  # share of the time under Strategy 2
    switches: int
    away: float  # mean distance to the pseudo-target [m]


class Craft(NamedTuple):
    """An aircraft at the start of its route."""

    plane: PlaneState
    model: PlaneModel


def fly_route(
    craft: Craft,
    route: tuple[Waypoint, ...],
    setting: Setting,
    climate: Climate,
    gusts: Key,
    out: Array,
) -> Tracked:
    """Fly a route; `gusts` is the key of what drives them, `out` (waypoints, 2): deviation [m] and time
    error [s].

    Kernel style.
    """
    plane, model = craft
    flown = launched(plane, gust_noise(gusts, 0))
    memory = fresh()
    command = command_for(sub(plane.velocity, wind_at(climate, plane.position)), plane.course)
    last = len(route) - 1
    count = int((route[last].time + OVERTIME) / model.dt)
    best = 1e300
    when = 0.0
    pursued = 0
    switches = 0
    away = 0.0
    steps = 0
    for k in range(count):
        time = k * model.dt
        tick = gust_tick(k)
        if tick >= 0:
            flown = blown(flown, model, climate, gust_noise(gusts, tick))
        state = flown.plane
        far = distance(state.position, route[memory.leg].position)
        if far < best:
            best = far
            when = time
        if k % CONTROL_EVERY == 0:
            air = add(wind_at(climate, state.position), gust_at(climate, flown, model))
            before = memory
            step = follow(route, setting, memory, Fix(time, state.position, state.velocity, air))
            memory = step.memory
            if memory.leg != before.leg:
                out[before.leg - 1, 0] = best
                out[before.leg - 1, 1] = when - route[before.leg].time
                best = 1e300
            if step.finished:
                break
            if step.strategy == Strategy.PURSUIT:
                pursued += 1
            if step.strategy != before.strategy:
                switches += 1
            away += distance(pseudo_target(route, time).position, state.position)
            steps += 1
            command = command_for(step.steering.velocity, state.course)
        flown = fly(flown, model, command, climate)
    total = max(steps, 1)
    return Tracked(memory.leg - 1, pursued / total, switches, away / total)


@cache
def compiled_route() -> Callable[..., Tracked]:
    """`fly_route` compiled; once for each number of waypoints."""
    register(KERNELS)
    return kernel(fly_route)


class Flight(NamedTuple):
    """One seed flown one way."""

    deviations: Array  # (waypoints,) [m]
    time_errors: Array  # (waypoints,) [s]
    tracked: Tracked


def fly_seed(
    route: Route, aircraft: str, way: Strategy, seed: int, wind: WindSpec, interpreted: bool = False
) -> Flight:
    """Fly a route once. The mean wind comes from a direction drawn from the seed, as do the gusts."""
    climate = climate_of(msgspec.structs.replace(wind, from_deg=drawn_wind(seed)))
    points = route.waypoints
    model = within(named(aircraft).model, route.limits)
    leg = sub(points[1].position, points[0].position)
    plane = trimmed(
        start_state(points[0].position, yaw_of(leg), route.nominal, wind_at(climate, points[0].position)),
        model,
    )
    out = np.full((len(points) - 1, 2), np.nan)
    setting = Setting(route.limits, route.nominal, AHEAD[aircraft], way)
    play = fly_route if interpreted else compiled_route()
    tracked = play(Craft(plane, model), points, setting, climate, key_of(seed, 1, Purpose.GUST), out)
    return Flight(out[:, 0], out[:, 1], Tracked(*tracked))


class Row(NamedTuple):
    """One way over all seeds."""

    way: str
    deviation: float  # mean over waypoints and seeds [m]
    time_error: float  # mean |…| [s]
    J: float
    J_half_width: float  # of the 95 % confidence interval of J over seeds
    away: float  # mean distance to the pseudo-target on the way [m]
    pursuing: float  # share of the time under Strategy 2
    switches: float  # per flight
    missed: int  # waypoints never passed


def compare(route: Route, aircraft: str, seeds: range, wind: WindSpec, tell: Tell = silent) -> list[Row]:
    """All four ways over the same seeds."""
    rows = []
    for number, (way, ordered) in enumerate(WAYS.items()):
        flown = over(seeds, part(tell, number, len(WAYS)), f"{aircraft}, {way}")
        flights = [fly_seed(route, aircraft, ordered, seed, wind) for seed in flown]
        deviation = np.array([f.deviations for f in flights])  # (seeds, waypoints)
        error = np.abs(np.array([f.time_errors for f in flights]))
        each = np.mean(deviation, axis=1) / 10.0 + np.mean(error, axis=1)
        rows.append(
            Row(
                way,
                float(np.mean(deviation)),
                float(np.mean(error)),
                float(np.mean(each)),
                1.96 * float(np.std(each, ddof=1)) / sqrt(len(each)) if len(each) > 1 else 0.0,
                float(np.mean([f.tracked.away for f in flights])),
                float(np.mean([f.tracked.pursuing for f in flights])),
                float(np.mean([f.tracked.switches for f in flights])),
                int(np.sum(np.isnan(deviation))),
            )
        )
    return rows


def table(rows: list[Row]) -> str:
    """A comparison as a Markdown table."""
    lines = [
        "| way | deviation at waypoints [m] | time error [s] | J (95 %) | to the pseudo-target [m] |"
        " time in Strategy 2 | switches |",
        "|---|---|---|---|---|---|---|",
    ]
    for r in rows:
        lines.append(
            f"| {r.way} | {r.deviation:.2f} | {r.time_error:.3f} | {r.J:.3f} ± {r.J_half_width:.3f} |"
            f" {r.away:.0f} | {100.0 * r.pursuing:.0f} % | {r.switches:.1f} |"
        )
    return "\n".join(lines)
