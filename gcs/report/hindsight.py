"""The figure that says why the evader was not captured."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from gcs.report import theme
from gcs.report.data import Array, Flown, Run
from gcs.report.drawing import INK, WIDTH, Drawing, Panel, curve, legend_below
from onboard.game.hindsight import Ways, missed
from onboard.game.hindsight_sketch import Marks, draw_map, draw_moment, note
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
    evader = run.evader
    own = INK if evader is None else run.colour(evader.id)
    marks = Marks(ids, tuple(run.colour(id) for id in ids), own, run.target)
    draw_map(above, ways, found, marks)
    series = tuple(curve(below, run, id, (found.instants, found.spare[:, k])) for k, id in enumerate(ids))
    for line in below.lines:
        line.set_label("")
    draw_moment(below, ways, found)
    below.set_xlabel(theme.clock(run))
    legend_below(figure, above)
    panels = (Panel(above, "plan", "m"), Panel(below, "time", "m", series))
    return Drawing("missed_capture", "Why it was not captured", note(found, ids), figure, panels)


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
