"""The figure that says why the evader was not captured."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from gcs.report import theme
from gcs.report.data import Array, Flown, Run
from gcs.report.drawing import FAINT, INK, WIDTH, Drawing, Panel, curve, legend_below
from onboard.game import palette
from onboard.game.hindsight import Ways, in_words, missed
from onboard.wire.bus.messages import OutcomeResult, Role


def missed_capture(run: Run) -> Drawing | None:
    """When it was too late, who could have met the evader last, and where; None after a capture."""
    ways, ids = ways_of(run)
    if ways is None:
        return None
    found = missed(ways)
    figure = Figure(figsize=(WIDTH, 7.6), layout="constrained")
    above, below = figure.subplots(2, 1, height_ratios=(2.2, 1.0))
    above.set_gid("a0")
    below.set_gid("a1")
    at = int(np.abs(ways.t - found.t).argmin())
    before, after = ways.evader[: at + 1], ways.evader[at:]
    evader = run.evader
    colour = run.colour(evader.id) if evader is not None else INK
    above.plot(before[:, 1], before[:, 0], color=colour, lw=1.0, label="evader until then")
    above.plot(after[:, 1], after[:, 0], color=colour, lw=2.2, label="and from then on")
    late = found.when - found.t if found.who >= 0 else float(ways.t[-1] - ways.t[at])
    for k, id in enumerate(ids):
        own = run.colour(id)
        north, east = ways.pursuers[k, at, 0], ways.pursuers[k, at, 1]
        above.plot(east, north, "o", color=own, label=f"pursuer {id}")
        reach = float(ways.speeds[k] * max(0.0, late) + ways.R)
        above.add_patch(Circle((east, north), reach, fill=False, ec=own, lw=0.8, ls="--"))
    if found.who >= 0:
        above.plot(found.place[1], found.place[0], "X", color=palette.CAPTURE.light, ms=10, ls="",
                   label="where the last chance was")  # fmt: skip
    if run.target is not None:
        north, east, _ = run.target
        above.plot(east, north, "*", color=palette.TARGET.light, ms=14, ls="", label="target")
    above.set(xlabel="east [m]", ylabel="north [m]")
    wide = max(float(np.ptp(ways.pursuers[:, at, axis])) for axis in range(2))
    wide = 0.6 * wide + float(ways.speeds.max()) * max(0.0, late) + 2.0 * ways.R
    middle = ways.pursuers[:, at].mean(axis=0)
    above.set_xlim(middle[1] - wide, middle[1] + wide, auto=True)  # one gives way to the aspect
    above.set_ylim(middle[0] - wide, middle[0] + wide, auto=True)
    above.set_aspect("equal", adjustable="datalim")
    series = tuple(curve(below, run, id, (found.instants, found.spare[:, k])) for k, id in enumerate(ids))
    for line in below.lines:
        line.set_label("")
    below.axhline(0.0, color=INK, lw=1.0)
    below.axvline(found.t, color=FAINT, lw=1.2, ls="--")
    if np.isfinite(found.open_since):
        below.axvspan(found.open_since, float(ways.t[-1]), color=palette.TARGET.light, alpha=0.08, lw=0)
    below.set(xlabel=theme.clock(run), ylabel="could still reach by [m]", xlim=(ways.t[0], ways.t[-1]))
    legend_below(figure, above)
    note = (
        f"{in_words(found, ids)} Dashed circles: where each pursuer could have been by the last chance."
        " Below: by how much each could still reach the rest of the evader's way; shaded: a ray was safe from"
        " everybody. By declared airspeeds, without the time for turns: nothing possible is called too late."
    )
    panels = (Panel(above, "plan", "m"), Panel(below, "time", "m", series))
    return Drawing("missed_capture", "Why it was not captured", note, figure, panels)


def ways_of(run: Run) -> tuple[Ways | None, tuple[int, ...]]:
    """The game as it was flown, in the air: None where the evader was captured, or too little is known."""
    evader, setup, outcome = run.evader, run.setup, run.outcome
    captured = outcome is not None and outcome.verdict is OutcomeResult.CAPTURED
    if evader is None or setup is None or outcome is None or captured:
        return None, ()
    speeds = {member.id: member.speed for member in setup.roster}
    team = [f for f in run.flown.values() if f.role is Role.PURSUER and len(f.t) > 1 and speeds.get(f.id)]
    inside = run.playing(evader.t)
    t = evader.t[inside]
    if len(t) < 2 or not team or not speeds.get(evader.id):
        return None, ()
    drift = _drift(evader, t)
    places = np.stack([_at(f, t) - drift for f in team])
    ids = tuple(f.id for f in team)
    return Ways(
        t,
        evader.position[inside] - drift,
        places,
        np.array([speeds[id] for id in ids]),
        speeds[evader.id],
        float(setup.rules.R),
        run.flat,
    ), ids


def _at(flown: Flown, t: Array) -> Array:
    return np.column_stack([np.interp(t, flown.t, flown.position[:, axis]) for axis in range(3)])


def _drift(evader: Flown, t: Array) -> Array:
    """How far the air had moved at each instant [m], by the mean wind that the evader's autopilot told."""
    wind = evader.wind[np.isfinite(evader.wind).all(axis=1)]
    mean = wind.mean(axis=0) if len(wind) else np.zeros(3)
    moved: Array = np.outer(t - t[-1], mean)
    return moved
