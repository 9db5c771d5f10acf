"""A report's figures over time, and the list of all figures."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, degrees

import numpy as np

from gcs.report import plotly_parts as parts
from gcs.report import theme as look
from gcs.report.data import Band, Run, windy
from gcs.report.plotly_parts import Figure, Trace
from gcs.report.track_plots import plan, space


def figures(run: Run) -> list[Figure]:
    """All figures that the run has values for."""
    makers: tuple[Callable[[Run], Figure | None], ...] = (
        space, plan, distances, rules, speeds, heights, wind, links, latencies,
    )  # fmt: skip
    return [figure for maker in makers if (figure := maker(run)) is not None]


def distances(run: Run) -> Figure | None:
    """Distance of each pursuer to the evader."""
    gaps = run.gaps()
    if not gaps:
        return None
    colors = look.colors(run)
    data = [
        parts.line(
            parts.short(gap.t), parts.short(gap.distance), run.role_of(gap.id), colors[gap.id], "%{y:.2f} m"
        )
        for gap in gaps
    ]
    shapes, notes = parts.phases(run)
    levels = (
        (run.capture_radius, "capture radius R", look.CAPTURE, "dash"),
        (run.safety_distance, "safety distance ρ", look.SAFETY, "dot"),
    )
    for level, text, color, dash in levels:
        if level is not None:
            data.append(parts.level(run, level, f"{text} = {level:g} m", color, dash))
    layout = parts.layout(
        xaxis=parts.time(run),
        yaxis=parts.axis("distance [m]") | {"rangemode": "tozero"},
        shapes=shapes,
        annotations=notes,
    )
    how = "Horizontal distance" if run.flat else "Distance"
    return Figure("distances", "Distances to the evader", f"{how} of each pursuer.", 420, data, layout)


def rules(run: Run) -> Figure | None:
    """Which rule was in force, for each vehicle, and when the supervisor acted on it."""
    if not run.rules:
        return None
    names = [run.role_of(i) for i in sorted(run.rules)]
    data = [
        _bars(run, run.rules, rule, look.words(rule), color, 0.6, -0.4)
        for rule, color in look.rule_colors(run).items()
    ]
    data += [
        _bars(run, run.guards, action, f"supervisor: {look.words(action)}", color, 0.16, 0.22)
        for action, color in look.guard_colors(run).items()
    ]
    shapes, notes = parts.phases(run)
    axis = {"autorange": "reversed", "type": "category", "categoryarray": names, "automargin": True}
    layout = parts.layout(
        barmode="overlay", xaxis=parts.time(run), yaxis=axis, shapes=shapes, annotations=notes
    )
    note = "What each vehicle's strategy said."
    if run.guards:
        note += " Thin bars below: when the supervisor did not let it pass as it was."
    return Figure("rules", "Rules in force", note, 170 + 36 * len(names), data, layout)


def _bars(
    run: Run,
    bands: dict[int, tuple[Band, ...]],
    rule: str,
    name: str,
    color: str,
    width: float,
    offset: float,
) -> Trace:
    rows = [(run.role_of(i), b) for i, found in sorted(bands.items()) for b in found if b.rule == rule]
    return {
        "type": "bar",
        "orientation": "h",
        "y": [who for who, _ in rows],
        "base": [parts.number(band.start) for _, band in rows],
        "x": [parts.number(band.end - band.start) for _, band in rows],
        "width": width,
        "offset": offset,
        "name": name,
        "marker": {"color": color, "line": {"width": 0}},
        "customdata": [[parts.number(band.start), parts.number(band.end), band.why] for _, band in rows],
        "hovertemplate": "<b>" + name + "</b><br>%{customdata[0]:.1f} to %{customdata[1]:.1f} s"
        "<br>%{customdata[2]}<extra>%{y}</extra>",
    }


def speeds(run: Run) -> Figure | None:
    """Ground speed, and airspeed where it is known."""
    if not run.flown:
        return None
    data: list[Trace] = []
    for vehicle_id, color in look.colors(run).items():
        flown = run.flown[vehicle_id]
        name = run.role_of(vehicle_id)
        data.append(
            parts.line(
                parts.short(flown.t), parts.short(flown.groundspeed), name, color, "%{y:.2f} m/s over ground"
            )
        )
        if not np.isnan(flown.airspeed).all():
            air = parts.line(
                parts.short(flown.t), parts.short(flown.airspeed), name, color, "%{y:.2f} m/s in the air"
            )
            data.append(air | {"yaxis": "y2", "showlegend": False})
    shapes, notes = parts.phases(run)
    layout = parts.two_rows(run, "speed over ground [m/s]", "airspeed [m/s]", shapes, notes)
    return Figure("speeds", "Speeds", "Above: over ground. Below: relative to the air.", 520, data, layout)


def heights(run: Run) -> Figure | None:
    """Height above the origin."""
    if not run.flown or (run.setup is not None and run.setup.rules.planar and not _climbs(run)):
        return None
    colors = look.colors(run)
    data = [
        parts.line(parts.short(f.t), parts.short(-f.position[:, 2]), run.role_of(i), colors[i], "%{y:.1f} m")
        for i, f in sorted(run.flown.items())
    ]
    fence = run.fence
    if fence is not None:
        for level in (fence.altitude_min, fence.altitude_max):
            data.append(parts.level(run, level, f"geofence {level:g} m", look.FENCE, "dash"))
    shapes, notes = parts.phases(run)
    layout = parts.layout(
        xaxis=parts.time(run), yaxis=parts.axis("height [m]"), shapes=shapes, annotations=notes
    )
    return Figure("heights", "Heights", "Above the origin of the game frame.", 360, data, layout)


def wind(run: Run) -> Figure | None:
    """Estimated wind."""
    known = windy(run)
    if not known:
        return None
    colors = look.colors(run)
    data: list[Trace] = []
    for vehicle_id, flown in sorted(known.items()):
        name = run.role_of(vehicle_id)
        north, east = flown.wind[:, 0], flown.wind[:, 1]
        speed = np.hypot(north, east)
        come = np.array([degrees(atan2(-e, -n)) % 360.0 for n, e in zip(north, east, strict=True)])
        data.append(
            parts.line(parts.short(flown.t), parts.short(speed), name, colors[vehicle_id], "%{y:.1f} m/s")
        )
        known_come = parts.short(np.where(speed > 0.05, come, np.nan))
        towards = parts.line(parts.short(flown.t), known_come, name, colors[vehicle_id], "from %{y:.0f}°")
        data.append(towards | {"yaxis": "y2", "showlegend": False, "mode": "markers", "marker": {"size": 3}})
    shapes, notes = parts.phases(run)
    layout = parts.two_rows(run, "wind [m/s]", "from [deg]", shapes, notes)
    layout["yaxis2"] |= {"range": [0, 360], "dtick": 90}
    note = "As each vehicle's autopilot estimates it; the direction is where it comes from."
    return Figure("wind", "Wind", note, 460, data, layout)


def links(run: Run) -> Figure | None:
    """Link quality and battery."""
    if not run.links:
        return None
    colors = look.colors(run)
    data: list[Trace] = []
    for vehicle_id, link in sorted(run.links.items()):
        name, color = run.role_of(vehicle_id), colors.get(vehicle_id, look.OTHERS)
        if not np.isnan(link.quality).all():
            data.append(
                parts.line(parts.short(link.t), parts.short(100 * link.quality), name, color, "%{y:.0f} %")
            )
        if not np.isnan(link.battery).all():
            charge = parts.line(
                parts.short(link.t), parts.short(100 * link.battery), name, color, "%{y:.0f} % battery"
            )
            data.append(charge | {"yaxis": "y2", "showlegend": bool(np.isnan(link.quality).all())})
    shapes, notes = parts.phases(run)
    layout = parts.two_rows(run, "link quality [%]", "battery [%]", shapes, notes)
    layout["yaxis"] |= {"range": [0, 105]}
    layout["yaxis2"] |= {"range": [0, 105]}
    note = "Link quality: the share of the telemetry expected from the autopilot that arrived."
    return Figure("links", "Links and batteries", note, 460, data, layout)


def latencies(run: Run) -> Figure | None:
    """How late states came."""
    known = {i: f for i, f in run.flown.items() if not np.isnan(f.latency).all()}
    if not known:
        return None
    colors = look.colors(run)
    data: list[Trace] = []
    for vehicle_id, flown in sorted(known.items()):
        name, late = run.role_of(vehicle_id), parts.short(1000 * flown.latency)
        line = parts.line(parts.short(flown.t), late, name, colors[vehicle_id], "%{y:.1f} ms")
        data.append(line | {"mode": "markers", "marker": {"size": 3, "color": colors[vehicle_id]}})
    shapes, notes = parts.phases(run)
    layout = parts.layout(
        xaxis=parts.time(run),
        yaxis=parts.axis("age at arrival [ms]") | {"rangemode": "tozero"},
        shapes=shapes,
        annotations=notes,
    )
    note = "From the stamp of each state message to its arrival at the recorder (clock offsets included)."
    return Figure("latencies", "Latencies", note, 360, data, layout)


def _climbs(run: Run) -> bool:
    return any(float(np.ptp(f.position[:, 2])) > 0.5 for f in run.flown.values())
