"""A scenario's start seen from above, and which headings and pitches of the evader its pursuers close."""

from __future__ import annotations

from math import cos, degrees, sin
from pathlib import Path
from typing import Any

import numpy as np

from onboard.core.strategy.team.closure import cones_of, past, pitch_band, way_out
from onboard.core.strategy.team.plan_types import Situation
from onboard.game import palette
from onboard.game.scenario import Scenario
from sim_bridge.programs.scenario_band import situation_of

CELLS = 361  # headings of the map


def draw_band(scenario: Scenario, folder: Path, name: str) -> list[Path]:
    """Two panels as PNG and SVG: the places with their noses, and the band with who closes what."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    s = situation_of(scenario, 0.0)
    folder.mkdir(parents=True, exist_ok=True)
    figure, (plan, band) = plt.subplots(1, 2, figsize=(12, 5), width_ratios=(1.0, 1.3), layout="constrained")
    _plan(plan, s)
    _band(band, s)
    way = way_out(s)
    word = (
        f"closed, smallest overlap {degrees(-way.gap):.0f}°"
        if way.closed
        else (f"open by {degrees(way.gap):.0f}° at heading {degrees(way.bearing) % 360:.0f}°")
    )
    figure.suptitle(f"{scenario.name}: {word}")
    paths = [folder / f"{name}.png", folder / f"{name}.svg"]
    for path in paths:
        figure.savefig(path, dpi=120)
    plt.close(figure)
    return paths


def _plan(axes: Any, s: Situation) -> None:
    vehicles = [s.evader, *(member.vehicle for member in s.team)]
    places = np.array([[v.position.y, v.position.x] for v in vehicles]) / 1000.0
    size = 0.16 * float(np.ptp(places) or 1.0)
    for number, (vehicle, place) in enumerate(zip(vehicles, places, strict=True), 1):
        color = palette.vehicle(number, number == 1).light
        ahead = np.array([vehicle.velocity.y, vehicle.velocity.x])
        ahead = size * ahead / max(float(np.linalg.norm(ahead)), 1e-9)
        axes.annotate("", place + ahead, place, arrowprops={"arrowstyle": "->", "color": color, "lw": 2.0})
        axes.plot(*place, "o", color=color, label=f"{'evader' if number == 1 else 'pursuer'} {number}")
    if s.target.exists:
        goal = s.target.position
        axes.plot(goal.y / 1000.0, goal.x / 1000.0, "*", color=palette.TARGET.light, ms=13, label="target")
    for area in s.rules.zones.areas:
        walls = s.rules.zones.walls[area.first : area.first + area.sides]
        corners = np.array([[wall.y, wall.x] for wall in walls]) / 1000.0
        axes.fill(*corners.T, color=palette.ZONE.light, alpha=0.3, lw=0)
    axes.set(xlabel="east [km]", ylabel="north [km]", title="places and noses", aspect="equal")
    axes.legend(fontsize=7, loc="upper right")


def _band(axes: Any, s: Situation) -> None:
    cones = cones_of(s)
    limits = pitch_band(s.evader, s.evader_limits, s.heights, past(s))
    low, high = (0.0, 0.0) if s.rules.planar else (limits.pitch_min, limits.pitch_max)
    yaw = np.linspace(-np.pi, np.pi, CELLS)
    pitch = np.linspace(low, high, 41) if high > low else np.array([-0.01, 0.01])
    closed = np.zeros((len(pitch), CELLS), int)
    for i, theta in enumerate(pitch):
        u = np.stack([cos(theta) * np.cos(yaw), cos(theta) * np.sin(yaw), np.full(CELLS, -sin(theta))])
        for cone in cones:
            closed[i] += np.array(cone.axis) @ u > cone.cos
    grid = np.degrees(yaw), np.degrees(pitch), closed
    shown = axes.pcolormesh(*grid, cmap="Greys", vmin=-0.5, vmax=4.5, shading="nearest", rasterized=True)
    axes.figure.colorbar(shown, ax=axes, label="pursuers that close it (0: a way out)", ticks=range(5))
    for number, cone in enumerate(cones, 2):
        color = palette.vehicle(number, False).light
        bearing, rise = np.arctan2(cone.axis.y, cone.axis.x), np.arcsin(-cone.axis.z)
        axes.plot(np.degrees(bearing), np.degrees(rise), "o", color=color, mec="white")
    axes.set(xlabel="heading [deg]", ylabel="pitch [deg]", title="the evader's band", xlim=(-180, 180))
