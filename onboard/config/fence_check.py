"""What a fence must be, wherever it is written: a scenario, an agent's configuration, another tool's file."""

from __future__ import annotations

from onboard.config.strict import demand
from onboard.core.geometry.polygon import Corner, area, crossing, extent, width, without_repeats

CORNERS_MAX = 500  # each is looked at in every control step
SMALLEST = 3.0  # [m] of a fence on its longer side; less are degrees
WIDTH_MIN = 0.01  # [m]
AREA_MIN = 1.0  # [m²]


def demand_fence(polygon: tuple[Corner, ...], low: float, high: float) -> None:
    """Raise FieldError for a fence that encloses nothing: corners [m; north, east], heights [m]."""
    demand(low < high, "height_min", low, f"less than height_max = {high:g} m")
    corners = without_repeats(polygon)
    demand(len(corners) <= CORNERS_MAX, "polygon", f"{len(corners)} corners", f"at most {CORNERS_MAX}")
    north, east = extent(polygon)
    metres = "metres north and east of the origin (degrees? name the file that they came from: file = …)"
    demand(max(north, east) >= SMALLEST, "polygon", f"a fence of {north:.4g} × {east:.4g} m", metres)
    demand(width(corners) >= WIDTH_MIN, "polygon", "corners on one line", "corners that enclose something")
    i, j = crossing(corners)
    demand(i < 0, "polygon", f"edges from corners {i + 1} and {j + 1} that cross or touch",
           "corners in their order around the fence")  # fmt: skip
    demand(area(corners) >= AREA_MIN, "polygon", f"an area of {area(corners):.2g} m²",
           "corners that enclose something")  # fmt: skip
