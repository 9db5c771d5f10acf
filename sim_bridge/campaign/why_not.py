"""Why the evader of a computed game was not captured: the moment that was missed, and its picture."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from onboard.game import palette
from onboard.game.hindsight import Ways, in_words, missed
from onboard.game.hindsight_sketch import Marks, draw_map, draw_moment
from onboard.game.scenario import Scenario, targets_of
from onboard.runtime.whole_files import whole_or_nothing
from sim_bridge.campaign.plane_in_wind import climate_of, wind_at

Array = NDArray[np.float64]


def ways_of(scenario: Scenario, places: Array, step: float, aircraft: bool) -> Ways:
    """A game by everybody's places (n, players, 3) [m; NED], evader first, every `step` [s]; that of
    `aircraft` in the air of the scenario's mean wind, others in air that stands."""
    t = np.asarray(step * np.arange(len(places)), dtype=np.float64)
    if aircraft:
        wind = wind_at(climate_of(scenario.flight.wind), scenario.evader.start())
        places = places - np.outer(t - t[-1], wind)[:, None, :]
    return Ways(
        t, places[:, 0], places[:, 1:].transpose(1, 0, 2), np.array([p.speed for p in scenario.pursuers]),
        scenario.evader.speed, scenario.parameters.R, scenario.planar,
    )  # fmt: skip


def why_not(scenario: Scenario, ways: Ways, path: Path) -> str:
    """Draw the moment from which nobody could have met the evader, as a PNG; gives it in words.

    Raises ConfigError where the file cannot be written.
    """
    found = missed(ways)
    ids = tuple(scenario.ids[1:])
    targets = tuple((goal.x, goal.y, goal.z) for goal in targets_of(scenario.evader))
    colours = tuple(palette.vehicle(id, False).light for id in ids)
    marks = Marks(ids, colours, palette.vehicle(scenario.ids[0], True).light, targets)
    figure = Figure(figsize=(9.0, 7.6), layout="constrained")
    FigureCanvasAgg(figure)
    above, below = figure.subplots(2, 1, height_ratios=(2.2, 1.0))
    draw_map(above, ways, found, marks)
    for k, colour in enumerate(colours):
        below.plot(found.instants, found.spare[:, k], color=colour, lw=1.2)
    draw_moment(below, ways, found)
    below.set_xlabel("t [s]")
    above.set_title(f"{scenario.name}: why it was not captured", fontsize=11)
    figure.legend(*above.get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=8)
    whole_or_nothing(path, partial(figure.savefig, dpi=110))
    return in_words(found, ids)
