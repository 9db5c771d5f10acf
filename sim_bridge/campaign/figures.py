"""Figures of a spatial game like 10 and 11 of the paper: initial and final stage, with direction arrows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from onboard.runtime.scenario import Scenario
from sim_bridge.campaign.games import Played

EVADER, PURSUER, TARGET = "crimson", "0.45", "green"
ARROW = 0.07  # length of an arrow, as a share of the picture


def draw_stages(scenario: Scenario, played: Played, folder: Path, name: str) -> list[Path]:
    """Two panels, PNG and SVG: after a fifth of the game, and at its end. Heights are stretched."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    folder.mkdir(parents=True, exist_ok=True)
    figure = plt.figure(figsize=(12, 6), layout="constrained")
    count = len(played.log)
    stages = (("(a) initial stage", max(2, count // 5)), ("(b) final stage", count))
    for index, (title, steps) in enumerate(stages, start=1):
        axes = figure.add_subplot(1, 2, index, projection="3d")
        _stage(axes, scenario, played, steps)
        time = min(steps * scenario.parameters.dt, played.time)
        axes.set_title(f"{title}, t = {time:.0f} s")
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
    target = scenario.evader.target
    if target is not None and len(target) == 3:
        goal = np.array([target[1], target[0], target[2]]) / 1000.0
        axes.scatter(*goal, color=TARGET, s=50, label="target")
        low, high = np.minimum(low, goal), np.maximum(high, goal)
    for player in range(path.shape[1]):
        line = path[:, player]
        evader = player == 0
        color = EVADER if evader else PURSUER
        label = "evader" if evader else ("pursuers" if player == 1 else None)
        axes.plot(*line.T, color=color, linestyle="--" if evader else "-", linewidth=1.3, label=label)
        axes.scatter(*line[0], facecolors="none", edgecolors=color, s=35)
        ahead = line[-1] - line[-min(len(line), 10)]
        size = float(np.linalg.norm(ahead))
        if size > 0.0:
            arrow = ahead / size * ARROW * float(np.max(high - low))
            axes.quiver(*line[-1], *arrow, color=color, linewidth=1.8, arrow_length_ratio=0.5)
    axes.set(xlabel="east [km]", ylabel="north [km]", zlabel="height [km]")
    axes.set_box_aspect((*(np.maximum(high - low, 0.3)[:2]), 0.45 * float(np.max((high - low)[:2]))))
    axes.view_init(elev=32, azim=-60)
    axes.legend(loc="upper left")
