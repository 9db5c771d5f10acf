"""The figures of a report: from above, in space, and over time."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, Polygon

from gcs.report import theme
from gcs.report.data import Array, Band, Run
from gcs.report.drawing import (
    FAINT,
    INK,
    PAPER,
    WIDTH,
    Drawing,
    Lane,
    Panel,
    Series,
    curve,
    legend_below,
    style,
    timed,
)
from gcs.report.hindsight import missed_captures
from gcs.report.space import space
from onboard.game import palette

MOST_BINS = 240  # stretches of time of which latencies are told


def figures(run: Run) -> list[Drawing]:
    """All figures that the run has values for, in the page's order."""
    with style():
        found: list[Drawing] = []
        for maker in MAKERS:
            made = maker(run)
            found += made if isinstance(made, list) else [made] if made is not None else []
        return found


def plan(run: Run) -> Drawing | None:
    """Everybody's way from above."""
    if not run.flown:
        return None
    (south, north), (west, east) = run.extent
    tall = (north - south) / (east - west)
    width = min(WIDTH, max(5.0, 6.4 / tall))
    figure = Figure(figsize=(width, min(7.6, max(3.4, width * tall)) + 0.9), layout="constrained")
    axes = figure.add_subplot()
    axes.set_gid("a0")
    if run.fence is not None:
        corners = np.array([*run.fence.polygon, run.fence.polygon[0]])
        edge = np.concatenate([np.linspace(*ends, 200) for ends in pairwise(corners)])
        seen = ((edge >= (south, west)) & (edge <= (north, east))).all(axis=1).any()
        fence = Line2D(*corners[:, ::-1].T, color=palette.FENCE.light, ls="--", lw=1)
        fence.set_label("geofence" if seen else "")
        axes.add_artist(fence)  # which leaves the limits to what was flown
    for number, zone in enumerate(run.zones):
        area = Polygon(np.array(zone.polygon)[:, ::-1], fc=f"{palette.ZONE.light}33", ec=palette.ZONE.light)
        area.set_label("" if number else "zone: everybody keeps out")
        axes.add_artist(area)
    named: list[Array] = []
    for vehicle, flown in sorted(run.flown.items()):
        colour, path = run.colour(vehicle), flown.position[:, [1, 0]]
        axes.plot(*path.T, color=colour, label=run.role_of(vehicle))
        axes.plot(*path[0], "o", mfc=PAPER, mec=colour, ms=6)
        axes.plot(*path[-1], "o", color=colour, ms=6)
        if all(np.abs(path[0] - other).max() > 0.035 * (north - south) for other in named):
            named.append(path[0])
            axes.annotate(
                str(vehicle), path[0], (5, 5), textcoords="offset points", color=colour, clip_on=True
            )
    note = "North is up; ids stand at the start (open circles), filled circles are the end of the recording."
    radius = run.capture_radius
    if run.evaders and radius is not None:
        for evader in run.evaders:
            spot = evader.position[run.at_the_end(evader)]
            axes.add_patch(Circle((spot[1], spot[0]), radius, fill=False, ec=palette.CAPTURE.light))
        label = f"capture radius R = {radius:g} m"
        axes.plot([], [], "o", mfc="none", mec=palette.CAPTURE.light, ms=9, ls="", label=label)
        each = "each evader at the end of its" if len(run.evaders) > 1 else "the evader at the end of the"
        note += f" The ring is the capture radius around {each} game."
    for number, (name, place) in enumerate(run.named_targets()):
        label = "" if number else "target" if len(run.targets) == 1 else "targets"
        axes.plot(place[1], place[0], "*", color=palette.TARGET.light, ms=14, ls="", label=label)
        if len(run.targets) > 1:
            axes.annotate(name, (place[1], place[0]), (6, -10), textcoords="offset points", clip_on=True)
    axes.set(xlabel="east [m]", ylabel="north [m]")
    axes.update_datalim([(west, south), (east, north)])
    axes.margins(0)
    axes.set_aspect("equal", adjustable="datalim")
    legend_below(figure, axes)
    return Drawing("plan", "Plan view", note, figure, (Panel(axes, "plan", "m"),))


def distances(run: Run) -> Drawing | None:
    """Distance of each pursuer to the evader, of several to the nearest."""
    gaps = [gap for gap in run.gaps() if len(gap.t)]
    if not gaps:
        return None
    figure, (axes,) = timed(run, ("distance [m]",), 4.4)
    series = tuple(curve(axes, run, gap.id, (gap.t, gap.distance)) for gap in gaps)
    for level, name, colour, dash in (
        (run.capture_radius, "capture radius R", palette.CAPTURE, "--"),
        (run.safety_distance, "safety distance ρ", palette.SAFETY, ":"),
    ):
        if level is not None:
            axes.axhline(level, color=colour.light, ls=dash, lw=1.2, label=f"{name} = {level:g} m")
    axes.set_ylim(bottom=0)
    legend_below(figure, axes)
    note = f"{'Horizontal distance' if run.flat else 'Distance'} of each pursuer."
    several = len(run.evaders) > 1
    if several:
        note = f"{note[:-1]} to the nearest evader that is in the game."
    title = "Distances to the nearest evader" if several else "Distances to the evader"
    return Drawing("distances", title, note, figure, (Panel(axes, "time", "m", series),))


def rules(run: Run) -> Drawing | None:
    """Which rule was in force for each vehicle, and when the supervisor acted on what it said."""
    if not run.rules:
        return None
    count = len(run.rules)
    figure, (axes,) = timed(run, ("",), 1.7 + _row_height(count) * count)
    lanes = []
    for row, vehicle in enumerate(sorted(run.rules)):
        bands, guards = run.rules[vehicle], run.guards.get(vehicle, ())
        for rule in {band.rule for band in bands}:
            _bars(axes, [b for b in bands if b.rule == rule], (row - 0.4, 0.6), palette.rule(rule).light)
        for action in {band.rule for band in guards}:
            colour = palette.action(action).light
            _bars(axes, [b for b in guards if b.rule == action], (row + 0.22, 0.16), colour)
        told = [_bar(band, palette.rule(band.rule), "") for band in bands]
        told += [_bar(band, palette.action(band.rule), "supervisor: ") for band in guards]
        lanes.append(Lane(run.role_of(vehicle), tuple(told)))
    _name_rows(axes, run, sorted(run.rules))
    axes.set_ylim(count - 0.5, -0.6)
    handles = [Patch(color=palette.rule(r).light, label=theme.words(r)) for r in run.rule_names()]
    for action in run.action_names():
        handles.append(Patch(color=palette.action(action).light, label=f"supervisor: {theme.words(action)}"))
    legend_below(figure, axes, tuple(handles))
    note = "What each vehicle's strategy said; the glossary below explains each rule."
    if run.guards:
        note += " Thin bars: the supervisor did not let it pass as it was."
    return Drawing("rules", "Rules in force", note, figure, (Panel(axes, "time", lanes=tuple(lanes)),))


def speeds(run: Run) -> Drawing | None:
    """Speed over ground, and airspeed where it is known."""
    if not run.flown:
        return None
    known = any(not np.isnan(flown.airspeed).all() for flown in run.flown.values())
    labels = ("over ground [m/s]", "airspeed [m/s]") if known else ("over ground [m/s]",)
    figure, rows = timed(run, labels, 5.6 if known else 3.8)
    series: list[list[Any]] = [[] for _ in rows]
    for vehicle, flown in sorted(run.flown.items()):
        for row, values in enumerate((flown.groundspeed, flown.airspeed)[: len(rows)]):
            if not np.isnan(values).all():
                series[row].append(curve(rows[row], run, vehicle, (flown.t, values)))
    for axes in rows:
        axes.set_ylim(bottom=0)
    legend_below(figure, rows[0])
    panels = tuple(Panel(axes, "time", "m/s", tuple(s)) for axes, s in zip(rows, series, strict=True))
    note = "Over ground, climb included" + ("; below: relative to the air." if known else ".")
    return Drawing("speeds", "Speeds", note, figure, panels)


def heights(run: Run) -> Drawing | None:
    """Height above the origin; none for a game in the plane where nobody climbs."""
    climbs = any(float(np.ptp(f.position[:, 2])) > 0.5 for f in run.flown.values())
    if not run.flown or (run.setup is not None and run.setup.rules.planar and not climbs):
        return None
    figure, (axes,) = timed(run, ("height [m]",), 3.8)
    series = tuple(curve(axes, run, i, (f.t, -f.position[:, 2])) for i, f in sorted(run.flown.items()))
    low, high = (f([f(-g.position[:, 2]) for g in run.flown.values()]) for f in (np.nanmin, np.nanmax))
    margin = max(2.0, 0.15 * (high - low))
    note = "Above the origin of the game frame."
    if run.fence is not None:
        for level, name in ((run.fence.altitude_min, "floor"), (run.fence.altitude_max, "ceiling")):
            if not low - (high - low) - 20.0 <= level <= high + (high - low) + 20.0:
                note += f" The geofence's {name}, {level:g} m, is far outside."  # it would flatten the curves
                continue
            dash = "--" if name == "ceiling" else ":"
            label = f"geofence {name} {level:g} m"
            axes.axhline(level, color=palette.FENCE.light, ls=dash, lw=1, label=label)
            low, high = min(low, level), max(high, level)
    axes.set_ylim(low - margin, high + margin)
    legend_below(figure, axes)
    return Drawing("heights", "Heights", note, figure, (Panel(axes, "time", "m", series),))


def wind(run: Run) -> Drawing | None:
    """Wind as each autopilot estimates it; none where nobody knows of any."""
    known = {
        i: f for i, f in sorted(run.flown.items()) if np.nan_to_num(np.abs(f.wind)).max(initial=0.0) > 0.01
    }
    if not known:
        return None
    figure, (upper, lower) = timed(run, ("wind speed [m/s]", "comes from [deg]"), 4.8)
    speeds, directions = [], []
    for vehicle, flown in known.items():
        north, east = flown.wind[:, 0], flown.wind[:, 1]
        speed = np.hypot(north, east)
        source = np.degrees(np.arctan2(-east, -north)) % 360.0
        jumps = np.abs(np.diff(source, prepend=source[0])) > 180.0  # past north: a gap, not a stroke
        speeds.append(curve(upper, run, vehicle, (flown.t, speed)))
        shown = np.where((speed > 0.05) & ~jumps, source, np.nan)
        directions.append(curve(lower, run, vehicle, (flown.t, shown)))
    upper.set_ylim(bottom=0)
    lower.set(ylim=(0, 360), yticks=range(0, 361, 90))
    legend_below(figure, upper)
    panels = (Panel(upper, "time", "m/s", tuple(speeds)), Panel(lower, "time", "°", tuple(directions)))
    note = "As each vehicle's autopilot estimates it; 0° is wind from the north, 90° from the east."
    return Drawing("wind", "Wind", note, figure, panels)


def links(run: Run) -> Drawing | None:
    """Link quality and battery, a row for each vehicle: equal ones would hide each other."""
    if not run.links:
        return None
    count = len(run.links)
    figure, (axes,) = timed(run, ("",), 1.5 + 1.25 * _row_height(count) * count)
    series = []
    for row, (vehicle, link) in enumerate(sorted(run.links.items())):
        zero, scale = row + 0.4, -0.8
        axes.axhline(zero, color=FAINT, lw=0.6)
        if not np.isnan(link.quality).all():
            axes.fill_between(
                link.t, zero, zero + scale * link.quality, color=run.colour(vehicle), alpha=0.45, lw=0
            )
            line = curve(axes, run, vehicle, (link.t, zero + scale * link.quality), lw=1.2)
            name = f"{run.role_of(vehicle)}: link"
            series.append(line._replace(name=name, scale=100 / scale, zero=zero))
        if not np.isnan(link.battery).all():
            (drawn,) = axes.plot(link.t, zero + scale * link.battery, color=INK, lw=1.1, ls="--")
            drawn.set_gid(f"a0-b{vehicle}")
            name = f"{run.role_of(vehicle)}: battery"
            series.append(Series(drawn.get_gid(), name, INK, 100 / scale, zero))
    _name_rows(axes, run, sorted(run.links))
    axes.set_ylim(count - 0.45, -0.55)
    battery = axes.plot([], [], color=INK, lw=1.1, ls="--", label="battery")[0]
    quality = Patch(color=FAINT, alpha=0.45, label="link quality (a row: 0 to 100 %)")
    figure.legend(handles=[quality, battery], loc="outside lower center", ncols=2)
    note = (
        "Each row reaches from 0 to 100 %. Link quality: the share of the telemetry expected from the "
        "autopilot that arrived."
    )
    return Drawing("links", "Links and batteries", note, figure, (Panel(axes, "time", "%", tuple(series)),))


def latencies(run: Run) -> Drawing | None:
    """How old each state message was when it came: the median and the oldest of each stretch of time."""
    known = {i: f for i, f in sorted(run.flown.items()) if not np.isnan(f.latency).all()}
    if not known or not any(np.nan_to_num(f.latency).any() for f in known.values()):
        return None  # on virtual time messages may arrive at the instant they are sent
    figure, (axes,) = timed(run, ("age at arrival [ms]",), 3.8)
    count = max(1, min(MOST_BINS, min(len(f.t) for f in known.values()) // 4))
    edges = np.linspace(*run.span, count + 1)
    middle, width = 0.5 * (edges[:-1] + edges[1:]), float(edges[1] - edges[0])
    series = []
    for vehicle, flown in known.items():
        bins = np.clip(np.searchsorted(edges, flown.t, side="right") - 1, 0, count - 1)
        found = [1000.0 * flown.latency[(bins == n) & np.isfinite(flown.latency)] for n in range(count)]
        median = np.array([np.median(values) if len(values) else np.nan for values in found])
        most = np.array([values.max(initial=-np.inf) for values in found])
        series.append(curve(axes, run, vehicle, (middle, median)))
        axes.plot(middle, most, color=run.colour(vehicle), lw=0.7, alpha=0.6)
    axes.plot([], [], color=FAINT, lw=0.7, label=f"thin: the oldest of each {width:.2g} s")
    axes.set_ylim(bottom=0)
    legend_below(figure, axes)
    note = (
        f"From the stamp of each state message to its arrival at the recorder, clock offsets included: "
        f"the median in each {width:.2g} s, thin: the oldest."
    )
    return Drawing("latencies", "Latencies", note, figure, (Panel(axes, "time", "ms", tuple(series)),))


def _bars(axes: Any, bands: list[Band], place: tuple[float, float], colour: str) -> None:
    """Bars from start to end of each band; `place` is their upper edge and height in the row's unit."""
    axes.broken_barh([(band.start, band.end - band.start) for band in bands], place, color=colour, lw=0)


def _bar(band: Band, colour: palette.Colour, who: str) -> tuple[float, float, str, str]:
    """What the page tells of a bar."""
    text = theme.words(f"{who}{band.rule}" + (f" ({band.why})" if band.why else ""))
    return round(band.start, 2), round(band.end, 2), text, colour.light


def _row_height(count: int) -> float:
    """Height of one vehicle's row [in]: lower where there are many."""
    return max(0.09, min(0.45, 12.0 / count))


def _name_rows(axes: Any, run: Run, vehicles: list[int]) -> None:
    """Rows named after vehicles, the first on top."""
    size = min(9.5, 60 * _row_height(len(vehicles)))
    axes.set_yticks(range(len(vehicles)), [run.role_of(i) for i in vehicles], fontsize=size)
    axes.grid(axis="y", visible=False)


MAKERS: tuple[Callable[[Run], Drawing | list[Drawing] | None], ...] = (
    plan, space, distances, missed_captures, rules, speeds, heights, wind, links, latencies,
)  # fmt: skip
NAMES = tuple(maker.__name__ for maker in MAKERS if maker is not missed_captures)
NAMED_LIKE = ("missed_capture*",)  # patterns of the names of those of which there may be several
