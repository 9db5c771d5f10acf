"""Everybody's way in space, in orthographic projection, for paper and PNG; on a screen the scene plays."""

from __future__ import annotations

from math import ceil, cos, floor, log10, radians, sin
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from gcs.report.data import Array, Run
from gcs.report.drawing import FAINT, GRID, INK, PAPER, POINTS, WIDTH, Drawing, legend_below, thin
from onboard.game import palette

HEADING, ELEVATION = radians(-32.0), radians(28.0)  # of the first view: from the south-south-east, from above
MARGIN = (60.0, 40.0)  # kept free around the box: sideways, up and down [points]
MOST = 400  # points of a way
FLATTEST = 0.2  # a lower height is drawn this share of the width high, and that is said


class Box(NamedTuple):
    """What is shown, and how: places are (east, north, height) [m]."""

    low: Array  # (3,)
    high: Array  # (3,)
    stretch: float  # of heights
    around: Array  # (n, 3), what must be in view from every side
    size: tuple[float, float]  # of the drawing [points]


def projected(places: Array, box: Box, heading: float, elevation: float) -> Array:
    """Places (n, 3) on the drawing (n, 2) [points, y down]: looking to `heading` [rad; from north to east]
    from `elevation` above the horizon, scaled so that all is in view."""

    def flat(at: Array) -> Array:
        east, north, height = at.T
        away = sin(heading) * east + cos(heading) * north
        rise = cos(elevation) * box.stretch * height + sin(elevation) * away
        return np.column_stack([cos(heading) * east - sin(heading) * north, -rise])

    ends = flat(box.around)
    least, most = ends.min(axis=0), ends.max(axis=0)
    room = np.array(box.size) - 2.0 * np.array(MARGIN)
    scale = float((room / np.maximum(most - least, 1e-6)).min())
    found: Array = (flat(places) - 0.5 * (least + most)) * scale + 0.5 * np.array(box.size)
    return found


def space(run: Run) -> Drawing | None:
    """Everybody's way in space, with its shadow on the floor."""
    if not run.flown:
        return None
    box = _box(run)
    width, height = box.size
    figure = Figure(figsize=(width / POINTS, height / POINTS + 0.5))
    share = height / (height + 0.5 * POINTS)
    axes: Any = figure.add_axes((0.0, 1.0 - share, 1.0, share))
    axes.set(xlim=(0, width), ylim=(height, 0), gid="a0")
    axes.set_axis_off()
    scene = _Scene(axes, box)
    _frame(scene)
    low = box.low[2]
    for vehicle, flown in sorted(run.flown.items()):
        way = _upright(np.array(thin(flown.position, MOST)))
        colour = run.colour(vehicle)
        scene.line(way * (1, 1, 0) + (0, 0, low), color=colour, lw=0.8, alpha=0.35)
        scene.line(way, color=colour, lw=1.9, label=run.role_of(vehicle))
        scene.mark(way[0], "o", color=colour, mfc=PAPER, ms=5)
        scene.mark(way[-1], "o", color=colour, ms=6)
    for number, zone in enumerate(run.zones):
        ring = np.array([(east, north, low) for north, east in [*zone.polygon, zone.polygon[0]]])
        label = "" if number else "zone: everybody keeps out"
        scene.line(ring, color=palette.ZONE.light, lw=1.2, label=label)
        if not run.flat:
            top = min(zone.high, box.high[2])
            scene.line(ring * (1, 1, 0) + (0, 0, top), color=palette.ZONE.light, lw=1.2)
            for corner in ring[:-1]:
                edge = np.array([corner, corner * (1, 1, 0) + (0, 0, top)])
                scene.line(edge, color=palette.ZONE.light, lw=0.8)
    for name, place in run.named_targets():
        target = _upright(np.array([place]))[0]
        scene.line(np.array([target * (1, 1, 0) + (0, 0, low), target]), color=FAINT, lw=0.8, ls=":")
        scene.mark(target, "*", color=palette.TARGET.light, ms=13, ls="", label=name)
    legend_below(figure, axes)
    note = "Open circles are the start, filled circles the end; faint lines are shadows on the floor."
    if box.stretch > 1.0:
        note += f" Heights are drawn {box.stretch:g} times as large as lengths."
    return Drawing("space", "Trajectories in space", note, figure)


class _Scene:
    """Draws parts at their places."""

    def __init__(self, axes: Any, box: Box) -> None:
        self.axes, self.box = axes, box

    def line(self, places: Array, **how: Any) -> None:
        """A line through places (n, 3)."""
        self.axes.plot(*self._seen(places), clip_on=False, **how)

    def mark(self, place: Array, marker: str, **how: Any) -> None:
        """A mark at a place (3,)."""
        self.axes.plot(*self._seen(place[None]), marker, clip_on=False, **how)

    def text(self, place: Array, text: str, **how: Any) -> None:
        """A text centred at a place (3,)."""
        text = text.replace("-", "\N{MINUS SIGN}")
        x, y = self._seen(place[None])[:, 0]
        self.axes.text(x, y, text, ha="center", va="center_baseline", **how)

    def _seen(self, places: Array) -> Array:
        return projected(places, self.box, HEADING, ELEVATION).T


def _box(run: Run) -> Box:
    """All that was flown, the target and the floor; the drawing is as high as the first view needs."""
    (south, north), (west, east) = run.extent
    heights = np.concatenate([-f.position[:, 2] for f in run.flown.values()])
    goals = [goal.place for goal in run.targets]
    top = max([float(heights.max()), *(-goal[2] for goal in goals)] if goals else [float(heights.max()), 0.0])
    low = np.array([west, south, min(0.0, float(heights.min()))])
    high = np.array([east, north, max(top, low[2] + 1.0)])
    wide = max(east - west, north - south)
    stretch = max(1.0, float(f"{FLATTEST * wide / (high[2] - low[2]):.1g}"))
    width = WIDTH * POINTS
    floor_corners = [(e, n, low[2]) for e in (west, east) for n in (south, north)]
    ways = [_upright(np.array(thin(f.position, 40))) for f in run.flown.values()]
    ends = [(west, south, high[2]), *(tuple(_upright(np.array([goal]))[0]) for goal in goals)]
    around = np.round(np.concatenate([floor_corners, ends, *ways]), 2)
    loose = Box(low, high, stretch, around, (width, 1e6))
    needed = float(np.ptp(projected(around, loose, HEADING, ELEVATION)[:, 1])) + 2.0 * MARGIN[1]
    return loose._replace(size=(width, min(480.0, max(240.0, needed))))


def _upright(places: Array) -> Array:
    """Places (n, 3) in the game frame (north, east, down) as (east, north, height)."""
    return places[:, [1, 0, 2]] * (1.0, 1.0, -1.0)


def _frame(scene: _Scene) -> None:
    """The floor's grid, and three axes with figures along the edges that the first view has in front."""
    low, high = scene.box.low, scene.box.high
    away = 0.05 * float((high - low)[:2].max())
    for axis, name, front, outward in ((0, "east [m]", low[1], -away), (1, "north [m]", high[0], away)):
        along, across = np.eye(3)[axis], np.eye(3)[1 - axis]
        for value in _ticks(low[axis], high[axis], 6):
            start = low * (1.0 - along) + value * along
            scene.line(np.array([start, start + (high - low) * across]), color=GRID, lw=0.8)
            place = start * (1.0 - across) + (front + outward) * across
            scene.text(place, f"{value:g}", fontsize=8, color=FAINT)
        middle = 0.5 * (low + high) * along + (front + 2.8 * outward) * across + low * np.eye(3)[2]
        scene.text(middle, name, color=INK)
    ring = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]), (low[0], low[1])]
    scene.line(np.array([(*corner, low[2]) for corner in ring]), color=FAINT, lw=0.8)
    top = np.array([low[0], low[1], high[2]])
    scene.line(np.array([low, top]), color=FAINT, lw=0.8)
    left = away * np.array([-cos(HEADING), sin(HEADING), 0.0])
    for value in _ticks(low[2], high[2], 4)[1:]:
        scene.text(low * (1, 1, 0) + left + (0.0, 0.0, value), f"{value:g}", fontsize=8, color=FAINT)
    above = np.array([0.0, 0.0, 0.8 * away / scene.box.stretch])
    scene.text(top + above, "height [m]", color=INK)


def _ticks(low: float, high: float, most: int) -> list[float]:
    """Round values from low to high, about so many."""
    rough = (high - low) / most
    power = 10.0 ** floor(log10(rough))
    step = next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= rough)
    return [round(n * step, 9) for n in range(ceil(low / step), floor(high / step) + 1)]
