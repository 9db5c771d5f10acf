"""Pieces of which a report's figures are made, as plotly.js takes them."""

from __future__ import annotations

from typing import Any, NamedTuple

from gcs.report import theme as look
from gcs.report.data import Array, Run

Trace = dict[str, Any]
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif"


class Figure(NamedTuple):
    """One figure of the page."""

    name: str  # also its element's id
    title: str
    note: str  # one line below the title
    height: int  # [px]
    data: list[Trace]
    layout: Trace


def layout(**more: Any) -> Trace:
    """A figure's layout: the common look, and what is given."""
    base: Trace = {
        "font": {"family": FONT, "size": 13, "color": look.INK},
        "paper_bgcolor": look.PAPER,
        "plot_bgcolor": look.PAPER,
        "margin": {"l": 64, "r": 16, "t": 26, "b": 92},
        "legend": {"orientation": "h", "x": 0, "y": 0, "yref": "container", "yanchor": "bottom"},
        "hoverlabel": {"font": {"family": FONT}},
        "hovermode": "closest",
    }
    return base | more


def axis(title: str) -> Trace:
    """An axis."""
    return {
        "title": {"text": title},
        "gridcolor": look.GRID,
        "zerolinecolor": look.GRID,
        "linecolor": look.GRID,
        "automargin": True,
    }


def time(run: Run) -> Trace:
    """The axis of time: the same in all figures."""
    start, end = run.span
    return axis("time since the start of the game [s]") | {"range": [number(start), number(end)]}


def two_rows(run: Run, upper: str, lower: str, shapes: list[Trace], notes: list[Trace]) -> Trace:
    """Two curves, one above the other, over one axis of time."""
    return layout(
        xaxis=time(run) | {"anchor": "y2"},
        yaxis=axis(upper) | {"domain": [0.55, 1.0]},
        yaxis2=axis(lower) | {"domain": [0.0, 0.45]},
        shapes=shapes,
        annotations=notes,
    )


def line(t: list[float | None], y: list[float | None], name: str, color: str, value: str) -> Trace:
    """A curve of one vehicle; `value` is how a point reads."""
    return {
        "type": "scatter",
        "mode": "lines",
        "x": t,
        "y": y,
        "name": name,
        "legendgroup": name,
        "line": {"color": color, "width": 2},
        "marker": {"color": color},
        "hovertemplate": "<b>" + name + "</b> at %{x:.2f} s<br>" + value + "<extra></extra>",
    }


def level(run: Run, level: float, name: str, color: str, dash: str) -> Trace:
    """A level line over the whole run."""
    start, end = run.span
    return {
        "type": "scatter",
        "mode": "lines",
        "x": [number(start), number(end)],
        "y": [level, level],
        "name": name,
        "line": {"color": color, "dash": dash, "width": 1.5},
        "hoverinfo": "name",
    }


def named_phases(run: Run) -> list[tuple[float, str]]:
    """The phases whose names have room on an axis of time: of several at nearly one place the last."""
    start, end = run.span
    kept: list[tuple[float, str]] = []
    limit = end
    for at, phase in reversed(run.phases):
        if start <= at and limit - at >= 0.07 * (end - start):
            kept.insert(0, (at, phase))
            limit = at
    return kept


def phases(run: Run) -> tuple[list[Trace], list[Trace]]:
    """A thin upright line where the game's phase changed, named on top."""
    shapes, notes = [], []
    start, end = run.span
    labels = set(named_phases(run))
    for at, phase in run.phases:
        if not start <= at <= end:
            continue
        x = number(at)
        line = {"color": look.FAINT, "width": 1, "dash": "dot"}
        shapes.append({"type": "line", "x0": x, "x1": x, "yref": "paper", "y0": 0, "y1": 1, "line": line})
        if (at, phase) not in labels:
            continue
        notes.append(
            {
                "x": x,
                "y": 1,
                "yref": "paper",
                "yanchor": "bottom",
                "xanchor": "left",
                "text": phase,
                "showarrow": False,
                "font": {"size": 11, "color": look.FAINT},
            }
        )
    return shapes, notes


def number(value: float) -> float:
    """Rounded to a millimetre or millisecond."""
    return round(float(value), 3)


def short(values: Array) -> list[float | None]:
    """Rounded to a millimetre or millisecond; what is unknown becomes a gap in the line."""
    return [None if value != value else round(value, 3) for value in values.tolist()]
