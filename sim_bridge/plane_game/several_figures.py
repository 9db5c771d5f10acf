"""Pictures and animations of plane games of several evaders: paths, targets, cones, who goes for whom."""

from __future__ import annotations

from math import atan2, pi
from pathlib import Path
from typing import Any

from onboard.core.game.advance import still_view
from onboard.core.game.many import ManyGame, alone, conditions_alone, live
from onboard.core.geometry.assessment import half_angle
from onboard.core.math.vectors import NORTH, Vec, unit
from onboard.core.strategy.team.plan_types import NOBODY
from onboard.game import palette
from sim_bridge.plane_game.figures import arrow, extent, filmed, frame, pyplot, saved, wedge, zones_on
from sim_bridge.plane_game.several import COUNTED, Played

LINES = 600  # points of a path at most
EVADER, TARGET = palette.EVADER.light, palette.TARGET.light


def draw_game(played: Played, folder: Path, stem: str = "") -> list[Path]:
    """Initial and final stage side by side, as PNG and SVG named `stem` ("": after scenario and strategy).

    Returns the files written.
    """
    figure, axes = pyplot().subplots(1, 2, figsize=(14, 7.2), layout="constrained")
    last = len(played.frames) - 1
    for axis, index, title in ((axes[0], 0, "initial stage"), (axes[1], last, "final stage")):
        draw_stage(axis, played, index)
        axis.set_title(title)
    figure.suptitle(title_of(played))
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=7, fontsize=9)
    name = f"{played.scenario.name}-{played.strategy}".replace(" ", "-").replace(",", "").replace("/", "-")
    return saved(figure, folder, stem or name)


def title_of(played: Played) -> str:
    """How the game ended, in a line."""
    found = [f"{played.verdicts.count(word)} {word}" for word in COUNTED if word in played.verdicts]
    return f"{played.scenario.name}, pursuers by {played.strategy}: {', '.join(found)}"


def animate(played: Played, path: Path) -> None:
    """The game as GIF, or as MP4 where ffmpeg is at hand. Raises ConfigError."""

    def draw(axis: Any, index: int) -> None:
        draw_stage(axis, played, index)
        axis.set_title(title_of(played))

    filmed(draw, len(played.frames), path)


def draw_stage(axis: Any, played: Played, index: int) -> None:
    """One instant: paths so far, targets, blocked headings, and a line from each pursuer to its quarry."""
    scenario, game = played.scenario, played.frames[index]
    points = _points(played)
    span = extent(points)
    zones_on(axis, played.scenario)
    for number, id in enumerate(scenario.evader_ids):
        _path(axis, [f.evaders[number].position for f in _kept(played, index)], EVADER, "--")
        place, verdict = game.evaders[number].position, game.scores[number].verdict
        axis.plot(place.y, place.x, "o" if live(game.scores[number]) else "X", color=EVADER, ms=8,
                  label=f"evader {id}")  # fmt: skip
        words = str(id) if live(game.scores[number]) else f"{id} {verdict.name.lower()}"
        axis.annotate(words, (place.y, place.x), (7, 6), textcoords="offset points", color=EVADER)
        _targets(axis, played, number, id)
        if live(game.scores[number]):
            _cones(axis, played, game, number, span)
    for number, id in enumerate(scenario.pursuer_ids):
        colour = palette.vehicle(id, evader=False).light
        _path(axis, [f.pursuers[number].position for f in _kept(played, index)], colour, "-")
        own, quarry = game.pursuers[number].position, game.quarries[number]
        axis.plot(own.y, own.x, "o", color=colour, ms=6, label=f"pursuer {id}")
        if quarry != NOBODY and live(game.scores[quarry]):
            its = game.evaders[quarry].position
            axis.plot([own.y, its.y], [own.x, its.x], ":", color=colour, lw=0.8)
    axis.text(
        0.02, 0.98, f"t = {game.time:.2f} s", transform=axis.transAxes, va="top", fontsize=9,
        bbox={"fc": palette.PAPER.light, "ec": "none", "alpha": 0.8},
    )  # fmt: skip
    frame(axis, points)


def _kept(played: Played, index: int) -> list[ManyGame]:
    frames = played.frames[: index + 1]
    return [*frames[: -1 : max(1, len(frames) // LINES)], frames[-1]]


def _path(axis: Any, line: list[Vec], colour: str, style: str) -> None:
    axis.plot([p.y for p in line], [p.x for p in line], style, color=colour, lw=1.1)


def _targets(axis: Any, played: Played, number: int, id: int) -> None:
    for k, target in enumerate(played.conditions.targets[number]):
        if target.exists:
            place = target.position
            label = "target" if number == 0 and k == 0 else None
            axis.plot(place.y, place.x, "*", color=TARGET, ms=14, label=label)
            axis.annotate(f"of {id}", (place.y, place.x), (8, -10), textcoords="offset points", color=TARGET)


def _cones(axis: Any, played: Played, game: ManyGame, number: int, span: float) -> None:
    """What pursuers block of an evader's headings, and where it flies."""
    evader = game.evaders[number]
    view = still_view(alone(game, number), conditions_alone(game, number, played.conditions))
    for cone in view.cones:
        half = half_angle(cone)
        if half < pi:
            axis.add_patch(wedge(evader.position, 0.05 * span, atan2(cone.axis.x, cone.axis.y), half))
    arrow(axis, evader.position, unit(evader.velocity, NORTH), 0.06 * span, EVADER, None)


def _points(played: Played) -> list[Vec]:
    step = max(1, len(played.frames) // 100)
    found = [v.position for f in played.frames[::step] for v in (*f.evaders, *f.pursuers)]
    return found + [t.position for own in played.conditions.targets for t in own if t.exists]
