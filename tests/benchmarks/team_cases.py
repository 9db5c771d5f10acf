"""The games of the team benchmark: closed rings, staged and shipped starts, each fixed by its seed."""

from __future__ import annotations

from math import atan2, cos, degrees, pi, radians, sin
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.vectors import Vec, yaw_of
from onboard.core.route.arrival import Pose, arrive, at
from onboard.core.strategy.team.parts import setting_out
from onboard.core.strategy.team.ring import laid
from onboard.core.strategy.team.staging import stacked
from onboard.core.strategy.team.timed import LAST, WIDER
from onboard.game.scenario import Scenario, VehicleSpec
from sim_bridge.campaign.plane_in_wind import climate_of, wind_at
from sim_bridge.campaign.spatial_draw import drawn_scenario, spatial
from sim_bridge.draws import Purpose, Stream, key_of
from sim_bridge.plane_game.setup import nearest_of
from sim_bridge.programs.scenario_band import situation_of

FAR = 2000.0  # [m] radius of the rings
FIRST = 5000  # added to a seed: no game of another benchmark has the same world
PLACE_OFF, HEADING_OFF = 4.0, radians(2.0)  # [m], [rad], one sigma: as flown planes meet their places

replace = msgspec.structs.replace


class Case(NamedTuple):
    """One kind of game."""

    name: str
    words: str
    pursuers: int
    seconds: float = 0.0  # of staging before the evader moves
    front: bool = False  # one pursuer on the line to the target
    ring: bool = False


CASES = (
    *(Case(f"ring-{n}", f"closed ring of {n}, 2 km, random phase", n, ring=True) for n in (4, 5, 6)),
    *(Case(f"front-{n}", f"the same of {n}, one on the line to the target", n, ring=True, front=True)
      for n in (4, 5, 6)),
    *(Case(f"staged-{t}-{n}", f"{t} s of staging from the shipped start of {n}", n, seconds=float(t))
      for t in (60, 120) for n in (5, 6)),
    *(Case(f"shipped-{n}", f"shipped start of {n}", n) for n in (5, 6)),
)  # fmt: skip


def game_of(case: Case, seed: int) -> Scenario:
    """The game of a seed (from 1), with wind, gusts and noise; pursuers know the target."""
    base = spatial("five" if case.pursuers == 5 else "six")
    if case.ring:
        world = drawn_scenario(base, FIRST + seed)
        found = replace(world, pursuers=_ring(world, case, FIRST + seed))
    else:
        found = drawn_scenario(base, FIRST + seed)
        if case.seconds:
            found = replace(found, pursuers=_staged(found, case.seconds, FIRST + seed))
    return replace(found, parameters=replace(found.parameters, target_known=True))


def _ring(scenario: Scenario, case: Case, seed: int) -> tuple[VehicleSpec, ...]:
    phase = 0.0 if case.front else pi * Stream(key_of(seed, 1, Purpose.PLACE), 4).at(0)[0]
    e = scenario.evader
    centre = e.start()
    placed = []
    for k in range(case.pursuers):
        a = phase + 2.0 * pi * k / case.pursuers
        place = Vec(centre.x + FAR * cos(a), centre.y + FAR * sin(a), centre.z)
        ahead = lead(place, scenario.pursuers[0].speed, centre, Vec(e.speed, 0.0, 0.0))
        heading = degrees(atan2(ahead.y, ahead.x))
        one = scenario.pursuers[0]
        placed.append(replace(one, position=(place.x, place.y, -place.z), heading_deg=heading))
    return tuple(placed)


def _staged(scenario: Scenario, seconds: float, seed: int) -> tuple[VehicleSpec, ...]:
    """The pursuers where the plan's slots are, as far as they reach them in exactly that time.

    Each flies from its place and heading of the file along a path of two turns and straight lines (`arrive`)
    that takes the whole time at its airspeed. Where there is none it is where the shortest such path has
    brought it. They arrive with errors as flown ones do. The evader circles about its place until then.
    """
    height = scenario.evader.start()
    wind = wind_at(climate_of(scenario.flight.wind), height)
    s = situation_of(scenario, seconds)._replace(wind=wind)
    slots = laid(s)
    found = []
    for i, (spec, member, aim) in enumerate(zip(scenario.pursuers, s.team, slots.aims, strict=True), 1):
        own = member.vehicle
        ahead = yaw_of(lead(aim, own.speed, s.expected, setting_out(s)))
        north, east = wind.x * seconds, wind.y * seconds  # by which the air carries it
        goal = Pose(aim.x - own.position.x - north, aim.y - own.position.y - east, ahead)
        radius = WIDER * own.speed / member.limits.turn_rate
        start, length = Pose(0.0, 0.0, yaw_of(own.velocity)), own.speed * seconds
        path = arrive(start, goal, radius, length, LAST * own.speed).path
        there = at(path, min(length, path.length))
        a, b, c, _ = Stream(key_of(seed, i, Purpose.PLACE), 4).at(1)
        north, east = own.position.x + there.x + north, own.position.y + there.y + east
        place = (north + PLACE_OFF * a, east + PLACE_OFF * b)
        yaw = wrap(there.heading + HEADING_OFF * c)
        found.append(replace(spec, position=(*place, -aim.z), heading_deg=degrees(yaw)))
    # Who is late is on its way, and flown it would have kept off its mates by now (they close by 80 m/s).
    places = stacked([spec.start() for spec in found], 3.0 * scenario.parameters.separation, s.heights)
    return tuple(replace(p, position=(at.x, at.y, -at.z)) for p, at in zip(found, places, strict=True))


def near(scenario: Scenario) -> bool:
    """Whether a pursuer is nearer to the evader than is allowed at t0."""
    e = scenario.evader.start()
    least = nearest_of(scenario) - 3.0 * PLACE_OFF
    return any((p.start().x - e.x) ** 2 + (p.start().y - e.y) ** 2 < least * least for p in scenario.pursuers)


def demand(name: str) -> Case:
    """The case of a name. Raises ConfigError for an unknown one."""
    for case in CASES:
        if case.name == name:
            return case
    raise ConfigError(f"--cases: found {name}, expected some of {', '.join(one.name for one in CASES)}")
