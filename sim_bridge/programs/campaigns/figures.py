"""Pictures of a campaign: wins over the swept values, capture and arrival over time, smallest distances."""

from __future__ import annotations

from functools import partial
from itertools import combinations, cycle
from pathlib import Path
from typing import Any

import numpy as np

from onboard.game import palette
from onboard.runtime.whole_files import whole_or_nothing
from sim_bridge.programs.campaigns.plan import model
from sim_bridge.programs.campaigns.show import Games, Results

CURVES = 12  # at most in one picture
COLOURS = [colour.light for colour in palette.PURSUERS]


def draw(found: Results, folder: Path) -> list[Path]:
    """All pictures of a campaign as PNG. Returns the files written."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    written = []
    for name, picture in (("wins", wins), ("survival", survival), ("distance", distance)):
        figure = plt.figure(figsize=(9, 6), layout="constrained")
        picture(found, figure)
        path = folder / f"{name}.png"
        whole_or_nothing(path, partial(figure.savefig, dpi=120))
        plt.close(figure)
        written.append(path)
    return written


def _name(found: Results, one: Games, *, values: bool) -> str:
    label, *rest = one.what
    count = len(found.plan.parameters())
    swept = [f"{key} {value}" for key, value in zip(found.plan.parameters(), rest[:count], strict=True)]
    evader, pursuers, _model = rest[count:]
    return ", ".join([label, *(swept if values else []), f"{pursuers} after {evader}"])


def _numeric(found: Results) -> list[str]:
    """The swept keys whose values are numbers of which there are two or more."""
    points = found.plan.points
    return [
        key for key in found.plan.parameters()
        if all(isinstance(p[key], (int, float)) for p in points) and len({p[key] for p in points}) > 1
    ]  # fmt: skip


def wins(found: Results, figure: Any) -> None:
    """Share of captures: a map over two swept values, a curve over one, a bar a cell without any."""
    keys = _numeric(found)
    if not keys:
        _bars(found, figure.add_subplot())
        return
    pairs = len(found.plan.pairs)
    groups: dict[tuple[int, int], list[Games]] = {}
    for one in found.cells:
        place, pair = divmod(one.cell, pairs)
        groups.setdefault((place // len(found.plan.points), pair), []).append(one)
    if len(keys) == 1:
        axis = figure.add_subplot()
        for colour, members in zip(cycle(COLOURS), list(groups.values())[:CURVES], strict=False):
            _curve(found, axis, keys[0], members, colour)
        axis.set(xlabel=keys[0], ylabel="share captured, with 95 % interval", ylim=(-0.02, 1.02))
        axis.legend(fontsize=8)
        axis.grid(color=palette.GRID.light)
        return
    shown = list(groups.values())[:CURVES]
    columns = min(3, len(shown))
    for number, members in enumerate(shown):
        axis = figure.add_subplot(-(-len(shown) // columns), columns, number + 1)
        mapped = _map(found, axis, _two_of(found, keys), members)
    figure.colorbar(mapped, ax=figure.axes, label="share captured", shrink=0.8)


def _two_of(found: Results, keys: list[str]) -> tuple[str, str]:
    """The two keys of a map: two that were drawn together where there are such, else the first two."""
    values = {key: {point[key] for point in found.plan.points} for key in keys}
    for first, second in combinations(keys, 2):
        together = {(point[first], point[second]) for point in found.plan.points}
        if len(together) < len(values[first]) * len(values[second]):
            return first, second
    return keys[0], keys[1]


def _bars(found: Results, axis: Any) -> None:
    cells = found.cells[: 4 * CURVES]
    shares = [one.share("captured") for one in cells]
    middle = np.array([count / len(one.seeds) for one, (count, _l, _h) in zip(cells, shares, strict=True)])
    low, high = (np.array([share[k] for share in shares]) for k in (1, 2))
    places = np.arange(len(cells))
    errors = np.maximum([middle - low, high - middle], 0.0)
    axis.barh(places, middle, xerr=errors, color=COLOURS[0], ecolor=palette.INK.light, capsize=2)
    axis.set_yticks(places, [_name(found, one, values=True) for one in cells], fontsize=8)
    axis.invert_yaxis()
    axis.set(xlabel="share captured, with 95 % interval", xlim=(0.0, 1.0))


def _curve(found: Results, axis: Any, key: str, members: list[Games], colour: str) -> None:
    """Captures over one value; games of other swept values count together."""
    sums: dict[float, list[int]] = {}
    for one in members:
        place = float(found.plan.cell(one.cell).point[key])
        count, games = sums.setdefault(place, [0, 0])
        sums[place] = [count + one.share("captured")[0], games + len(one.seeds)]
    from sim_bridge.programs.campaigns.until import wilson

    x = sorted(sums)
    bounds = np.array([wilson(*sums[v]) for v in x])
    axis.plot(x, [sums[v][0] / sums[v][1] for v in x], "o-", color=colour, ms=4,
              label=_name(found, members[0], values=False))  # fmt: skip
    axis.fill_between(x, bounds[:, 0], bounds[:, 1], color=colour, alpha=0.15, lw=0)


def _map(found: Results, axis: Any, keys: tuple[str, str], members: list[Games]) -> Any:
    places = np.array([[float(found.plan.cell(one.cell).point[key]) for key in keys] for one in members])
    shares = np.array([one.share("captured")[0] / len(one.seeds) for one in members])
    x, y = (np.unique(places[:, k]) for k in (0, 1))
    settings: dict[str, Any] = {"cmap": "cividis", "vmin": 0.0, "vmax": 1.0}
    values, counts = np.zeros((2, len(y), len(x)))
    at = np.searchsorted(y, places[:, 1]), np.searchsorted(x, places[:, 0])
    np.add.at(values, at, shares)  # over whatever else was swept
    np.add.at(counts, at, 1.0)
    values /= np.maximum(counts, 1.0)
    if np.all(counts > 0.0):
        mapped = axis.pcolormesh(x, y, values, shading="nearest", **settings)
    else:
        row, column = np.nonzero(counts)
        mapped = axis.scatter(x[column], y[row], c=values[row, column], s=60, edgecolors="none", **settings)
    axis.set(xlabel=keys[0], ylabel=keys[1])
    axis.set_title(_name(found, members[0], values=False), fontsize=9)
    return mapped


def survival(found: Results, figure: Any) -> None:
    """Share of the evaders that fly on over time, and of those that have arrived."""
    axis = figure.add_subplot()
    for colour, one in zip(cycle(COLOURS), found.cells[:CURVES], strict=False):
        end = float(np.max(one.times))
        for verdict, line in (("captured", "-"), ("arrived", "--")):
            times = np.sort(one.times[one.verdicts == verdict])
            share = np.arange(len(times) + 1) / len(one.seeds)
            gone = np.concatenate([share, share[-1:]])
            x = np.concatenate([[0.0], times, [end]])
            label = f"{one.cell}: {_name(found, one, values=True)}" if line == "-" else None
            axis.step(x, 1.0 - gone if line == "-" else gone, line, where="post", color=colour, label=label)
    axis.set(xlabel="time since t₀ [s]", ylabel="share of games", ylim=(-0.02, 1.02))
    axis.set_title(f"not captured yet (solid), arrived (dashed){_first(found)}", fontsize=10)
    _told(found, axis)


def distance(found: Results, figure: Any) -> None:
    """How near a pursuer ever came: the share of games up to each smallest distance."""
    axis = figure.add_subplot()
    for colour, one in zip(cycle(COLOURS), found.cells[:CURVES], strict=False):
        values = np.sort(one.smallest[~np.isnan(one.smallest)])
        if len(values):
            share = np.arange(1, len(values) + 1) / len(values)
            axis.step(values, share, where="post", color=colour,
                      label=f"{one.cell}: {_name(found, one, values=True)}")  # fmt: skip
            radius = found.plan.cell(one.cell).scenario.parameters.R
            axis.axvline(radius, color=palette.CAPTURE.light, lw=0.8, ls=":")
    axis.set(xlabel="smallest distance of a pursuer [m] (dotted: capture radius)", ylabel="share of games")
    axis.set_ylim(-0.02, 1.02)
    axis.set_title(f"how near a pursuer ever came{_first(found)}", fontsize=10)
    _told(found, axis)


def _told(found: Results, axis: Any) -> None:
    axis.grid(color=palette.GRID.light)
    models = {model(found.plan.cell(one.cell), found.plan.flown) for one in found.cells[:CURVES]}
    title = "played as " + ", ".join(sorted(models))
    axis.figure.legend(loc="outside lower center", ncols=2, fontsize=7, title=title, title_fontsize=8)


def _first(found: Results) -> str:
    return f"; the first {CURVES} of {len(found.cells)} cells" if len(found.cells) > CURVES else ""
