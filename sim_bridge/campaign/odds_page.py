"""What odds.json says beside what happened: a page in Markdown, and the reliability diagram."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np


class Judged(NamedTuple):
    """How a fit did on games held out."""

    kind: str
    evader: str
    outcome: str
    games: int
    share: float
    brier: float
    plain: float  # Brier score of always saying the share
    bins: tuple[tuple[float, int, int], ...]  # mean said, games, happened


class Shipped(NamedTuple):
    """How often games of a shipped scenario end in an outcome, and what is said of it."""

    name: str
    outcome: str
    games: int
    said: float  # mean
    happened: int


def page(
    kind: str, told: list[Judged], shipped: list[Shipped], made: str, held_out: int, pursuers: str
) -> str:
    """The judgement as Markdown: `made` says by what, every `held_out`-th game judged, who pursued."""
    where = {"plane": "in the plane", "space": "in space"}[kind]
    lines = [
        f"# Go or no-go {where}: what the table says, and what happened",
        "",
        made,
        "",
        f"Every {held_out}th game was held out of the fit. Pursuers: `{pursuers}`. Brier score: the mean of"
        " squares of (said − happened); beside it that of always saying the share.",
        "",
        "| evader | outcome | held out | share | Brier | of the share alone |"
        " said in the mean: happened, by tenths |",
        "|---|---|---|---|---|---|---|",
    ]
    for one in told:
        cells = [f"{100 * s:.0f} %: {100 * k / n:.0f} % of {n}" for s, n, k in one.bins]
        lines.append(
            f"| {one.evader} | {one.outcome} | {one.games} | {100 * one.share:.0f} % |"
            f" {one.brier:.3f} | {one.plain:.3f} | {'; '.join(cells)} |"
        )
    if shipped:
        lines += [
            "",
            "Shipped scenarios against the evader `paper`, drawn as campaigns draw them, in no fit. What is"
            " said is a mean over starts that are alike in the features above, and one of them may be far"
            " off: `sim-bridge campaign NAME` plays it.",
            "",
            "| scenario | games | captured: said | happened (95 %) | arrived: said | happened (95 %) |",
            "|---|---|---|---|---|---|",
        ]
    for captured, arrived in zip(shipped[::2], shipped[1::2], strict=True):
        cells = [f"{100 * one.said:.0f} % | {_share(one.happened, one.games)}" for one in (captured, arrived)]
        lines.append(f"| {captured.name} | {captured.games} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _share(count: int, games: int) -> str:
    from scipy.stats import binomtest

    low, high = binomtest(count, games).proportion_ci(method="wilson")
    return f"{100 * count / games:.0f} % ({100 * low:.0f}–{100 * high:.0f})"


def reliability(told: list[Judged], evaders: Sequence[str], path: Path) -> None:
    """The reliability diagram: what was said, and what happened with Wilson's 95 % interval, bin by bin."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from scipy.stats import binomtest

    figure = Figure(figsize=(9.0, 4.3), layout="constrained")
    FigureCanvasAgg(figure)
    places: Any = figure.subplots(1, len(evaders), squeeze=False, sharex=True, sharey=True)
    for axes, evader in zip(places.flat, evaders, strict=True):
        axes.plot([0, 1], [0, 1], color="0.7", lw=1)
        for one, colour in zip([t for t in told if t.evader == evader], ("#aa3377", "#228833"), strict=True):
            said = [s for s, _, _ in one.bins]
            share = [k / n for _, n, k in one.bins]
            reach = [binomtest(k, n).proportion_ci(method="wilson") for _, n, k in one.bins]
            error = [[h - r.low for h, r in zip(share, reach, strict=True)],
                     [r.high - h for h, r in zip(share, reach, strict=True)]]  # fmt: skip
            label = f"{one.outcome}: Brier {one.brier:.3f} (share alone {one.plain:.3f})"
            axes.errorbar(said, share, yerr=np.maximum(error, 0.0), fmt="o-", ms=4, lw=1, capsize=2,
                          color=colour, label=label)  # fmt: skip
        axes.set_title(f"evader {evader}", fontsize=10)
        axes.legend(fontsize=8, loc="upper left", frameon=False)
        axes.grid(alpha=0.2)
    for axes in places[-1]:
        axes.set_xlabel("said before the game")
    for axes in places[:, 0]:
        axes.set_ylabel("happened")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
