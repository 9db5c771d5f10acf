"""A zone that everybody keeps out of, as `game/setup` carries it."""

from __future__ import annotations

from collections.abc import Sequence

from onboard.core.geometry.zones import (
    ENDLESS,
    MOST_CORNERS,
    MOST_ZONES,
    Prism,
    Zones,
    bent_in,
    zones_of,
)
from onboard.wire.bus.base import Message


class Zone(Message, frozen=True):
    """A no-fly zone or an obstacle: a convex polygon of (north, east) [m] and a band of heights [m]."""

    name: str  # for people
    polygon: tuple[tuple[float, float], ...]
    low: float = -ENDLESS  # above the origin; −1e9: from the ground
    high: float = ENDLESS  # above the origin; 1e9: without end


def core_zones(zones: Sequence[Zone]) -> Zones:
    """The zones for the core; none of them where one is no zone (`no_zone` says why)."""
    if no_zone(zones):
        return Zones()
    return zones_of([Prism(zone.polygon, zone.low, zone.high) for zone in zones])


def no_zone(zones: Sequence[Zone]) -> str:
    """Why these cannot be a game's zones, in words; '' if they can."""
    if len(zones) > MOST_ZONES:
        return f"{len(zones)} zones, and at most {MOST_ZONES} are known"
    for zone in zones:
        if not 3 <= len(zone.polygon) <= MOST_CORNERS or bent_in(zone.polygon) >= 0:
            return f"the zone {zone.name} is no convex polygon of 3 to {MOST_CORNERS} corners"
        if not zone.low < zone.high:
            return f"the zone {zone.name} has no height"
    return ""
