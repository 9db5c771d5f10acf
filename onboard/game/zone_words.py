"""What a scenario's zones mean for its game, in lines for people."""

from __future__ import annotations

from onboard.core.geometry.zone_rays import Stand, looking
from onboard.core.geometry.zone_ways import way_round
from onboard.core.geometry.zones import FAR, Area, clearance
from onboard.core.math.vectors import NORTH, ZERO, Vec, distance, sub, unit
from onboard.core.strategy.keep_out import margin_of
from onboard.game.scenario import Scenario
from onboard.game.vehicle_spec import targets_of


def zone_lines(scenario: Scenario) -> list[str]:
    """The zones, whom they keep from flying straight, and what is kept to them; nothing without zones."""
    zones = scenario.rules.zones
    if not zones.areas:
        return []
    lines = [
        f"zone {spec.name}: {_size(spec.prism().polygon)}{_heights(area)}"
        for spec, area in zip(scenario.zones, zones.areas, strict=True)
    ]
    for evader, id in zip(scenario.evading, scenario.evader_ids, strict=True):
        here, margin = evader.start(), margin_of(evader.limits(), evader.speed, ZERO)
        for goal in targets_of(evader):
            ahead = unit(sub(goal, here), NORTH)
            stand = Stand(zones, here, goal, margin, scenario.planar, ahead, 1.0)
            way = way_round(looking(stand, evader.speed, ZERO, distance(here, goal)), goal)
            straight = distance(here, goal)
            if way.length >= FAR:
                lines.append(f"warning: no way round the zones leads evader {id} to its target")
            elif way.round:
                lines.append(
                    f"evader {id}: the zones are in the way to its target: {way.length:.0f} m round them,"
                    f" {straight:.0f} m straight; {way.length / evader.speed:.1f} s"
                )
            lines += _near(scenario, "a target", goal, margin)
    for key, spec in scenario.keyed().items():
        kept = margin_of(spec.limits(), spec.speed, ZERO)
        lines += _near(scenario, f"{key}.position", spec.start(), kept)
    return lines


def _size(polygon: tuple[tuple[float, float], ...]) -> str:
    north, east = zip(*polygon, strict=True)
    return (
        f"{len(polygon)} corners, north {min(north):.0f} to {max(north):.0f} m, east {min(east):.0f} to"
        f" {max(east):.0f} m"
    )


def _heights(area: Area) -> str:
    if abs(area.low) > FAR and abs(area.high) > FAR:
        return ""
    low = "the ground" if abs(area.low) > FAR else f"{area.low:g} m"
    high = "without end" if abs(area.high) > FAR else f"to {area.high:g} m"
    return f", from {low} {high}"


def _near(scenario: Scenario, what: str, place: Vec, margin: float) -> list[str]:
    """A warning for each zone nearer to a place than what a vehicle keeps to it."""
    zones = scenario.rules.zones
    found = []
    for spec, area in zip(scenario.zones, zones.areas, strict=True):
        gap = clearance(zones, area, place, scenario.planar)
        if gap < margin:
            found.append(
                f"warning: {what} is {gap:.0f} m from the zone {spec.name}; {margin:.0f} m are kept to zones"
            )
    return found
