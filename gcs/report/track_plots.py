"""Where everybody flew: in space, to turn with the mouse, and from above.

Axes: east, north, height [m].
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from gcs.report import plotly_parts as parts
from gcs.report import theme as look
from gcs.report.data import Array, Flown, Run
from gcs.report.plotly_parts import Figure, Trace


def space(run: Run) -> Figure | None:
    """Trajectories in 3D, to turn with the mouse."""
    if not run.flown:
        return None
    data: list[Trace] = []
    low = min(0.0, min(float((-f.position[:, 2]).min()) for f in run.flown.values()))
    for vehicle_id, color in look.colors(run).items():
        flown = run.flown[vehicle_id]
        name = run.role_of(vehicle_id)
        north, east, height = _places(flown)
        text = {"x": parts.short(east), "y": parts.short(north), "type": "scatter3d", "mode": "lines"}
        data.append(
            {
                **text,
                "z": parts.short(np.full(len(height), low)),
                "line": {"color": color, "width": 1.5},
                "opacity": 0.25,
                "hoverinfo": "skip",
                "showlegend": False,
                "legendgroup": name,
            }
        )
        data.append(
            {
                **text,
                "z": parts.short(height),
                "name": name,
                "legendgroup": name,
                "line": {"color": color, "width": 5},
                "customdata": parts.short(flown.t),
                "hovertemplate": "<b>" + name + "</b> at %{customdata:.1f} s<br>east %{x:.1f} m, "
                "north %{y:.1f} m<br>height %{z:.1f} m<extra></extra>",
            }
        )
        data.append(
            {
                "type": "scatter3d",
                "mode": "markers",
                "x": [parts.number(east[0]), parts.number(east[-1])],
                "y": [parts.number(north[0]), parts.number(north[-1])],
                "z": [parts.number(height[0]), parts.number(height[-1])],
                "marker": {"color": color, "size": [4, 6], "symbol": ["circle-open", "circle"]},
                "hoverinfo": "skip",
                "showlegend": False,
                "legendgroup": name,
            }
        )
    if run.target is not None:
        target_north, target_east, target_down = run.target
        data.append(
            {
                "type": "scatter3d",
                "mode": "markers+text",
                "x": [target_east],
                "y": [target_north],
                "z": [-target_down],
                "name": "target",
                "text": ["target"],
                "textposition": "top center",
                "marker": {"color": look.TARGET, "size": 6, "symbol": "diamond"},
            }
        )
    data += _fence_in_space(run)
    axis = {"gridcolor": look.GRID, "zerolinecolor": look.GRID, "backgroundcolor": look.PAPER}
    layout = parts.layout(
        scene={
            "xaxis": {"title": {"text": "east [m]"}, **axis},
            "yaxis": {"title": {"text": "north [m]"}, **axis},
            "zaxis": {"title": {"text": "height [m]"}, "nticks": 4, **axis},
            "aspectmode": "data",
            "camera": {"eye": _eye(run, low)},
            "dragmode": "turntable",
        },
        margin={"l": 0, "r": 0, "t": 0, "b": 40},
    )
    note = (
        "Drag to turn, scroll to come closer. Open circles: start; filled: end. Faint lines: shadows below."
    )
    return Figure("space", "Trajectories in space", note, 620, data, layout)


def _eye(run: Run, low: float) -> dict[str, float]:
    """Where to look from, so that all is seen: plotly.js measures in the geometric mean of the spans."""
    tops = [float((-f.position[:, 2]).max()) for f in run.flown.values()]
    spans = np.array([high - least for least, high in run.extent] + [max(tops) - low])
    spans = np.maximum(spans, 1e-3)
    far = max(1.0, 0.8 * float(spans.max() / np.exp(np.log(spans).mean())))
    return {"x": round(0.95 * far, 3), "y": round(-1.2 * far, 3), "z": round(0.8 * far, 3)}


def plan(run: Run) -> Figure | None:
    """Trajectories from above."""
    if not run.flown:
        return None
    data: list[Trace] = []
    fence = run.fence
    if fence is not None:
        corners = [*fence.polygon, fence.polygon[0]]
        data.append(
            {
                "type": "scatter",
                "mode": "lines",
                "x": [c[1] for c in corners],
                "y": [c[0] for c in corners],
                "name": "geofence",
                "line": {"color": look.FENCE, "dash": "dash", "width": 1.5},
                "hoverinfo": "name",
            }
        )
    for vehicle_id, color in look.colors(run).items():
        flown = run.flown[vehicle_id]
        name = run.role_of(vehicle_id)
        north, east, height = _places(flown)
        data.append(
            {
                "type": "scatter",
                "mode": "lines",
                "x": parts.short(east),
                "y": parts.short(north),
                "name": name,
                "legendgroup": name,
                "line": {"color": color, "width": 2.5},
                "customdata": [
                    [parts.number(t), parts.number(h)] for t, h in zip(flown.t, height, strict=True)
                ],
                "hovertemplate": "<b>" + name + "</b> at %{customdata[0]:.1f} s<br>east %{x:.1f} m, "
                "north %{y:.1f} m, height %{customdata[1]:.1f} m<extra></extra>",
            }
        )
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "x": [parts.number(east[0]), parts.number(east[-1])],
                "y": [parts.number(north[0]), parts.number(north[-1])],
                "marker": {"color": color, "size": [9, 11], "symbol": ["circle-open", "circle"]},
                "hoverinfo": "skip",
                "showlegend": False,
                "legendgroup": name,
            }
        )
    data += _capture_circle(run)
    if run.target is not None:
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "x": [run.target[1]],
                "y": [run.target[0]],
                "name": "target",
                "marker": {"color": look.TARGET, "size": 14, "symbol": "star"},
            }
        )
    north_range, east_range = run.extent
    layout = parts.layout(
        xaxis=parts.axis("east [m]") | {"range": list(east_range)},
        yaxis=parts.axis("north [m]") | {"scaleanchor": "x", "scaleratio": 1, "range": list(north_range)},
        dragmode="pan",
    )
    note = "North is up. Open circles: start; filled: end. Double click shows all."
    if run.capture_radius is not None:
        note += f" Red: the capture radius R = {run.capture_radius:g} m around the evader at the end."
    return Figure("plan", "Plan view", note, 620, data, layout)


def _capture_circle(run: Run) -> list[Trace]:
    evader, radius = run.evader, run.capture_radius
    if evader is None or radius is None:
        return []
    north, east, _ = evader.position[_end(run, evader)]
    around = [2 * pi * n / 60 for n in range(61)]
    return [
        {
            "type": "scatter",
            "mode": "lines",
            "x": [parts.number(east + radius * cos(a)) for a in around],
            "y": [parts.number(north + radius * sin(a)) for a in around],
            "name": f"R = {radius:g} m",
            "line": {"color": look.CAPTURE, "width": 1.5},
            "hoverinfo": "name",
        }
    ]


def _end(run: Run, flown: Flown) -> int:
    """The sample nearest to the outcome, the last one where there is none."""
    if run.outcome is None:
        return len(flown.t) - 1
    return int(np.abs(flown.t - run.outcome.time).argmin())


def _fence_in_space(run: Run) -> list[Trace]:
    fence = run.fence
    if fence is None:
        return []
    corners = [*fence.polygon, fence.polygon[0]]
    return [
        {
            "type": "scatter3d",
            "mode": "lines",
            "x": [c[1] for c in corners],
            "y": [c[0] for c in corners],
            "z": [level] * len(corners),
            "name": "geofence",
            "legendgroup": "geofence",
            "showlegend": level == fence.altitude_min,
            "visible": "legendonly",
            "line": {"color": look.FENCE, "width": 2, "dash": "dash"},
            "hoverinfo": "name",
        }
        for level in (fence.altitude_min, fence.altitude_max)
    ]


def _places(flown: Flown) -> tuple[Array, Array, Array]:
    return flown.position[:, 0], flown.position[:, 1], -flown.position[:, 2]
