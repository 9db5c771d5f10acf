"""Figures of predictors, in the manner of the paper's Figures 3 and 4, and of a comparison."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from onboard.game import palette
from onboard.pilot.predictor.activation import SParabola
from sim_bridge.studies.comparison import FLYING, LAST, PAPER, STEADY, Drawn
from sim_bridge.studies.paper_example import FIGURE4_TRAINED, Figure4
from sim_bridge.studies.pictures import pyplot, save_both

_BLUE, _GREEN, _PINK = (colour.light for colour in palette.PURSUERS[:3])  # told apart by most people
_FAINT, _GRID = palette.FAINT.light, palette.GRID.light
_TRACK = palette.EVADER.light  # what is predicted is the evader's way
COLOURS = {LAST: _FAINT, STEADY: _BLUE, FLYING: _GREEN, PAPER: _PINK}


def draw_activation(folder: Path) -> list[Path]:
    """The s-parabola for p = 1/4 and 1/20 (Figure 3). Returns the files written."""
    plt = pyplot()
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", sharey=True)
    s = np.linspace(-3.0, 3.0, 1201)
    for axis, p, name in zip(axes, (0.25, 0.05), ("1/4", "1/20"), strict=True):
        f = SParabola(p, 0.0)
        axis.plot(s, f.value(s), color=_BLUE, label="s-parabola (25)")
        axis.plot(s, f.upper(s), color=_GREEN, linestyle="--", label="upper branch alone")
        axis.plot(s, SParabola(p, -0.5).value(s), color=_PINK, linestyle=":", label="β = −0.5")
        axis.set(title=f"p = {name}", xlabel="s")
        axis.axhline(0.0, color=_GRID, linewidth=0.8)
        axis.axvline(0.0, color=_GRID, linewidth=0.8)
    axes[0].set_ylabel("f(s)")
    axes[0].legend()
    return save_both(figure, folder, "s-parabola")


def draw_example(example: Figure4, folder: Path) -> list[Path]:
    """Trajectory, prediction on the training set and on the test set (Figure 4). Returns the files."""
    plt = pyplot()
    wide, high = np.ptp(example.truth, axis=0)
    figure, axis = plt.subplots(figsize=(8, 1.3 + 7.0 * high / wide), layout="constrained")
    cut = FIGURE4_TRAINED
    axis.plot(*example.truth.T, color=_TRACK, label="trajectory")
    axis.plot(*example.predicted[:cut].T, color=_BLUE, linestyle="-.", label="prediction, training set")
    axis.plot(*example.predicted[cut:].T, color=_GREEN, linestyle="--", label="prediction, test set")
    x, y = example.results
    axis.set(
        title=f"mean test error: x {x.error_test:.2f} m, y {y.error_test:.2f} m"
        f" (constant velocity: {x.error_steady:.2f} and {y.error_steady:.2f} m)",
        xlabel="x [m]",
        ylabel="y [m]",
        aspect="equal",
    )
    axis.legend(fontsize=8)
    return save_both(figure, folder, "example-3-5-2")


def draw_comparison(drawn: Drawn, folder: Path) -> list[Path]:
    """The track with what was predicted 1 s ahead, and mean errors by horizon. Returns the files."""
    plt = pyplot()
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 6), layout="constrained")
    truth = drawn.recording.truth
    left.plot(truth[:, 1], truth[:, 0], color=_TRACK, label="track")
    for name, path in drawn.paths.items():
        if name != LAST:
            label = f"{name}, 1 s ahead"
            left.plot(path[:, 1], path[:, 0], ".", markersize=3, color=COLOURS[name], label=label)
    left.set(title=drawn.comparison.track, xlabel="east [m]", ylabel="north [m]")
    left.set_aspect("equal", adjustable="datalim")
    left.legend(fontsize=8)
    for row in drawn.comparison.rows:
        right.plot(
            drawn.comparison.horizons, row.mean_error, "o-", color=COLOURS[row.predictor], label=row.predictor
        )
        if any(row.stated):
            right.plot(
                drawn.comparison.horizons,
                row.stated,
                ":",
                color=COLOURS[row.predictor],
                label=f"{row.predictor}, stated",
            )
    right.set(xscale="log", yscale="log", xlabel="ahead [s]", ylabel="mean distance [m]", title="error")
    right.set_xticks(drawn.comparison.horizons, [f"{h:g}" for h in drawn.comparison.horizons])
    right.minorticks_off()
    right.legend(fontsize=8)
    stem = "predict-" + "".join(c if c.isalnum() else "-" for c in drawn.comparison.track)
    return save_both(figure, folder, stem)
