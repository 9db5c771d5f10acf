"""`[[zones]]` of a scenario: no-fly zones and obstacles, convex polygons or discs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated

import msgspec

from onboard.config.bounds import Coordinate, PositiveDistance
from onboard.config.names import Title
from onboard.config.strict import StrictConfig, demand
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
        if self.polygon is not None:
            bent = bent_in(self.polygon)
            demand(bent < 0, "polygon", f"corner {bent} at {list(self.polygon[bent])} bends inwards",
                   "a convex polygon (make two zones of it)")  # fmt: skip
        low, high = self.low, self.high
        demand(low is None or high is None or low < high, "low", low, f"below high = {high} m")

    def prism(self) -> Prism:
        """The zone for the core."""
        polygon: tuple[tuple[float, float], ...] = self.polygon or ()
        if self.centre is not None and self.radius is not None:
            polygon = round_about(self.centre, self.radius)
        return Prism(
            polygon, -ENDLESS if self.low is None else self.low, ENDLESS if self.high is None else self.high
        )


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
