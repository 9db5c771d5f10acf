"""Why an evader was not captured, as a picture: for the report of a flight and for a game played again.

Axes are given from outside (matplotlib's, or whatever draws like them); nothing that flies draws.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from onboard.game import palette
from onboard.game.hindsight import Missed, Ways, in_words

LEGEND = (
    "Dashed circles: where each pursuer could have been by the last chance. Below: by how much each could"
    " still reach the rest of the evader's way; shaded: a ray was safe from everybody. By declared airspeeds,"
    " without the time for turns: nothing possible is called too late."
)


class Marks(NamedTuple):
    """Whose game it is, and in which colours."""

    ids: tuple[int, ...]  # of the pursuers, in order
    colours: tuple[str, ...]  # theirs
    evader: str
    targets: tuple[tuple[float, float, float], ...]  # [m; NED]


def note(found: Missed, ids: tuple[int, ...]) -> str:
    """The picture's words."""
    return f"{in_words(found, ids)} {LEGEND}"


def draw_map(axes: Any, ways: Ways, found: Missed, marks: Marks) -> None:
    """The ways from above, everybody's place at the moment, and how far each could have come from there."""
    at = int(np.abs(ways.t - found.t).argmin())
    before, after = ways.evader[: at + 1], ways.evader[at:]
    axes.plot(before[:, 1], before[:, 0], color=marks.evader, lw=1.0, label="evader until then")
    axes.plot(after[:, 1], after[:, 0], color=marks.evader, lw=2.2, label="and from then on")
    late = found.when - found.t if found.who >= 0 else float(ways.t[-1] - ways.t[at])
    around = np.linspace(0.0, 2.0 * np.pi, 181)
    for k, (id, own) in enumerate(zip(marks.ids, marks.colours, strict=True)):
        north, east = ways.pursuers[k, at, 0], ways.pursuers[k, at, 1]
        axes.plot(east, north, "o", color=own, label=f"pursuer {id}")
        reach = float(ways.speeds[k] * max(0.0, late) + ways.R)
        circle = east + reach * np.sin(around), north + reach * np.cos(around)
        axes.plot(*circle, color=own, lw=0.8, ls="--", scalex=False, scaley=False)
    if found.who >= 0:
        axes.plot(found.place[1], found.place[0], "X", color=palette.CAPTURE.light, ms=10, ls="",
                  label="where the last chance was")  # fmt: skip
    for k, (north, east, _) in enumerate(marks.targets):
        label = "" if k else "target" if len(marks.targets) == 1 else "targets"
        axes.plot(east, north, "*", color=palette.TARGET.light, ms=14, ls="", label=label)
    axes.set(xlabel="east [m]", ylabel="north [m]")
    wide = max(float(np.ptp(ways.pursuers[:, at, axis])) for axis in range(2))
    wide = 0.6 * wide + float(ways.speeds.max()) * max(0.0, late) + 2.0 * ways.R
    middle = ways.pursuers[:, at].mean(axis=0)
    axes.set_xlim(middle[1] - wide, middle[1] + wide, auto=True)  # one gives way to the aspect
    axes.set_ylim(middle[0] - wide, middle[0] + wide, auto=True)
    axes.set_aspect("equal", adjustable="datalim")


def draw_moment(axes: Any, ways: Ways, found: Missed) -> None:
    """Below the map: the moment on the time axis of everybody's curve, and since when a ray was safe."""
    axes.axhline(0.0, color=palette.INK.light, lw=1.0)
    axes.axvline(found.t, color=palette.FAINT.light, lw=1.2, ls="--")
    if np.isfinite(found.open_since):
        axes.axvspan(found.open_since, float(ways.t[-1]), color=palette.TARGET.light, alpha=0.08, lw=0)
    axes.set(ylabel="could still reach by [m]", xlim=(ways.t[0], ways.t[-1]))
