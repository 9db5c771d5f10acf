"""`gcs fence FILE`: another tool's fence, checked, and as a scenario writes it."""

from __future__ import annotations

from pathlib import Path

from onboard.config.fence_check import demand_fence
from onboard.config.strict import ConfigError, FieldError
from onboard.core.geometry.polygon import area, extent
from onboard.game.fence_file import GeoFence, polygon_in, read_fence
from onboard.game.scenario import Scenario, with_fence
from onboard.game.zone_spec import zones_in
from onboard.wire.geodesy import Frame


def show(file: Path, scenario: Scenario | None) -> list[str]:
    """What a fence holds, in lines; in a scenario's frame, with its vehicles inside. Raises ConfigError.

    Without a scenario the frame's origin is the fence's first corner."""
    found = read_fence(file)
    if scenario is None:
        return _alone(file, found)
    origin = scenario.flight.origin
    fence = scenario.flight.fence
    polygon = polygon_in(found, Frame(*_place(scenario)), str(file))
    _sound(polygon, str(file))
    zones: list[str] = []
    lines = [
        _words(file, found, polygon),
        f"in metres from {scenario.name}'s origin, {origin.latitude_deg:.6f}, {origin.longitude_deg:.6f}:",
        "",
        "[flight.fence]",
        f"polygon = [{', '.join(f'[{north:.1f}, {east:.1f}]' for north, east in polygon)}]",
    ]
    for zone in zones_in(Frame(*_place(scenario)), found, str(file)):
        shape = f"centre = {list(zone.centre)}\nradius = {zone.radius:g}" if zone.centre else ""
        if zone.polygon:
            shape = f"polygon = [{', '.join(f'[{north:.1f}, {east:.1f}]' for north, east in zone.polygon)}]"
        zones += ["", "[[zones]]", f'name = "{zone.name}"', *shape.splitlines()]
    if fence is None:
        return [*lines, "# height_min and height_max [m above the origin] are yours to say", *zones]
    with_fence(scenario, found, str(file))  # everybody starts within it
    heights = [f"height_min = {fence.height_min:g}", f"height_max = {fence.height_max:g}"]
    everybody = f"all {len(scenario.vehicles)} vehicles of {scenario.name} start within it"
    return [*lines, *heights, *zones, "", everybody]


def _alone(file: Path, found: GeoFence) -> list[str]:
    (latitude, longitude), *_ = found.corners
    polygon = polygon_in(found, Frame(latitude, longitude, 0.0), str(file))
    _sound(polygon, str(file))
    corners = [f"  {one:.7f}, {other:.7f}" for one, other in found.corners]
    kept = [f"{len(found.outs)} areas to keep out of"] if found.outs else []
    return [_words(file, found, polygon), *kept, "corners by latitude, longitude:", *corners]


def _words(file: Path, found: GeoFence, polygon: tuple[tuple[float, float], ...]) -> str:
    north, east = extent(polygon)
    size = f"{north:.0f} m north to south, {east:.0f} m east to west, {area(polygon) / 1e4:.2f} ha"
    return f"{file}: {found.origin}, {len(polygon)} corners, {size}"


def _place(scenario: Scenario) -> tuple[float, float, float]:
    origin = scenario.flight.origin
    return origin.latitude_deg, origin.longitude_deg, origin.altitude_m


def _sound(polygon: tuple[tuple[float, float], ...], name: str) -> None:
    try:
        demand_fence(polygon, 0.0, 1.0)  # its heights are the scenario's
    except FieldError as error:
        raise ConfigError(f"{name}: {error}") from None
