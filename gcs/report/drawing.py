"""How a report's figures are drawn: by matplotlib, once, for the page (SVG) and for papers (PNG)."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from gcs.report import theme
from gcs.report.data import Array, Run
from onboard.game import palette
from onboard.wire.bus.messages import Role

WIDTH, PNG_DPI, POINTS = 9.0, 200, 72.0  # [in], [dots/in], [SVG units/in]
MOST_LEGEND_ROWS = 5
SILENCE_S = 1.0  # a curve is broken where nothing was heard for longer
INK, FAINT, PAPER, GRID = (c.light for c in (palette.INK, palette.FAINT, palette.PAPER, palette.GRID))
STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.size": 9.5,
    "text.color": INK,
    "text.parse_math": False,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.facecolor": "none",
    "grid.color": GRID,
    "xtick.color": FAINT,
    "ytick.color": FAINT,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "svg.fonttype": "none",
    "svg.hashsalt": "apollonius",
}


class Series(NamedTuple):
    """A curve whose value a reader of the page can ask for."""

    gid: str  # of its line in the figure
    name: str  # what the value is of, `pursuer 2`
    colour: str
    scale: float = 1.0  # value = scale · (y − zero)
    zero: float = 0.0


class Lane(NamedTuple):
    """A row of bars: what was in force when."""

    name: str
    bars: tuple[tuple[float, float, str, str], ...]  # start, end [s], text, colour


class Panel(NamedTuple):
    """Axes that a reader of the page can ask and zoom."""

    axes: Any
    kind: str  # time | plan
    unit: str = ""
    series: tuple[Series, ...] = ()
    lanes: tuple[Lane, ...] = ()


class Drawing(NamedTuple):
    """One figure with what the page needs to explain it and to answer a reader."""

    name: str  # also of its file and of its element in the page
    title: str
    note: str  # a line or two on how to read it
    figure: Figure
    panels: tuple[Panel, ...] = ()


@contextmanager
def style() -> Iterator[None]:
    """Matplotlib's settings for everything drawn and written inside."""
    with matplotlib.rc_context(STYLE), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing")  # names from the network may have any letter
        yield


def timed(run: Run, labels: tuple[str, ...], height: float) -> tuple[Figure, list[Any]]:
    """A figure over time with one row of axes per label [height in inches], and the game's phases."""
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    rows = figure.subplots(len(labels), 1, sharex=True, squeeze=False)[:, 0]
    start, end = run.span
    named = named_phases(run)
    for number, (axes, label) in enumerate(zip(rows, labels, strict=True)):
        axes.set_gid(f"a{number}")
        axes.set(ylabel=label, xlim=(start, max(end, start + 1e-3)))
        for at, phase in run.phases:
            if start <= at <= end:
                axes.axvline(at, color=FAINT, lw=0.8, ls=":")
            if number == 0 and (at, phase) in named:
                text = axes.annotate(
                    phase, (at, 1.0), (0, 3), xycoords=("data", "axes fraction"),
                    textcoords="offset points", fontsize=8, color=FAINT, va="bottom",
                )  # fmt: skip
                text.set_gid(f"phase{len(axes.texts)}")
    rows[-1].set_xlabel(theme.clock(run))
    return figure, list(rows)


def named_phases(run: Run) -> list[tuple[float, str]]:
    """The phases whose names have room above an axis of time: of several at nearly one place the last."""
    start, end = run.span
    kept: list[tuple[float, str]] = []
    limit = end
    for at, phase in reversed(run.phases):
        room = (5.0 * len(phase) + 6.0) / (0.88 * WIDTH * POINTS)
        if start <= at and limit - at >= room * (end - start):
            kept.insert(0, (at, phase))
            limit = at
    return kept


def curve(axes: Any, run: Run, vehicle: int, points: tuple[Array, Array], **how: Any) -> Series:
    """Draw a vehicle's values over time, in its colour. NaN and silence are gaps."""
    colour = run.colour(vehicle)
    t, values = points
    usual = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    silent = np.flatnonzero(np.diff(t) > max(SILENCE_S, 5.0 * usual)) + 1
    t, values = np.insert(t, silent, t[silent]), np.insert(values, silent, np.nan)
    (line,) = axes.plot(t, values, color=colour, label=run.role_of(vehicle), **how)
    line.set_gid(f"{axes.get_gid()}-v{vehicle}-{len(axes.lines)}")
    return Series(line.get_gid(), run.role_of(vehicle), colour)


def legend_below(figure: Figure, axes: Any, more: tuple[Any, ...] = ()) -> None:
    """A legend below everything: of what is labelled in the axes, and of more handles."""
    handles, labels = axes.get_legend_handles_labels()
    handles, labels = [*handles, *more], [*labels, *(handle.get_label() for handle in more)]
    widest = 46.0 + 5.4 * max((len(label) for label in labels), default=1)
    columns = max(1, min(len(labels), int(figure.get_size_inches()[0] * POINTS / widest)))
    pursuers = [n for n, label in enumerate(labels) if label.startswith(Role.PURSUER.value)]
    hidden = pursuers[-max(0, len(labels) - MOST_LEGEND_ROWS * columns) :] if pursuers else []
    if len(labels) > MOST_LEGEND_ROWS * columns and len(hidden) < len(pursuers):
        labels[hidden[0] - 1] += f" … {labels[hidden[-1]].rpartition(' ')[2]}"
        handles, labels = ([part for n, part in enumerate(p) if n not in hidden] for p in (handles, labels))
    if labels:
        figure.legend(handles, labels, loc="outside lower center", ncols=columns)


def write_png(drawing: Drawing, run: Run, path: Path) -> None:
    """Write the figure as a picture that says by itself what it shows. Raises OSError."""
    with style():
        title = f"{drawing.title}\n{theme.words(run.name)[:60]} · {theme.verdict(run)}"
        drawing.figure.suptitle(title, fontsize=10.5)
        drawing.figure.savefig(path, dpi=PNG_DPI, facecolor=PAPER, metadata={"Software": None})
        drawing.figure.suptitle("")


def svg(drawing: Drawing) -> str:
    """The figure as an SVG element to stand in a page, whose style sheet gives the colours as variables."""
    with style():
        buffer = io.StringIO()
        nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        drawing.figure.savefig(buffer, format="svg", facecolor="none", metadata=nothing)
    text = buffer.getvalue()
    text = text[text.index("<svg") :]
    width, height = drawing.figure.get_size_inches() * POINTS
    head = f'<svg role="img" aria-label="{drawing.title}" viewBox="0 0 {width:g} {height:g}"'
    head += f' style="max-width:{1.72 * width:.0f}px">'
    body = text[text.index(">") + 1 :]
    body = re.sub(r"<metadata>.*?</metadata>|<style.*?</style>", "", body, flags=re.DOTALL)
    body = re.sub(r' (?:d|x|y|width|height)="[^"]*"', _shortened, body)
    body = re.sub(r"font-family: [^;\"]*;? ?| transform=\"rotate\(-0 [^\"]*\"", "", body)
    body = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{drawing.name}-", body)
    body = re.sub(r'style="[^"]*"', _variables, body)
    return head + re.sub(r"\n\s*", "\n", body)


def _shortened(attribute: re.Match[str]) -> str:
    """A number or path of an SVG with two decimals: a hundredth of a point."""
    return re.sub(r"(\.\d\d)\d+", r"\1", attribute.group()).replace("\n", "")


def _variables(style: re.Match[str]) -> str:
    """Colours as variables, which differ between light and dark."""
    return re.sub(r"#([0-9a-f]{6})", r"var(--c\1)", style.group())


def questions(drawing: Drawing) -> dict[str, Any]:
    """What the page's script needs to answer and to zoom: call it after `svg`, which lays the figure out."""
    width, height = drawing.figure.get_size_inches() * POINTS
    panels = []
    for panel in drawing.panels:
        box = panel.axes.get_position()
        panels.append(
            {
                "gid": panel.axes.get_gid(),
                "kind": panel.kind,
                "unit": panel.unit,
                "x": [box.x0 * width, box.x1 * width, *map(float, panel.axes.get_xlim())],
                "y": [(1 - box.y0) * height, (1 - box.y1) * height, *map(float, panel.axes.get_ylim())],
                "series": panel.series,
                "lanes": panel.lanes,
            }
        )
    return {"name": drawing.name, "panels": panels}


def thin(values: Array, most: int) -> list[Any]:
    """At most so many of the rows, first and last among them, rounded to a centimetre or centisecond."""
    keep = np.unique(np.linspace(0, len(values) - 1, most).round().astype(int))
    kept: list[Any] = np.round(values[keep], 2).tolist()
    return kept
