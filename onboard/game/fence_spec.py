"""`[flight.fence]` of a scenario: a polygon, or the file of another tool that holds one."""

from __future__ import annotations

from typing import Annotated

import msgspec

from onboard.config.bounds import Coordinate
from onboard.config.fence_check import demand_fence
from onboard.config.strict import ConfigError, FieldError, StrictConfig, demand
from onboard.core.safety.fence import inside
from onboard.game.fence_file import GeoFence, polygon_in
from onboard.wire.geodesy import Frame

Polygon = Annotated[
    tuple[tuple[Coordinate, Coordinate], ...], msgspec.Meta(min_length=3, description="three or more corners")
]


class FenceSpec(StrictConfig, frozen=True, kw_only=True):
    """Geofence: polygon of [north, east], or another tool's file that holds one, and a height band [m]."""

    height_min: Coordinate  # [m] floor
    height_max: Coordinate  # [m] ceiling
    polygon: Polygon = ()  # corners [north, east] [m]
    file: str = ""  # beside the scenario: QGroundControl's .plan, MAVProxy's fence, KML

    def __post_init__(self) -> None:
        given = "both" if self.polygon and self.file else "neither"
        demand(
            bool(self.polygon) != bool(self.file), "polygon", f"{given} of polygon and file", "one of them"
        )
        if self.polygon:
            demand_fence(self.polygon, self.height_min, self.height_max)


def demand_start(fence: FenceSpec, key: str, place: tuple[float, ...], up: float | None) -> None:
    """Raise FieldError for `key` unless a start [m; north, east] is inside, `up` [m] high (None: landed)."""
    within = up is None or fence.height_min <= up <= fence.height_max
    at = "" if up is None else f" at {up:g} m"
    demand(within and inside(place[0], place[1], fence.polygon), key,
           f"[{place[0]:g}, {place[1]:g}]{at}, outside flight.fence", "a start within it")  # fmt: skip


def fence_in(frame: Frame, spec: FenceSpec | None, found: GeoFence, name: str) -> FenceSpec:
    """Another tool's fence in a game frame, with the height band of `spec`. Raises ConfigError."""
    if spec is None:
        raise ConfigError(f"{name}: found no height_min and height_max, expected them in [flight.fence]")
    polygon = polygon_in(found, frame, name)
    try:
        return FenceSpec(height_min=spec.height_min, height_max=spec.height_max, polygon=polygon)
    except FieldError as error:
        raise ConfigError(f"{name}: {error}") from None
