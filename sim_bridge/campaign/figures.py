"""Figures of a spatial game like 10 and 11 of the paper: initial and final stage, with direction arrows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from onboard.game import palette
from onboard.game.scenario import Scenario, targets_of
from sim_bridge.campaign.spatial_campaign import Played

ARROW = 0.05  # length of an arrow's barbs, as a share of the picture
BARB = 0.45  # [rad] between barb and shaft


def draw_stages(scenario: Scenario, played: Played, folder: Path, name: str) -> list[Path]:
    """Two panels, PNG and SVG: after a fifth of the game, and at its end. Heights are stretched."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    folder.mkdir(parents=True, exist_ok=True)
    figure = plt.figure(figsize=(12, 6))
    figure.subplots_adjust(left=0.02, right=0.94, wspace=0.12, bottom=0.06, top=0.88)
    count = len(played.log)
    stages = (("(a) initial stage", max(2, count // 5)), ("(b) final stage", count))
    for index, (title, steps) in enumerate(stages, start=1):
        axes = figure.add_subplot(1, 2, index, projection="3d")
        _stage(axes, scenario, played, steps)
        time = min(steps * scenario.parameters.dt, played.time)
        axes.set_title(f"{title}, t = {time:.0f} s")
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=8, frameon=False)
    figure.suptitle(
        f"{scenario.name}: {played.verdict.name.lower()} at {played.time:.0f} s,"
        f" nearest pursuer ever {played.smallest:.0f} m"
    )
    paths = [folder / f"{name}.png", folder / f"{name}.svg"]
    for path in paths:
        figure.savefig(path, dpi=130)
    plt.close(figure)
    return paths


def _stage(axes: Any, scenario: Scenario, played: Played, steps: int) -> None:
    path = played.log[:steps, :, :3] * np.array([1.0, 1.0, -1.0]) / 1000.0  # km; height up
    path = path[:, :, [1, 0, 2]]  # east to the right, north away
    low, high = path.min(axis=(0, 1)), path.max(axis=(0, 1))
    for number, target in enumerate(place for spec in scenario.evading for place in targets_of(spec)):
        goal = np.array([target.y, target.x, -target.z]) / 1000.0
        label = "" if number else "target"
        axes.scatter(*goal, color=palette.TARGET.light, s=110, marker="*", label=label)
        low, high = np.minimum(low, goal), np.maximum(high, goal)
    for player in range(path.shape[1]):
        line = path[:, player]
        id = scenario.ids[player]
        evader = id in scenario.evader_ids
        color = palette.vehicle(id, evader).light
        label = f"{'evader' if evader else 'pursuer'} {id}"
        axes.plot(*line.T, color=color, linestyle="--" if evader else "-", linewidth=1.3, label=label)
        axes.scatter(*line[0], facecolors="none", edgecolors=color, s=35)
        ahead = line[-1] - line[-min(len(line), 10)]
        level = float(np.hypot(ahead[0], ahead[1]))
        if level > 0.0:  # a head drawn in the level plane: axes of unequal scale would distort a 3-D one
            size = ARROW * float(np.max((high - low)[:2]))
            for turn in (-BARB, BARB):
                c, s = -np.cos(turn) * size / level, -np.sin(turn) * size / level
                barb = line[-1] + np.array([c * ahead[0] - s * ahead[1], s * ahead[0] + c * ahead[1], 0.0])
                axes.plot(*np.stack([line[-1], barb]).T, color=color, linewidth=2.0)
    axes.set(xlabel="east [km]", ylabel="north [km]", zlabel="height [km]")
    middle, half = 0.5 * (low[2] + high[2]), max(0.5 * (high[2] - low[2]), 0.6)
    axes.set_zlim(middle - half, middle + half)
    axes.set_box_aspect(
        (*(np.maximum(high - low, 0.3)[:2]), 0.45 * float(np.max((high - low)[:2]))), zoom=0.9
    )
    axes.view_init(elev=32, azim=-60)
