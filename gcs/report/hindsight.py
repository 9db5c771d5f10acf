"""The figures that say why an evader was not captured: one of each."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from gcs.report import theme
from gcs.report.data import Array, Flown, Run
from gcs.report.drawing import WIDTH, Drawing, Panel, curve, legend_below
from onboard.game.hindsight import Ways, missed
from onboard.game.hindsight_sketch import Marks, draw_map, draw_moment, note
from onboard.wire.bus.messages import OutcomeResult, Role


def missed_captures(run: Run) -> list[Drawing]:
    """A figure of each evader that was not captured, as far as enough is known."""
    return [found for evader in run.evaders if (found := _missed(run, evader)) is not None]


def _missed(run: Run, evader: Flown) -> Drawing | None:
    """When it was too late, who could have met the evader last, and where; None after a capture."""
    ways, ids = ways_of(run, evader)
    if ways is None:
        return None
    found = missed(ways)
    figure = Figure(figsize=(WIDTH, 7.6), layout="constrained")
    above, below = figure.subplots(2, 1, height_ratios=(2.2, 1.0))
    above.set_gid("a0")
    below.set_gid("a1")
    goals = tuple(goal.place for goal in run.targets if goal.evader in (evader.id, 0))
    marks = Marks(ids, tuple(run.colour(id) for id in ids), run.colour(evader.id), goals)
    draw_map(above, ways, found, marks)
    series = tuple(curve(below, run, id, (found.instants, found.spare[:, k])) for k, id in enumerate(ids))
    for line in below.lines:
        line.set_label("")
    draw_moment(below, ways, found)
    below.set_xlabel(theme.clock(run))
    legend_below(figure, above)
    panels = (Panel(above, "plan", "m"), Panel(below, "time", "m", series))
    alone = len(run.evaders) == 1
    name, whom = ("missed_capture", "it") if alone else (f"missed_capture_{evader.id}", f"evader {evader.id}")
    return Drawing(name, f"Why {whom} was not captured", note(found, ids), figure, panels)


def ways_of(run: Run, evader: Flown) -> tuple[Ways | None, tuple[int, ...]]:
    """The game of an evader as it was flown, in the air, with all pursuers, for any could have met it: None
    where it was captured, or too little is known."""
    setup, fate = run.setup, run.fate_of(evader.id)
    if setup is None or fate is None or fate.verdict is OutcomeResult.CAPTURED:
        return None, ()
    speeds = {member.id: member.speed for member in setup.roster}
    team = [f for f in run.flown.values() if f.role is Role.PURSUER and len(f.t) > 1 and speeds.get(f.id)]
    inside = (evader.t >= 0.0) & (evader.t <= fate.time_s)
    t = evader.t[inside]
    if len(t) < 2 or not team or not speeds.get(evader.id):
        return None, ()
    drift = _drift(evader, t)
    places = np.stack([f.at(t) - drift for f in team])
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


def _drift(evader: Flown, t: Array) -> Array:
    """How far the air had moved at each instant [m], by the mean wind that the evader's autopilot told."""
    wind = evader.wind[np.isfinite(evader.wind).all(axis=1)]
    mean = wind.mean(axis=0) if len(wind) else np.zeros(3)
    moved: Array = np.outer(t - t[-1], mean)
    return moved
