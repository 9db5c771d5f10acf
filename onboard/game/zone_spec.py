"""`[[zones]]` of a scenario: no-fly zones and obstacles, convex polygons or discs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated

import msgspec

from onboard.config.bounds import Coordinate, PositiveDistance
from onboard.config.names import Title
from onboard.config.strict import ConfigError, FieldError, StrictConfig, demand
from onboard.core.geometry.zones import (
    ENDLESS,
    MOST_ZONES,
    Prism,
    Zones,
    bent_in,
    clearance,
    round_about,
    zones_of,
)
from onboard.core.math.vectors import Vec
from onboard.game.fence_file import GeoFence, places_in
from onboard.wire.geodesy import Frame

Place = tuple[Coordinate, Coordinate]
Corners = Annotated[
    tuple[Place, ...], msgspec.Meta(min_length=3, max_length=12, description="3 to 12 corners [north, east]")
]


class ZoneSpec(StrictConfig, frozen=True, kw_only=True):
    """A zone that everybody keeps out of: a convex polygon of [north, east], or a disc."""

    name: Title  # for people
    polygon: Corners | None = None  # convex, corners [north, east] [m], in either direction
    centre: Place | None = None  # of a disc [north, east] [m]
    radius: PositiveDistance | None = None  # of a disc [m]
    low: Coordinate | None = None  # [m above the origin] its floor; none: from the ground
    high: Coordinate | None = None  # [m above the origin] its top; none: without end

    def __post_init__(self) -> None:
        disc = self.centre is not None and self.radius is not None
        given = "both" if self.polygon and disc else "neither"
        half = (self.centre is None) != (self.radius is None)
        demand(not half, "centre", f"centre {self.centre} with radius {self.radius}", "both of a disc")
        demand((self.polygon is not None) != disc, "polygon", f"{given} of polygon and disc", "one of them")
        self.demand_whole()
        low, high = self.low, self.high
        demand(low is None or high is None or low < high, "low", low, f"below high = {high} m")

    def demand_whole(self) -> None:
        """Demand a convex polygon of 3 to 12 corners, or a disc that has a size."""
        demand(self.radius is None or self.radius > 0.0, "radius", self.radius, "a positive radius [m]")
        if self.polygon is not None:
            corners = len(self.polygon)
            demand(3 <= corners <= 12, "polygon", f"{corners} corners", "3 to 12 corners")
            bent = bent_in(self.polygon)
            demand(bent < 0, "polygon", f"corner {bent} at {list(self.polygon[bent])} bends inwards",
                   "a convex polygon (make two zones of it)")  # fmt: skip

    def prism(self) -> Prism:
        """The zone for the core."""
        polygon: tuple[tuple[float, float], ...] = self.polygon or ()
        if self.centre is not None and self.radius is not None:
            polygon = round_about(self.centre, self.radius)
        return Prism(
            polygon, -ENDLESS if self.low is None else self.low, ENDLESS if self.high is None else self.high
        )


def zones_in(frame: Frame, found: GeoFence, name: str) -> tuple[ZoneSpec, ...]:
    """The areas of another tool's fence to keep out of, as zones in a game frame. Raises ConfigError."""
    made = []
    for number, out in enumerate(found.outs, 1):
        places = places_in(out.corners, frame, name)
        title = f"keep out {number}"
        try:
            if out.radius:
                made.append(ZoneSpec(name=title, centre=places[0], radius=out.radius))
            else:
                made.append(ZoneSpec(name=title, polygon=places))
        except FieldError as error:
            raise ConfigError(f"{name}: {title}: {error}") from None
    return tuple(made)


def core_zones(zones: Sequence[ZoneSpec]) -> Zones:
    """The zones for the core."""
    return zones_of([zone.prism() for zone in zones])


def demand_zones(zones: Sequence[ZoneSpec], places: Mapping[str, Sequence[float]], planar: bool) -> None:
    """Raise FieldError unless zones lie apart and no start and no target of `places` is inside one.

    `places` are [north, east(, height)] by their keys.
    """
    demand(len(zones) <= MOST_ZONES, "zones", f"{len(zones)} zones", f"at most {MOST_ZONES}")
    names = [zone.name for zone in zones]
    demand(len(set(names)) == len(names), "zones.name", names, "names that differ")
    made = core_zones(zones)
    for index, zone in enumerate(zones):
        for key in ("low", "high"):
            demand(not planar or getattr(zone, key) is None, f"zones[{index}].{key}", getattr(zone, key),
                   "none: this game is in the plane")  # fmt: skip
        area = made.areas[index]
        for place_key, place in places.items():
            here = Vec(place[0], place[1], -place[2] if len(place) == 3 else 0.0)
            demand(clearance(made, area, here, planar) > 0.0, place_key, list(place),
                   f"a place outside the zone {zone.name}")  # fmt: skip
        for other in range(index):
            demand(not _meet(zone.prism(), zones[other].prism()), f"zones[{index}].polygon",
                   f"{zone.name} overlaps {names[other]}", "zones apart, or one about both")  # fmt: skip


def _meet(one: Prism, two: Prism) -> bool:
    """Whether two zones have a place in common: no wall or height parts them."""
    if one.low > two.high or two.low > one.high:
        return False
    for a, b in ((one, two), (two, one)):
        made = zones_of([a])
        for wall in made.walls:
            if all(wall.nx * x + wall.ny * y > wall.level for x, y in b.polygon):
                return False
    return True
