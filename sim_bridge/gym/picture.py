"""A picture of a game as an array of pixels: from above, and in games in space the heights below it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.ImageDraw import Draw, ImageDraw

from onboard.game.palette import CAPTURE, EVADER, FAINT, GRID, INK, PAPER, PURSUERS, TARGET
from onboard.game.scenario import Scenario, vec

SIZE = 480  # [px] width, and height of the view from above
STRIP = 120  # [px] height of the heights
MARGIN = 0.08  # of the width
DOT = 4  # [px] radius of a vehicle

Array = NDArray[np.float64]


class _Scale:
    """From metres to pixels: north up, east right."""

    def __init__(self, points: Array, size: int) -> None:
        low, high = points.min(axis=0), points.max(axis=0)
        self.span = max(float((high - low)[:2].max()), 1.0)
        self.middle = (low + high) / 2.0
        self.k = size * (1.0 - 2.0 * MARGIN) / self.span
        self.size = size

    def at(self, place: Array) -> tuple[float, float]:
        return (
            self.size / 2 + self.k * (place[1] - self.middle[1]),
            self.size / 2 - self.k * (place[0] - self.middle[0]),
        )


def draw(scenario: Scenario, trail: list[Array], size: int = SIZE) -> NDArray[np.uint8]:
    """The game so far: `trail` holds everybody's places (players, 3) [m; NED], the newest last.

    Raises ValueError before the first place.
    """
    if not trail:
        raise ValueError("render: found no game, expected reset() before it")
    ways = np.array(trail)  # (instants, players, 3)
    goal = scenario.evader.target
    goals = [] if goal is None else [np.array(vec(goal))]
    scale = _Scale(np.concatenate([ways.reshape(-1, 3), *[g[None] for g in goals]]), size)
    height = size if scenario.planar else size + STRIP
    image = Image.new("RGB", (size, height), PAPER.light)
    pen = Draw(image)
    for line in range(1, 8):
        edge = line * size / 8
        pen.line((edge, 0, edge, size), fill=GRID.light)
        pen.line((0, edge, size, edge), fill=GRID.light)
    for place in goals:
        x, y = scale.at(place)
        r = max(DOT, scale.k * scenario.parameters.epsilon_min)
        pen.ellipse((x - r, y - r, x + r, y + r), outline=TARGET.light, width=2)
    for player in range(ways.shape[1]):
        colour = EVADER.light if player == 0 else PURSUERS[(player - 1) % len(PURSUERS)].light
        way = [scale.at(place) for place in ways[:, player]]
        if len(way) > 1:
            pen.line(way, fill=colour, width=2)
        x, y = way[-1]
        pen.ellipse((x - DOT, y - DOT, x + DOT, y + DOT), fill=colour)
        if player:
            r = scale.k * scenario.parameters.R
            pen.ellipse((x - r, y - r, x + r, y + r), outline=CAPTURE.light)
        if not scenario.planar:
            _heights(pen, ways[:, player, 2], colour, size)
    pen.text((6, 6), f"{scale.span:.0f} m across", fill=FAINT.light)
    if not scenario.planar:
        pen.line((0, size, size, size), fill=INK.light)
    return np.asarray(image, dtype=np.uint8)


def _heights(pen: ImageDraw, down: Array, colour: str, size: int) -> None:
    """A vehicle's height over time, below the view from above; the strip is 400 m high about its start."""
    mid = size + STRIP / 2
    xs = np.linspace(0.0, size - 1.0, max(len(down), 2))
    rise = np.clip((down[0] - down) * STRIP / 400.0, -STRIP / 2, STRIP / 2)
    points = [(float(x), float(mid - up)) for x, up in zip(xs, rise, strict=False)]
    if len(points) > 1:
        pen.line(points, fill=colour)
