"""A run's figures as PNG pictures, by matplotlib: for papers, mails and those without a browser."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch

from gcs.report import theme as look
from gcs.report.data import Run, windy
from gcs.report.plotly_parts import named_phases

matplotlib.use("Agg")
WIDTH, DPI = 9.0, 130
STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "axes.edgecolor": look.FAINT,
    "axes.labelcolor": look.INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": look.GRID,
    "text.color": look.INK,
    "xtick.color": look.FAINT,
    "ytick.color": look.FAINT,
    "legend.frameon": False,
    "svg.hashsalt": "apollonius",
}


def write_figures(run: Run, folder: Path) -> list[Path]:
    """Write every figure that the run has values for; the files, named after the report's figures."""
    makers: dict[str, Callable[[Run], Figure | None]] = {
        "plan": plan,
        "space": space,
        "distances": distances,
        "rules": rules,
        "speeds": speeds,
        "wind": wind,
        "links": links,
    }
    written = []
    with matplotlib.rc_context(STYLE):
        for name, make in makers.items():
            path = folder / f"{name}.png"
            figure = make(run)
            if figure is None:
                path.unlink(missing_ok=True)  # of an earlier report
            else:
                figure.savefig(path, dpi=DPI, metadata={"Software": None})
                written.append(path)
    return written


def plan(run: Run) -> Figure | None:
    """From above."""
    if not run.flown:
        return None
    figure = Figure(figsize=(WIDTH, 7.2), layout="constrained")
    axes = figure.add_subplot()
    colors = look.colors(run)
    if run.fence is not None:
        corners = np.array([*run.fence.polygon, run.fence.polygon[0]])
        axes.plot(corners[:, 1], corners[:, 0], color=look.FENCE, ls="--", lw=1, label="geofence")
    for vehicle_id, flown in sorted(run.flown.items()):
        north, east = flown.position[:, 0], flown.position[:, 1]
        color = colors[vehicle_id]
        axes.plot(east, north, color=color, lw=1.8, label=run.role_of(vehicle_id))
        axes.plot(east[0], north[0], "o", mfc="white", mec=color, ms=6)
        axes.plot(east[-1], north[-1], "o", color=color, ms=7)
    evader = run.evader
    if evader is not None and run.capture_radius is not None:
        north, east, _ = evader.position[-1]
        label = f"R = {run.capture_radius:g} m"
        axes.add_patch(Circle((east, north), run.capture_radius, fill=False, ec=look.CAPTURE, label=label))
    if run.target is not None:
        axes.plot(run.target[1], run.target[0], "*", color=look.TARGET, ms=14, label="target")
    north_range, east_range = run.extent
    axes.set(
        xlim=east_range, ylim=north_range, xlabel="east [m]", ylabel="north [m]", title=look.verdict(run)
    )
    axes.set_aspect("equal")
    _legend_below(figure, axes)
    return figure


def space(run: Run) -> Figure | None:
    """In space, from the south-east."""
    if not run.flown:
        return None
    figure = Figure(figsize=(WIDTH, 6.6), layout="constrained")
    axes: Any = figure.add_subplot(projection="3d")
    colors = look.colors(run)
    low = min(0.0, min(float((-f.position[:, 2]).min()) for f in run.flown.values()))
    for vehicle_id, flown in sorted(run.flown.items()):
        north, east, height = flown.position[:, 0], flown.position[:, 1], -flown.position[:, 2]
        axes.plot(east, north, np.full(len(east), low), color=colors[vehicle_id], lw=0.8, alpha=0.3)
        axes.plot(east, north, height, color=colors[vehicle_id], lw=1.8, label=run.role_of(vehicle_id))
        axes.scatter(east[-1:], north[-1:], height[-1:], color=colors[vehicle_id], s=22)
    if run.target is not None:
        axes.scatter([run.target[1]], [run.target[0]], [-run.target[2]], color=look.TARGET, marker="*", s=90)
    north_range, east_range = run.extent
    spans = [east_range[1] - east_range[0], north_range[1] - north_range[0]]
    tops = [float((-f.position[:, 2]).max()) for f in run.flown.values()]
    top = max([*tops, -run.target[2] if run.target is not None else low, low + 0.25 * max(spans)])
    axes.set(xlim=east_range, ylim=north_range, zlim=(low, top))
    axes.set(xlabel="east [m]", ylabel="north [m]", zlabel="height [m]")
    axes.set_box_aspect((*spans, top - low), zoom=0.95)  # one scale for all three axes
    axes.view_init(elev=26, azim=-58)
    _legend_below(figure, axes)
    return figure


def distances(run: Run) -> Figure | None:
    """To the evader."""
    gaps = [gap for gap in run.gaps() if len(gap.t)]
    if not gaps:
        return None
    figure, axes = _timed(run, 4.2, "distance to the evader [m]")
    colors = look.colors(run)
    for gap in gaps:
        axes.plot(gap.t, gap.distance, color=colors[gap.id], label=run.role_of(gap.id))
    for level, name, color, style in (
        (run.capture_radius, "capture radius R", look.CAPTURE, "--"),
        (run.safety_distance, "safety distance ρ", look.SAFETY, ":"),
    ):
        if level is not None:
            axes.axhline(level, color=color, ls=style, lw=1.2, label=f"{name} = {level:g} m")
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=9)
    return figure


def rules(run: Run) -> Figure | None:
    """In force."""
    if not run.rules:
        return None
    figure, axes = _timed(run, 1.6 + 0.45 * len(run.rules), "")
    named, guards = look.rule_colors(run), look.guard_colors(run)
    for row, vehicle in enumerate(sorted(run.rules)):
        for band in run.rules[vehicle]:
            axes.broken_barh([(band.start, band.end - band.start)], (row - 0.4, 0.6), color=named[band.rule])
        for band in run.guards.get(vehicle, ()):
            axes.broken_barh(
                [(band.start, band.end - band.start)], (row + 0.22, 0.16), color=guards[band.rule]
            )
    axes.set_yticks(range(len(run.rules)), [run.role_of(i) for i in sorted(run.rules)])
    axes.set_ylim(len(run.rules) - 0.4, -0.9)
    axes.grid(axis="y", visible=False)
    handles = [Patch(color=color, label=look.words(rule)) for rule, color in named.items()]
    handles += [Patch(color=color, label=f"supervisor: {action}") for action, color in guards.items()]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=9)
    return figure


def speeds(run: Run) -> Figure | None:
    """Over ground, and in the air."""
    if not run.flown:
        return None
    figure, axes = _timed(run, 4.2, "speed [m/s]")
    colors = look.colors(run)
    for vehicle_id, flown in sorted(run.flown.items()):
        axes.plot(flown.t, flown.groundspeed, color=colors[vehicle_id], label=run.role_of(vehicle_id))
        axes.plot(flown.t, flown.airspeed, color=colors[vehicle_id], lw=0.9, ls=":")
    axes.set_ylim(bottom=0)
    axes.set_title("solid: over ground, dotted: in the air", fontsize=9, loc="left", color=look.FAINT)
    axes.legend(fontsize=9)
    return figure


def wind(run: Run) -> Figure | None:
    """Estimated."""
    known = windy(run)
    if not known:
        return None
    figure, axes = _timed(run, 3.6, "wind [m/s]")
    colors = look.colors(run)
    for vehicle_id, flown in sorted(known.items()):
        speed = np.hypot(flown.wind[:, 0], flown.wind[:, 1])
        axes.plot(flown.t, speed, color=colors[vehicle_id], label=run.role_of(vehicle_id))
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=9)
    return figure


def links(run: Run) -> Figure | None:
    """Quality and battery."""
    if not run.links:
        return None
    figure, axes = _timed(run, 3.6, "[%]")
    colors = look.colors(run)
    for vehicle_id, link in sorted(run.links.items()):
        color = colors.get(vehicle_id, look.OTHERS)
        axes.plot(link.t, 100 * link.quality, color=color, label=run.role_of(vehicle_id))
        axes.plot(link.t, 100 * link.battery, color=color, lw=0.9, ls=":")
    axes.set_ylim(0, 105)
    axes.set_title("solid: link quality, dotted: battery", fontsize=9, loc="left", color=look.FAINT)
    axes.legend(fontsize=9)
    return figure


def _legend_below(figure: Figure, axes: Any) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, fontsize=9)


def _timed(run: Run, height: float, label: str) -> tuple[Figure, Any]:
    """A figure over time, with the game's phases."""
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    axes: Any = figure.add_subplot()
    start, end = run.span
    named = named_phases(run)
    for at, phase in run.phases:
        if start <= at <= end:
            axes.axvline(at, color=look.FAINT, lw=0.8, ls=":")
        if (at, phase) in named:
            axes.annotate(phase, (at, 1.0), (3, -10), xycoords=("data", "axes fraction"),
                          textcoords="offset points", fontsize=8, color=look.FAINT)  # fmt: skip
    axes.set(
        xlabel="time since the start of the game [s]", ylabel=label, xlim=(start, max(end, start + 1e-3))
    )
    return figure, axes
